"""Figs. 1, 3 and 5: the bodies, their control meshes and the line."""

from __future__ import annotations

from matplotlib.figure import Figure as Sheet

from app.research.cases import BODIES, LINE, Study
from app.research.figure_scene import Image, body_picture, control_picture, view_of
from app.research.figure_style import Figure, sheet, show, trimmed
from core.document.design import TEMPLATES
from core.geometry.mesh import Points
from core.pipeline.build import Stages

COLUMNS = (
    "body",
    "body_polygons",
    "control_polygons",
    "control_points",
    "free_control_points",
    "control_volume_ml",
    "line_rest_mm",
)
AZIMUTH, ELEVATION = 25.0, 6.0


def figure_1(study: Study) -> Figure:
    """Draw both bodies, each with both control meshes (paper Fig. 1, which shows the mannequin with 120)."""
    drawn = sheet(4.8)
    axes = drawn.subplots(2, 3, width_ratios=(0.8, 1.0, 1.0))
    rows = []
    for line, (letter, body) in zip(axes, BODIES.items(), strict=True):
        stages = {number: study.stages(body, number) for number in sorted(TEMPLATES)}
        whole = view_of(stages["120"].body.mesh, AZIMUTH, ELEVATION)
        picture = body_picture(stages["120"].body.mesh, study.occlusion(body), whole)
        show(line[0], trimmed([picture])[0], f"({letter}) {body}")
        near = view_of(stages["120"].control.mesh, AZIMUTH, ELEVATION)
        meshes = [
            control_picture(each.control.mesh, near, fixed=each.control.fixed) for each in stages.values()
        ]
        for plot, picture, number in zip(line[1:], trimmed(meshes), stages, strict=True):
            show(plot, picture, f"{number} polygons")
        rows += [_counts(body, each) for each in stages.values()]
    caption = (
        "Left: the bodies, "
        + " and ".join(
            f"{body} of {row[1]:,} polygons" for body, row in zip(BODIES.values(), rows[::2], strict=True)
        )
        + ". Right: the two control meshes laid on each, enlarged; dark points are fixed, light ones move ("
        + " and ".join(f"{row[4]} of {row[3]} on {row[2]} polygons" for row in rows[:2])
        + "). As in the paper, the figures below have 120 polygons on the mannequin and 168 on the person."
    )
    return Figure("fig-1-meshes", "Bodies and control meshes", caption, COLUMNS, rows, drawn)


def figure_3(study: Study) -> Figure:
    """Draw the person and its control mesh with the line (paper Fig. 3)."""
    stages = study.stages("person")
    path = line_points(stages)
    views = [view_of(mesh, AZIMUTH, ELEVATION) for mesh in (stages.body.mesh, stages.control.mesh)]
    pictures = [
        body_picture(stages.body.mesh, study.occlusion("person"), views[0], paths={LINE: path}),
        control_picture(stages.control.mesh, views[1], fixed=stages.control.fixed, paths=[path]),
    ]
    row = _counts("person", stages)
    drawn = _side_by_side(pictures, ("(a) person with the line", "(b) control mesh"))
    caption = (
        f"(a) The person, {row[1]:,} polygons. (b) Its control mesh of {row[2]} polygons; {row[4]} of "
        f"{row[3]} control points are free (light), the others are fixed. The line runs halfway between "
        f"fold and bust points, {row[6]:.0f} mm at rest from side to side."
    )
    return Figure("fig-3-person", "The person with its line", caption, COLUMNS, [row], drawn)


def figure_5(study: Study) -> Figure:
    """Draw both bodies under the control meshes that the turns are made with (paper Fig. 5)."""
    pictures, rows = [], []
    for body in BODIES.values():
        stages = study.stages(body)
        control = (stages.control.mesh, stages.control.fixed)
        view = view_of(stages.body.mesh, AZIMUTH, ELEVATION)
        pictures.append(body_picture(stages.body.mesh, study.occlusion(body), view, control=control))
        rows.append(_counts(body, stages))
    drawn = _side_by_side(pictures, [f"({letter}) {body}" for letter, body in BODIES.items()])
    caption = "The bodies of Figs. 6 and 7 under their control meshes. " + " ".join(
        f"({letter}) {row[0]}: {row[1]:,} polygons, control mesh of {row[2]}, volume {row[5]:,.0f} ml."
        for letter, row in zip(BODIES, rows, strict=True)
    )
    return Figure("fig-5-bodies", "Bodies under their control meshes", caption, COLUMNS, rows, drawn)


def line_points(stages: Stages) -> Points:
    """Return the control points at rest that the paper's line runs through, shape (k, 3) [mm]."""
    return stages.control.mesh.vertices[list(stages.control.paths[LINE])]


def _side_by_side(pictures: list[Image], titles: list[str] | tuple[str, ...]) -> Sheet:
    drawn = sheet(3.9)
    for plot, picture, title in zip(drawn.subplots(1, len(pictures)), pictures, titles, strict=True):
        show(plot, trimmed([picture])[0], title)
    return drawn


def _counts(body: str, stages: Stages) -> tuple[str, int, int, int, int, float, float]:
    control = stages.control
    line = next(line for line in stages.model.lines if line.name == LINE)
    return (
        body,
        len(stages.body.mesh.faces),
        len(control.mesh.faces),
        len(control.mesh.vertices),
        int((~control.fixed).sum()),
        stages.model.volume.rest_volume / 1000.0,
        line.rest_length,
    )
