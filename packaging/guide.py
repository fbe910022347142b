"""Build the user guide, English and Japanese, into ``site/`` (``make docs``), without the network."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from importlib import metadata
from pathlib import Path

ROOT = Path(__file__).parent.parent
DOCS = ROOT / "docs"
SITE = ROOT / "site"

PARTS = ("sphinx", "snowballstemmer", "furo", "sphinx-basic-ng", "pygments", "accessible-pygments")
"""Packages whose files are part of the built guide; their licences are included."""

_LOADED = re.compile(
    r"""<(?:script|img|iframe|source|embed|object|video|audio|use)\b[^>]*?\b(?:src|srcset|data|href)=["']([^"']+)
      | <link\b(?![^>]*\brel=["'](?:next|prev|index|search)["'])[^>]*?\bhref=["']([^"']+)
      | url\(\s*["']?([^"')]+)
      | @import\s+["']([^"']+)""",
    re.VERBOSE,
)


def build(site: Path = SITE, work: Path = ROOT / "build" / "guide") -> None:
    """Build the guide and replace ``site`` when it is complete; warnings are errors.

    Raises SystemExit on a warning of Sphinx, or if a page would load a file that is not in the guide.
    """
    shutil.rmtree(work, ignore_errors=True)
    made = work / "site"
    _sphinx(DOCS, made, work / "read")
    _sphinx(DOCS / "ja", made / "ja", work / "read-ja", "-t", "ja")
    _tidy(made)
    remote = loaded_from_elsewhere(made)
    if remote:
        raise SystemExit("The guide would load files that it does not contain:\n" + "\n".join(remote))
    site.parent.mkdir(parents=True, exist_ok=True)
    shutil.rmtree(site, ignore_errors=True)
    shutil.move(made, site)
    shutil.rmtree(work)


def loaded_from_elsewhere(site: Path) -> list[str]:
    """Return remote or missing files that pages and style sheets load, as ``page: address``.

    Links are not loaded.
    """
    found = []
    for page in sorted((*site.rglob("*.html"), *site.rglob("*.css"))):
        for match in _LOADED.finditer(page.read_text("utf-8")):
            address = next(filter(None, match.groups()))
            if address.startswith(("#", "data:")):
                continue
            there = page.parent / re.split("[?#]", address)[0]
            if re.match(r"\w+:|//", address) or not there.exists():
                found.append(f"{page.relative_to(site)}: {address}")
    return found


def _sphinx(source: Path, target: Path, doctrees: Path, *more: str) -> None:
    strictly = ("-q", "-W", "--keep-going")
    command = (sys.executable, "-m", "sphinx", "-b", "html", *strictly, "-c", DOCS, "-d", doctrees, *more)
    # Reproducible: the date of the build must not be in the pages.
    made = subprocess.run(
        [*command, source, target],
        env={**os.environ, "SOURCE_DATE_EPOCH": "0"},
        check=False,
    )
    if made.returncode:
        raise SystemExit(f"Sphinx could not build the guide of {source.name}; see the messages above.")


def _tidy(made: Path) -> None:
    """Remove files that no reader needs, and add the licences."""
    for name in (".buildinfo", "objects.inv", "*.map", ".doctrees"):
        for path in made.rglob(name):
            path.unlink()
    texts = []
    for name in PARTS:
        part = metadata.distribution(name)
        files = [path for path in part.files or () if re.match(r"LICEN[CS]E|COPYING", path.name)]
        texts += [f"{name} {part.version}\n\n{path.read_text(encoding='utf-8')}" for path in files]
    rule = "\n" + "-" * 80 + "\n\n"
    (made / "licences.txt").write_text(rule.join(texts), encoding="utf-8")


if __name__ == "__main__":
    build()
    size = sum(path.stat().st_size for path in SITE.rglob("*") if path.is_file())
    print(f"{SITE.relative_to(ROOT) / 'index.html'} ({size / 1e6:.0f} MB)")
