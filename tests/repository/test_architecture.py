"""Packages use only their libraries, and nothing reaches a network. Import-linter checks their order."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2]
NUMBERS = {"numpy", "scipy"}
QT = {"PySide6.QtCore", "PySide6.QtGui", "PySide6.QtWidgets"}
SCENE = NUMBERS | {"pyvista", "vtkmodules"}
LIBRARIES = {
    "core": NUMBERS,
    "core.geometry": NUMBERS | {"numba", "potpourri3d"},
    "core.scan": NUMBERS | {"PIL"},
    "core.blas_threads": {"scipy", "threadpoolctl"},
    "core.document": NUMBERS | {"platformdirs"},
    "core.measurements": NUMBERS | {"platformdirs"},
    "core.garment": NUMBERS | {"platformdirs"},
    "core.pattern": NUMBERS | {"shapely"},
    "core.export": NUMBERS | {"ezdxf", "trimesh"},
    "app.i18n": set(),
    "app.rendering": SCENE | {"PIL"},
    "app.presenters": {"numpy"},
    "app.research": SCENE | {"matplotlib", "PIL", "threadpoolctl", "trimesh"},
    "app.batch": {"numpy", "threadpoolctl", "psutil"},
    "app.batch.body_files": {"numpy", "PIL"},
    "app.batch.engine": {"dask", "distributed"},
    "app.batch.worker_plugin": {"distributed"},
    "app.batch.index_page": {"numpy", "pyarrow"},
    "app.batch.results": {"numpy", "pyarrow"},
    "app.batch.store": {"pyarrow"},
    "app.batch.parts": {"pyarrow"},
    "app.report": QT | {"numpy", "shapely"},
    "app.gui.theme": QT | {"PySide6.QtSvg"},
    "app.gui.widgets": QT | {"numpy"},
    "app.gui.plots": QT | {"numpy", "PySide6.QtSvg"},
    "app.gui.session": QT | {"numpy", "platformdirs"},
    "app.gui.viewport": QT | SCENE | {"pyvistaqt", "PySide6.QtOpenGLWidgets", "PySide6.QtPrintSupport"},
    "app.gui.features": QT | {"PySide6", "numpy", "platformdirs", "PySide6.QtPrintSupport", "PySide6.QtSvg"},
    "app.gui.drawing_base": QT | {"numpy"},
    "app.gui": QT
    | {"PySide6", "PySide6.QtPrintSupport", "platformdirs", "threadpoolctl", "pyvista", "pyvistaqt"},
    "app.cli.commands.batch": {"distributed"},
    "app.cli": QT | SCENE | {"PySide6", "PIL", "ezdxf", "pyvistaqt", "platformdirs", "threadpoolctl"},
    "app": set(),
}
"""Libraries of each package: of the longest name that a module's name begins with."""
# Scans are personal data: nothing here talks to a network, and no file can smuggle code in.
FORBIDDEN = {"asyncio", "ftplib", "http", "pickle", "requests", "shelve", "smtplib", "socket", "socketserver"}
FORBIDDEN |= {"ssl", "urllib", "urllib3", "webbrowser", "xmlrpc", "PySide6.QtNetwork", "PySide6.QtWebSockets"}
FILES = {
    ".".join(path.relative_to(ROOT).with_suffix("").parts): path
    for house in ("core", "app")
    for path in sorted((ROOT / house).rglob("*.py"))
    if path.name != "__init__.py"
}


@cache
def imported_names(module: str) -> frozenset[str]:
    """Return every name that a module imports anywhere, in full; not those that only annotations need."""
    return frozenset(_names(ast.parse(FILES[module].read_text("utf-8"))))


def _names(node: ast.AST) -> Iterator[str]:
    if isinstance(node, ast.Import):
        yield from (alias.name for alias in node.names)
    elif isinstance(node, ast.ImportFrom):
        assert node.level == 0, "imports name their module in full"
        yield from (f"{node.module}.{alias.name}" for alias in node.names)
    elif not (isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"):
        for child in ast.iter_child_nodes(node):
            yield from _names(child)


def _library(name: str) -> str:
    parts = name.split(".")
    return ".".join(parts[:2]) if parts[0] == "PySide6" else parts[0]


def _package(module: str) -> str:
    return max((each for each in LIBRARIES if f"{module}.".startswith(f"{each}.")), key=len)


def test_each_package_uses_only_its_libraries() -> None:
    own = {*sys.stdlib_module_names, "core", "app", "resources"}
    outside = {module: {_library(name) for name in imported_names(module)} - own for module in FILES}
    wrong = {module: names - LIBRARIES[_package(module)] for module, names in outside.items()}
    assert {module: names for module, names in wrong.items() if names} == {}


def test_nothing_reaches_a_network_or_unpickles() -> None:
    assert len(FILES) > 100
    wrong = {module: _forbidden(module) for module in FILES}
    assert {module: names for module, names in wrong.items() if names} == {}


def _forbidden(module: str) -> set[str]:
    pairs = (name.split(".")[:2] for name in imported_names(module))
    return {part for pair in pairs for part in (pair[0], ".".join(pair))} & FORBIDDEN
