"""± on the sheet: as data, in tables, on paper, and a band round its curves; without it nothing is there."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pdf_tools import Pdf
from PySide6.QtGui import QImage

from app.cli.commands import report as reported
from app.cli.commands.report import ReportOptions, write_report
from app.gui.theme.stylesheet import load_fonts
from app.presenters.samples import sample_design
from app.report.cut_rows import force_range_warning, line_notes
from app.report.document import SHOTS, ReportDocument
from app.report.pages import pages_of
from app.report.text import note_groups
from core.export.report_data import Heading, Report, make_report, with_uncertainty
from core.export.report_data_file import report_csv, report_json
from core.garment.elastic_library import find_elastic
from core.garment.presets import built_in, with_preset
from core.measurements.uncertain_value import (
    AFTER,
    BEFORE,
    CHANGE,
    CUT,
    LIFT,
    MAX_KPA,
    OUT,
    SOURCES,
    TENSION,
    OutputUncertainties,
    Uncertainty,
)
from core.pipeline.build import Stages, build
from core.pipeline.solve import Solution, solve
from core.pipeline.warnings import ShownState

OFFS = {"before:bust_girth": 3.7, "after:bust_girth": 4.2, "change:bust_girth": 0.7, "lift": 0.1}


@pytest.fixture(scope="module")
def solved() -> Solution:
    return solve(build(sample_design().with_line("mid-bust", 0.95)))


@pytest.fixture(scope="module")
def plain(solved: Solution) -> Report:
    shown: ShownState = solved
    return make_report(shown, solved.records, Heading("anna", "2026-01-31"))


def spread(stages: Stages) -> OutputUncertainties:
    """What is off by what, without the work of finding it."""
    doubts = {key: Uncertainty({"scan": sd}) for key, sd in OFFS.items()}
    heights = stages.body.mesh.vertices[:, 2] / 1000.0
    return OutputUncertainties(doubts, heights, 0.2, 2.0, SOURCES, {}, "sliding")


def test_a_sheet_without_it_has_nothing_of_it(plain: Report) -> None:
    assert plain.off == {}
    assert all(cut.off_mm == () for cut in plain.sections)


def test_figures_and_curves_get_what_they_may_be_off_by(solved: Solution, plain: Report) -> None:
    sheet = with_uncertainty(plain, solved.stages, solved.control_points, spread(solved.stages))
    assert sheet.off == {key: 2.0 * sd for key, sd in OFFS.items()}
    for before, cut in zip(plain.sections, sheet.sections, strict=True):
        assert replace(cut, off_mm=(), off_before_mm=0.0) == before  # nothing else moves
        assert [len(each) for each in cut.off_mm] == [len(curve) for curve in cut.after]
        assert cut.off_before_mm == 0.4
    side = sheet.sections[0]
    heights = np.concatenate([np.array(curve)[:, 1] for curve in side.after])
    assert np.abs(np.concatenate(side.off_mm) - 2.0 * heights / 1000.0).max() < 0.05
    told = json.loads(report_json(sheet))
    assert told["off"]["after:bust_girth"] == 8.4
    rows = {row["key"]: row for row in csv.DictReader(io.StringIO(report_csv(sheet)))}
    girth = rows["bust_girth"]
    assert [float(girth[f"off_{each}"]) for each in ("before", "after", "difference")] == [7.4, 8.4, 1.4]
    assert rows["waist_girth"]["off_after"] == ""
    assert float(rows["up"]["off_difference"]) == 0.2


def everywhere(stages: Stages, sheet: Report) -> OutputUncertainties:
    """What is off by as much as on a usual body, at every figure."""
    keys = [f"{kind}:{row['key']}" for row in sheet.measures for kind in (BEFORE, AFTER, CHANGE)]
    doubts = {key: Uncertainty({"scan": 4.0}) for key in (*keys, LIFT, OUT)}
    doubts |= {f"{CUT}:{row.line}": Uncertainty({"tape": 4.0}) for row in sheet.cuts.rows}
    figures = {f"{TENSION}:{row.line}": row.tension_n for row in sheet.cuts.rows if row.tension_n}
    figures |= {f"{MAX_KPA}:{row.line}": row.max_kpa for row in sheet.pressures if row.max_kpa}
    doubts |= {key: Uncertainty({"tissue": 0.5 * value}) for key, value in figures.items()}
    skin = np.full(len(stages.body.mesh.vertices), 1.0)
    return OutputUncertainties(doubts, skin, 0.2, 2.0, SOURCES, {}, "sliding", values=figures)


@pytest.mark.parametrize("body", ["mannequin", "person"])
def test_a_usual_design_has_room_on_two_pages(
    body: str, built: Callable[[str], Stages], qapp: object
) -> None:
    load_fonts()
    stages = built(body)
    bra = with_preset(stages.design, next(each for each in built_in() if each.title == "Bra"))
    shown = solve(build(bra, stages))
    sheet = make_report(shown, shown.records, Heading("anna", "2026-01-31", customer="Anna"))
    sheet = with_uncertainty(sheet, shown.stages, shown.control_points, everywhere(shown.stages, sheet))
    assert [row["within_off"] for row in sheet.sizes if row["key"] == "jp"] != [[]]
    pictures = {name: QImage(40, 80, QImage.Format.Format_RGB32) for name in SHOTS}
    for language in ("en", "ja"):
        assert pages_of(ReportDocument(sheet, pictures, {}), language).count == 2


def notes_of(sheet: Report) -> list[str]:
    return [note for _, notes in line_notes(sheet, []) for note in notes]


def test_pieces_tell_how_far_they_may_be_off(built: Callable[[str], Stages]) -> None:
    stages = built("mannequin")
    made = stages.design.with_line("mid-bust", 0.75).with_elastic("mid-bust", find_elastic("plush 12"))
    shown = solve(build(made, stages))
    plain = make_report(shown, shown.records, Heading("anna", "2026-01-31"))
    assert not any("95 %" in note for note in notes_of(plain))
    assert force_range_warning(plain) == ""
    sheet = with_uncertainty(plain, shown.stages, shown.control_points, everywhere(shown.stages, plain))
    (note,) = (note for note in notes_of(sheet) if "95 %" in note)
    assert note == "In 95 % of cases: cut ± 8.0 mm.", "nobody can work by forces within a factor of e"
    assert "a factor of 3:" in force_range_warning(sheet)
    surer = replace(sheet, off_factor=dict.fromkeys(sheet.off_factor, 1.5))
    newtons, kpa = plain.cuts.rows[0].tension_n, plain.pressures[0].max_kpa
    ends = [f"{value * each:.1f}" for value in (newtons, kpa) for each in (1.0 / 1.5, 1.5)]
    (note,) = (note for note in notes_of(surer) if "95 %" in note)
    assert note == (
        f"In 95 % of cases: cut ± 8.0 mm, tension {ends[0]} to {ends[1]} N, "
        f"maximum contact pressure {ends[2]} to {ends[3]} kPa."
    )
    assert force_range_warning(surer) == ""
    rows = {row["key"]: row for row in csv.DictReader(io.StringIO(report_csv(sheet)))}
    assert sheet.off_sources == ("scan", "tissue", "tape"), "no elastic, no landmark: it holds none of them"
    (meaning,) = (each for _, notes in note_groups(sheet) for each in notes if "Included: " in each)
    assert "Included: scan, tissue, cutting and sewing." in meaning
    assert float(rows["mid-bust: cut"]["off_after"]) == 8.0
    assert float(rows["mid-bust: tension"]["off_factor"]) == pytest.approx(np.e)
    assert rows["mid-bust: width"]["off_after"] == ""


def test_it_stands_on_paper(mannequin: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reported, "estimate_uncertainty", spread)
    monkeypatch.setattr(reported, "_pictures", lambda _: {})
    design, out = sample_design().with_line("mid-bust", 0.95), tmp_path / "sheet.pdf"
    write_report(str(mannequin), design, [], [], ReportOptions(str(out)))
    assert "± 7.4" not in Pdf(out).text()
    write_report(str(mannequin), design, [], [], ReportOptions(str(out), uncertainty=True))
    said = Pdf(out).text()
    assert all(each in said for each in ("± 7.4", "± 8.4", "± 0.2 mm", "± 1.4", "twice the standard"))
    assert said.index("Bust point lift") < said.index("± 0.2 mm") < said.index("Measurements")
