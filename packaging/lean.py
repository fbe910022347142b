"""What of the libraries goes into the frozen program: decided by name first, then by who needs whom.

Python packages bring far more than Busk can reach: VTK alone 180 modules, Qt the drivers of embedded
screens. What is loaded by name (modules of VTK, plug-ins of Qt) is listed here; every other shared library
stays exactly if something that stays is linked to it. ``packaging/README.md`` says how that was proved.
"""

from __future__ import annotations

import fnmatch
import json
import os
import re
import subprocess
import sys
from collections.abc import Callable, Iterable
from functools import cache
from pathlib import Path, PurePosixPath

# One thing that goes into the program, as PyInstaller writes it: where it will lie, where it lies now,
# its kind.
Entry = tuple[str, str, str]

# Prints the modules of VTK that stay. pyvista has one table of every class that it can ever ask of VTK,
# and so can name all it may load, whatever it is asked for; but its readers and writers of other
# programs' files are left out, as Busk has its own. Modules import others in their machine code: what is
# loaded in the end is told.
NAMED_BY_PYVISTA = """
import importlib, sys
import pyvista, pyvistaqt
from pyvista import _vtk
named = {*_vtk._VTK_CLASS_TO_MODULE.values(), "vtkPythonContext2D", "vtkRenderingMatplotlib"}
for name in named:
    if not name.startswith(("vtkIO", "vtkDomains")):
        importlib.import_module("vtkmodules." + name)
print(*(name[11:] for name in sys.modules if name.startswith("vtkmodules.vtk")))
"""

# Plug-ins of Qt: screens, input methods (compose keys, Japanese by ibus), icons and pictures, printers.
# Left out are embedded screens, the network, and the GTK theme, which draws in some forty libraries of
# the desktop's own.
QT_PLUGINS = (
    "platforms/*qxcb*", "platforms/*qwayland*", "platforms/*qoffscreen*", "platforms/*qminimal.*",
    "platforms/*qwindows*", "platforms/*qcocoa*", "platformthemes/*qxdgdesktopportal*",
    "platforminputcontexts/*", "iconengines/*", "imageformats/*qjpeg*", "imageformats/*qsvg*",
    "imageformats/*qgif*", "imageformats/*qico*", "imageformats/*qicns*", "imageformats/*qwebp*",
    "xcbglintegrations/*", "wayland-shell-integration/*xdg-shell*",
    "wayland-graphics-integration-client/*wayland-egl*", "wayland-decoration-client/*", "printsupport/*",
    "styles/*",
)  # fmt: skip

# Libraries that every Linux desktop has and that must be its own: a graphics driver of the system is
# linked to these too, and one that meets an older copy beside it does not load. Names as Debian packages
# them.
OF_THE_SYSTEM = {
    "libstdc++.so.6": "libstdc++6", "libgcc_s.so.1": "libgcc-s1", "libz.so.1": "zlib1g",
    "libglib-2.0.so.0": "libglib2.0-0", "libgobject-2.0.so.0": "libglib2.0-0",
    "libgio-2.0.so.0": "libglib2.0-0", "libgthread-2.0.so.0": "libglib2.0-0",
    "libgmodule-2.0.so.0": "libglib2.0-0", "libdbus-1.so.3": "libdbus-1-3",
    "libfontconfig.so.1": "libfontconfig1", "libfreetype.so.6": "libfreetype6",
    "libexpat.so.1": "libexpat1", "libX11.so.6": "libx11-6", "libX11-xcb.so.1": "libx11-xcb1",
    "libxcb.so.1": "libxcb1", "libXau.so.6": "libxau6", "libXdmcp.so.6": "libxdmcp6",
    "libXext.so.6": "libxext6", "libXrender.so.1": "libxrender1", "libGL.so.1": "libgl1",
    "libEGL.so.1": "libegl1", "libcups.so.2": "libcups2", "libwayland-client.so.0": "libwayland-client0",
    "libwayland-cursor.so.0": "libwayland-cursor0", "libwayland-egl.so.1": "libwayland-egl1",
}  # fmt: skip

# Opened by name while the program runs, so that nothing is linked to them.
OPENED_BY_NAME = ("*llvmlite*", "*libpython3*", "*python3*.dll", "*opengl32sw.dll", "*Python")

# Data that nobody reads in the program.
NO_DATA = (
    "*/tests/*", "*/test/*", "*.pyi", "*.pyx", "*.pxd", "*.hpp", "*.h", "*.c", "*/py.typed",
    "*/sample_data/*", "matplotlib/mpl-data/fonts/afm/*", "matplotlib/mpl-data/fonts/pdfcorefonts/*",
    "*/__pycache__/*", "certifi/*", "resources/*.py",
    "*.dist-info/RECORD", "*.dist-info/REQUESTED", "*.dist-info/direct_url.json", "*.dist-info/INSTALLER",
    "*.dist-info/uv_cache.json",
)  # fmt: skip
TRANSLATIONS = ("*/translations/qtbase_ja.qm", "*/translations/qtbase_en.qm")

# The bytes of these stay as they were published.
UNTOUCHED = ("numpy", "scipy", "PIL", "pillow", "PySide6", "shapely", "shiboken6")

# Python packages that an import somewhere names and that Busk never comes to: the network, consoles,
# development.
NO_MODULES = [
    "requests", "urllib3", "certifi", "idna", "charset_normalizer", "_ssl", "PySide6.QtNetwork",
    "PySide6.QtDBus", "PySide6.QtTest", "readline", "tkinter", "IPython", "PyQt5", "PyQt6", "PySide2",
    "pytest", "hypothesis", "mypy", "librt", "yaml", "sphinx", "docutils", "babel", "jinja2", "pygments",
    "rich", "cyclopts", "setuptools", "pip", "jedi", "lib2to3", "pydoc_data", "PIL._avif",
    "dask", "distributed", "pyarrow", "psutil",
]  # fmt: skip


def _matches(path: str, patterns: Iterable[str]) -> bool:
    return any(fnmatch.fnmatchcase(path, pattern) for pattern in patterns)


def _parts(place: str) -> str:
    return place.replace("\\", "/")


@cache
def vtk_modules() -> frozenset[str]:
    """Return the names of the modules of VTK that stay."""
    environment = {**os.environ, "QT_API": "pyside6", "QT_QPA_PLATFORM": "offscreen"}
    told = subprocess.run(
        [sys.executable, "-c", NAMED_BY_PYVISTA], capture_output=True, text=True, check=True, env=environment
    )
    return frozenset(told.stdout.split())


def is_of_vtk(place: str) -> bool:
    """Tell whether a shared library or an extension module belongs to VTK, by its name."""
    return bool(re.match(r"(lib)?(vtk|viskores)", PurePosixPath(_parts(place)).name))


def wanted(place: str, kind: str) -> bool:
    """Tell whether what will lie at ``place`` may stay, as far as its name tells."""
    path = _parts(place)
    name = PurePosixPath(path).name
    if name in OF_THE_SYSTEM:
        return False
    if kind == "EXTENSION" and is_of_vtk(path):
        return name.split(".")[0] in vtk_modules()
    if "/plugins/" in path and "PySide6" in path:
        return _matches(path.split("/plugins/")[1], QT_PLUGINS)
    return True


def is_root(place: str, kind: str) -> bool:
    """Tell whether something is loaded by name: an extension module, a plug-in, a library by ctypes."""
    path = _parts(place)
    return kind == "EXTENSION" or "/plugins/" in path or _matches(path, OPENED_BY_NAME)


def linked_to(library: str) -> set[str]:
    """Return the names of the libraries that one is linked to itself; needs objdump (binutils)."""
    listing = subprocess.run(["objdump", "-p", library], capture_output=True, text=True, check=True).stdout
    return set(re.findall(r"^\s+NEEDED\s+(\S+)", listing, re.MULTILINE))


def reached(entries: list[Entry], needs: Callable[[str], set[str]] = linked_to) -> list[Entry]:
    """Return the ``entries`` that are loaded by name, or that one of those needs, directly or through others.

    ``needs`` returns the names that the library at a path is linked to.
    """
    named: dict[str, list[Entry]] = {}
    for entry in entries:
        named.setdefault(PurePosixPath(_parts(entry[0])).name, []).append(entry)
    waiting = [entry for entry in entries if is_root(entry[0], entry[2])]
    found: set[Entry] = set()
    while waiting:
        entry = waiting.pop()
        if entry in found:
            continue
        found.add(entry)
        waiting += [other for name in needs(entry[1]) for other in named.get(name, [])]
    return [entry for entry in entries if entry in found]


def lean(
    binaries: list[Entry], data: list[Entry], needs: Callable[[str], set[str]] = linked_to
) -> tuple[list[Entry], list[Entry]]:
    """Return the shared libraries and the data that stay; a link whose library goes, goes with it."""
    real = [entry for entry in binaries if entry[2] != "SYMLINK" and wanted(entry[0], entry[2])]
    kept = reached(real, needs)
    read = [entry for entry in data if entry[2] != "SYMLINK" and is_read(_parts(entry[0]))]
    places = {_parts(entry[0]) for entry in (*kept, *read)}
    links = [entry for entry in (*binaries, *data) if entry[2] == "SYMLINK" and leads_to(entry) in places]
    return kept, read + links


def leads_to(link: Entry) -> str:
    """Return the place that a link leads to."""
    return str(PurePosixPath(_parts(link[0])).parent / _parts(link[1]))


def is_read(path: str) -> bool:
    """Tell whether a data file is of use in the program, by its place."""
    if "/translations/" in path and "PySide6" in path:
        return _matches(path, TRANSLATIONS)
    return not _matches(path, NO_DATA)


def may_be_stripped(place: str) -> bool:
    """Tell whether the symbols of linking can be taken out of a library, by its place in ``_internal``.

    Not those of OpenBLAS and all else whose wheel was edited after linking: strip breaks them. Qt and its
    bridge stay as they were published, so that anybody can put others in their place.
    """
    return not place.startswith(UNTOUCHED) and fnmatch.fnmatchcase(place, "*.so*")


def strip(program: Path) -> None:
    """Take the symbols of linking out of the libraries of the program that can do without (Linux)."""
    inside = program / "_internal"
    for path in sorted(inside.rglob("*.so*")):
        if path.is_file() and not path.is_symlink() and may_be_stripped(path.relative_to(inside).as_posix()):
            subprocess.run(["strip", "--strip-unneeded", str(path)], check=True)


def write_origins(to: Path, *entries: Iterable[Entry]) -> None:
    """Write where everything came from, ``[[place, source], ...]``: the bill is made of that."""
    origins = sorted(
        {
            (_parts(place), str(source))
            for part in entries
            for place, source, kind in part
            if kind != "SYMLINK"
        }
    )
    to.write_text(json.dumps(origins, indent=0), "utf-8")
