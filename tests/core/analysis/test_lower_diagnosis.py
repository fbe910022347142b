"""Diagnosis of the lower trunk: the region with the problem is found, and what ends it was run."""

from __future__ import annotations

import pytest
from whole_trunk import wearing

from core.analysis.diagnosis.diagnose import diagnose
from core.analysis.diagnosis.opposing_constraints import analyse
from core.analysis.diagnosis.stability import forecast
from core.analysis.diagnosis.trial_run import run_trial
from core.pipeline.build import Stages, build
from core.pipeline.solve import solve

BUST = {"mid-bust": 0.99}


def lower_of(stages: Stages) -> Stages:
    assert stages.lower is not None
    return stages.lower  # type: ignore[return-value]


def test_a_gain_beyond_the_limit_of_the_lower_trunk_is_found_and_lowered_or_adapted() -> None:
    stages = wearing({**BUST, "waist": 0.95}, volume="conventional", gain=1.3)
    found = diagnose(stages)
    assert found.problem in ("vibrating", "diverging")
    assert found.trial.worst == 1
    assert found.gain_limit is not None
    assert found.gain_limit < 1.3
    kinds = {fix.change.kind: fix for fix in found.fixes}
    assert kinds["setting"].change.setting == ("volume", "adaptive")
    assert kinds["gain"].change.design.gain < found.gain_limit
    for fix in found.fixes:
        assert not run_trial(build(fix.change.design, stages)).problem


def test_the_gain_that_a_shape_bears_is_where_its_runs_begin_to_swing() -> None:
    stages = wearing({**BUST, "waist": 0.95}, volume="conventional", gain=1.3)
    limit = diagnose(stages).gain_limit
    assert limit is not None
    for share, ends in ((0.96, ("settled",)), (1.06, ("vibrating", "diverging", "settling"))):
        run = run_trial(wearing({**BUST, "waist": 0.95}, volume="conventional", gain=share * limit))
        assert run.runs[1].verdict.motion in ends


@pytest.mark.parametrize("gain", [0.4, 0.9])
def test_the_forecast_of_the_conventional_control_is_where_its_run_comes_to_rest(gain: float) -> None:
    lower = lower_of(wearing({"waist": 0.95, "hip": 0.97}, volume="conventional", gain=gain))
    seen = forecast(lower)
    assert seen is not None
    assert seen.is_stable
    run = run_trial(wearing({"waist": 0.95, "hip": 0.97}, volume="conventional", gain=gain)).runs[1]
    assert abs(run.state.moved - seen.balance.state.moved).max() < 0.1  # slow ways are not awaited
    points = lower.model.tensegric.expand(seen.balance.state.moved)
    pressure = lower.model.state_pressure(seen.balance.pressures)
    missing = -lower.model.zone_errors(points, pressure.value)
    assert missing == pytest.approx(run.state.pressure.error, rel=0.02)
    assert pressure.value == pytest.approx(gain * missing, rel=1e-6)


def test_strain_at_the_fold_is_ended_by_longer_slings() -> None:
    slings = {"sling-left": 0.75, "sling-right": 0.75}
    stages = wearing({**BUST, **slings}, volume="adaptive")
    found = diagnose(stages)
    assert found.trial.worst == 1
    assert found.problem in ("strained", "overstrained", "folded")
    best = found.best_fix
    assert best is not None
    assert best.change.design.ratio("sling-left") == best.change.design.ratio("sling-right") > 0.75
    condition = solve(build(best.change.design, stages)).verdict.condition
    assert condition is not None
    assert not condition.overstrained


def test_a_pressure_of_the_waist_is_ended_by_a_longer_or_wider_band() -> None:
    stages = wearing({"waist": 0.9}, volume="adaptive")
    found = diagnose(stages)
    assert not found.problem
    assert next(each.lines for each in found.findings if each.topic == "pressure") == ("waist",)
    assert {fix.change.kind for fix in found.fixes} >= {"length", "width"}
    assert all(fix.change.lines == ("waist",) for fix in found.fixes)


def test_forces_of_the_region_that_has_lines_are_told() -> None:
    lower = lower_of(wearing({"waist": 0.95, "hip": 0.95}))
    told = analyse(lower)
    assert {force.lines for force in told.forces} == {("waist",), ("hip",), ()}
    waist = next(force for force in told.forces if force.lines == ("waist",))
    assert waist.to_volume > 90.0
