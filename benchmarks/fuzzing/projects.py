"""Mutated projects: damaged archives, designs with values that make no sense. What opens must save again."""

from __future__ import annotations

import json
import random
import tempfile
import zipfile
from collections.abc import Iterator
from copy import deepcopy
from pathlib import Path
from typing import Any

from damaged_files import damaged_file

from core.document.custom_measures import CustomMeasurement
from core.document.design import Design, ScanSource
from core.document.document import Document
from core.document.elastic import Elastic
from core.document.lines import CustomLine, LineSettings
from core.document.serialization import DESIGN, VARIANTS, to_texts
from core.document.storage.project_file import ScanFile, open_project, read_scan_file, save_project
from core.errors import UserError
from core.landmarks.manual import PlacedMark
from fuzzing.simpler import packed, unpacked, without_items

MEMBER = "scan/body.ply"
SCAN = b"ply\nformat ascii 1.0\nend_header\n"

VALUES = [
    *(None, True, False, 0, 1, -1, 1e308, -1e308, 1e-320, 10**30, 0.5, 9007199254740993),
    *("", " ", "mm", "+z", "nan", "x" * 300, "\u202eabc", "\ud800", "a\0b", "a\nb", "=1+1", "<b>", "é" * 60),
    *([], {}, [[]], [None] * 3, [1, 2, 3], {"a": 1}, [0.1] * 3000, "mid-bust", "168", [["mid-bust", 0.9]]),
]
"""What may stand in the place of any value; JSON's own words for no number come beside them."""


def _document() -> Document:
    line = CustomLine("strap left", (28, 45, 34))
    elastic = Elastic("plush 12", 12.0, ((0.0, 0.0), (0.3, 4.0), (0.8, 11.0)))
    design = Design(ScanSource("/scans/body.ply", MEMBER), customer="Anna").with_custom_line(line)
    design = design.with_line_settings(LineSettings("mid-bust", "Band", "#e5536b", width=20.0)).with_line(
        "mid-bust", 0.9
    )
    design = design.with_custom_measurement(
        CustomMeasurement("rise", "straight", ("bust_point_left", "fold_left"))
    )
    placed = PlacedMark("bust_point_left", (80.0, -140.0, 1204.0))
    design = design.with_placed(placed.name, placed.position).with_elastic("mid-bust", elastic)
    return Document((("A", design), ("B", design.with_line("mid-bust", 0.95))), "A")


def make(chance: random.Random) -> Any:
    """Return a damaged archive, or some changes of the texts in a whole one."""
    if chance.random() < 0.3:
        _, data = damaged_file(chance, {"anna.busk": _archived(to_texts(_document()))})
        return {"data": packed(data)}
    text = chance.choice((DESIGN, DESIGN, VARIANTS))
    changes = [
        [text, chance.randrange(10**6), chance.choice(("set", "set", "drop", "add", "twice", "deep")), value]
        for value in (chance.randrange(len(VALUES) + 2) for _ in range(chance.randrange(1, 4)))
    ]
    return {"changes": changes}


def run(recipe: Any) -> str:
    """Open the project; if it opens, save it, and open what was saved: it must be the same."""
    with tempfile.TemporaryDirectory() as folder:
        path, again = Path(folder) / "anna.busk", Path(folder) / "again.busk"
        path.write_bytes(unpacked(recipe["data"]) if "data" in recipe else _changed(recipe["changes"]))
        document = open_project(path)
        scan = read_scan_file(document.design.scan)
        try:
            save_project(again, document, ScanFile("body.ply", scan.data), None)
            found = open_project(again)
        except UserError as problem:
            raise AssertionError(f"what was opened cannot be saved and opened again: {problem}") from problem
        if repr(_bare(found)) != repr(_bare(document)):
            raise AssertionError("what was saved opens as something else")
    return "opened"


def simpler(recipe: Any) -> Iterator[Any]:
    """Give fewer changes."""
    if "changes" in recipe:
        yield from ({"changes": changes} for changes in without_items(recipe["changes"]) if changes)


def _bare(document: Document) -> list[tuple[str, Any]]:
    """Return the designs without where their scan lies."""
    return [
        (name, vars(design) | {"scan": vars(design.scan) | {"path": "", "member": ""}})
        for name, design in document.designs
    ]


def _changed(changes: list[list[Any]]) -> bytes:
    texts = to_texts(_document())
    trees = {name: json.loads(text) for name, text in texts.items()}
    for name, place, how, value in changes:
        spots = list(_spots(trees[name]))
        if spots:
            _change(*spots[place % len(spots)], how, value)
    return _archived({name: _text(tree) for name, tree in trees.items()})


def _change(holder: Any, key: Any, how: str, value: int) -> None:
    new = deepcopy(VALUES[value]) if value < len(VALUES) else float(("nan", "inf")[value - len(VALUES)])
    if how == "drop":
        del holder[key]
    elif how == "add" and isinstance(holder, dict):
        holder["a key of tomorrow"] = new
    elif how == "twice" and isinstance(holder, list):
        holder.append(holder[key])
    elif how == "deep":
        for _ in range(200 * (1 + value % 4)):
            new = [new]
        holder[key] = new
    else:
        holder[key] = new


def _spots(tree: Any) -> Iterator[tuple[Any, Any]]:
    """Give each place of a value in a tree of JSON, however deep: what holds it, and under which key."""
    waiting = [tree]
    while waiting:
        holder = waiting.pop()
        for key, value in list(holder.items() if isinstance(holder, dict) else enumerate(holder)):
            yield holder, key
            if isinstance(value, dict | list):
                waiting.append(value)


def _text(tree: Any) -> str:
    try:
        return json.dumps(tree)
    except RecursionError:
        return "[" * 5000 + "]" * 5000


def _archived(texts: dict[str, str]) -> bytes:
    with tempfile.TemporaryFile() as file:
        with zipfile.ZipFile(file, "w", zipfile.ZIP_STORED) as archive:
            for name, text in texts.items():
                archive.writestr(name, text.encode("utf-8", "surrogatepass"))
            archive.writestr(MEMBER, SCAN)
        file.seek(0)
        return file.read()
