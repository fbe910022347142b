"""Calibration: numbers of tissue and lines from a made pair of scans, their slopes, what a project keeps."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from worn_pair import released_design

from app.presenters.scan_comparison import improvement_text
from benchmarks.worn_pairs import scanned, worn_mesh, written
from core.analysis.calibration.api import CalibrationResult, FittingScan, calibrate, read_fitting_scan
from core.analysis.calibration.calibrate import unidentifiable
from core.analysis.calibration.fit import solve_from
from core.analysis.calibration.parameters import (
    MOST,
    Parameter,
    candidate_parameters,
    point_sensitivities,
    prior_precision,
)
from core.analysis.calibration.registration import align
from core.analysis.calibration.residuals import aligned_fitting_scan
from core.analysis.calibration.robust_least_squares import NormalEquations
from core.analysis.calibration.surface_distance import ScanSurface
from core.document.calibration_record import Calibration, FittedParameter
from core.document.design import Design, ScanSource
from core.document.serialization import from_json, to_json
from core.errors import ProjectError, UserError
from core.garment.elastic_library import find_elastic
from core.pipeline.build import Stages, build
from core.progress import Cancelled

STEP = 3e-4


def design(**settings: object) -> Design:
    """Two lines on a mannequin of 2,100 corners, as an older version kept it."""
    small = released_design()
    base = replace(small, lines=(), volume="exact", **settings)
    return base.with_line("mid-bust", 0.85).with_line("full-bust", 0.9)


VARIANTS = {
    "glued": design(firm_chest=0.05),
    "sliding": design(firm_chest=0.05, line_contact="sliding"),
    "prestressed": design(firm_chest=0.05, member_law="prestressed"),
    "elastic": design(firm_chest=0.05, member_law="prestressed").with_elastic(
        "mid-bust", find_elastic("picot 10")
    ),
}


@pytest.mark.parametrize("name", VARIANTS)
def test_slopes_by_numbers_are_those_of_differences(name: str) -> None:
    plan = VARIANTS[name]
    stages = build(plan)
    here = solve_from(stages)
    numbers = candidate_parameters(stages, lengths=True, each=True)
    assert 4 <= len(numbers) <= 6
    rates = point_sensitivities(stages, here, numbers)
    for column, number in enumerate(numbers):

        def moved(change: float, number: Parameter = number) -> np.ndarray:
            there = build(number.from_unknown(plan, number.to_unknown(plan) + change), stages)
            return solve_from(there, here.balance).balance.state.moved.ravel()

        far, near = (moved(2.0 * STEP) - moved(-2.0 * STEP)), (moved(STEP) - moved(-STEP))
        expected = (8.0 * near - far) / (12.0 * STEP)
        assert np.abs(rates[:, column] - expected).max() < 1e-6 * np.abs(expected).max(), number.name


@pytest.fixture(scope="module")
def pair(tmp_path_factory: pytest.TempPathFactory) -> tuple[Stages, FittingScan, Design]:
    """A design, a scan with the garment on that it knows nothing of, and the design that made it."""
    plan = design(firm_chest=0.03)
    truth = replace(plan, line_stiffness=7.0, firm_chest=0.07)
    stages = build(plan)
    rng = np.random.default_rng(8)
    mesh, _ = scanned(worn_mesh(stages, truth), stages, rng, noise=0.3, resampled=False, hole=15.0)
    path = written(mesh, tmp_path_factory.mktemp("worn") / "worn.ply")
    return stages, read_fitting_scan(stages, ScanSource(path)), truth


@pytest.fixture(scope="module")
def found(pair: tuple[Stages, FittingScan, Design]) -> CalibrationResult:
    return calibrate(*pair[:2])


def test_the_numbers_of_a_made_pair_are_found(
    pair: tuple[Stages, FittingScan, Design], found: CalibrationResult
) -> None:
    _, _, truth = pair
    assert found.is_improved
    assert found.after.total.rms < 0.35 < found.before.total.rms
    after = {number.name: number for number in found.calibration.numbers}
    for name in ("stiffness of mid-bust", "stiffness of full-bust"):
        assert after[name].after == pytest.approx(truth.line_stiffness, rel=0.1)
        assert 0.0 < after[name].plus_minus < 1.0
    assert after["firm_chest"].after == pytest.approx(truth.firm_chest, rel=0.1)


def test_lines_of_one_roll_share_a_stiffness_that_is_told_better(
    pair: tuple[Stages, FittingScan, Design], found: CalibrationResult
) -> None:
    one = calibrate(*pair[:2], one_roll=True)
    told = {number.name: number for number in one.calibration.numbers}
    assert set(told) == {"line_stiffness", "firm_chest"}
    share = told["line_stiffness"].plus_minus / told["line_stiffness"].after
    apart = next(each for each in found.calibration.numbers if each.name == "stiffness of full-bust")
    assert share < 0.8 * apart.plus_minus / apart.after
    assert told["line_stiffness"].after == pytest.approx(pair[2].line_stiffness, rel=2.0 * share)


def test_the_design_has_the_numbers_and_a_record(found: CalibrationResult) -> None:
    kept = found.design.calibration
    assert kept is not None
    assert kept.worn == "worn.ply"
    told = {number.name: number.after for number in kept.numbers}
    assert found.design.firm_chest == told["firm_chest"]
    assert found.design.line_settings("mid-bust").stiffness == told["stiffness of mid-bust"]
    assert found.design.ratio("mid-bust") == 0.85, "lengths stay as they were designed"
    assert from_json(to_json(found.design)) == found.design


def test_what_was_found_is_found_again_and_helps_no_more(
    pair: tuple[Stages, FittingScan, Design], found: CalibrationResult
) -> None:
    stages = build(found.design, pair[0])
    again = calibrate(stages, pair[1])
    assert not again.is_improved
    for number in again.calibration.numbers:
        assert number.after == pytest.approx(number.before, rel=0.01)


def test_length_and_stiffness_of_a_glued_line_are_not_told_apart(
    pair: tuple[Stages, FittingScan, Design],
) -> None:
    stages = build(pair[0].design.with_line("full-bust", None), pair[0])
    both = calibrate(stages, pair[1], lengths=True)
    assert both.confounded["length of mid-bust"] == "line_stiffness"
    stayed = next(number for number in both.calibration.numbers if number.name == "length of mid-bust")
    assert stayed.kept
    assert stayed.after == stayed.before == 0.85
    assert min(both.singular) < 1.0 < max(both.singular)


def test_without_a_line_that_moves_the_body_nothing_is_found(
    pair: tuple[Stages, FittingScan, Design],
) -> None:
    bare = build(replace(pair[0].design, lines=()), pair[0])
    with pytest.raises(UserError, match="No active line moves the body"):
        calibrate(bare, pair[1])


def test_the_scan_without_the_garment_tells_nothing_of_its_lines(
    pair: tuple[Stages, FittingScan, Design],
) -> None:
    stages = pair[0]
    worn = FittingScan(
        "bare.ply", stages.body, align(stages, stages.body), ScanSurface(stages.body.mesh), {}, {}
    )
    found = calibrate(stages, worn)
    assert found.after.total.rms < 0.5 * found.before.total.rms, "it fits, by numbers of no line"
    assert found.at_end
    assert not found.is_improved
    assert improvement_text(found, stages.design).startswith("Calibration failed: ")


def test_where_most_remains_it_is_not_of_the_numbers(
    pair: tuple[Stages, FittingScan, Design], found: CalibrationResult
) -> None:
    stages, worn, _ = pair
    wider = worn.body.mesh.moved(worn.body.mesh.vertices * (1.02, 1.02, 1.0))
    body = replace(worn.body, mesh=wider)
    other = calibrate(stages, aligned_fitting_scan("wider.ply", body, align(stages, body)))
    assert other.has_large_residual
    assert not found.has_large_residual


def test_numbers_that_are_all_told_weakly_are_a_hint(found: CalibrationResult) -> None:
    def told(share: float) -> CalibrationResult:
        record = found.calibration
        numbers = tuple(replace(each, plus_minus=share * each.after) for each in record.numbers)
        return replace(found, design=replace(found.design, calibration=replace(record, numbers=numbers)))

    well, weakly = told(0.04), told(0.06)
    assert [(each.is_improved, each.is_poorly_determined) for each in (well, weakly)] == [
        (True, False),
        (True, True),
    ]
    assert improvement_text(well, well.design).endswith(" mm."), "the plain outcome"
    assert improvement_text(weakly, weakly.design).endswith("Treat the values as indicative.")


def test_a_calibration_is_cancelled(pair: tuple[Stages, FittingScan, Design]) -> None:
    def stop(what: str, share: float) -> None:
        raise Cancelled

    with pytest.raises(Cancelled):
        calibrate(*pair[:2], progress=stop)


def test_each_line_or_one_stiffness_for_all() -> None:
    stages = build(VARIANTS["glued"])
    both = [candidate_parameters(stages, lengths=False, each=each) for each in (True, False)]
    assert [[number.name for number in numbers] for numbers in both] == [
        ["stiffness of mid-bust", "stiffness of full-bust", "firm_chest"],
        ["line_stiffness", "firm_chest"],
    ]
    elastic = build(VARIANTS["elastic"])
    assert [number.name for number in candidate_parameters(elastic, lengths=False, each=True)] == [
        "line_stiffness",
        "tissue_stiffness",
        "firm_chest",
        "prestress",
    ]


def test_lines_are_taken_to_be_somewhat_alike_before_a_scan_tells_more() -> None:
    numbers = (
        Parameter("stiffness", ("mid-bust",)),
        Parameter("stiffness", ("full-bust",)),
        Parameter("firm_chest"),
    )
    known = np.linalg.inv(prior_precision(numbers))
    one, other, chest = np.sqrt(np.diag(known))
    assert [one, other] == pytest.approx([np.sqrt(1.25)] * 2)
    assert np.sqrt(known[0, 0] + known[1, 1] - 2.0 * known[0, 1]) == pytest.approx(0.5 * np.sqrt(2.0))
    assert chest == pytest.approx(0.1)
    assert known[2, :2] == pytest.approx(0.0)


def test_many_lines_share_one_stiffness() -> None:
    stages = build(VARIANTS["glued"])
    plan = stages.design
    for line in stages.model.lines:
        if line.constrains:
            plan = plan.with_line(line.name, 0.95)
    many = candidate_parameters(build(plan, stages), lengths=False)
    assert len(many) <= MOST
    assert "firm_chest" in [number.name for number in many]


def test_a_number_stays_where_the_scans_say_next_to_nothing_of_it() -> None:
    numbers = Parameter("line_stiffness"), Parameter("firm_chest")
    sure = NormalEquations(np.eye(2), np.zeros(2), np.diag([0.7, 0.07]) ** 2)
    unsure = NormalEquations(np.eye(2), np.zeros(2), np.diag([0.7, 0.09]) ** 2)
    assert unidentifiable(sure, numbers).tolist() == [False, False]
    assert unidentifiable(unsure, numbers).tolist() == [False, True]


def test_a_number_is_told_well_by_its_plus_minus() -> None:
    assert FittedParameter("firm_chest", 0.05, 0.1, 0.005).is_well_determined
    assert not FittedParameter("firm_chest", 0.05, 0.1, 0.006).is_well_determined
    assert not FittedParameter("firm_chest", 0.05, 0.05, 0.0, kept=True).is_well_determined


def test_a_design_without_a_calibration_is_written_as_ever() -> None:
    plain = Design(ScanSource("a.ply"))
    assert "calibration" not in json.loads(to_json(plain))
    record = Calibration("worn.ply", 3.1, 1.4, (FittedParameter("firm_chest", 0.0, 0.1, 0.01),), 1.0)
    kept = replace(plain, calibration=record)
    assert json.loads(to_json(kept))["format"] == 1, "a program that knows nothing of it keeps it"
    assert from_json(to_json(kept)) == kept
    assert kept.is_equivalent(plain)


@pytest.mark.parametrize(
    "broken",
    [{"worn": ""}, {"rms_before": "x"}, {"rms_after": float("nan")}, {"numbers": [{"name": "x"}]}, None, 7],
)
def test_a_broken_record_is_no_design(broken: object) -> None:
    record = Calibration("worn.ply", 3.1, 1.4, ())
    values = json.loads(to_json(replace(Design(ScanSource("a.ply")), calibration=record)))
    values["calibration"] = values["calibration"] | broken if isinstance(broken, dict) else broken
    if broken is None:
        assert from_json(json.dumps(values)).calibration is None
        return
    with pytest.raises((ProjectError, UserError)):
        from_json(json.dumps(values))
