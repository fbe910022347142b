"""Names that designers give: into lines, elastics and measures, and out again in files of all kinds."""

from __future__ import annotations

import csv
import io
import json
import random
import re
import tempfile
import xml.etree.ElementTree as Xml
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import ezdxf

from app.cli.commands.cut import FORMS, Cut
from app.cli.solved_design import SolvedDesign
from app.presenters.export import ExportOptions, ExportSource
from app.presenters.export_preview import prepare_export
from core.document.custom_measures import CustomMeasurement
from core.document.design import Design, ScanSource
from core.document.document import Document
from core.document.elastic import Elastic
from core.document.lines import CustomLine, LineSettings
from core.document.storage.project_file import open_project, read_scan_file, save_project
from core.garment.cut_list import cut_list
from core.pipeline.build import Stages, build
from core.pipeline.solve import solve_valid
from core.progress import in_one_go, quiet

BODY = Path(__file__).parents[2] / "resources" / "samples" / "person.ply"

PARTS = [
    *(
        "strap",
        "left",
        " ",
        ".",
        "/",
        "\\",
        ":",
        "..",
        "|",
        "%",
        "$AC",
        "{",
        "}",
        "&amp;",
        "<b>",
        "</svg>",
        "]]>",
    ),
    *(
        "=1+1",
        "+1",
        "-1",
        "@sum",
        "\uff1d1",
        "\uff0b1",
        "\t=1",
        "\n=1",
        '"',
        "'",
        ",",
        ";",
        "#",
        "\\P",
        "\\U+0041",
    ),
    *("\x00", "\x07", "\x1b[31m", "\x7f", "\x85", "\u2028", "\u202e", "\u200f", "\ufeff", "\ufffe", "\uffff"),
    *("\ud800", "\udfff", "é", "e\u0301", "線", "😀", "👩‍👧", "x" * 70, "é" * 250, "con", "nul", "mid-bust"),
]
"""What names are put together of: markup, formulas, controls, halves of letters, long ones, other scripts."""

FORMULA = tuple("=+-@\t\r\uff1d\uff0b\uff0d\uff20")
FILES = ("lines.dxf", "lines.obj", "flat.svg", "flat.dxf", "measures.csv", "measures.json")


def make(chance: random.Random) -> Any:
    """Return names for a line, its title, an elastic, a measure and a customer."""
    keys = ("line", "title", "elastic", "measure", "customer", "source")
    odd = set(chance.sample(keys, chance.randrange(1, len(keys) + 1)))
    return {key: _name(chance) if key in odd else f"my {key}" for key in keys}


def _name(chance: random.Random) -> str:
    return "".join(chance.choice(PARTS) for _ in range(chance.randrange(1, 5)))


def run(recipe: Any) -> str:
    """Make a project with the names, open it, and write all files that they come into."""
    design = _design(recipe)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "names.busk"
        save_project(path, Document.single(design), read_scan_file(design.scan), None)
        opened = open_project(path).design
        assert opened.own_lines == design.own_lines
        assert opened.elastics == design.elastics
        stages = build(design, _stages())
        solution = solve_valid(stages)
        points = solution.control_points
        outcome = ExportSource(stages, points, (), named=("names", design.customer))
        for name in FILES:
            ready = prepare_export(name.partition(".")[0], str(Path(folder) / name), outcome, ExportOptions())
            drawn = in_one_go(ready.draw()) if ready.draw else None
            ready.write(Path(folder) / name, drawn, quiet)
            _check(Path(folder) / name)
        cut = Cut(cut_list(stages, points), SolvedDesign(solution, []))
        for form in ("", "csv", "json"):
            _check_text(FORMS[form](cut), form)
    return "written"


def _design(recipe: Any) -> Design:
    line = CustomLine(recipe["line"], (28, 45, 34))
    curve = ((0.0, 0.0), (0.3, 4.0), (0.8, 11.0))
    elastic = Elastic(recipe["elastic"], 12.0, curve, source=recipe["source"])
    measure = CustomMeasurement(recipe["measure"], "straight", ("bust_point_left", "bust_point_right"))
    design = Design(ScanSource(str(BODY)), customer=recipe["customer"]).with_custom_line(line)
    design = design.with_line(line.name, 0.95).with_custom_measurement(measure)
    return design.with_line_settings(LineSettings(line.name, recipe["title"])).with_elastic(
        line.name, elastic
    )


@cache
def _stages() -> Stages:
    return build(Design(ScanSource(str(BODY))))


def _check(path: Path) -> None:
    """Fail where a file is not what its kind asks for."""
    kind, text = path.suffix[1:], path.read_text(encoding="utf-8")
    if kind == "dxf":
        assert not ezdxf.readfile(path).audit().has_errors, f"{path.name} has errors"
    elif kind == "obj":
        heads = {line.split(" ")[0] for line in text.splitlines() if line}
        assert heads <= {"v", "l", "o", "g", "#"}, heads
    else:
        _check_text(text, kind)


def _check_text(text: str, kind: str) -> None:
    text.encode("utf-8")
    if kind == "svg":
        Xml.fromstring(text)
    elif kind == "json":
        json.loads(text)
    elif kind == "csv":
        rows = list(csv.reader(io.StringIO(text)))
        assert len({len(row) for row in rows if row}) <= 2, "rows of different lengths"
        for cell in (cell for row in rows for cell in row):
            assert not cell.strip().startswith(FORMULA) or _is_number(cell), f"a formula: {cell!r}"
    controls = {letter for letter in text if ord(letter) < 32 or ord(letter) == 127} - set("\n\r\t")
    assert not controls, f"controls in {kind or 'plain'} text: {controls}"


def _is_number(cell: str) -> bool:
    return cell.strip() == "-" or re.fullmatch(r"\s*[+-][\d.,\s]*\d\s?%?", cell) is not None


def simpler(recipe: Any) -> Iterator[Any]:
    """Give plainer names."""
    for key, name in recipe.items():
        if name != f"my {key}":
            yield recipe | {key: f"my {key}"}
            yield from (recipe | {key: name[:k] + name[k + 1 :]} for k in range(len(name)) if len(name) > 1)
