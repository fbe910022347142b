"""Pieces in files, read back: DXF by ezdxf, SVG by an XML reader, HPGL and CSV by hand."""

import csv
import io
import re
from collections import Counter
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import ezdxf
import numpy as np
import pytest
from made_pieces import made_pieces

from core.errors import ProjectError
from core.export.band_geometry import Strip
from core.export.pattern_csv import write_pieces, write_seams
from core.export.pattern_dxf import STANDARDS, block_names, write_pattern_dxf
from core.export.pattern_plt import UNITS, write_pattern_plt
from core.export.pattern_strips import piece_of_strip
from core.export.pattern_svg import write_pattern_svg
from core.export.report_data import Heading
from core.pattern.allowance import cut_piece
from core.pattern.annotation import annotate, english_words
from core.pattern.layout import MARGIN, Layout, lay_out
from core.pattern.mirroring import merge_mirrored
from core.pattern.piece import Piece, Side

HEADING = Heading("Étude 斜め", "2026-11-26", "Customer 0412")
SVG = "{http://www.w3.org/2000/svg}"
LINE = np.array([[60.0, -20.0], [80.0, 10.0]])


@pytest.fixture(scope="module")
def layout() -> Layout:
    first, *others = merge_mirrored(made_pieces())
    marked = replace(first, internal=(("control", LINE), ("control", LINE + 15.0)))
    return lay_out([cut_piece(each) for each in (marked, *others, darted())], 600.0)


def darted() -> Piece:
    """A piece with a dart in its lower edge, whose cloth stretches down."""
    tip, mouth = (50.0, 60.0), ((40.0, 0.0), (60.0, 0.0))
    sides = (
        Side("hem", np.array([(0.0, 0.0), mouth[0]]), 6.0),
        Side("dart", np.array([mouth[0], tip]), 6.0, partner=("skirt", 2)),
        Side("dart", np.array([tip, mouth[1]]), 6.0, partner=("skirt", 1)),
        Side("hem", np.array([mouth[1], (100.0, 0.0), (100.0, 120.0), (0.0, 120.0), (0.0, 0.0)]), 6.0),
    )
    return Piece("skirt", "", "Woven", 1, sides, stretch=(0.0, 1.0))


def notches(layout: Layout) -> int:
    return sum(len(side.notches) for each in layout.pieces for side in each.piece.sides)


def read_dxf(path: Path, layout: Layout, standard: str) -> ezdxf.document.Drawing:
    write_pattern_dxf(path, layout, HEADING, standard)
    drawing = ezdxf.readfile(path)
    audit = drawing.audit()
    assert (audit.errors, audit.fixes) == ([], [])
    return drawing


def flat(polyline: ezdxf.entities.Polyline) -> np.ndarray:
    return np.array([each.dxf.location.vec2 for each in polyline.vertices])


@pytest.mark.parametrize("standard", STANDARDS)
def test_each_piece_is_one_block_with_its_lines_on_numbered_layers(tmp_path, layout, standard):
    drawing = read_dxf(tmp_path / "p.dxf", layout, standard)
    inserts = drawing.modelspace().query("INSERT")
    assert len(inserts) == len(layout.pieces)
    for insert, piece in zip(inserts, layout.pieces, strict=True):
        block, at = drawing.blocks[insert.dxf.name], np.array(insert.dxf.insert.vec2)
        lines = block.query("POLYLINE")
        curves = {each.dxf.layer: each for each in lines if each.dxf.layer not in ("8", "85")}
        np.testing.assert_allclose(flat(curves["1"]) + at, piece.cut, atol=1e-3)
        np.testing.assert_allclose(flat(curves["14"]) + at, piece.piece.outline, atol=1e-3)
        assert curves["1"].is_closed
        assert set(curves) == ({"1", "14", "84", "87"} if standard == "astm" else {"1", "14"})
        inside = [each for each in lines if each.dxf.layer == "8"]
        assert len(inside) == len(piece.piece.internal) + len(piece.piece.darts) + 1, "with the arrow"
        note = annotate(piece, english_words(piece.piece, (HEADING.customer, HEADING.date)))
        np.testing.assert_allclose(flat(inside[-1]) + at, note.stretch, atol=1e-3)
        words = {each.dxf.text: np.array(each.dxf.insert.vec2) + at for each in block.query("TEXT")}
        np.testing.assert_allclose(words["stretch"], note.stretch_word, atol=1e-3)
        assert not any(each.is_closed for each in inside)
        points = Counter(each.dxf.layer for each in block.query("POINT"))
        assert points["2"] + points["3"] == sum(
            len(flat(each)) for each in [curves["1"], curves["14"], *inside]
        )
        assert points["13"] == len(piece.piece.darts)
        (grain,) = block.query("LINE")
        assert grain.dxf.layer == "7"
        assert grain.dxf.start[0] == pytest.approx(grain.dxf.end[0])
        marks = [each for each in block.query("POINT") if each.dxf.layer == "4"]
        for mark, (place, inner) in zip(marks, piece.notches, strict=True):
            way = inner - place
            np.testing.assert_allclose(np.array(mark.dxf.location.vec2) + at, place, atol=1e-3)
            assert mark.dxf.location.z == pytest.approx(np.linalg.norm(way), abs=1e-3)
            turned = np.radians(mark.dxf.angle)
            assert np.array([np.cos(turned), np.sin(turned)]) @ way == pytest.approx(np.linalg.norm(way))


@pytest.mark.parametrize("standard", STANDARDS)
def test_the_file_has_no_other_block_no_table_no_layer_0_and_only_ascii(tmp_path, layout, standard):
    drawing = read_dxf(tmp_path / "p.dxf", layout, standard)
    text = (tmp_path / "p.dxf").read_bytes().decode("ascii")
    lines = text.splitlines()
    tags = list(zip(map(str.strip, lines[::2]), lines[1::2], strict=True))
    blocks = [tags[k + 2][1] for k, tag in enumerate(tags) if tag == ("0", "BLOCK")]
    assert blocks == block_names([each.piece for each in layout.pieces])
    assert all(re.fullmatch(r"[A-Z0-9_]{1,20}", each) for each in blocks)
    assert [tags[k + 1][1] for k, tag in enumerate(tags) if tag == ("0", "SECTION")] == [
        "HEADER",
        "BLOCKS",
        "ENTITIES",
    ]
    assert {value for code, value in tags if code == "8"} <= {
        *map(str, (1, 2, 3, 4, 7, 8, 13, 14, 15, 84, 85, 87))
    }
    words = [each.dxf.text for each in drawing.modelspace().query("TEXT")]
    assert any(re.fullmatch(r"(?i)units: metric", each) for each in words)
    assert any(re.fullmatch(r"(?i)style name: Etude \?\?", each) for each in words)
    own = [each.dxf.text for each in drawing.blocks["UPPER_CUP"].query("TEXT[layer=='1']")]
    assert [each.partition(": ")[2] for each in own] == [
        "UPPER_CUP",
        "M2M",
        "2" if standard == "aama" else "1,1",
        "Cup tricot, stable",
    ]


def test_names_of_blocks_differ_whatever_the_pieces_are_called():
    piece = made_pieces()[0]
    names = [
        "upper cup",
        "Upper-Cup",
        "斜め",
        "",
        "a very long name of a piece, the first",
        "a very long name of a p",
    ]
    found = block_names([replace(piece, name=name, side="") for name in names])
    assert len(set(found)) == len(names)
    assert found[0] == "UPPER_CUP"
    assert all(re.fullmatch(r"[A-Z0-9_]{1,20}", each) for each in found)


def svg_points(path: ElementTree.Element) -> np.ndarray:
    return np.array(re.findall(r"-?[\d.]+", path.get("d")), dtype=float).reshape(-1, 2)


def test_svg_is_at_full_size_with_a_named_path_for_each_side(tmp_path, layout):
    write_pattern_svg(tmp_path / "p.svg", layout, HEADING)
    root = ElementTree.parse(tmp_path / "p.svg").getroot()
    width, height = (float(root.get(each).removesuffix("mm")) for each in ("width", "height"))
    assert root.get("viewBox").split()[2:] == [f"{width:.3f}", f"{height:.3f}"]
    assert width == pytest.approx(layout.width + 2 * MARGIN, abs=1e-3)
    groups = [each for each in root.iter(f"{SVG}g") if each.get("id") != "test-square"]
    for group, piece in zip(groups, layout.pieces, strict=True):
        kinds = Counter(each.get("class") for each in group.iter(f"{SVG}path"))
        assert kinds["cut"] == kinds["grain"] == 1
        assert kinds["notch"] == len(piece.notches)
        assert kinds["internal"] == len(piece.piece.internal)
        sides = [each for each in group.iter(f"{SVG}path") if each.get("class") == "sew"]
        for path, side in zip(sides, piece.piece.sides, strict=True):
            assert path.get("data-seam") == side.name
            expected = side.points * [1.0, -1.0] + MARGIN
            np.testing.assert_allclose(svg_points(path), expected, atol=1e-3)
    idents = [each.get("id") for each in root.iter() if each.get("id")]
    assert len(set(idents)) == len(idents)
    sewn = [each.get("data-sewn-to") for each in root.iter() if each.get("data-sewn-to")]
    assert len(sewn) == sum(side.partner is not None for each in layout.pieces for side in each.piece.sides)
    assert set(sewn) <= set(idents)
    (square,) = (each for each in root.iter(f"{SVG}path") if each.get("class") == "square")
    assert np.ptp(svg_points(square), axis=0) == pytest.approx([50.0, 50.0])


def test_hpgl_draws_each_line_with_its_pen_inside_the_layout(tmp_path, layout):
    write_pattern_plt(tmp_path / "p.plt", layout)
    text = (tmp_path / "p.plt").read_text("ascii")
    pens = {int(pen): strokes for pen, strokes in re.findall(r"SP([123]);\n((?:PU.*\n)+?)(?=SP|PU0,0)", text)}
    assert list(pens) == [3, 2, 1], "what is cut comes last"
    strokes = {pen: re.findall(r"PU(-?\d+),(-?\d+);PD([^;]+);", lines) for pen, lines in pens.items()}
    assert len(strokes[1]) == len(strokes[2]) == len(layout.pieces)
    inside = sum(len(each.piece.internal) for each in layout.pieces)
    assert len(strokes[3]) == notches(layout) + 4 * len(layout.pieces) + inside, "two arrows, one with heads"
    for (x, y, rest), piece in zip(strokes[1], layout.pieces, strict=True):
        units = np.array([x, y, *rest.split(",")], dtype=float).reshape(-1, 2)
        np.testing.assert_array_equal(units[0], units[-1])
        np.testing.assert_allclose(
            units[:-1] / UNITS - [0.0, layout.height], piece.cut, atol=0.5 / UNITS + 1e-9
        )
        assert units.min() >= 0.0
    labels = re.findall(r"PU(-?\d+),(-?\d+);SI([\d.]+),[\d.]+;LB([^\x03]*)\x03", pens[3])
    starts = {(text, int(y)): int(x) for x, y, _, text in labels}
    for piece in layout.pieces:
        note = annotate(piece, english_words(piece.piece))
        words = [*zip(note.lines, note.bases, strict=True), ("stretch", note.stretch_word)]
        for word, base in words:
            x, y = np.rint((base + np.array([0.0, layout.height])) * UNITS)
            assert 0.0 < x - starts[word, int(y)] < 0.5 * len(word) * note.size * UNITS, "the middle is there"


def rows_of(path: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(path.read_text("utf-8-sig"))))


def test_tables_have_a_row_for_each_piece_and_each_seam_with_both_lengths(tmp_path, layout):
    pieces = [each.piece for each in layout.pieces]
    write_pieces(tmp_path / "pieces.csv", pieces)
    write_seams(tmp_path / "seams.csv", pieces)
    rows, seams = rows_of(tmp_path / "pieces.csv"), rows_of(tmp_path / "seams.csv")
    assert [row["piece"] for row in rows] == [each.name for each in pieces]
    assert float(rows[0]["area_cm2"]) == pytest.approx(pieces[0].area / 100.0, rel=1e-4)
    assert sum(int(row["cut"]) for row in rows) == 10
    assert len(seams) == sum(len(each.sides) for each in pieces)
    sewn = [row for row in seams if row["sewn_to"]]
    for row in sewn:
        (other,) = (
            each
            for each in seams
            if (each["piece"], each["number"]) == (row["sewn_to"], row["sewn_to_number"])
        )
        assert row["sewn_to_length_mm"] == other["length_mm"]
        assert abs(float(row["difference_mm"])) < 1e-6
    assert sum(int(row["notches"]) for row in seams) == sum(int(row["notches"]) for row in rows)
    write_seams(tmp_path / "alone.csv", pieces[:1])
    assert rows_of(tmp_path / "alone.csv")[0]["sewn_to_length_mm"] == ""


def test_every_format_has_all_notches(tmp_path, layout):
    write_pieces(tmp_path / "p.csv", [each.piece for each in layout.pieces])
    write_pattern_svg(tmp_path / "p.svg", layout, HEADING)
    write_pattern_plt(tmp_path / "p.plt", layout)
    counts = [sum(int(row["notches"]) for row in rows_of(tmp_path / "p.csv"))]
    counts.append((tmp_path / "p.svg").read_text("utf-8").count('class="notch"'))
    for standard in STANDARDS:
        drawing = read_dxf(tmp_path / "p.dxf", layout, standard)
        names = [each.dxf.name for each in drawing.modelspace().query("INSERT")]
        counts.append(sum(len(drawing.blocks[name].query("POINT[layer=='4']")) for name in names))
    other = 4 * len(layout.pieces) + sum(len(each.piece.internal) for each in layout.pieces)
    counts.append((tmp_path / "p.plt").read_text().split("SP2")[0].count("PD") - other)
    assert counts == [notches(layout)] * len(counts)


WRITERS = {
    "dxf": lambda path, layout: write_pattern_dxf(path, layout, HEADING),
    "svg": lambda path, layout: write_pattern_svg(path, layout, HEADING),
    "plt": write_pattern_plt,
    "csv": lambda path, layout: write_seams(path, [each.piece for each in layout.pieces]),
}


@pytest.mark.parametrize("ending", sorted(WRITERS))
def test_a_file_is_whole_or_not_there(tmp_path, layout, ending):
    with pytest.raises(ProjectError):
        WRITERS[ending](tmp_path / "none" / f"p.{ending}", layout)
    assert list(tmp_path.iterdir()) == []


def test_a_dart_has_a_drill_hole_at_its_tip_and_its_legs(tmp_path, layout):
    block = read_dxf(tmp_path / "p.dxf", layout, "aama").blocks["SKIRT"]
    (cut,) = (each for each in layout.pieces if each.piece.name == "skirt")
    at = cut.cut.min(axis=0)
    ((legs, tip),) = cut.piece.darts
    (hole,) = block.query("POINT[layer=='13']")
    np.testing.assert_allclose(np.array(hole.dxf.location.vec2) + at, tip, atol=1e-3)
    drawn = [flat(each) + at for each in block.query("POLYLINE[layer=='8']")]
    assert any(np.allclose(each, legs, atol=1e-3) for each in drawn if len(each) == len(legs))
    assert not any(each.darts for each in made_pieces()), "seams are no darts"


def test_words_of_another_language_stay_out_of_ascii(tmp_path):
    """A strip in a Japanese window: names of the program in English, its title on paper."""
    strip = piece_of_strip(Strip("under-bust", "アンダーバスト", 700.0, 12.0), "under-bust", "Band", "ゴム")
    layout = lay_out([cut_piece(strip)], 600.0)
    texts = [each.dxf.text for each in read_dxf(tmp_path / "p.dxf", layout, "aama").query("TEXT")]
    texts += [each.dxf.text for each in ezdxf.readfile(tmp_path / "p.dxf").blocks["UNDER_BUST"].query("TEXT")]
    assert "MATERIAL: Band" in texts
    write_pattern_plt(tmp_path / "p.plt", layout)
    assert "?" not in (tmp_path / "p.plt").read_text("ascii")
    assert not any("?" in each for each in texts if not each.startswith("STYLE"))
    write_pattern_svg(tmp_path / "p.svg", layout, HEADING, lambda message: f"<{message}>")
    words = [each.text for each in ElementTree.parse(tmp_path / "p.svg").iter(f"{SVG}text")]
    assert words[1:] == ["<stretch>", "アンダーバスト · ゴム · <cut 1> · Customer 0412 · 2026-11-26"]
    write_pieces(tmp_path / "p.csv", [strip])
    assert [(row["piece"], row["cloth"]) for row in rows_of(tmp_path / "p.csv")] == [("under-bust", "Band")]
