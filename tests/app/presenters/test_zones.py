"""Zones of the lower trunk: their curves, their table, and the volume that is taken up inside."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from whole_trunk import wearing

from app.presenters.plots import lower_run, lower_table_of
from app.presenters.zones import taken_up_texts
from core.pipeline.live_solver import Frame, make_frame
from core.pipeline.region_solvers import RegionSolvers

ZONES = ["waist", "belly", "front", "seat-left", "seat-right"]


@cache
def cinched(volume: str = "adaptive", waist_kept: float = 0.5) -> Frame:
    """A waist at 94 % at rest."""
    stages = wearing({"waist": 0.94}, volume=volume, waist_kept=waist_kept)
    solvers = RegionSolvers(stages)
    while not solvers.is_finished:
        solvers.advance()
    return make_frame(1, stages, solvers)


def test_errors_of_zones_add_up_to_that_of_the_lower_trunk() -> None:
    frame = cinched()
    run = lower_run(frame)
    assert run is not None
    assert list(run.zones) == ZONES
    whole = run.tracks["adaptive"]
    assert np.abs(whole.error_ml).max() > 1.0
    together = sum(zone.error_ml for zone in run.zones.values())
    assert together == pytest.approx(whole.error_ml, abs=1e-9)
    assert all(abs(zone.error_ml[-1]) < 0.5 for zone in run.zones.values()), "each comes to rest"
    heading, rows = lower_table_of(frame.lower)
    assert {len(row) for row in rows} == {len(heading)}
    at = heading.index("Left seat, volume error [ml]")
    last = next(row for row in reversed(rows) if row[0] == "adaptive")
    assert last[at] == pytest.approx(run.zones["seat-left"].error_ml[-1])


def test_the_exact_solution_has_no_curves_of_zones() -> None:
    run = lower_run(cinched("exact"))
    assert run is not None
    assert run.zones == {}
    assert {"adaptive", "conventional"} <= run.tracks.keys()


def test_what_the_waist_does_not_keep_is_taken_up_inside() -> None:
    zones = {zone.name: zone for zone in cinched("exact").lower.zones}
    waist = zones["waist"]
    assert waist.error_ml == pytest.approx(0.0, abs=1e-6)
    assert waist.taken_up_ml == pytest.approx(-waist.change_ml, abs=1e-6)
    assert waist.taken_up_ml > 30.0
    assert all(zones[name].taken_up_ml == 0.0 for name in ZONES[1:])
    text, tip = taken_up_texts(cinched("exact"))
    assert text == f"Taken up inside: Waist {waist.taken_up_ml:.1f} ml"
    assert "Not measured" in tip
    assert taken_up_texts(cinched("exact", waist_kept=1.0)) == ("", "")
