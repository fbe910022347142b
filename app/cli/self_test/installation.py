"""Parts of a self-test about the program itself: what it is made of, what it brings along."""

from __future__ import annotations

import json
import platform
import sys
from collections.abc import Callable, Sized
from importlib import metadata, resources
from pathlib import Path

from app.cli.self_test.checks import PartError, check
from app.cli.self_test.fixture import Bench
from core import __version__


def is_frozen() -> bool:
    """Tell whether this is the packaged program."""
    return bool(getattr(sys, "frozen", False))


def _home() -> Path:
    """Return the folder that holds the resources."""
    return Path(str(resources.files("resources"))).parent


def versions(bench: Bench) -> str:
    """Tell what the program is made of, and where it lies."""
    import numpy  # noqa: PLC0415 (what cannot be imported is told by this part)
    import scipy  # noqa: PLC0415
    from PySide6.QtCore import qVersion  # noqa: PLC0415
    from vtkmodules.vtkCommonCore import vtkVersion  # noqa: PLC0415

    from app.gui.features.help.system_info import LIBRARIES  # noqa: PLC0415

    made_of = {
        "Busk": __version__,
        "Python": platform.python_version(),
        "Qt": qVersion(),
        "VTK": vtkVersion.GetVTKVersion(),
        "numpy": numpy.__version__,
        "scipy": scipy.__version__,
    }
    untold = [name for name in LIBRARIES if name != "numba" and not _is_told(name)]
    check(not untold, f"unknown versions: {', '.join(untold)}")
    told = ", ".join(f"{name} {version}" for name, version in made_of.items())
    return f"{told}; {'packaged' if is_frozen() else 'from source'}, {platform.platform()}, in {_home()}"


def _is_told(name: str) -> bool:
    try:
        return bool(metadata.version(name))
    except metadata.PackageNotFoundError:
        return False


def shipped_files(bench: Bench) -> str:
    """Read all tables, words, icons and samples."""
    from app.i18n.catalog import read_words  # noqa: PLC0415
    from app.i18n.licences import licences  # noqa: PLC0415
    from core.control_mesh.template import TEMPLATES, read_template  # noqa: PLC0415
    from core.document.presets import built_in as presets  # noqa: PLC0415
    from core.garment.elastic_library import built_in as elastics  # noqa: PLC0415
    from core.garment.pressure_limits import pressure_limits  # noqa: PLC0415
    from core.measurements.letter_sizes import letter_sizes  # noqa: PLC0415
    from core.measurements.sizes import built_in as sizes  # noqa: PLC0415

    counts = {
        "templates": _counted("a template", lambda: [read_template(name) for name in TEMPLATES], 2),
        "presets": _counted("a preset", presets, 3),
        "elastics": _counted("an elastic", elastics, 6),
        "size charts": _counted("a size chart", sizes, 7),
        "words": _counted("words", lambda: [*read_words("ja"), *read_words("ja_messages")], 1000),
        "icons": _counted("an icon", lambda: list(_home().glob("resources/icons/*.svg")), 40),
        "samples": _counted("a sample", lambda: list(_home().glob("resources/samples/*.ply")), 2),
    }
    _counted("letter sizes", lambda: letter_sizes().tables, 1)
    _counted("measurement names", lambda: json.loads(_text("measure_names.json")), 1)
    _counted("contact pressure limits", lambda: [pressure_limits()], 1)
    _counted("style", lambda: _text("style.qss"), 100)
    missing = [title for title, text in licences() if len(text) < 500]
    check(not missing, f"missing text: {', '.join(missing)}")
    return ", ".join(f"{count} {name}" for name, count in counts.items())


def _text(name: str) -> str:
    return (resources.files("resources") / name).read_text(encoding="utf-8")


def _counted(name: str, read: Callable[[], Sized], least: int) -> int:
    """Return how many there are, and say which kind it is that cannot be read or is not complete."""
    try:
        count = len(read())
    except Exception as fault:
        raise PartError(f"{name} cannot be read: {type(fault).__name__}, {fault}") from fault
    check(count >= least, f"{count} files of {name}, not {least}")
    return count


def guide(bench: Bench) -> str:
    """Find the user guide; a checkout may not have built it."""
    page = _home() / "site" / "index.html"
    if not page.is_file():
        check(not is_frozen(), f"no guide at {page}")
        return "not built in this checkout"
    check(b"</html>" in page.read_bytes(), f"{page} is an incomplete page")
    return f"{len(list(page.parent.rglob('*.html')))} pages"
