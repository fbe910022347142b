"""± on the sheet: as data, in tables, on paper, and a band round its curves; without it nothing is there."""

from __future__ import annotations

import csv
import io
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pdf_tools import Pdf

from app.commands import reported
from app.commands.reported import SheetWishes, run_report
from app.wording.samples import sample_design
from core.measuring.plus_minus import SOURCES, Doubt, Spread
from core.pipeline import Stages, build
from core.report import Shown
from core.sheet import Heading, Sheet, sheet_of, with_spread
from core.solution import Solution, run
from core.writing_out.sheet_file import sheet_csv, sheet_json

OFFS = {"before:bust_girth": 3.7, "after:bust_girth": 4.2, "change:bust_girth": 0.7, "lift": 0.1}


@pytest.fixture(scope="module")
def solved() -> Solution:
    return run(build(sample_design().with_line("mid-bust", 0.95)))


@pytest.fixture(scope="module")
def plain(solved: Solution) -> Sheet:
    shown: Shown = solved
    return sheet_of(shown, solved.records, Heading("anna", "2026-01-31"))


def spread(stages: Stages) -> Spread:
    """What is off by what, without the work of finding it."""
    doubts = {key: Doubt({"scan": sd}) for key, sd in OFFS.items()}
    heights = stages.body.mesh.vertices[:, 2] / 1000.0
    return Spread(doubts, heights, 0.2, 2.0, SOURCES, {}, "sliding")


def test_a_sheet_without_it_has_nothing_of_it(plain: Sheet) -> None:
    assert plain.off == {}
    assert all(cut.off_mm == () for cut in plain.sections)


def test_figures_and_curves_get_what_they_may_be_off_by(solved: Solution, plain: Sheet) -> None:
    sheet = with_spread(plain, solved.stages, solved.control_points, spread(solved.stages))
    assert sheet.off == {key: 2.0 * sd for key, sd in OFFS.items()}
    for before, cut in zip(plain.sections, sheet.sections, strict=True):
        assert replace(cut, off_mm=(), off_before_mm=0.0) == before  # nothing else moves
        assert [len(each) for each in cut.off_mm] == [len(curve) for curve in cut.after]
        assert cut.off_before_mm == 0.4
    side = sheet.sections[0]
    heights = np.concatenate([np.array(curve)[:, 1] for curve in side.after])
    assert np.abs(np.concatenate(side.off_mm) - 2.0 * heights / 1000.0).max() < 0.05
    told = json.loads(sheet_json(sheet))
    assert told["off"]["after:bust_girth"] == 8.4
    rows = {row["key"]: row for row in csv.DictReader(io.StringIO(sheet_csv(sheet)))}
    girth = rows["bust_girth"]
    assert [float(girth[f"off_{each}"]) for each in ("before", "after", "difference")] == [7.4, 8.4, 1.4]
    assert rows["waist_girth"]["off_after"] == ""
    assert float(rows["up"]["off_difference"]) == 0.2


def test_it_stands_on_paper(mannequin: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reported, "spread_of", spread)
    monkeypatch.setattr(reported, "_pictures", lambda _: {})
    design, out = sample_design().with_line("mid-bust", 0.95), tmp_path / "sheet.pdf"
    run_report(str(mannequin), design, [], [], SheetWishes(str(out)))
    assert "± 7.4" not in Pdf(out).text()
    run_report(str(mannequin), design, [], [], SheetWishes(str(out), spread=True))
    said = Pdf(out).text()
    assert all(each in said for each in ("± 7.4", "± 8.4", "± 0.2 mm", "± 1.4", "twice the standard"))
