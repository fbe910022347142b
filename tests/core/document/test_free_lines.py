"""Free lines on bodies: they keep the curve that was drawn, are written, saved, split and mirrored."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from core.control_mesh.embedding import embed
from core.control_mesh.path_snapping import max_deviation, snap
from core.control_mesh.skin_projection import locate_on_mesh, points_on_skin
from core.control_mesh.template import read_template
from core.document.design import Design, ScanSource
from core.document.free_lines import free_curve
from core.document.line_notation import format_path, mirror_image, parse_line
from core.document.lines import CustomLine
from core.document.serialization import from_json, to_json
from core.document.split_lines import split
from core.errors import LineError
from core.geometry.geodesic import SurfacePaths
from core.geometry.mesh import Points
from core.geometry.plane_sections import resample
from core.pipeline.build import Stages, build

TEMPLATE = read_template("168")
Built = Callable[[str], Stages]


def diagonal(stages: Stages) -> Points:
    """A curve drawn over the left breast, from below the middle up and out."""
    points = stages.control.mesh.vertices
    ends = points[TEMPLATE.point(2, 1)], points[TEMPLATE.point(5, 4)]
    return SurfacePaths(stages.body.mesh).path(*ends)


@pytest.mark.parametrize("sample", ["mannequin", "person"])
def test_a_diagonal_is_shown_where_it_was_drawn(built: Built, sample: str) -> None:
    stages = built(sample)
    curve = diagonal(stages)
    found = free_curve(stages.body.mesh, stages.control, [curve])
    assert found.is_movable
    assert not found.cut
    assert found.deviation < 1.0
    assert max_deviation(resample(curve, 0.5), found.shown) < 1.0
    assert snap(stages.control, curve).deviation > 4.0  # which through control points it is not
    line = CustomLine("diagonal", places=found.places)
    laid = build(replace(stages.design, own_lines=(line,)), stages)
    np.testing.assert_allclose(laid.routes["diagonal"].path, found.shown, atol=1e-6)
    assert laid.routes["diagonal"].drawn


def test_the_way_to_the_mesh_and_back_leads_to_the_same_place(built: Built) -> None:
    stages = built("mannequin")
    control, skin = stages.control, stages.body.mesh
    rng = np.random.default_rng(3)
    moving = stages.moving.rest[rng.choice(len(stages.moving.rest), 200, replace=False)]
    cells = locate_on_mesh(control.mesh, control.grid, moving)
    inside = np.flatnonzero(cells.inside)
    assert len(inside) > 100
    for at in inside[:40]:
        place = tuple(cells.cells[at].tolist())
        weights = embed(control.grid, (place, (0.0, 0.0))).weights[[0]]
        np.testing.assert_allclose(points_on_skin(skin, control.mesh, weights)[0], moving[at], atol=1e-3)


def test_what_leaves_the_control_mesh_is_cut_off_or_refused(built: Built) -> None:
    stages = built("mannequin")
    inner = diagonal(stages)
    high = stages.body.mesh.vertices[stages.body.mesh.vertices[:, 2].argmax()]
    found = free_curve(stages.body.mesh, stages.control, [inner, np.stack([inner[-1], high])])
    assert found.cut
    with pytest.raises(LineError, match="leaves the control mesh"):
        free_curve(stages.body.mesh, stages.control, [high + np.array([[0.0, 0.0, 0.0], [5.0, 0.0, 0.0]])])
    with pytest.raises(LineError, match="no length"):
        free_curve(stages.body.mesh, stages.control, [inner[:1].repeat(2, axis=0)])


def test_it_is_written_by_rows_and_columns_and_saved() -> None:
    line = parse_line("Diagonal=r2.35c-3.2,r3c0,r4.5c1.25,shoulder", TEMPLATE)
    assert line.places == ((2.35, -3.2), (3.0, 0.0), (4.5, 1.25))
    assert line.over_shoulder
    assert parse_line(f"diagonal={format_path(line, TEMPLATE)}", TEMPLATE) == line
    ring = parse_line("ring=r2.5c1,r3.5c2,r3c0.5,closed", TEMPLATE)
    assert parse_line(f"ring={format_path(ring, TEMPLATE)}", TEMPLATE) == ring
    design = Design(ScanSource("a.ply"), own_lines=(line, ring))
    assert from_json(to_json(design)) == design
    plain = Design(ScanSource("a.ply"), own_lines=(CustomLine("plain", (1, 2)),))
    assert '"places"' not in to_json(plain)
    for wrong in ("a=r2.5c-6.5,r3c0", "a=r7.5c0,r3c0", "a=r2.5c0"):
        with pytest.raises(LineError):
            parse_line(wrong, TEMPLATE)


def test_its_mirror_image_and_its_halves_are_as_long() -> None:
    across = CustomLine("across", places=((2.2, -3.4), (3.1, -1.0), (3.4, 0.5), (4.2, 3.0)))
    left, right = split(
        Design(ScanSource("a.ply"), own_lines=(across,)).with_line("across", 0.95), TEMPLATE, "across"
    ).own_lines
    assert left.places == ((3.3, 0.0), (3.4, 0.5), (4.2, 3.0))
    assert right.places == ((3.3, 0.0), (3.1, -1.0), (2.2, -3.4))
    assert mirror_image(left, TEMPLATE, "x").places == ((3.3, -0.0), (3.4, -0.5), (4.2, -3.0))
    backwards = replace(across, places=across.places[::-1])
    again = split(Design(ScanSource("a.ply"), own_lines=(backwards,)), TEMPLATE, "across").own_lines
    assert again == (left, right)
    for other in (across.places[2:], (*across.places, (4.0, -2.0))):
        with pytest.raises(LineError, match="does not cross"):
            split(Design(ScanSource("a.ply"), own_lines=(CustomLine("a", places=other),)), TEMPLATE, "a")
