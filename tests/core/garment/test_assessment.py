"""The overall verdict: the worst of all that was checked, the same in every place that shows it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest
from whole_trunk import trunk_stages

from app.i18n.catalog import tr, using_language
from app.presenters.assessment import IDLE, assessment_lines, assessment_view
from core.analysis.diagnosis.candidate_changes import fixable_findings
from core.analysis.diagnosis.trial_run import run_trial
from core.document.design import Design
from core.document.elastic import Elastic
from core.export.report_data import Heading, make_report
from core.garment.assessment import (
    BAD,
    CAUTION,
    GOOD,
    GROWS,
    PENDING,
    PUSHES,
    Assessment,
    assess,
    assess_with,
)
from core.garment.cut_list import CutList, CutRow, cut_list
from core.garment.presets import find_preset, with_preset
from core.garment.pressure import mmhg, pressure_limits
from core.garment.pressure_list import PressureList, PressureRow, pressure_list
from core.garment.tension import line_tensions
from core.measurements.lower_trunk import lower_before_after
from core.mechanics.convergence import Convergence
from core.mechanics.mesh_quality import MeshQuality
from core.messages import Length
from core.pipeline.build import Stages, build
from core.pipeline.solve import Solution, solve

Built = Callable[[str], Stages]
CALM = MeshQuality(0.99, 0.95, 1.05)


@pytest.fixture(scope="module")
def sure(built: Built) -> Solution:
    """A settled design on a body without doubts: landmarks that a hand confirmed."""
    stages = built("mannequin")
    points = {name: replace(mark, confidence=1.0) for name, mark in stages.landmarks.points.items()}
    landmarks = replace(stages.landmarks, points=points, warnings=())
    design = stages.design.with_line("mid-bust", 0.98)
    return solve(replace(build(design, stages), landmarks=landmarks))


def row(kpa: float, line: str = "mid-bust") -> PressureRow:
    return PressureRow(line, line, "", max_kpa=kpa, max_mmhg=mmhg(kpa), light=pressure_limits().rating(kpa))


def pressed(*rows: PressureRow) -> PressureList:
    return PressureList(rows, {})


def cuts(**changes: object) -> CutList:
    plain = CutRow("mid-bust", "mid-bust", "", 12.0, True, 400.0, 800.0, tension_n=1.0)
    return CutList((replace(plain, **changes),), 530.0, 1.0, ())  # type: ignore[arg-type]


def levels(of: Assessment) -> list[tuple[str, str]]:
    return [(each.topic, each.level) for each in of.findings]


@pytest.mark.parametrize(
    ("kpa", "level"),
    [(0.5, GOOD), (2.5, CAUTION), (4.5, BAD), (47.7, BAD)],
    ids=["green", "amber", "red", "far"],
)
def test_pressure_alone_decides_where_all_else_is_well(sure: Solution, kpa: float, level: str) -> None:
    found = assess_with(sure, cuts(), pressed(row(kpa)))
    assert found.level == level
    if level != GOOD:
        assert found.findings[0].topic == "pressure"
        assert f"{kpa:.1f} kPa ({mmhg(kpa):.0f} mmHg)" in str(found.findings[0].message)
    if kpa > 9.2:
        assert "Not wearable" in str(found.findings[0].action)


def test_it_is_never_good_before_the_pressure_is_known(sure: Solution) -> None:
    assert assess_with(sure, cuts(), None).level == PENDING
    assert assess_with(sure, cuts(), None).pending == "pressure"
    assert assess_with(sure, None, None, running=True).pending == "convergence"
    unknown = assess_with(sure, cuts(), None, failed=True)
    assert (unknown.level, unknown.pending) == (CAUTION, ""), "no pressure is no good pressure"
    slack = assess_with(sure, cuts(slack=True, push_n=2.0), None)
    assert slack.level == BAD, "what is bad already is shown at once"
    mild = assess_with(sure, cuts(slack=True, push_n=0.1), None)
    assert mild.level == PENDING, "it may become worse"


@pytest.mark.parametrize(
    ("motion", "condition", "level", "topic"),
    [
        ("diverging", CALM, BAD, "convergence"),
        ("vibrating", CALM, BAD, "convergence"),
        ("settling", CALM, BAD, "convergence"),
        ("settled", replace(CALM, least_cosine=0.0), BAD, "shape"),
        ("settled", replace(CALM, longest=1.4), BAD, "shape"),
        ("settled", replace(CALM, shortest=0.75), CAUTION, "shape"),
        ("settled", CALM, GOOD, ""),
    ],
)
def test_convergence_and_shape_decide_too(
    sure: Solution, motion: str, condition: MeshQuality, level: str, topic: str
) -> None:
    bust = replace(sure.bust, verdict=Convergence(motion, 100, 0.0, condition=condition))
    run_so = replace(sure, bust=bust)
    found = assess_with(run_so, cuts(), pressed(row(0.5)))
    assert found.level == level
    assert [each.topic for each in found.findings] == ([topic] if topic else [])


def test_what_is_worst_stands_first_and_the_hardest_press_before_others(sure: Solution) -> None:
    rows = row(2.5, "full-bust"), row(5.0, "under-bust"), row(30.0)
    slack = cuts(slack=True, push_n=0.5 * PUSHES)
    found = assess_with(sure, slack, pressed(*rows))
    assert levels(found) == [("pressure", BAD), ("pressure", BAD), ("band", CAUTION), ("pressure", CAUTION)]
    assert [each.lines for each in found.findings] == [
        *(("mid-bust",), ("under-bust",), ("mid-bust",), ("full-bust",)),
    ]


@pytest.mark.parametrize("what", ["deviation_max", "fold_off"])
@pytest.mark.parametrize(("far", "level"), [(39.0, CAUTION), (13.8, GOOD)])
def test_a_fit_far_off_the_body_is_no_good_result(sure: Solution, what: str, far: float, level: str) -> None:
    control = sure.stages.control
    assert control.quality is not None
    quality = replace(control.quality, **{what: far})
    stages = replace(sure.stages, control=replace(control, quality=quality))
    found = assess_with(replace(sure, stages=stages), cuts(), pressed(row(0.5)))
    assert found.level == level
    if level == CAUTION:
        assert found.findings[0].message.parameters == {"mm": Length(far)}


def test_a_pressure_that_is_not_known_is_no_good_one(sure: Solution, built: Built) -> None:
    """A band on the rib cage moves nothing, so without an elastic nobody knows how it presses."""
    design = built("mannequin").design.with_line("mid-bust", None).with_line("under-bust", 0.6)
    stages = replace(build(design, built("mannequin")), landmarks=sure.stages.landmarks)
    found = assess(solve(stages))
    assert levels(found) == [("pressure", CAUTION)]
    assert "elastic" in str(found.findings[0].action)
    assert fixable_findings(run_trial(stages)) == (), "no change of its length makes it known"


def test_doubtful_landmarks_are_in_it(sure: Solution) -> None:
    points = {name: replace(mark, confidence=0.1) for name, mark in sure.stages.landmarks.points.items()}
    stages = replace(sure.stages, landmarks=replace(sure.stages.landmarks, points=points))
    found = assess_with(replace(sure, stages=stages), cuts(), pressed(row(0.5)))
    assert ("landmarks", CAUTION) in levels(found)


def test_a_band_that_would_have_to_push_is_slack_everywhere(built: Built) -> None:
    stages = built("person")
    design = stages.design.with_line("mid-bust", 0.97).with_line("full-bust", 1.03)
    solution = solve(build(design, stages))
    points = solution.control_points
    assert line_tensions(solution.stages, points)["full-bust"].mean < -1.0, "the model pushes"
    listed = {each.line: each for each in cut_list(solution.stages, points).rows}
    presses = {each.line: each for each in pressure_list(solution.stages, points).rows}
    assert listed["full-bust"].tension_n == presses["full-bust"].tension_n == 0.0
    assert listed["full-bust"].slack
    assert listed["full-bust"].push_n > 1.0
    assert not listed["mid-bust"].slack
    sheet = make_report(solution, solution.records, Heading("anna", "2026-01-31"))
    assert all((each.tension_n or 0.0) >= 0.0 for each in sheet.cuts.rows)
    assert not any(
        "-" in str(note).partition("from ")[2][:3] for each in sheet.cuts.rows for note in each.notes
    )
    slack = [each for each in sheet.assessment.findings if each.topic == "band"]
    assert [each.lines for each in slack] == [("full-bust",)]
    assert sheet.assessment == assess(solution), "one verdict on the sheet and for every command"


def test_an_elastic_beyond_its_table_is_in_it(built: Built) -> None:
    stages = built("mannequin")
    weak = Elastic("weak", 10.0, ((0.0, 0.0), (0.3, 2.0)))
    design = replace(stages.design.with_line("mid-bust", 0.97), line_hold="held", volume="exact")
    solution = solve(build(design.with_elastic("mid-bust", weak), stages))
    (listed,) = cut_list(solution.stages, solution.control_points).rows
    assert "the table of the elastic ends at 2 N" in str(listed.refused)
    band = [each for each in assess(solution).findings if each.topic == "band"]
    assert [(each.level, each.message) for each in band] == [(BAD, listed.refused)]


def test_bands_that_enlarge_the_hips_beside_them_are_told_with_what_helps() -> None:
    girdle = with_preset(trunk_stages().design, find_preset("girdle"))
    assert girdle.lower is not None
    found = solve(build(girdle.with_line("under-hip", None), trunk_stages()))
    assert found.lower is not None
    before, after = lower_before_after(found.lower.stages, found.lower.control_points)["hip"]
    told = [each for each in assess(found).findings if each.topic == "band"]
    (growth,) = told
    assert after.tape_mm - before.tape_mm > GROWS
    assert f"{after.tape_mm - before.tape_mm:.0f} mm" in str(growth.message)
    assert growth.level == CAUTION
    assert set(growth.lines) == {"high-hip", "hip"}
    helped = solve(build(girdle, trunk_stages()))
    assert not [each for each in assess(helped).findings if each.topic == "band"]


def test_no_line_is_no_result_yet(sure: Solution) -> None:
    bare = replace(sure, stages=replace(sure.stages, design=replace(sure.stages.design, lines=())))
    found = assess_with(bare, CutList((), 530.0, 1.0, ()), None)
    assert (found.level, found.active) == (GOOD, False)
    assert assessment_view(found, bare.stages.design).level == IDLE


@pytest.mark.parametrize("code", ["en", "ja"])
def test_it_is_worded_once_in_every_language(sure: Solution, code: str) -> None:
    found = assess_with(sure, cuts(slack=True, push_n=2.0), pressed(row(47.7), row(2.5, "full-bust")))
    design: Design = sure.stages.design
    with using_language(code):
        view, lines = assessment_view(found, design), assessment_lines(found, design)
    assert lines[0].endswith(view.headline)
    assert len(lines) == 1 + len(view.reasons) == 4
    for reason in view.reasons:
        assert all(reason)
        assert (code == "en") == all(letter < "\u3000" for text in reason for letter in text)
    with using_language(code):
        title = tr("Mid-bust")
    assert view.reasons[0][0].startswith(title)
