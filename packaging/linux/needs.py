"""Which packages of Debian the frozen program needs: read off its own libraries, never guessed."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent))

from lean import OF_THE_SYSTEM

OF_LIBC = re.compile(r"(lib(c|m|dl|rt|pthread|util|resolv)|ld-linux-[\w-]+)\.so\.\d")

# Others that a program is linked to if the machine that froze it had no copy to take along.
OTHERS = {
    "libxkbcommon.so.0": "libxkbcommon0", "libxkbcommon-x11.so.0": "libxkbcommon-x11-0",
    "libdrm.so.2": "libdrm2",
    "libxcb-cursor.so.0": "libxcb-cursor0", "libxcb-icccm.so.4": "libxcb-icccm4",
    "libxcb-keysyms.so.1": "libxcb-keysyms1", "libxcb-shape.so.0": "libxcb-shape0",
}  # fmt: skip

# Debian 13 and Ubuntu 24.04 know these under a new name; Debian 12 under the old one.
RENAMED = {"libglib2.0-0", "libcups2"}

# Done without where it is not there: numba's loops run on another pool of threads.
OPTIONAL = {"libtbb.so.12"}

# No library is linked to it: the keyboards that libxkbcommon, inside the program, reads when a window opens.
READ_BY_NAME = ("xkb-data",)


def read_libraries(program: Path) -> tuple[set[str], str]:
    """Return the names that the libraries of a program are linked to outside of it, and the libc they need.

    Needs objdump (binutils), as freezing does.
    """
    files = [path for path in program.rglob("*") if path.is_file() and _is_elf(path)]
    listing = subprocess.run(["objdump", "-p", *files], capture_output=True, text=True, check=False).stdout
    needed = set(re.findall(r"^\s+NEEDED\s+(\S+)", listing, re.MULTILINE))
    versions = {tuple(map(int, found.split("."))) for found in re.findall(r"\sGLIBC_(\d+\.\d+)", listing)}
    inside = {path.name for path in program.rglob("*.so*")}
    return needed - inside, ".".join(map(str, max(versions)))


def depends(outside: set[str], libc: str) -> str:
    """Return the field ``Depends`` for libraries from outside; raises LookupError for an unknown one."""
    packages = set(READ_BY_NAME)
    for name in outside - OPTIONAL:
        package = {**OF_THE_SYSTEM, **OTHERS}.get(name)
        if package:
            packages.add(f"{package}t64 | {package}" if package in RENAMED else package)
        elif not OF_LIBC.fullmatch(name):
            raise LookupError(f"{name} is neither in the program nor known as a library of Debian")
    return ", ".join([f"libc6 (>= {libc})", *sorted(packages)])


def _is_elf(path: Path) -> bool:
    with path.open("rb") as file:
        return file.read(4) == b"\x7fELF"
