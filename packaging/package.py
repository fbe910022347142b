"""`make package`: guide, frozen program, bill, Debian package, portable archive, checksums; tells sizes.

    python packaging/package.py [guide] [freeze] [bill] [deb] [archive] [sums]    (nothing named: all of them)

What is in `dist/` is replaced only by what has been finished, so that a failed build leaves the last one.
"""

from __future__ import annotations

import hashlib
import io
import os
import shutil
import subprocess
import sys
import tarfile
import time
from collections.abc import Callable
from pathlib import Path, PurePosixPath
from typing import IO

ROOT = Path(__file__).parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "packaging")]

import lean  # noqa: E402

from core import __version__  # noqa: E402

DIST, BUILD = ROOT / "dist", ROOT / "build"
PROGRAM = DIST / "busk"
ARCHIVE = DIST / f"busk-{__version__}-linux-x86_64.tar.zst"
TOOLS = {"objdump": "binutils", "strip": "binutils", "dpkg-deb": "dpkg", "zstd": "zstd"}
LEVEL = 16
"""Of zstd, for package and archive: what other levels take is measured in packaging/README.md."""

READ_ME = f"""\
Busk {__version__}, portable, for Linux on x86-64 (glibc 2.36 or newer: Debian 12, Ubuntu 24.04, Fedora 38)

Unpack it anywhere and start busk/busk, with a file to open one. Nothing is installed, and removing the folder
removes the program; what you save, and its settings, are yours and stay where they are.

What it needs is what every desktop has: OpenGL (libGL, libEGL), X11 or Wayland, GLib, D-Bus, fontconfig,
FreeType. `busk/busk self-test` tells what works. Licences: busk/_internal/licences. Guide: the menu Help, or
busk/_internal/site/index.html.
"""


def main(steps: list[str]) -> int:
    """Take the named steps, or all; say what is missing, what each made, and how large it is."""
    known = {"guide": guide, "freeze": freeze, "bill": bill, "deb": deb, "archive": archive, "sums": sums}
    if unknown := set(steps) - set(known):
        print(f"No such step: {', '.join(sorted(unknown))}. There are: {', '.join(known)}.", file=sys.stderr)
        return 2
    if missing := sorted({package for tool, package in TOOLS.items() if not shutil.which(tool)}):
        print(f"Building needs packages that are not here: {', '.join(missing)}.", file=sys.stderr)
        print("'make package' installs them; packaging/README.md tells more.", file=sys.stderr)
        return 2
    DIST.mkdir(exist_ok=True)
    for name, step in known.items():
        if not steps or name in steps:
            _timed(name, step)
    return 0


def _timed(name: str, step: Callable[[], None]) -> None:
    start = time.perf_counter()
    step()
    print(f"package: {name} {time.perf_counter() - start:.0f} s", flush=True)


def _run(*command: str | Path, **settings: str) -> None:
    environment = {**os.environ, **settings}
    subprocess.run([str(word) for word in command], cwd=ROOT, env=environment, check=True)


def guide() -> None:
    """Build the user guide, if it has changed, into ``site/``."""
    _run("make", "--no-print-directory", "docs")


def freeze() -> None:
    """Build the one-folder program and put it in the place of the last one."""
    fresh = BUILD / "dist"
    shutil.rmtree(fresh, ignore_errors=True)
    _run(
        *(sys.executable, "-m", "PyInstaller", "--log-level", "WARN", "--noconfirm"),
        *("--distpath", fresh, "--workpath", BUILD / "work", ROOT / "packaging" / "busk.spec"),
        PYTHONHASHSEED="1",  # sets are written into compiled modules in the order of their hashes
        SOURCE_DATE_EPOCH=str(epoch()),
    )
    lean.strip(fresh / "busk")
    _swap(fresh / "busk", PROGRAM)
    print(told_sizes(PROGRAM))


def _swap(fresh: Path, place: Path) -> None:
    """Put a folder in the place of another, so that nobody meets half of it."""
    old = place.with_name(place.name + ".old")
    shutil.rmtree(old, ignore_errors=True)
    if place.exists():
        place.rename(old)
    fresh.rename(place)
    shutil.rmtree(old, ignore_errors=True)


def epoch() -> int:
    """Return the time of all that is written, in seconds since 1970: if not told, of the last commit."""
    if told := os.environ.get("SOURCE_DATE_EPOCH"):
        return int(told)
    asked = subprocess.run(
        ["git", "log", "-1", "--format=%ct"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    return int(asked.stdout.strip() or 0)


def bill() -> None:
    """List what is shipped, and lay the texts of its licences beside it."""
    _run(sys.executable, "packaging/bill.py")


def deb() -> None:
    """Make the Debian package."""
    _run(sys.executable, "packaging/linux/deb.py", "--program", PROGRAM, "--out", DIST)


def archive() -> None:
    """Pack the program into one file, the same bytes from the same program."""
    unfinished = ARCHIVE.with_suffix(".part")
    pack = ["zstd", f"-{LEVEL}", "--long=27", "-T2", "-q", "-c"]
    with unfinished.open("wb") as file, subprocess.Popen(pack, stdin=subprocess.PIPE, stdout=file) as packer:
        assert packer.stdin is not None
        write_tar(packer.stdin, PROGRAM, f"busk-{__version__}")
    if packer.returncode:
        raise SystemExit("zstd failed; its reason stands above.")
    unfinished.replace(ARCHIVE)


def write_tar(stream: IO[bytes], program: Path, folder: str) -> None:
    """Write ``folder``, with a README and the program in it: sorted, of one time, owned by nobody."""
    with tarfile.open(fileobj=stream, mode="w|", format=tarfile.PAX_FORMAT) as tar:
        text = READ_ME.encode()
        read_me = _plain(tarfile.TarInfo(f"{folder}/README.txt"))
        read_me.size, read_me.mode = len(text), 0o644
        tar.addfile(read_me, io.BytesIO(text))
        for path in sorted((program, *program.rglob("*"))):
            place = PurePosixPath(folder, "busk", path.relative_to(program))
            tar.add(path, str(place), recursive=False, filter=_plain)


def _plain(entry: tarfile.TarInfo) -> tarfile.TarInfo:
    entry.uid = entry.gid = 0
    entry.uname = entry.gname = ""
    entry.mtime = epoch()
    entry.mode = 0o755 if entry.isdir() or entry.mode & 0o100 else 0o644
    return entry


def sums() -> None:
    """Write SHA256SUMS over what is given to people, and say how large it is."""
    lines = []
    for path in sorted(DIST.glob("busk[-_]*")):
        if path.is_file() and __version__ in path.name and not path.name.endswith(".part"):
            with path.open("rb") as file:
                lines.append(f"{hashlib.file_digest(file, 'sha256').hexdigest()}  {path.name}\n")
            print(f"{path.stat().st_size / 1e6:9.1f} MB  {path.name}")
    (DIST / "SHA256SUMS").write_text("".join(lines))


def told_sizes(program: Path) -> str:
    """Return what the program takes, and its largest parts, in MB."""
    parts: dict[str, int] = {}
    for path in program.rglob("*"):
        if path.is_file() and not path.is_symlink():
            inside = path.relative_to(program).parts
            part = inside[1] if len(inside) > 2 else "the rest"
            parts[part] = parts.get(part, 0) + path.stat().st_size
    lines = [f"{sum(parts.values()) / 1e6:9.1f} MB  unpacked, of this:"]
    largest = sorted(parts.items(), key=lambda part: -part[1])[:12]
    return "\n".join([*lines, *(f"{size / 1e6:9.1f} MB    {part}" for part, size in largest)])


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
