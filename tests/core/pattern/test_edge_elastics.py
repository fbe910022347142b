"""Elastics of edges: their parts are the whole, their quarters meet those of the edges."""

from __future__ import annotations

import numpy as np
import pytest
from whole_trunk import trunk_stages

from core.control_mesh.template import read_template
from core.document.garment_pattern import GarmentPattern
from core.document.lower_trunk import lower_line_names
from core.garment.cut_list import CutList, CutRow
from core.geometry.plane_sections import arc_length
from core.pattern.annotation import piece_words
from core.pattern.block_library import built_in_blocks, find_block
from core.pattern.edge_elastics import edge_elastics, lines_on_edges
from core.pattern.garment import Pattern, pattern_of
from core.pattern.piece import EdgeElastic, SideKey


def row(line: str, cut: float | None, front_only: bool = False) -> CutRow:
    return CutRow(
        line, line, "tape", 10.0, True, 300.0, 700.0, cut_mm=cut, allowance_mm=20.0, front_only=front_only
    )


def cuts(*rows: CutRow) -> CutList:
    return CutList(rows, 100.0, 1.0, ())


def on_body(pattern: Pattern, key: SideKey, share: float) -> np.ndarray:
    """Where a share of an edge of a piece lies on the body."""
    number = [flat.panel.name for flat in pattern.flats].index(key[0])
    flat, side = pattern.flats[number], pattern.flats[number].panel.sides[key[1]]
    along, places = arc_length(flat.points[side.points]), pattern.places[number][side.points]
    return np.array([np.interp(share * along[-1], along, column) for column in places.T])


@pytest.fixture(scope="module")
def brief() -> Pattern:
    stages = trunk_stages()
    return pattern_of(stages, stages.body.mesh.vertices, GarmentPattern(find_block("high-waist-brief")))


def test_lines_of_shipped_blocks_are_lines_of_the_templates() -> None:
    known = {*read_template("168").paths, *lower_line_names()}
    lines = [seam.line for block in built_in_blocks() for seam in block.seams if seam.line]
    assert len(lines) >= 8
    for line in lines:
        assert line in known or {f"{line}-left", f"{line}-right"} <= known, line


def test_a_waistband_goes_all_round_with_marks_where_no_seam_is(brief: Pattern) -> None:
    found = edge_elastics(brief, cuts(row("waist", 660.0)))
    assert {key[0] for key in found} == {"front", "back"}
    assert sum(each.part_mm for each in found.values()) == pytest.approx(640.0)
    assert [each.quarter_mm for each in found.values()] == pytest.approx([160.0] * 4)
    marks = [on_body(brief, key, share) for key, each in found.items() for share in each.marks]
    assert len(marks) == 2, "the side seams mark the other two"
    middle = trunk_stages().landmarks.position("bust_point_left")[0]
    middle += trunk_stages().landmarks.position("bust_point_right")[0]
    assert all(abs(mark[0] - 0.5 * middle) < 10.0 for mark in marks)
    assert abs(marks[0][1] - marks[1][1]) > 100.0, "one in front, one behind"


def test_a_leg_has_its_own_elastic_in_quarters_of_the_length_on_the_body(brief: Pattern) -> None:
    found = edge_elastics(brief, cuts(row("leg-opening-left", 520.0), row("leg-opening-right", 500.0)))
    left = {key: each for key, each in found.items() if each.cut_mm == 520.0}
    assert {key[0] for key in left} == {"front", "back", "gusset"}
    assert all(on_body(brief, key, 0.5)[0] > 0.0 for key in left), "+x is the left of the body"
    order = sorted(left.values(), key=lambda each: each.start)
    assert [each.end for each in order] == pytest.approx([*(each.start for each in order[1:]), 1.0])
    lengths = {
        key: float(arc_length(np.array([on_body(brief, key, s) for s in np.linspace(0, 1, 400)]))[-1])
        for key in left
    }
    whole = sum(lengths.values())
    for key, each in left.items():
        assert lengths[key] / whole == pytest.approx(each.end - each.start, abs=1e-3)
        for mark in each.marks:
            line = arc_length(np.array([on_body(brief, key, s) for s in np.linspace(0, mark, 400)]))
            share = each.start + float(line[-1]) / whole
            assert 4.0 * share == pytest.approx(round(4.0 * share), abs=4e-3)


def test_what_is_not_worn_says_nothing_and_what_cannot_be_cut_no_length(brief: Pattern) -> None:
    assert edge_elastics(brief, cuts(row("hip", 700.0))) == {}
    assert lines_on_edges(brief, cuts(row("hip", 700.0), row("waist", None))) == {"waist"}
    for unknown in (row("waist", None), row("waist", 660.0, front_only=True)):
        found = edge_elastics(brief, cuts(unknown)).values()
        assert {(each.cut_mm, each.part_mm, each.quarter_mm) for each in found} == {(None, None, None)}
        assert sum(len(each.marks) for each in found) == 2


def test_marks_are_notches_and_pieces_tell_their_part(brief: Pattern) -> None:
    pieces = {each.name: each for each in brief.pieces(7.0, edge_elastics(brief, cuts(row("waist", 660.0))))}
    bare = {each.name: each for each in brief.pieces(7.0)}
    count = {
        name: sum(len(side.notches) for side in piece.sides) - sum(len(s.notches) for s in bare[name].sides)
        for name, piece in pieces.items()
    }
    assert count == {"front": 1, "back": 1, "gusset": 0}
    part = sum(side.elastic.part_mm for side in pieces["front"].sides if side.elastic)
    assert piece_words(pieces["front"])[3] == f"waist: elastic, {part:.0f} mm of 660 mm to cut"
    assert len(piece_words(pieces["gusset"])) == 3


def test_the_band_of_a_bra_begins_at_its_hooks(bra: Pattern) -> None:
    found = edge_elastics(bra, cuts(row("under-bust", 720.0)))
    order = sorted(found, key=lambda key: found[key].start)
    assert [key[0] for key in order] in (
        ["wing right", "cradle right", "bridge", "bridge", "cradle left", "wing left"],
        ["wing left", "cradle left", "bridge", "bridge", "cradle right", "wing right"],
    )
    middle = [key for key in found if key[0] == "bridge" and found[key].marks]
    assert len(middle) == 1, "the half of the elastic, in one of both edges that meet at the centre front"
    names = {piece.key for piece in bra.pieces(7.0, found)}
    assert {"wing", "lower cup"} <= names, "elastics do not keep left and right apart"


def test_on_a_mirrored_edge_an_elastic_runs_the_other_way() -> None:
    own = EdgeElastic("waist", "tape", 10.0, 660.0, 160.0, 0.1, 0.35, (0.2, 0.7))
    other = own.mirrored
    assert (other.start, other.end) == pytest.approx((0.65, 0.9))
    assert other.marks == pytest.approx((0.3, 0.8))
    assert other.mirrored.marks == pytest.approx(own.marks)
