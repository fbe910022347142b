"""What other programs find in exported files, read by none of the libraries that wrote them.

Bodies are read by VTK, drawings by the group codes of DXF and by the paths of SVG, and what is known in
millimetres is measured there.
"""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass, field, replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
import pyvista as pv

from app.i18n.catalog import using_language
from app.presenters.export import ExportOptions, ExportSettings, ExportSource, exports
from app.presenters.export_preview import prepare_export
from core.control_mesh.template import read_template
from core.document.custom_measures import CustomMeasurement
from core.document.design import Design, ScanSource
from core.document.line_notation import ready_made_lines
from core.export.drawings import CURVE_FORMATS, STRIP_FORMATS
from core.export.measurement_files import MEASURE_FORMATS
from core.export.mesh import FORMATS
from core.export.units_and_axes import AXES, UNITS, space_of
from core.garment.cut_list import cut_list
from core.garment.elastic_library import find_elastic
from core.geometry.mesh import Mesh
from core.geometry.plane_sections import arc_length
from core.pipeline.build import build
from core.pipeline.solve import solve
from core.progress import quiet

SAMPLES = Path(__file__).parents[3] / "resources" / "samples"
SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def outcome() -> ExportSource:
    """A body that wears a band of plush elastic, a plain band and a closed ring."""
    design = Design(ScanSource(str(SAMPLES / "mannequin.ply")))
    design = design.with_custom_line(ready_made_lines(read_template("168"))["rings"][0]).with_line(
        "ring left", 0.99
    )
    design = design.with_line("under-bust", 0.97).with_line("mid-bust", 0.8)
    solution = solve(build(design.with_elastic("mid-bust", find_elastic("plush 12"))))
    return ExportSource(solution.stages, solution.control_points, solution.records)


def write(what: str, path: Path, outcome: ExportSource, manner: ExportOptions) -> Path:
    prepare_export(what, path, outcome, manner).write(path, None, quiet)
    return path


def test_measures_of_ones_own_keep_their_names_in_files(outcome: ExportSource, tmp_path: Path) -> None:
    marks = "bust_point_left", "bust_point_right"
    own = replace(outcome.stages.design, own_measures=(CustomMeasurement("Bust girth", "straight", marks),))
    stages = replace(outcome.stages, design=own)
    named = ExportSource(stages, outcome.control_points, outcome.records)
    with using_language("ja"):
        written = write("measures", tmp_path / "a.csv", named, ExportOptions())
    titles = [title for _, title, *_ in csv.reader(written.read_text("utf-8").splitlines())]
    assert titles.count("Bust girth") == 1, "in the words of the designer"
    assert titles.count("バスト囲") == 1, "in those of the window"


@pytest.mark.parametrize("axes", AXES)
def test_the_axes_are_told_in_the_language_of_the_window(outcome: ExportSource, axes: str) -> None:
    manner = ExportOptions(unit="mm", axes=axes)
    assert prepare_export("body", "a.stl", outcome, manner).how == f"in mm, {axes}"
    with using_language("ja"):
        assert prepare_export("body", "a.stl", outcome, manner).how.startswith(f"mm、{axes[0]} が上")


def turned(places: np.ndarray, unit: str, axes: str) -> np.ndarray:
    """Return places of a file in Busk's axes and millimetres."""
    return np.asarray(places) @ np.array(AXES[axes], dtype=float) * UNITS[unit]


def read_mesh(path: Path) -> pv.PolyData:
    mesh = pv.read(path)
    if isinstance(mesh, pv.MultiBlock):
        mesh = mesh.combine().extract_surface(algorithm="dataset_surface")
    assert isinstance(mesh, pv.PolyData)
    return mesh


@pytest.mark.parametrize("axes", AXES)
@pytest.mark.parametrize("unit", UNITS)
@pytest.mark.parametrize("kind", FORMATS)
def test_a_mesh_is_read_at_its_size_and_faces_where_it_is_said(
    tmp_path: Path, outcome: ExportSource, kind: str, unit: str, axes: str
) -> None:
    path = write("control", tmp_path / f"c.{kind}", outcome, ExportOptions(unit, axes))
    mesh, wanted = read_mesh(path), outcome.stages.control.mesh.moved(outcome.control_points)
    places = turned(mesh.points, unit, axes)
    corners = places[mesh.regular_faces]
    found = np.sort(_corners(mesh, places), axis=0)
    np.testing.assert_allclose(found, np.sort(_corners_of(wanted), axis=0), atol=2e-3)
    # The winding is kept: areas with their direction add up to the same.
    areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]).sum(axis=0) / 2.0
    assert areas == pytest.approx(wanted.area_vectors.sum(axis=0), rel=1e-4, abs=0.5)


@pytest.mark.parametrize("kind", FORMATS)
@pytest.mark.parametrize("before", [False, True])
def test_a_whole_body_is_read_at_its_place_and_size(
    tmp_path: Path, outcome: ExportSource, kind: str, before: bool
) -> None:
    path = write("body", tmp_path / f"b.{kind}", outcome, ExportOptions(before=before))
    space, wanted = space_of(kind), outcome.body(before)
    mesh = read_mesh(path)
    places = turned(mesh.points, space.unit, space.axes)
    assert mesh.n_cells == len(wanted.faces)
    for each in (np.min, np.max):
        np.testing.assert_allclose(each(places, axis=0), each(wanted.vertices, axis=0), atol=1e-3)
    volume = float(mesh.volume) * UNITS[space.unit] ** 3
    assert volume == pytest.approx(_volume(wanted), rel=1e-4)
    found = np.sort(_corners(mesh, places), axis=0)
    other = np.sort(_corners_of(outcome.body(not before)), axis=0)
    np.testing.assert_allclose(found, np.sort(_corners_of(wanted), axis=0), atol=1e-3)
    assert np.abs(found - other).max() > 0.1, "at rest and reshaped are two bodies"


@pytest.mark.parametrize("unit", UNITS)
def test_a_dxf_of_lines_holds_closed_curves_of_the_length_that_is_told(
    tmp_path: Path, outcome: ExportSource, unit: str
) -> None:
    manner = ExportOptions(unit, "y-up")
    told = prepare_export("lines", "l.dxf", outcome, manner).contents
    parts = read_polylines(write("lines", tmp_path / "l.dxf", outcome, manner))
    assert {part.layer for part in parts} == {
        "under-bust front", "under-bust back", "mid-bust front", "mid-bust back", "ring left front"
    }  # fmt: skip
    found: dict[str, float] = {}
    for part in parts:
        name, front = part.layer.rsplit(" ", 1)
        found[name] = found.get(name, 0.0) + float(arc_length(part.places * UNITS[unit])[-1])
        other = next(
            (p for p in parts if p.layer == f"{name} {'back' if front == 'front' else 'front'}"), part
        )
        np.testing.assert_allclose(part.places[-1], other.places[0], atol=1e-9)  # it goes round
    lines = {line.name: line for line in outcome.stages.model.lines}
    for name, length in found.items():
        assert f"{length:.1f} mm" in told
        line = lines[name]
        reached = line.length(outcome.control_points) + line.back_length
        # Both ways round: the curve is smooth on the skin, the length goes straight between control points.
        assert length == pytest.approx(reached, rel=0.06 if name.startswith("ring") else 0.02)


def test_what_stands_on_a_strip_is_in_the_language_of_the_window(
    tmp_path: Path, outcome: ExportSource
) -> None:
    with using_language("ja"):
        again = ExportSource(outcome.stages, outcome.control_points, outcome.records)
        root = ElementTree.parse(write("flat", tmp_path / "ja.svg", again, ExportOptions())).getroot()
    words = [each.text or "" for each in root.iter(f"{SVG}text")][2:]  # heading and scale bar say mm
    assert {"前中心", "右脇（縫い目）", "左脇", "後ろ中心"} <= set(words)
    assert re.findall(r"[A-Za-z]{3,}", " ".join(words)) == []
    wide = float(root.get("width", "").removesuffix("mm"))
    assert wide > 20.0 + max(4.0 * sum(ord(letter) > 255 for letter in text) for text in words)


def test_strips_are_headed_with_project_and_customer(tmp_path: Path, outcome: ExportSource) -> None:
    for named, told in (
        (("anna-3", "Anna M."), "anna-3 · Anna M."),
        (("anna-3", ""), "anna-3"),
        (None, ".ply"),
    ):
        file = write("flat", tmp_path / "w.svg", replace(outcome, named=named), ExportOptions())
        heading = next(ElementTree.parse(file).getroot().iter(f"{SVG}text")).text or ""
        assert heading.endswith(f"{told}  1:1, mm")


@pytest.mark.parametrize("kind", STRIP_FORMATS)
def test_a_strip_is_as_long_as_the_cut_list_says_and_closed(
    tmp_path: Path, outcome: ExportSource, kind: str
) -> None:
    path = write("flat", tmp_path / f"f.{kind}", outcome, ExportOptions())
    if kind == "dxf":
        parts = read_polylines(path)
        assert all(part.closed for part in parts)
        sizes = {part.layer: np.ptp(part.places[:, :2], axis=0) for part in parts}
    else:
        root = ElementTree.parse(path).getroot()
        scale = float(root.get("width", "").removesuffix("mm")) / float(root.get("viewBox", "").split()[2])
        groups = [each for each in root.iter(f"{SVG}g") if each.get("id", "").startswith("strip-")]
        sizes = {}
        for each in groups:
            box = each.find(f"{SVG}rect")
            assert box is not None
            size = [scale * float(box.get(side, "")) for side in ("width", "height")]
            sizes[each.get("id", "").removeprefix("strip-").replace("-left", " left")] = np.array(size)
    rows = {row.line: row for row in cut_list(outcome.stages, outcome.control_points).rows}
    assert set(sizes) == {"under-bust", "mid-bust", "ring left"}
    assert sizes["mid-bust"] == pytest.approx([rows["mid-bust"].cut_mm, 12.0], abs=1e-3)
    assert rows["mid-bust"].cut_mm < 0.95 * rows["mid-bust"].reached_whole_mm
    assert sizes["under-bust"][0] == pytest.approx(rows["under-bust"].reached_whole_mm, abs=1e-3)


def test_control_points_are_a_table_as_they_are_reshaped(tmp_path: Path, outcome: ExportSource) -> None:
    for before in (True, False):
        path = write("control", tmp_path / "c.csv", outcome, ExportOptions(before=before))
        rows = np.genfromtxt(path, delimiter=",", skip_header=1, usecols=(0, 3, 4, 5))
        np.testing.assert_allclose(rows[:, 1:], outcome.points(before), atol=6e-4)
        assert rows[:, 0].tolist() == list(range(len(rows)))


def test_turns_are_a_table_with_a_row_each(tmp_path: Path, outcome: ExportSource) -> None:
    path = write("turns", tmp_path / "t.csv", outcome, ExportOptions())
    rows = np.genfromtxt(path, delimiter=",", names=True)
    assert len(rows) == len(outcome.records) > 5
    names = [line.name for line in outcome.stages.model.lines]
    last = dict(zip(names, outcome.records[-1].lengths, strict=True))
    assert rows["length_midbust_mm"][-1] == pytest.approx(last["mid-bust"], abs=1e-4)


def test_the_window_offers_what_can_be_written_and_nothing_else() -> None:
    offered = {export.what: set(export.formats) for export in exports()}
    assert offered == {
        "body": set(FORMATS),
        "control": {*FORMATS, "csv"},
        "lines": set(CURVE_FORMATS),
        "flat": set(STRIP_FORMATS),
        "cut": {"csv"},
        "measures": set(MEASURE_FORMATS),
        "picture": {"png"},
        "turntable": {"gif", "webp", "png"},
        "turns": {"csv"},
    }


@pytest.mark.parametrize("export", exports(), ids=lambda export: export.what)
def test_every_choice_can_be_made(outcome: ExportSource, export: object) -> None:
    what = export.what  # type: ignore[attr-defined]
    for kind in export.formats:  # type: ignore[attr-defined]
        choices = ExportSettings("{}")
        choices.choose(what, "format", kind)
        for setting in choices.settings(what):
            if setting.key != "format":
                for value, _ in setting.options:
                    choices.choose(what, setting.key, value)
                    assert choices.values(what)[setting.key] == value
                    ready = prepare_export(what, f"x.{kind}", outcome, choices.manner(what))
                    assert ready.contents


@dataclass
class Polyline:
    """A polyline as its group codes tell it."""

    layer: str = ""
    closed: bool = False
    points: list[list[float]] = field(default_factory=list)

    @property
    def places(self) -> np.ndarray:
        return np.array(self.points)


def read_polylines(path: Path) -> list[Polyline]:
    """Read the polylines of a DXF from nothing but pairs of a group code and a value."""
    lines = path.read_text("utf-8").splitlines()
    pairs = [(int(code), value.strip()) for code, value in zip(lines[::2], lines[1::2], strict=True)]
    begin = pairs.index((2, "ENTITIES"))
    found: list[Polyline] = []
    kind = ""
    for code, value in pairs[begin : pairs.index((0, "ENDSEC"), begin)]:
        if code == 0:
            kind = value
            if kind in ("POLYLINE", "LWPOLYLINE"):
                found.append(Polyline())
            elif kind == "VERTEX":
                found[-1].points.append([0.0, 0.0, 0.0])
        elif kind in ("POLYLINE", "LWPOLYLINE") and code == 8:
            found[-1].layer = value
        elif kind in ("POLYLINE", "LWPOLYLINE") and code == 70:
            found[-1].closed = bool(int(value) & 1)
        elif kind == "LWPOLYLINE" and code == 10:
            found[-1].points.append([float(value), 0.0, 0.0])
        elif (kind == "VERTEX" and code in (10, 20, 30)) or (kind == "LWPOLYLINE" and code == 20):
            found[-1].points[-1][code // 10 - 1] = float(value)
    return found


def _corners(mesh: pv.PolyData, places: np.ndarray) -> np.ndarray:
    """Return the corners of all triangles, in whatever order the file has them."""
    return np.asarray(places[mesh.regular_faces].reshape(-1, 3))


def _corners_of(mesh: Mesh) -> np.ndarray:
    return np.asarray(mesh.vertices[mesh.faces].reshape(-1, 3))


def _volume(mesh: Mesh) -> float:
    """Return the volume inside a body [mm^3]."""
    a, b, c = np.moveaxis(mesh.vertices[mesh.faces], 1, 0)
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0)
