"""Pieces on paper as a PDF, read back: the test square, the sheets, cut lines at their size, words."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pypdfium2 as pdfium
import pytest
from made_pieces import made_pieces
from pdf_tools import POINT, Pdf
from pypdfium2 import raw
from PySide6.QtWidgets import QApplication

from app.gui.theme.stylesheet import load_fonts
from app.report.pattern_sheets import CUT, pattern_sheets
from app.report.pdf_file import write_pdf
from core.export.report_data import Heading
from core.pattern.allowance import CutPiece, cut_piece
from core.pattern.layout import MARGIN, PAPERS, SQUARE, Tiling, lay_out_on_tiles, whole_sheet
from core.pattern.mirroring import merge_mirrored

HEADING = Heading("Two-part cup bra", "2026-11-26", "Customer 0412", "A")


@pytest.fixture(scope="module")
def pieces(qapp: QApplication) -> list[CutPiece]:
    load_fonts()
    return [cut_piece(each) for each in merge_mirrored(made_pieces())]


def written(path: Path, tiling: Tiling, language: str = "en") -> Pdf:
    write_pdf(path, pattern_sheets(tiling, HEADING, language), "pieces")
    return Pdf(path)


def strokes(page: pdfium.PdfPage) -> Iterator[tuple[np.ndarray, float]]:
    """The places of each path of a page from its top left, and the weight of its line [mm]."""
    high = page.get_size()[1]
    for each in page.get_objects(filter=[raw.FPDF_PAGEOBJ_PATH]):
        weight, x, y = ctypes.c_float(), ctypes.c_float(), ctypes.c_float()
        raw.FPDFPageObj_GetStrokeWidth(each.raw, weight)
        matrix, places = each.get_matrix(), []
        for k in range(raw.FPDFPath_CountSegments(each.raw)):
            raw.FPDFPathSegment_GetPoint(raw.FPDFPath_GetPathSegment(each.raw, k), x, y)
            places.append(matrix.on_point(x.value, y.value))
        scale = abs(np.linalg.det([[matrix.a, matrix.b], [matrix.c, matrix.d]])) ** 0.5
        yield np.array([(px * POINT, (high - py) * POINT) for px, py in places]), weight.value * scale * POINT


def squares(page: pdfium.PdfPage) -> list[np.ndarray]:
    """The sizes of paths that are about as large as the test square [mm]."""
    sizes = [np.ptp(places, axis=0) for places, _ in strokes(page) if len(places) == 5]
    return [size for size in sizes if np.abs(size - SQUARE).max() < 2.0]


@pytest.mark.parametrize("paper", sorted(PAPERS))
def test_the_square_is_fifty_millimetres_and_every_sheet_is_there(tmp_path, pieces, paper):
    tiling = lay_out_on_tiles(pieces, PAPERS[paper])
    pdf = written(tmp_path / "p.pdf", tiling)
    assert len(pdf.document) == 1 + len(tiling.tiles)
    assert set(pdf.sizes) == {tuple(map(round, tiling.size))}
    found = [size for page in list(pdf.document)[1:] for size in squares(page)]
    assert found
    np.testing.assert_allclose(found, SQUARE, atol=0.01)


def test_what_a_sheet_shows_is_where_the_layout_has_it(tmp_path, pieces):
    tiling = lay_out_on_tiles(pieces, PAPERS["a4"])
    pdf = written(tmp_path / "p.pdf", tiling)
    shown: set[str] = set()
    for tile, page in zip(tiling.tiles, list(pdf.document)[1:], strict=True):
        paths = [places for places, _ in strokes(page)]
        origin = np.array([MARGIN - tile.window[0], MARGIN + tile.window[3]])
        for each in tiling.layout.pieces:
            expected = origin + each.cut * [1.0, -1.0]
            for places in paths:
                if len(places) == len(expected) + 1 and np.abs(places[:-1] - expected).max() < 0.02:
                    shown.add(each.piece.key)
    assert shown == {each.piece.key for each in pieces}


def test_one_sheet_has_every_notch_and_no_overview(tmp_path, pieces):
    tiling = whole_sheet(pieces, 600.0)
    pdf = written(tmp_path / "p.pdf", tiling)
    assert len(pdf.document) == 1
    assert pdf.sizes == [tuple(map(round, tiling.size))]
    marks = [
        places
        for places, weight in strokes(pdf.document[0])
        if len(places) == 2 and weight == pytest.approx(CUT, abs=0.01)
    ]
    assert len(marks) == sum(len(each.notches) for each in pieces)
    np.testing.assert_allclose([np.linalg.norm(b - a) for a, b in marks], 4.0, atol=0.01)
    np.testing.assert_allclose(squares(pdf.document[0]), SQUARE, atol=0.01)


def test_sheets_tell_their_place_and_that_they_are_printed_at_full_size(tmp_path, pieces):
    tiling = lay_out_on_tiles(pieces, PAPERS["a4"])
    pdf = written(tmp_path / "p.pdf", tiling)
    for number, tile in enumerate(tiling.tiles, start=1):
        words = [each.text for each in pdf.pieces(number)]
        assert tile.name in words
        assert "Print at 100 %, do not fit to the page" in words
    assert "50 mm" in pdf.text()
    overview = " ".join(each.text for each in pdf.pieces(0))
    for word in (*(tile.name for tile in tiling.tiles), "Upper cup", "cut 2, mirrored", "Customer 0412"):
        assert word in overview


@pytest.mark.parametrize("language", ["en", "ja"])
@pytest.mark.parametrize("paper", ["a4", "a3", "letter"])
def test_no_words_of_the_overview_lie_over_each_other_or_leave_the_page(tmp_path, pieces, language, paper):
    tiling = lay_out_on_tiles(pieces, PAPERS[paper])
    pdf = written(tmp_path / "p.pdf", tiling, language)
    words = pdf.pieces(0)
    wide, high = tiling.size
    for k, one in enumerate(words):
        assert one.left >= MARGIN - 0.5
        assert one.right <= wide - MARGIN + 0.5
        assert one.bottom <= high - 3.0
        assert not any(one.overlaps(other) for other in words[k + 1 :])
