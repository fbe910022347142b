"""Worn lines for pattern programs: read back by other libraries, at their length."""

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import ezdxf
import numpy as np
import pytest
import pyvista as pv
from PySide6.QtSvg import QSvgRenderer

from core.control_mesh.template import read_template
from core.document.design import Design, ScanSource
from core.document.line_notation import ready_made_lines
from core.errors import LineError, UserError
from core.export.band_geometry import AS_WORN, BACK, CENTRE, LEFT, SIDE_SEAM, Strip, line_curves, strips
from core.export.drawings import SCALE_BAR, strip_label, write_curves, write_strips
from core.export.units_and_axes import UNITS, FileSpace
from core.garment.cut_list import cut_list
from core.garment.elastic_library import find_elastic
from core.geometry.plane_sections import arc_length
from core.pipeline.build import build
from core.pipeline.solve import solve

SAMPLES = Path(__file__).parents[3] / "resources" / "samples"
SVG = {"s": "http://www.w3.org/2000/svg"}
ODD = (Strip("a/b", 'Sling <left> & "ours"', 312.345, 12.0), Strip("A_b", "斜めの帯", 87.5, 6.5))


@pytest.fixture(scope="module")
def solution():
    design = Design(ScanSource(str(SAMPLES / "mannequin.ply"))).with_line("mid-bust", 0.95)
    return solve(build(design.with_line("under-bust", 0.97)))


@pytest.fixture(scope="module")
def curves(solution):
    return line_curves(solution.stages, solution.control_points, {"mid-bust": "Mid-bust"}, {})


@pytest.fixture(scope="module")
def flat(solution):
    return strips(solution.stages, solution.control_points, {}, {"under-bust": 22.0})


def test_worn_lines_alone_are_drawn_and_lie_on_the_reshaped_skin(solution, curves):
    assert [(curve.name, curve.title) for curve in curves] == [
        (line.name, line.name.replace("mid-bust", "Mid-bust"))
        for line in solution.stages.model.lines
        if line.name in ("mid-bust", "under-bust")
    ]
    skin = pv.PolyData.from_regular_faces(solution.body.vertices, solution.body.faces)
    for curve in curves:
        for places in curve.parts.values():
            away = pv.PolyData(places).compute_implicit_distance(skin)["implicit_distance"]
            assert np.abs(away).max() < 1.5


def test_front_and_back_meet_at_both_sides_and_go_round_once(curves):
    for curve in curves:
        np.testing.assert_array_equal(curve.front[-1], curve.back[0])
        np.testing.assert_array_equal(curve.back[-1], curve.front[0])
        assert curve.front[0, 0] < -100.0 < 100.0 < curve.front[-1, 0]  # from the right to the left
        assert curve.front[:, 1].min() + 100.0 < curve.back[:, 1].max()


def test_a_curve_is_as_long_as_the_band_up_to_the_skin_between_control_points(solution, curves):
    for curve, line in zip(curves, worn_lines(solution), strict=True):
        drawn = sum(arc_length(part)[-1] for part in curve.parts.values())
        assert drawn == pytest.approx(line.length(solution.control_points) + line.back_length, rel=0.015)


@pytest.mark.parametrize("unit", UNITS)
def test_a_dxf_holds_each_part_on_a_layer_of_its_own_in_its_unit(tmp_path, curves, unit):
    write_curves(tmp_path / "lines.dxf", curves, FileSpace(unit, "y-up"))
    drawing = ezdxf.readfile(tmp_path / "lines.dxf")
    found = {each.dxf.layer: np.array(list(each.points())) for each in drawing.modelspace().query("POLYLINE")}
    assert drawing.dxfversion == "AC1024"
    assert drawing.units == {"mm": 4, "cm": 5, "m": 6, "in": 1}[unit]
    assert set(found) == {f"{curve.name} {part}" for curve in curves for part in ("front", "back")}
    assert not drawing.audit().has_errors
    for curve in curves:
        for part, places in curve.parts.items():
            x, y, z = found[f"{curve.name} {part}"].T * UNITS[unit]
            np.testing.assert_allclose(np.stack([x, -z, y], axis=1), places, atol=1e-6)


def test_an_obj_of_lines_is_read_by_another_library(tmp_path, curves):
    write_curves(tmp_path / "lines.obj", curves, FileSpace("cm", "z-up"))
    read = pv.read(tmp_path / "lines.obj")
    parts = [places for curve in curves for places in curve.parts.values()]
    assert (read.n_lines, read.n_points) == (len(parts), sum(map(len, parts)))
    np.testing.assert_allclose(read.points, np.concatenate(parts) / 10.0, atol=1e-4)


def test_a_strip_is_as_long_as_the_program_says_everywhere_else(solution, flat):
    for strip, line in zip(flat, worn_lines(solution), strict=True):
        reached = line.length(solution.control_points)
        assert strip.length == pytest.approx(reached + line.back_length, abs=1e-9)
        (right, centre, left, back, end) = strip.marks
        assert (right, left) == ((0.0, SIDE_SEAM), (pytest.approx(reached), LEFT))
        assert back == (pytest.approx(reached + 0.5 * line.back_length, rel=0.02), BACK)
        assert end == (pytest.approx(strip.length), SIDE_SEAM)
        assert centre == (pytest.approx(reached / 2.0, rel=0.02), CENTRE)
    assert {strip.name: strip.width for strip in flat} == {"mid-bust": 12.0, "under-bust": 22.0}


def test_a_strip_of_elastic_is_as_long_as_it_is_to_be_cut(solution):
    stages = solution.stages
    elastic = replace(find_elastic("plush 12"), allowance_mm=30.0)
    design = stages.design.with_line("mid-bust", 0.75).with_elastic("mid-bust", elastic)
    stretched = solve(build(design, stages))
    points = stretched.control_points
    row = next(row for row in cut_list(stretched.stages, points).rows if row.line == "mid-bust")
    flat = strips(stretched.stages, points, {}, {})
    cut, worn = (next(s for s in flat if s.name == name) for name in ("mid-bust", "under-bust"))
    assert cut.length == row.cut_mm
    assert cut.length < 0.9 * row.reached_whole_mm
    assert (worn.length, worn.note) == (flat_length(stretched, "under-bust"), AS_WORN)
    (right, centre, left, back, end) = cut.marks
    assert (right[0], end[0]) == (15.0, pytest.approx(cut.length - 15.0))
    assert right[1] == end[1] == SIDE_SEAM
    assert left[0] < back[0] < end[0]
    # Between its seams the strip is the band, relaxed as a whole.
    share = (left[0] - 15.0) / (cut.length - 30.0)
    assert share == pytest.approx(row.reached_front_mm / row.reached_whole_mm)
    assert 15.0 < centre[0] < left[0]
    assert "elongation" in str(strip_label(cut))


def test_the_ends_of_a_strap_are_told_apart(solution):
    whole = ready_made_lines(read_template("168"))["straps"]
    own = tuple(replace(strap, over_shoulder=False) for strap in whole)
    stages = solution.stages
    stages = build(replace(stages.design, own_lines=own).with_line("strap left", 0.98), stages)
    lines = {line.name: line for line in stages.model.lines}
    points = stages.control.mesh.vertices
    strap = next(each for each in strips(stages, points, {}, {}) if each.name == "strap left")
    first, last = lines["strap left"].places(points)[[0, -1], 2]
    assert abs(first - last) > 50.0
    names = ["upper end", "lower end"] if first > last else ["lower end", "upper end"]
    assert [(at, str(mark)) for at, mark in (strap.marks[0], strap.marks[-1])] == list(
        zip((0.0, strap.length), names, strict=True)
    )
    stages = build(replace(stages.design, own_lines=whole), stages)
    worn = next(each for each in strips(stages, points, {}, {}) if each.name == "strap left")
    tail = stages.tails["strap left"]
    assert worn.length == pytest.approx(strap.length + tail.length)
    at = {str(name): place for place, name in worn.marks}
    assert at["shoulder"] == pytest.approx(strap.length + tail.top)
    assert at["back, at the under-bust band"] == pytest.approx(worn.length)
    curve = next(each for each in line_curves(stages, points, {}, {}) if each.name == "strap left")
    assert len(curve.parts) == 1, "one band from end to end"
    assert curve.front[-1, 1] > curve.front[0, 1] + 100.0
    assert curve.length == pytest.approx(worn.length, rel=0.05)
    stages = build(stages.design.with_elastic("strap left", find_elastic("strap 15")), stages)
    strap = next(each for each in strips(stages, points, {}, {}) if each.name == "strap left")
    assert str(strap.note).startswith("cut from Strap")


def test_an_svg_is_at_its_size_in_millimetres(tmp_path, flat):
    write_strips(tmp_path / "w.svg", flat, "anna")
    root = ElementTree.parse(tmp_path / "w.svg").getroot()
    box = [float(each) for each in root.get("viewBox").split()]
    assert [f"{side:.3f}mm" for side in box[2:]] == [root.get("width"), root.get("height")]
    boxes = [
        (float(each.get("width")), float(each.get("height"))) for each in root.iterfind(".//s:rect", SVG)
    ]
    assert boxes == [(pytest.approx(strip.length, abs=0.1), strip.width) for strip in flat]
    words = "\n".join(each.text for each in root.iterfind(".//s:text", SVG))
    assert all(str(strip_label(strip)) in words for strip in flat)
    assert words.count("centre front") == len(flat)
    assert "anna" in words


def test_a_painter_of_svg_finds_strips_and_scale_bar_at_their_size(tmp_path, flat, qapp):
    write_strips(tmp_path / "w.svg", flat)
    painter = QSvgRenderer(str(tmp_path / "w.svg"))
    bar = painter.boundsOnElement("scale-bar")
    assert bar.width() == pytest.approx(SCALE_BAR, abs=0.25)  # and half a line at each end
    for strip in flat:
        bounds = painter.boundsOnElement(f"strip-{strip.name}")
        assert bounds.width() >= strip.length
        assert painter.viewBoxF().contains(bounds)


def test_a_dxf_of_strips_is_at_its_size_with_a_layer_a_strip(tmp_path, flat):
    write_strips(tmp_path / "w.dxf", flat)
    drawing = ezdxf.readfile(tmp_path / "w.dxf")
    assert (drawing.units, drawing.header["$MEASUREMENT"]) == (4, 1)
    outlines = {each.dxf.layer: each for each in drawing.modelspace().query("LWPOLYLINE")}
    for strip in flat:
        corners = np.array(list(outlines[strip.name].vertices()))
        assert outlines[strip.name].closed
        assert np.ptp(corners, axis=0) == pytest.approx([strip.length, strip.width], abs=0.1)
        marks = drawing.modelspace().query(f'LINE[layer=="{strip.name}"]')
        assert sorted(line.dxf.start.x for line in marks) == pytest.approx([at for at, _ in strip.marks])
    longest = max(drawing.modelspace().query('LINE[layer=="scale bar"]'), key=lambda line: line.dxf.end.x)
    assert (longest.dxf.end - longest.dxf.start).magnitude == pytest.approx(SCALE_BAR)
    assert not drawing.audit().has_errors


def test_strips_do_not_lie_on_one_another(tmp_path):
    write_strips(tmp_path / "w.dxf", ODD)
    spans = [
        sorted(y for _, y in each.vertices())
        for each in ezdxf.readfile(tmp_path / "w.dxf").modelspace().query("LWPOLYLINE")
    ]
    assert spans[1][-1] < spans[0][0] - 5.0


@pytest.mark.parametrize("kind", ["svg", "dxf"])
def test_any_letters_come_through_and_layers_stay_apart(tmp_path, kind):
    path = tmp_path / f"w.{kind}"
    write_strips(path, ODD)
    if kind == "svg":
        words = [each.text for each in ElementTree.parse(path).getroot().iterfind(".//s:text", SVG)]
    else:
        drawing = ezdxf.readfile(path)
        words = [each.dxf.text for each in drawing.modelspace().query("TEXT")]
        outlines = [each.dxf.layer for each in drawing.modelspace().query("LWPOLYLINE")]
        assert outlines == ["a_b", "A_b 2"]
    assert {str(strip_label(strip)) for strip in ODD} <= set(words)


@pytest.mark.parametrize(
    "write", [lambda path: write_curves(path, (), FileSpace()), lambda p: write_strips(p, ())]
)
def test_other_endings_are_refused_with_a_choice(tmp_path, write):
    with pytest.raises(UserError, match="dxf"):
        write(tmp_path / "lines.pdf")
    with pytest.raises(UserError, match="cannot be written"):
        write(tmp_path / "missing" / "lines.dxf")
    assert list(tmp_path.iterdir()) == []


def test_nothing_else_is_left_in_the_folders_of_the_user(tmp_path):
    home, out = tmp_path / "home", tmp_path / "w.dxf"
    home.mkdir()
    code = (
        "import sys; from core.export.drawings import write_strips; "
        "from core.export.band_geometry import BACK, CENTRE, LEFT, SIDE_SEAM, Strip;"
        " write_strips(sys.argv[1], [Strip('a', 'a', 100.0, 10.0)])"
    )
    folders = {"HOME": str(home), "XDG_CACHE_HOME": str(home / "cache"), "USERPROFILE": str(home)}
    subprocess.run(
        [sys.executable, "-c", code, str(out)],
        env=os.environ | folders,
        cwd=SAMPLES.parent.parent,
        check=True,
    )
    assert list(home.rglob("*")) == []
    assert out.exists()


def test_a_design_without_worn_lines_is_refused(solution):
    stages = build(Design(solution.stages.design.scan), solution.stages)
    with pytest.raises(LineError, match="No active lines"):
        line_curves(stages, solution.control_points, {}, {})


def flat_length(solution, name):
    line = next(line for line in solution.stages.model.lines if line.name == name)
    return line.length(solution.control_points) + line.back_length


def worn_lines(solution):
    worn = solution.stages.design.active_lines()
    return [line for line in solution.stages.model.lines if line.name in worn]
