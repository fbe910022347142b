"""The first page of a sheet: no name of a line is cut, what holds for all is said once, strain is amber."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from pdf_tools import Pdf
from PySide6.QtGui import QImage

from app.gui.theme.stylesheet import load_fonts
from app.report.cut_rows import line_notes
from app.report.document import SHOTS, ReportDocument
from app.report.pages import pages_of
from app.report.pdf_file import write_pdf
from core.document.lines import LineSettings
from core.export.report_data import Heading, Report, make_report
from core.garment.presets import built_in, with_preset
from core.pipeline.build import Stages, build
from core.pipeline.solve import solve

LONG = "Upper edge of the cup, laid double, left"


@pytest.fixture(scope="module")
def bra(built: Callable[[str], Stages], qapp: object) -> Report:
    """A bra as a designer has it whose strap has a long name, with ± of every force as a note."""
    load_fonts()
    stages = built("mannequin")
    design = with_preset(stages.design, next(each for each in built_in() if each.title == "Bra"))
    shown = solve(build(design.with_line_settings(LineSettings("strap left", title=LONG)), stages))
    sheet = make_report(shown, shown.records, Heading("anna", "2026-01-31"))
    factors = {f"tension:{row.line}": 2.0 for row in sheet.cuts.rows}
    return replace(sheet, off_factor=factors)


def printed(sheet: Report, path: Path, words: str = "en") -> Pdf:
    pictures = {name: QImage(40, 80, QImage.Format.Format_RGB32) for name in SHOTS}
    write_pdf(path, pages_of(ReportDocument(sheet, pictures, {}), words), "sheet")
    return Pdf(path)


def test_no_name_of_a_line_is_cut(bra: Report, tmp_path: Path) -> None:
    english, japanese = (printed(bra, tmp_path / f"{words}.pdf", words).text() for words in ("en", "ja"))
    assert all(name in english for name in ("Mid-bust", LONG, "Strap right"))
    assert all(name in japanese for name in ("バスト下部", "ストラップ右"))
    assert "…" not in english.partition("Cut list")[2].partition("Notes")[0]


def test_what_is_noted_of_every_line_is_said_once(bra: Report) -> None:
    (title, shared), *own = line_notes(bra, [])
    assert title == ""
    assert shared
    assert not {note for _, notes in own for note in notes} & set(shared)
    one = replace(bra, cuts=replace(bra.cuts, rows=bra.cuts.rows[:1]), pressures=bra.pressures[:1])
    assert [title for title, _ in line_notes(one, [])] == ["Mid-bust"]


def test_strained_skin_heads_the_sheet_and_says_how_far(
    built: Callable[[str], Stages], tmp_path: Path
) -> None:
    load_fonts()
    stages = built("mannequin")
    design = replace(stages.design, volume="exact")
    shown = solve(build(design.with_line("mid-bust", 0.87), stages))
    sheet = make_report(shown, shown.records, Heading("anna", "2026-01-31"))
    assert sheet.state == "strained"
    assert sheet.strain == shown.verdict.strain is not None
    said = printed(sheet, tmp_path / "strained.pdf").text()
    assert "Do not use" in said
    assert "over 20 %" in said
    assert "使用不可" in printed(sheet, tmp_path / "ja.pdf", "ja").text()
