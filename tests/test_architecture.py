"""The floor plan of ARCHITECTURE.md holds: each module imports only what stands below or before it."""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from functools import cache
from itertools import permutations
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
PAGE = (ROOT / "ARCHITECTURE.md").read_text("utf-8")

# From the ground up, each floor in order: a module may import what stands to its left or on a floor below.
# The rooms stand in ARCHITECTURE.md: `folder/` holds what follows in its row, but for **`nouns`**.
CORE_FLOORS = ("ground", "reading", "cleaning", "standing", "slicing", "finding", "fitting", "measuring")
CORE_FLOORS += ("mechanics", "solving", "document", "tailoring", "aims", "advice")
APP_FLOORS = (
    "seeing",
    "wording",
    "printing",
    "asking",
    "dress",
    "showing",
    "presenting",
    "exporting",
    "reporting",
    "keeping",
    "viewing",
)
APP_FLOORS += ("helping", "desks", "lining", "roof")


def rooms_of(floor: str) -> list[str]:
    row = next(line for line in PAGE.splitlines() if line.startswith(f"| {floor} |")).split("|")[2]
    house, folder, rooms = "core" if floor in CORE_FLOORS else "app", "", []
    for noun, name in re.findall(r"(\*\*)?`([a-z_]+/?)`", row):
        if name.endswith("/"):
            folder = name[:-1] + "."
        else:
            rooms.append(f"{house}.{name if noun else folder + name}")
    return rooms


FLOORS = {floor: rooms_of(floor) for floor in CORE_FLOORS + APP_FLOORS}
ANATOMY = CORE_FLOORS[1:8]
NUMBERS = {"numpy", "scipy"}
QT = {"PySide6.QtCore", "PySide6.QtGui", "PySide6.QtWidgets"}
OUTSIDE = {
    "ground": NUMBERS | {"numba"},
    **dict.fromkeys(ANATOMY, NUMBERS),
    "reading": NUMBERS | {"PIL"},
    "mechanics": NUMBERS,
    "solving": NUMBERS | {"threadpoolctl"},
    "document": NUMBERS | {"trimesh", "threadpoolctl", "platformdirs", "potpourri3d"},
    "tailoring": NUMBERS | {"ezdxf", "platformdirs"},
    "aims": NUMBERS | {"threadpoolctl"},
    "advice": NUMBERS | {"threadpoolctl"},
    "seeing": NUMBERS | {"pyvista", "vtkmodules"},
    "wording": set(),
    "printing": NUMBERS | {"pyvista", "vtkmodules", "matplotlib", "PIL"},
    "asking": {"numpy", "PySide6.QtCore", "PySide6.QtGui"},
    "dress": {"PySide6.QtCore", "PySide6.QtGui", "PySide6.QtWidgets", "PySide6.QtSvg"},
    "showing": {"numpy", "pyvista", "pyvistaqt", "pyqtgraph", "vtkmodules", "PySide6.QtCore", "PySide6.QtGui"}
    | {"PySide6.QtWidgets", "PySide6.QtOpenGLWidgets"},
    "presenting": {"numpy"},
    "reporting": QT | {"numpy"},
    "exporting": set(),
    "keeping": QT,
    "viewing": QT | {"numpy"},
    "helping": QT | {"PySide6", "platformdirs"},
    "desks": QT | {"numpy", "PySide6.QtSvg", "PySide6.QtPrintSupport"},
    "lining": QT | {"numpy"},
    "roof": NUMBERS
    | {"PySide6", "pyvista", "pyvistaqt", "platformdirs", "threadpoolctl", "PySide6.QtCore", "PySide6.QtGui"}
    | {"PySide6.QtWidgets", "PySide6.QtPrintSupport", "PySide6.QtSvg", "PIL", "ezdxf", "vtkmodules"},
}
PANELS = ("lines", "landmarks", "model", "rail", "result", "scan", "status", "top_bar", "view_tools")
STRANGERS = (
    ["core.mechanics.tensegrity", "core.mechanics.constraint_lines", "core.mechanics.volume"],
    [
        "app.gui.viewport.viewport",
        "app.gui.plots.convergence_panel",
        "app.gui.widgets.notification_bar",
        *(f"app.panels.{panel}" for panel in PANELS),
    ],
)
# Scans are personal data: nothing here talks to a network, and no file can smuggle code in.
FORBIDDEN = {"asyncio", "ftplib", "http", "pickle", "requests", "shelve", "smtplib", "socket", "socketserver"}
FORBIDDEN |= {"ssl", "urllib", "urllib3", "webbrowser", "xmlrpc", "PySide6.QtNetwork", "PySide6.QtWebSockets"}

FLOOR_OF = {name: floor for floor, names in FLOORS.items() for name in names}
RANK = {module: rank for rank, module in enumerate(FLOOR_OF)}
FILES = {
    ".".join(path.relative_to(ROOT).with_suffix("").parts): path
    for house in ("core", "app")
    for path in sorted((ROOT / house).rglob("*.py"))
    if path.name != "__init__.py"
}


def imports(module: str) -> set[str]:
    """Every module that this one imports anywhere: ours in full, of others the first name, of Qt two."""
    return {_room(name) for name in imported_names(module)}


@cache
def imported_names(module: str) -> frozenset[str]:
    """Every name that this module imports anywhere, in full; not those that only annotations need."""
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


def _room(name: str) -> str:
    parts = name.split(".")
    if parts[0] in ("core", "app"):
        return next((room for room in (name, name.rpartition(".")[0]) if room in FILES), parts[0])
    return ".".join(parts[:2]) if parts[0] == "PySide6" else parts[0]


def test_every_module_has_a_room() -> None:
    homeless = sorted(FILES.keys() - FLOOR_OF.keys())
    assert not homeless, f"give them a place in the table of ARCHITECTURE.md: {homeless}"


@pytest.mark.parametrize("module", FILES)
def test_imports_point_downward(module: str) -> None:
    ours = {name for name in imports(module) if name in FILES}
    wrong = sorted(name for name in ours if RANK.get(name, -1) >= RANK.get(module, len(RANK)))
    assert not wrong, f"{module} stands below or beside {wrong}"


@pytest.mark.parametrize("module", FILES)
def test_each_floor_uses_only_its_libraries(module: str) -> None:
    outside = {
        name
        for name in imports(module)
        if name not in FILES and name.split(".")[0] not in sys.stdlib_module_names | {"core", "app"}
    }
    floor = FLOOR_OF.get(module, "roof")
    assert outside <= OUTSIDE[floor], f"not for the floor '{floor}': {sorted(outside - OUTSIDE[floor])}"


@pytest.mark.parametrize("module", FILES)
def test_nothing_reaches_a_network_or_unpickles(module: str) -> None:
    pairs = (name.split(".")[:2] for name in imported_names(module))
    assert not {part for pair in pairs for part in (pair[0], ".".join(pair))} & FORBIDDEN


@pytest.mark.parametrize("group", STRANGERS, ids=lambda group: group[0])
def test_neighbours_do_not_know_each_other(group: list[str]) -> None:
    known = [(one, other) for one, other in permutations(group, 2) if one in FILES and other in imports(one)]
    assert not known


def test_core_never_imports_app() -> None:
    upward = [
        module
        for module in FILES
        if module.startswith("core.") and any(n.startswith("app") for n in imports(module))
    ]
    assert not upward
