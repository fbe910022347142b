"""Fixes that leave nothing to be checked: several, each tried, the best first."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from app.presenters.samples import sample_design
from core.analysis.diagnosis.candidate_changes import Change
from core.analysis.diagnosis.diagnose import Diagnosis, diagnose
from core.analysis.diagnosis.pressure_fixes import WIDEST
from core.analysis.diagnosis.search import Search
from core.analysis.diagnosis.trial_run import run_trial
from core.document.design import Design
from core.document.elastic import OverstretchedError
from core.garment.assessment import BAD, assess
from core.garment.elastic_library import find_elastic
from core.pipeline.build import Stages, build
from core.pipeline.solve import solve
from core.progress import quiet

Built = Callable[[str], Stages]


def ends(found: Diagnosis) -> list[tuple[str, str]]:
    return [(cure.change.kind, cure.level) for cure in found.fixes]


def level_of(design: Design, stages: Stages) -> str:
    """The worst that a change can end, of a design that is solved anew."""
    findings = assess(solve(build(design, stages))).findings
    return next((each.level for each in findings if each.topic not in ("landmarks", "fit")), "good")


def test_adaptive_comes_first_where_the_conventional_control_alone_vibrates(built: Built) -> None:
    stages = built("mannequin")
    design = replace(stages.design.with_line("mid-bust", 0.95), volume="conventional", gain=1.7)
    found = diagnose(build(design, stages))
    assert found.problem == "vibrating"
    assert found.fixes[0].change.setting == ("volume", "adaptive")
    assert found.fixes[0].change.kind == "setting"
    assert len(found.fixes) > 1


@pytest.mark.parametrize(("sample", "ratio"), [("mannequin", 0.8), ("person", 0.88)])
def test_a_fix_without_a_warning_stands_before_one_with_another(
    built: Built, sample: str, ratio: float
) -> None:
    stages = built(sample)
    found = diagnose(build(stages.design.with_line("mid-bust", ratio), stages))
    assert found.problem == "overstrained"
    assert len(found.fixes) > 1, "several are offered"
    assert [cure.rank for cure in found.fixes] == sorted(cure.rank for cure in found.fixes)
    assert found.fixes[0].level == "good"
    assert found.fixes[-1].level == BAD, "the smallest change alone leaves what nobody can wear"
    for cure in found.fixes:
        assert level_of(cure.change.design, stages) == cure.level, "it is told as it ends"


@pytest.mark.parametrize(
    ("ratios", "settings", "most"),
    [
        ({"mid-bust": 0.7}, {"volume": "conventional", "gain": 1.7}, 0.0),
        ({"mid-bust": 0.6}, {"line_hold": "held", "volume": "exact"}, 0.0),
        ({"mid-bust": 0.6, "full-bust": 0.6}, {}, 9.2),
        ({"mid-bust": 0.93, "full-bust": 0.93}, {}, 9.2),
    ],
)
def test_a_fix_that_leaves_far_too_much_pressure_is_never_the_best(
    built: Built, ratios: dict[str, float], settings: dict[str, Any], most: float
) -> None:
    """What ends an oscillation, a fold or a refusal alone would leave up to 56 kPa."""
    stages = built("mannequin")
    design = replace(stages.design, lines=(), **settings)
    for name, ratio in ratios.items():
        design = design.with_line(name, ratio)
    best = diagnose(build(design, stages)).best_fix
    assert best is not None
    pressures = [each.value for each in best.remains if each.topic == "pressure"]
    assert max(pressures, default=0.0) <= most


def test_a_calm_design_that_presses_too_much_is_widened_or_lengthened(built: Built) -> None:
    stages = built("mannequin")
    found = diagnose(build(stages.design.with_line("mid-bust", 0.95), stages))
    assert found.problem == ""
    assert [each.topic for each in found.findings] == ["pressure"]
    assert ends(found) == [("length", "good"), ("width", "caution")], "wider, the shape stays"
    assert all(level_of(cure.change.design, stages) == cure.level for cure in found.fixes)
    wide = found.fixes[1].change.design
    assert wide.ratio("mid-bust") == 0.95
    assert 12.0 < (wide.line_settings("mid-bust").width or 0.0) <= WIDEST


def banded() -> Design:
    """Return the person with a wide soft band that slides over the skin."""
    bare = replace(sample_design("person"), lines=(), line_contact="sliding", line_height=0.7)
    return bare.with_elastic("mid-bust", find_elastic("power-net 80")).with_line("mid-bust", 0.68)


def test_a_tight_elastic_is_made_longer_though_shorter_is_beyond_its_table() -> None:
    design = banded()
    stages = build(design)
    tight = build(design.with_line("mid-bust", 0.53), stages)
    with pytest.raises(OverstretchedError):
        build(design.with_line("mid-bust", 0.51), stages)
    found = diagnose(tight)
    assert found.problem == ""
    assert {each.topic for each in found.findings} == {"band", "pressure"}
    assert found.fixes
    assert [cure.change.kind for cure in found.fixes] == ["length"], "a band that lifts is not taken off"
    assert found.fixes[0].level == "good"
    assert found.fixes[0].change.design.ratio("mid-bust") > 0.6


def test_a_fix_that_is_refused_is_left_out() -> None:
    design = banded()
    stages = build(design)
    tight = build(design.with_line("mid-bust", 0.53), stages)
    search = Search(run_trial(tight, quiet), quiet)
    shorter = Change("length", design.with_line("mid-bust", 0.51), 2.0, ("mid-bust",))
    longer = Change("length", design.with_line("mid-bust", 0.7), 17.0, ("mid-bust",))
    assert [cure.change for cure in search.run_changes([shorter, longer])] == [longer]
    assert search.first_verified(iter([shorter, longer])).change is longer


def test_a_slack_line_is_taken_off(built: Built) -> None:
    stages = built("person")
    design = stages.design.with_line("mid-bust", 0.995).with_line("full-bust", 1.03)
    found = diagnose(build(design, stages))
    assert "band" in {each.topic for each in found.findings}
    (off,) = (cure for cure in found.fixes if cure.change.kind == "off")
    assert off.change.lines == ("full-bust",)
    assert "band" not in {each.topic for each in off.remains}
