"""Preparation of a body for drawing in a background thread."""

from __future__ import annotations

from app.rendering.band import OFF_WIDTH, band_width
from app.rendering.render_mesh import NONE, PREPARING, mesh_parts, render_mesh
from app.rendering.ribbon_mesh import RibbonSurface
from core.pipeline.build import IncompleteBuildError, Stages
from core.progress import Progress, quiet


def prepare_scene(built: Stages | IncompleteBuildError, progress: Progress = quiet) -> None:
    """Prepare all slow parts of a body with its bands before it is shown. Raises Cancelled."""
    mesh, stages = built.body.mesh, built if isinstance(built, Stages) else None
    skin = render_mesh(mesh, lambda what, share: progress(what, 0.7 * share))
    progress(PREPARING, 0.7)
    _ = built.body.holes  # kept with the body: they are listed beside it
    mesh_parts(skin, NONE if stages is None else stages.skin.vertices)
    if stages is None:
        return
    surface = RibbonSurface(mesh)
    routes, lines = stages.all_routes, [line.name for line in stages.drawn_lines]
    for done, name in enumerate(lines):
        progress(PREPARING, 0.9 + 0.1 * done / len(lines))
        for width in (band_width(name, stages.design), OFF_WIDTH):
            surface.lay_ready(routes[name], width)
