"""What a Debian package of Busk holds, as a folder: the program, and all that makes a desktop know it."""

from __future__ import annotations

import gzip
import json
import os
import shutil
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent))

from icon_files import DRAWINGS, picture
from man_page import man_page

HERE = Path(__file__).parent
ROOT = HERE.parent.parent

SIZES = (16, 22, 24, 32, 48, 64, 128, 256, 512)
"""Widths of the pictures that desktops look for before they draw the SVG file themselves [pixels]."""

PROJECT_TYPE = "application-x-busk"

COPYRIGHT = """\
Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: Busk

Files: *
Copyright: the authors of Busk, and those of the parts that it brings along
License: Apache-2.0 and those of its parts

License: Apache-2.0 and those of its parts
 Busk itself is under the Apache License 2.0; on Debian systems its text is in
 /usr/share/common-licenses/Apache-2.0.
 .
 The parts that it brings along, each with its licence; copyright and text of
 each stand in /usr/lib/busk/_internal/licences:
 .
"""


def fill(stage: Path, program: Path, epoch: int) -> None:
    """Lay out the package of the one-folder ``program`` below ``stage``, with one date and plain rights."""
    shutil.copytree(program, stage / "usr/lib/busk", symlinks=True)
    (stage / "usr/bin").mkdir(parents=True)
    (stage / "usr/bin/busk").symlink_to("../lib/busk/busk")
    share = stage / "usr/share"
    for entry in sorted(HERE.glob("*.desktop")):
        _copied(entry, share / "applications" / entry.name)
    _copied(HERE / "busk.xml", share / "mime/packages/busk.xml")
    _add_icons(share / "icons/hicolor")
    _packed(man_page(epoch), share / "man/man1/busk.1.gz")
    _packed((ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), share / "doc/busk/changelog.gz")
    (share / "doc/busk/copyright").write_text(copyright_text(program), encoding="utf-8")
    plain(stage, epoch)


def plain(stage: Path, epoch: int) -> None:
    """Give everything the rights 755 or 644 and one date, so that the same files make the same package."""
    for path in [*sorted(stage.rglob("*"), reverse=True), stage]:
        if not path.is_symlink():
            runs = path.is_dir() or (os.access(path, os.X_OK) and ".so" not in path.name)
            path.chmod(0o755 if runs else 0o644)
        os.utime(path, (epoch, epoch), follow_symlinks=False)


def _add_icons(hicolor: Path) -> None:
    for drawing, kind, name in (("busk", "apps", "busk"), ("busk-project", "mimetypes", PROJECT_TYPE)):
        source = DRAWINGS / f"{drawing}.svg"
        _copied(source, hicolor / "scalable" / kind / f"{name}.svg")
        for size in SIZES:
            target = hicolor / f"{size}x{size}" / kind / f"{name}.png"
            target.parent.mkdir(parents=True, exist_ok=True)
            if not picture(drawing, size).save(str(target)):
                raise OSError(f"the picture {target} cannot be written")


def copyright_text(program: Path) -> str:
    """Return who owns what, as the bill of materials inside the program lists it."""
    bill = program / "_internal/licences/bill.json"
    parts = json.loads(bill.read_text(encoding="utf-8"))["components"] if bill.is_file() else []
    return COPYRIGHT + "".join(
        f"  {part['name']} {part.get('version', '')}: {part['licenses'][0]['expression']}\n" for part in parts
    )


def _copied(source: Path, target: Path) -> None:
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(source, target)


def _packed(text: str, target: Path) -> None:
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_bytes(gzip.compress(text.encode(), mtime=0))
