"""The sheet as a PDF, read back by another library: its figures, its type, and that nothing is lost."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pdf_tools import Pdf
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QApplication

from app.gui.theme.stylesheet import load_fonts
from app.i18n.catalog import language, number, use_language
from app.i18n.lengths import length_number
from app.presenters.lines import line_colours
from app.report.cut_rows import cut_views
from app.report.cut_table import EDGES
from app.report.document import SHOT_SIZES, SHOTS, ReportDocument
from app.report.pages import pages_of
from app.report.painter import A4, MARGIN, TYPES
from app.report.pdf_file import write_pdf
from core.document.lines import LineSettings
from core.errors import UserError
from core.export.report_data import Heading, Report, make_report
from core.garment.assessment import Assessment, Finding
from core.garment.elastic_library import find_elastic
from core.messages import Length, Message, SideName
from core.pipeline.build import Stages, build
from core.pipeline.solve import solve

LONG = "Customer 0412, who has a name so long that it never fits on one line of any sheet, however wide it is"
HEADING = Heading("Bodysuit", "2026-11-22", "Customer 0412", "B", "eu")
Built = Callable[[str], Stages]


@pytest.fixture(scope="module")
def sheet(built: Built, qapp: QApplication) -> Report:
    """Four lines worn: two of elastics, one of none, one named by hand that does not move."""
    load_fonts()
    stages = built("mannequin")
    design = replace(stages.design, template="168").with_line("mid-bust", 0.7).with_line("full-bust", 0.98)
    design = design.with_line("under-bust", 0.75).with_elastic("mid-bust", find_elastic("plush 12"))
    design = design.with_elastic("under-bust", find_elastic("picot 10"))
    design = design.with_line_settings(LineSettings("full-bust", title="Upper edge " * 5))
    solution = solve(build(design, stages))
    return make_report(solution, solution.records, HEADING)


def pictures() -> dict[str, QImage]:
    found = {}
    for name in SHOTS:
        wide, high = SHOT_SIZES[name.partition(" ")[0]]
        found[name] = QImage(round(4 * wide), round(4 * high), QImage.Format.Format_RGB32)
        found[name].fill(0xC8A090)
    return found


def handout(sheet: Report, drawn: bool = True) -> ReportDocument:
    names = [row.line for row in sheet.cuts.rows]
    return ReportDocument(sheet, pictures() if drawn else {}, line_colours(names))


def written(of: ReportDocument, path: Path, words: str = "en") -> Pdf:
    write_pdf(path, pages_of(of, words), "sheet")
    return Pdf(path)


def told(value: float | None, digits: int, signed: bool = False) -> str:
    return "\N{EN DASH}" if value is None else number(value, digits, signed)


@pytest.mark.parametrize("words", ["en", "ja"])
def test_every_figure_of_the_tables_is_that_of_the_data(sheet: Report, tmp_path: Path, words: str) -> None:
    text = written(handout(sheet), tmp_path / "sheet.pdf", words).text()
    data = sheet.as_data()
    for row in data["measures"]:
        digits = 0 if row["unit"] == "ml" else 1
        values = [told(row["before"], digits), told(row["after"], digits)]
        if row["before"] is not None or row["after"] is not None:
            assert " ".join((*values, told(change_shown(row, digits), digits, signed=True))) in text, row[
                "key"
            ]
    for cut, press in zip(data["cuts"]["rows"], data["pressures"], strict=True):
        stretch = None if cut["elongation"] is None else 100.0 * cut["elongation"]
        figures = (
            *(told(cut["cut_mm"], 0), told(cut["allowance_mm"], 0), told(stretch, 0)),
            *(told(cut["reached_whole_mm"], 0), told(cut["height_mm"], 0, signed=True)),
            *(told(cut["tension_n"], 1), told(press["max_kpa"], 1)),
        )
        shown = figures if cut["cut_mm"] is not None else figures[3:]
        assert " ".join(shown) in text, cut["line"]
        if cut["cut_mm"] is not None:
            assert f"{cut['cut_mm']:,.0f} mm" in text, "the great figure at the head"
    assert f"{told(data['lift']['up'], 1, signed=True)} mm" in text
    assert f"{told(data['volume']['error_ml'], 1, signed=True)} ml" in text
    chosen = data["sizes"][0]
    assert chosen["key"] == "eu"
    assert re.search(rf"{chosen['band']} .{{0,24}}{chosen['cup']} ", text)
    for size in data["sizes"]:
        assert f"{size['size']}" in text


def change_shown(row: dict[str, Any], digits: int) -> float | None:
    """The columns of a table agree: 85.4 to 83.8 is -1.6, whatever lies behind the last figure."""
    if row["before"] is None or row["after"] is None:
        return row["difference"]
    return round(row["after"], digits) - round(row["before"], digits)


@pytest.mark.parametrize("words", ["en", "ja"])
def test_it_is_two_pages_of_a4_with_its_type_inside(sheet: Report, tmp_path: Path, words: str) -> None:
    pdf = written(handout(sheet), tmp_path / "sheet.pdf", words)
    assert pdf.sizes == [(210, 297)] * 2
    fonts = pdf.fonts()
    assert all(fonts.values()), fonts
    assert any(name.startswith("InterFigures") for name in fonts)
    assert any(name.startswith("NotoSansJP") for name in fonts) == (words == "ja")
    assert "Customer 0412" in pdf.text()
    assert "2026-11-22" in pdf.text()


@pytest.mark.parametrize("words", ["en", "ja"])
@pytest.mark.parametrize("drawn", [True, False])
@pytest.mark.parametrize("customer", ["", LONG])
def test_no_text_leaves_the_margins_or_lies_over_another(
    sheet: Report, tmp_path: Path, words: str, drawn: bool, customer: str
) -> None:
    changed = replace(sheet, heading=replace(HEADING, customer=customer, project=f"{LONG}.busk"))
    pdf = written(handout(changed, drawn), tmp_path / "sheet.pdf", words)
    for page in range(len(pdf.sizes)):
        pieces = pdf.pieces(page)
        assert len(pieces) > 20
        for piece in pieces:
            assert piece.left >= MARGIN - 0.3, piece
            assert piece.right <= A4[0] - MARGIN + 0.3, piece
            assert piece.top >= MARGIN - 0.5, piece
            assert piece.bottom <= A4[1] - MARGIN + 1.2, piece
        assert [pair for pair in combinations(pieces, 2) if pair[0].overlaps(pair[1])] == []


def test_long_names_end_in_dots_and_nobody_leaves_no_hole(sheet: Report, tmp_path: Path) -> None:
    named = replace(sheet, heading=replace(HEADING, customer=LONG))
    text = written(handout(named), tmp_path / "named.pdf").text()
    assert LONG not in text
    assert LONG[:30] in text
    assert "…" in text
    nobody = replace(sheet, heading=replace(HEADING, customer=""))
    first = written(handout(nobody), tmp_path / "nobody.pdf").pieces(0)
    title, project = (next(p for p in first if p.text.startswith(t)) for t in ("Fitting", "Bodysuit"))
    assert abs(title.left - project.left) < 0.6, "the project stands where the customer would"


def test_what_is_missing_is_said(sheet: Report, built: Built, tmp_path: Path) -> None:
    stages = built("mannequin")
    bare = solve(build(replace(stages.design, lines=()), stages))
    at_rest = make_report(bare, bare.records, HEADING)
    text = written(handout(at_rest, drawn=False), tmp_path / "bare.pdf").text()
    assert "No active lines: the cut list is empty." in text
    assert "No iterations to plot: no active lines." in text
    assert "The images of the body could not be drawn" in text
    plain = tuple(replace(row, elastic="", cut_mm=None, elongation=None) for row in sheet.cuts.rows)
    without = replace(sheet, cuts=replace(sheet.cuts, rows=plain))
    assert "No elastics chosen" in written(handout(without), tmp_path / "plain.pdf").text()
    found = Finding("convergence", "bad", Message("The solver does not converge: it oscillates."))
    wrong = {"state": "vibrating", "lift": None, "assessment": Assessment((found,))}
    sizeless = replace(sheet, sizes=(), no_size=Message("The scan shows no bust."), **wrong)
    text = written(handout(sizeless), tmp_path / "none.pdf").text()
    assert "The scan shows no bust." in text
    assert "Do not use The solver does not converge: it oscillates." in text
    assert "No value: the shape is not valid." in text


@pytest.mark.parametrize(
    ("words", "said"), [("en", "is not clearly visible"), ("ja", "バージスがはっきり見えません")]
)
def test_doubts_stand_on_the_first_page(sheet: Report, tmp_path: Path, words: str, said: str) -> None:
    unclear = Message(
        "The inframammary fold of the {side} breast is not clearly visible. Please check.",
        side=SideName("left"),
    )
    doubted = replace(sheet, assessment=Assessment((Finding("landmarks", "caution", unclear),)))
    page = written(handout(doubted), tmp_path / "sheet.pdf", words)
    assert said in "".join(piece.text for piece in page.pieces(0))
    assert said not in "".join(piece.text for piece in page.pieces(1))


def test_a_shape_that_is_no_result_tells_no_figure_of_it(sheet: Report, tmp_path: Path) -> None:
    folded = replace(sheet, state="folded", lift=None)
    text = written(handout(folded), tmp_path / "folded.pdf").text()
    assert text.count("No value: the shape is not valid.") == 3 + len(sheet.cuts.rows)
    assert text.count("DO NOT CUT") == len(sheet.cuts.rows)
    assert sheet.lift is not None
    lift = length_number(sheet.lift.up, signed=True)
    assert lift in written(handout(sheet), tmp_path / "valid.pdf").text()
    assert lift not in text
    for cut in sheet.cuts.rows:
        assert cut.cut_mm is None or f" {cut.cut_mm:,.0f} " not in text
    measured = [row for row in sheet.measures if row["before"] is not None and row["unit"] == "mm"]
    assert len(measured) > 10
    for row in measured:
        assert " ".join((told(row["before"], 1), told(None, 0), told(None, 0))) in text, row["key"]


def test_every_figure_of_the_cut_list_has_its_column(sheet: Report) -> None:
    views = cut_views(sheet, [])
    assert views
    assert all(set(view.values) == set(EDGES) for view in views)


def test_a_front_part_alone_is_no_great_figure(sheet: Report, tmp_path: Path) -> None:
    parts = tuple(replace(row, front_only=True) for row in sheet.cuts.rows)
    text = written(handout(replace(sheet, cuts=replace(sheet.cuts, rows=parts))), tmp_path / "p.pdf").text()
    assert "No full lengths: the cut list contains front lengths only." in text
    for cut in sheet.cuts.rows:
        assert cut.cut_mm is None or f"{cut.cut_mm:,.0f} mm" not in text


def test_elastics_are_named_in_the_language_of_the_sheet(sheet: Report, tmp_path: Path) -> None:
    text = written(handout(sheet), tmp_path / "ja.pdf", "ja").text()
    assert "Picot" not in text
    assert "plush" not in text


def test_the_band_of_a_size_is_no_band_of_the_garment_in_japanese(sheet: Report, tmp_path: Path) -> None:
    text = written(handout(sheet), tmp_path / "ja.pdf", "ja").text()
    assert "アンダー EU 75" in text
    assert "バンド EU" not in text


def test_letters_are_large_enough_for_the_bench() -> None:
    assert min(size for kind, (size, *_) in TYPES.items() if kind != "axis") >= 7.5


def test_a_garment_of_six_lines_is_two_pages_too(sheet: Report, tmp_path: Path) -> None:
    cuts, presses = sheet.cuts.rows * 2, sheet.pressures * 2
    rows = tuple(replace(row, line=f"own {k}", title=f"Own line {k}") for k, row in enumerate(cuts))
    bridges = "Bridges hollows over {length}, up to {height} off the skin: no contact pressure there."
    notes = [(Message(bridges, length=Length(k), height=Length(k)),) for k in range(6)]
    lines = zip(presses, rows, notes, strict=True)
    pressed = tuple(replace(press, line=row.line, notes=note) for press, row, note in lines)
    six = replace(sheet, cuts=replace(sheet.cuts, rows=rows), pressures=pressed)
    for words in ("en", "ja"):
        assert len(written(handout(six), tmp_path / f"{words}.pdf", words).sizes) == 2


def test_many_lines_are_all_printed(sheet: Report, tmp_path: Path) -> None:
    cut, press = sheet.cuts.rows[0], sheet.pressures[0]
    rows = tuple(replace(cut, line=f"own {k}", title=f"Own line {k}") for k in range(40))
    pressed = tuple(replace(press, line=row.line, title=row.title) for row in rows)
    many = replace(sheet, cuts=replace(sheet.cuts, rows=rows), pressures=pressed)
    pdf = written(handout(many), tmp_path / "many.pdf")
    assert all(f"Own line {k} " in pdf.text() for k in range(40))
    for page in range(len(pdf.sizes)):
        assert all(piece.bottom <= A4[1] - MARGIN + 1.2 for piece in pdf.pieces(page))


def test_lights_are_told_apart_without_colour(sheet: Report, tmp_path: Path) -> None:
    lights = {}
    for light in ("green", "amber", "red"):
        same = tuple(replace(row, light=light, notes=()) for row in sheet.pressures)
        pdf = written(handout(replace(sheet, pressures=same)), tmp_path / f"{light}.pdf")
        grey = pdf.pixels(0, 300).mean(axis=2)
        word = [
            p for p in pdf.pieces(0) if p.left > MARGIN + 160.0 and p.text in ("gentle", "snug", "too tight")
        ]
        assert len({piece.text for piece in word}) == 1
        dot = 300.0 / 25.4
        box = grey[
            round((word[0].top - 1.0) * dot) : round((word[0].bottom + 1.0) * dot),
            round((word[0].left - 5.0) * dot) : round((word[0].left - 1.2) * dot),
        ]
        lights[light] = box < 200.0
    ink = {light: float(shape.mean()) for light, shape in lights.items()}
    assert min(ink.values()) > 0.02, "each has a mark"
    assert ink["green"] < ink["amber"] < ink["red"], "a ring, a triangle, a full square"
    assert not np.array_equal(lights["amber"], lights["red"])


def test_a_sheet_is_whole_or_not_there(sheet: Report, tmp_path: Path) -> None:
    with pytest.raises(UserError):
        write_pdf(tmp_path / "no folder" / "sheet.pdf", pages_of(handout(sheet), "en"), "sheet")
    assert list(tmp_path.iterdir()) == []


def test_a_disk_that_gets_full_leaves_the_former_sheet(sheet: Report, tmp_path: Path) -> None:
    resource = pytest.importorskip("resource")
    path = tmp_path / "sheet.pdf"
    path.write_bytes(b"the former one")
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, hard))
    try:
        with pytest.raises(UserError, match="cannot be written"):
            write_pdf(path, pages_of(handout(sheet), "en"), "sheet")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert [each.read_bytes() for each in tmp_path.iterdir()] == [b"the former one"]


def test_the_language_of_the_window_stays(sheet: Report) -> None:
    use_language("en")
    pages_of(handout(sheet), "ja")
    assert language() == "en"
