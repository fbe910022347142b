"""Straps and bands as pieces: as long and wide as they are cut, with their marks."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from core.export.band_geometry import Strip
from core.export.pattern_strips import piece_of_strip, uncut_strips
from core.garment.cut_list import CutList, CutRow
from core.messages import Message
from core.pattern.allowance import cut_piece
from core.pattern.annotation import annotate, piece_words

STRIP = Strip(
    "mid-bust",
    "Mid-bust",
    700.0,
    8.0,
    ((0.0, Message("upper end")), (10.0, Message("seam allowance")), (350.0, Message("centre front"))),
)


def test_a_strip_is_a_rectangle_without_allowance_with_its_marks() -> None:
    piece = piece_of_strip(STRIP, "mid-bust", "picot")
    cut = cut_piece(piece)
    assert shapely.Polygon(cut.cut).symmetric_difference(shapely.box(0, 0, 700, 8)).area < 1e-6
    assert (piece.name, piece.cloth, piece.count) == ("mid-bust", "picot", 1)
    assert [what for what, _ in piece.internal] == ["seam allowance", "centre front"]
    assert sorted(cut.notches[:, 0, 0]) == pytest.approx([10.0, 10.0, 350.0, 350.0])
    assert set(np.round(cut.notches[:, 0, 1], 6)) == {0.0, 8.0}, "on both edges"


@pytest.mark.parametrize("width", [6.0, 8.0, 12.0, 25.0])
def test_its_words_are_in_one_row_inside_it(width: float) -> None:
    cut = cut_piece(piece_of_strip(Strip("a", "Mid-bust", 700.0, width), "a", "picot 8 mm"))
    note = annotate(cut, piece_words(cut.piece, about=("Anna",)))
    rows = ("Mid-bust", "picot 8 mm", "cut 1", "Anna")
    assert note.lines == (rows if width > 20.0 else (" · ".join(rows),))
    assert 0.5 * note.size < note.centre[1] < width - 0.5 * note.size


def test_what_cannot_be_cut_is_named() -> None:
    rows = (
        CutRow("hip", "hip", "", None, True, 400.0, 900.0),
        CutRow("waist", "waist", "", None, True, 300.0, 700.0),
        CutRow("belly", "belly", "tape", 10.0, True, 300.0, 700.0, cut_mm=600.0),
        CutRow("strap left", "strap", "tape", 10.0, False, 300.0, 300.0, cut_mm=250.0, front_only=True),
    )
    assert uncut_strips(CutList(rows, 100.0, 1.0, ()), {"waist"}) == ("hip", "strap left")
