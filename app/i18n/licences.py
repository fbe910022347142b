"""The licences of Busk and of what it uses, found from a checkout and from an installation."""

from __future__ import annotations

from importlib import metadata, resources
from pathlib import Path

from app.i18n.catalog import tr


def licences() -> list[tuple[str, str]]:
    """Return titles and texts: Busk's own licence, what it uses, and what is shipped with it."""
    shipped = (
        ("fonts", "Inter-LICENSE.txt"),
        ("fonts", "NotoSansJP-LICENSE.txt"),
        ("icons", "LICENSE-phosphor.txt"),
        ("samples", "LICENSE.txt"),
    )
    texts = [(resources.files("resources") / folder / name).read_text("utf-8") for folder, name in shipped]
    return [
        ("Busk", _text_of("LICENSE")),
        (tr("Libraries"), _text_of("THIRD_PARTY.md")),
        (tr("Fonts, icons, samples"), ("\n\n" + "-" * 80 + "\n\n").join(texts)),
    ]


def _text_of(name: str) -> str:
    """Return a file that lies beside the program in a checkout, and with its metadata once installed."""
    beside = Path(str(resources.files("resources"))).parent / name
    if beside.is_file():
        return beside.read_text("utf-8")
    try:
        found = metadata.distribution("busk").read_text(f"licenses/{name}")
    except metadata.PackageNotFoundError:
        found = None
    return found or tr("{name} is not installed.").format(name=name)
