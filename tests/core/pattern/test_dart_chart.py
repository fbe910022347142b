"""Where a dart helps: known curvature, a cone that one dart lays flat, and a cup on a body."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest
from curved_patches import EVEN, ball, cap, cylinder, loop, sheet

from core.geometry.mesh import Mesh
from core.pattern.block_library import find_block
from core.pattern.cloth_library import built_in
from core.pattern.dart_chart import DartChart, angle_deficit, dart_chart
from core.pattern.garment import cut_garment
from core.pattern.panel import Panel, PanelSeed, cut_panels
from core.pattern.places import BodyPlaces
from core.pattern.seam_curves import SeamDrawing
from core.pattern.surface_cut import cut_surface
from core.pipeline.build import Stages
from core.progress import Cancelled


def patch(place: Callable) -> tuple[Panel, Mesh]:
    """A panel of 100 by 80 mm on a bent sheet."""
    skin = sheet(place, 160.0, 120.0)
    edge = loop("edge", place, [(-50.0, -40.0), (50.0, -40.0), (50.0, 40.0), (-50.0, 40.0)])
    seed = np.array([float(each) for each in place(np.array(20.0), np.array(10.0))])
    return cut_panels(cut_surface(skin, tuple(edge)), (PanelSeed("piece", seed),), 5.0)[0], skin


def pyramid(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, ...]:
    """A blunt cone about its tip, which can be laid flat once it is slit up to there."""
    return u, 0.8 * np.hypot(u, v), v


def test_the_deficit_is_the_curvature_of_the_skin() -> None:
    panel = cap(40.0)
    places = panel.places(ball().vertices)
    inner = 40.0 - np.degrees(2.5 / 70.0)  # that of half of the triangles at the border is not within it
    assert angle_deficit(panel, places) == pytest.approx(360.0 * (1.0 - np.cos(np.radians(inner))), rel=0.03)
    bent, skin = patch(cylinder)
    assert angle_deficit(bent, bent.places(skin.vertices)) == pytest.approx(0.0, abs=0.3)  # chords
    tip, skin = patch(pyramid)
    assert angle_deficit(tip, tip.places(skin.vertices)) == pytest.approx(
        360.0 * (1.0 - 1.0 / np.sqrt(1.64)), rel=0.02
    )


def test_any_dart_to_the_tip_of_a_cone_takes_out_nearly_all_its_work() -> None:
    panel, skin = patch(pyramid)
    chart = dart_chart(panel, panel.places(skin.vertices), EVEN)
    assert chart.within > 0.1
    assert len(chart.darts) > 10
    assert max(dart.left for dart in chart.darts) < 0.05
    assert chart.best is not None
    assert chart.best.within < 0.02
    for dart in chart.darts:
        np.testing.assert_allclose(dart.end, [0.0, 0.0, 0.0], atol=3.0)  # the target that was found
        assert np.abs(np.abs(dart.start[[0, 2]]) - [50.0, 40.0]).min() < 1.0, "it starts on the border"
        assert dart.seam.startswith("edge")


@cache
def cup_chart(stages: Stages) -> tuple[DartChart, Panel]:
    drawing = SeamDrawing(BodyPlaces.of(stages))
    panel = cut_garment(drawing, find_block("one-part-cup")).panels[0]
    places = panel.places(stages.body.smoothed.vertices)
    cloth = next(each for each in built_in() if each.name == panel.cloth)
    return dart_chart(panel, places, cloth, breast=drawing.places.breasts["left"]), panel


def test_a_dart_to_the_bust_point_takes_out_most_work_wherever_it_starts(
    coarsely_built: Callable[[str], Stages],
) -> None:
    chart, panel = cup_chart(coarsely_built("mannequin"))
    left = [dart.left for dart in chart.darts]
    assert 0.05 < min(left) < max(left) < 0.2
    assert {dart.seam for dart in chart.darts} == {side.name for side in panel.sides}
    assert chart.best is not None
    assert chart.best.within < 0.5 * chart.within
    clocks = [dart.clock for dart in chart.darts if dart.seam == "wire left"]
    assert min(clocks) < 60.0, "the outer end of the wire"
    assert max(clocks) > 300.0, "its inner end"


def test_clock_positions_are_those_of_the_places_of_a_block(coarsely_built: Callable[[str], Stages]) -> None:
    breast = BodyPlaces.of(coarsely_built("mannequin")).breasts["right"]
    clocks = np.arange(0.0, 360.0, 15.0)
    assert breast.clock(breast.places(clocks, np.full(24, 50.0))) == pytest.approx(clocks, abs=0.6)


def test_a_chart_can_be_stopped() -> None:
    panel, skin = patch(pyramid)

    def stop(what: str, share: float) -> None:
        if share > 0.3:
            raise Cancelled

    with pytest.raises(Cancelled):
        dart_chart(panel, panel.places(skin.vertices), EVEN, progress=stop)
