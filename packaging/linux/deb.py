"""Makes ``dist/busk_VERSION_ARCHITECTURE.deb`` of the frozen program in ``dist/busk``.

    python packaging/linux/deb.py [--program DIR] [--out DIR] [--version V]

Needs dpkg-deb and objdump. The same program and the same commit make the same package, byte for byte.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory

import tree
from needs import depends, read_libraries
from package import LEVEL, epoch

from core import __version__

MAINTAINER = "The Busk project <busk@busk.invalid>"
"""Whom to ask; the address is none until the project has one."""

RECOMMENDS = "desktop-file-utils, shared-mime-info, hicolor-icon-theme, xdg-utils"
"""What tells desktops of Busk; the last opens the guide and folders from within it."""

DESCRIPTION = """\
see how a foundation garment reshapes a body, before it is cut
 Busk is a program for designers of tailor-made bras, bodysuits and girdles.
 Open a body scan: it finds the bust landmarks and lays lines of a garment on
 the body. Drag the length of a line, and the body is reshaped at once, true
 to its volume. It measures before and after, tells lengths to cut and prints
 the sheet to work from. In English and Japanese.
 .
 The result is a model. Nothing leaves the computer: Busk has no network code.
"""


def architecture() -> str:
    """Return Debian's name for this kind of machine."""
    return _asked("dpkg", "--print-architecture")


def control(version: str, needed: str, size: int) -> str:
    """Return the control file; ``size`` [KiB] is what the package takes on the disk."""
    fields = {
        "Package": "busk",
        "Version": version,
        "Section": "graphics",
        "Priority": "optional",
        "Architecture": architecture(),
        "Maintainer": MAINTAINER,
        "Installed-Size": str(size),
        "Depends": needed,
        "Recommends": RECOMMENDS,
        "Description": DESCRIPTION.rstrip(),
    }
    return "".join(f"{name}: {value}\n" for name, value in fields.items())


def checksums(stage: Path) -> str:
    """Return the list by which ``dpkg --verify`` finds a file that was changed."""
    files = sorted(path for path in stage.rglob("*") if path.is_file() and not path.is_symlink())
    return "".join(
        f"{hashlib.md5(path.read_bytes()).hexdigest()}  {path.relative_to(stage)}\n"
        for path in files
        if "DEBIAN" not in path.parts
    )


def make_deb(program: Path, out: Path, version: str, level: int = LEVEL) -> Path:
    """Write the package of a frozen program into a folder and return its path."""
    if not os.access(program / "busk", os.X_OK):
        raise SystemExit(f"There is no frozen program in {program}: call make package.")
    date, needed = epoch(), depends(*read_libraries(program))
    out.mkdir(parents=True, exist_ok=True)
    target = out / f"busk_{version}_{architecture()}.deb"
    # Beside the target: the copy is large, and a temporary file system may be small.
    with TemporaryDirectory(dir=out, prefix=".deb-") as folder:
        stage = Path(folder) / "busk"
        tree.fill(stage, program, date)
        size = sum(-(-path.lstat().st_size // 1024) for path in stage.rglob("*") if not path.is_dir())
        told = stage / "DEBIAN"
        told.mkdir()
        (told / "md5sums").write_text(checksums(stage), encoding="utf-8")
        (told / "control").write_text(control(version, needed, size), encoding="utf-8")
        tree.plain(stage, date)
        options = ["--root-owner-group", "-Zzstd", f"-z{level}", "--threads-max=2"]
        environment = os.environ | {"SOURCE_DATE_EPOCH": str(date)}
        subprocess.run(["dpkg-deb", *options, "--build", stage, target], check=True, env=environment)
    return target


def _asked(*command: str) -> str:
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


def main() -> None:
    """Read the words and make the package."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument(
        "--program", type=Path, default=tree.ROOT / "dist/busk", help="the one-folder program"
    )
    parser.add_argument("--out", type=Path, default=tree.ROOT / "dist", help="where the package goes")
    parser.add_argument("--version", default=__version__, help="another version, to try an upgrade")
    parser.add_argument("--level", type=int, default=LEVEL, help="how hard zstd tries, 1 to 22")
    words = parser.parse_args()
    print(make_deb(words.program, words.out, words.version, words.level))


if __name__ == "__main__":
    main()
