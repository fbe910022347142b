"""The model against reference cases: its own displacements are met, others by the difference; files."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from coarse_bodies import coarse_body
from reference_cases import BOTH, MID_BUST, SLINGS, case_arrays, cup_arrays, write_case

from core.analysis.model_check.compare import (
    NO_CUPS,
    NO_WEIGHT,
    CaseComparison,
    Rise,
    body_file,
    check_model,
)
from core.analysis.model_check.reference_case import case_file, read_case
from core.document.cup import Cup
from core.document.design import Design, ScanSource
from core.errors import UserError

Arrays = dict[str, Any]


@pytest.fixture(scope="module")
def body(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return coarse_body("mannequin", tmp_path_factory.mktemp("coarse"))


@pytest.fixture(scope="module")
def sling(body: Path) -> Arrays:
    return case_arrays(body, SLINGS)


def compared(case: Path, **settings: Any) -> CaseComparison:
    (found,) = all_compared([case], **settings)
    return found


def all_compared(cases: Sequence[Path], **settings: Any) -> list[CaseComparison]:
    return list(check_model(map(read_case, cases), Design(ScanSource(""), **settings)))


def test_displacements_of_the_model_itself_are_met(body: Path, sling: Arrays, tmp_path: Path) -> None:
    found = compared(write_case(tmp_path, sling, body))
    assert found.kind == "sling"
    assert found.reference_rms_mm > 0.2
    assert found.ratio < 1e-6
    assert found.left.model == pytest.approx(found.left.reference, abs=1e-6)
    assert found.left.model > 0.2  # a sling lifts
    assert found.passed
    assert (found.left_out, found.notes) == (0, ())


def test_the_difference_is_told_as_part_of_the_reference(body: Path, sling: Arrays, tmp_path: Path) -> None:
    scaled = 1.1 * sling["displacement"]
    found = compared(write_case(tmp_path, sling, body, displacement=scaled))
    assert found.ratio == pytest.approx(1.0 / 11.0, rel=1e-6)
    away = np.linalg.norm(sling["displacement"], axis=1)
    assert found.largest_mm == pytest.approx(0.1 * away.max(), rel=1e-6)
    assert found.largest_at == pytest.approx(sling["rest"][away.argmax()])
    assert found.left.reference == pytest.approx(1.1 * found.left.model, rel=1e-6)


@pytest.mark.parametrize(("lines", "kind"), [(MID_BUST, "mid-bust"), (BOTH, "other")])
def test_it_is_the_stored_control_mesh_that_wears_the_lines(
    body: Path, tmp_path: Path, lines: list[Any], kind: str
) -> None:
    stored = case_arrays(body, lines, line_height=0.65)
    found = compared(write_case(tmp_path, stored, body))
    assert found.kind == kind
    assert found.ratio < 1e-6
    assert compared(tmp_path / "case.npz", line_stiffness=100.0).ratio > 0.01  # settings act


def test_a_net_does_not_respond_to_gravity(body: Path, sling: Arrays, tmp_path: Path) -> None:
    none = {"line_rows": np.empty(0), "line_columns": np.empty(0), "gravity": np.zeros(3)}
    found = compared(write_case(tmp_path, sling, body, **none))
    assert (found.kind, found.ratio, found.passed) == ("weight", 1.0, False)
    assert found.notes == (NO_WEIGHT,)


def test_solid_tissue_wears_the_cup_of_a_case(body: Path, tmp_path: Path) -> None:
    cup = Cup(coverage="half", lift=20.0, forward=5.0, gather=10.0)
    arrays = case_arrays(body, [], tissue="solid", sag=15.0, cup=cup)
    case = write_case(tmp_path, arrays, body)
    assert read_case(case).cup == cup
    lower = cup_arrays(Cup(coverage="half", lift=15.0, forward=5.0, gather=10.0))
    other = write_case(tmp_path / "lower", arrays, body, **lower)
    # those of the case count
    own, low = all_compared([case, other], tissue="solid", sag=30.0, cup=Cup("sewn"))
    assert (own.kind, own.limit) == ("cup", 0.30)
    assert own.ratio < 1e-6
    assert own.left.model > 4.0  # it lifts
    assert low.ratio > 0.1
    net = compared(write_case(tmp_path, arrays, body))
    assert (net.ratio, net.notes) == (1.0, (NO_CUPS,))


@pytest.mark.parametrize(
    "cup",
    [
        Cup(coverage="half", lift=10.0, wire=True, wire_width=0.95),
        Cup("sewn", "full", across=0.95, upright=0.9, cloth=400.0),
        Cup("sewn", across=0.95, wire=True),
    ],
)
def test_wires_and_sewn_cups_are_those_of_the_file(sling: Arrays, tmp_path: Path, cup: Cup) -> None:
    none = {"line_rows": np.empty(0), "line_columns": np.empty(0)}
    case = read_case(write_case(tmp_path, sling, **none, **cup_arrays(cup)))
    assert (case.cup, case.kind) == (cup, "cup")


def test_a_sewn_cup_with_a_wire_is_worn(body: Path, tmp_path: Path) -> None:
    cup = Cup("sewn", across=0.92, upright=0.88, wire=True, wire_width=0.9)
    case = write_case(tmp_path, case_arrays(body, [], tissue="solid", sag=15.0, cup=cup), body)
    others = (replace(cup, upright=0.9), replace(cup, wire_width=0.95))
    changed = [
        write_case(tmp_path / str(number), dict(np.load(case)), body, **cup_arrays(other))
        for number, other in enumerate(others)
    ]
    own, *different = all_compared([case, *changed], tissue="solid")
    assert own.ratio < 1e-6
    assert own.reference_rms_mm > 2.0
    assert min(found.ratio for found in different) > 0.02


def test_cups_beside_lines_make_another_kind(sling: Arrays, tmp_path: Path) -> None:
    assert read_case(write_case(tmp_path, sling, **cup_arrays(Cup(lift=10.0)))).kind == "other"


def test_a_cup_of_each_kind_that_comes_with_the_program_is_met() -> None:
    names = (
        "mannequin_cup-half_lift-20_forward-5_gather-15",
        "mannequin_cup-three-quarter_lift-20_forward-3_wire-0.95",
        "mannequin_sewn-three-quarter_across-0.95_upright-0.92_cloth-300_wire-1.0",
    )
    push_up, wired, sewn = check_model(
        [read_case(case_file(name)) for name in names], Design(ScanSource(""), tissue="solid")
    )
    for found in (push_up, wired, sewn):
        assert (found.kind, found.passed) == ("cup", True), found
    assert min(rise.reference for rise in (push_up.left, push_up.right, wired.left, wired.right)) > 7.0
    assert max(sewn.left.reference, sewn.right.reference) < -1.0  # by itself it does not lift


def test_nodes_away_from_movable_skin_are_left_out(body: Path, sling: Arrays, tmp_path: Path) -> None:
    rest = np.vstack([sling["rest"], [0.0, 200.0, 0.0]])
    moved = np.vstack([sling["displacement"], [50.0, 50.0, 50.0]])
    found = compared(write_case(tmp_path, sling, body, rest=rest, displacement=moved))
    assert (found.compared, found.left_out) == (len(rest) - 1, 1)
    assert found.ratio < 1e-6


@pytest.mark.parametrize(
    ("changed", "problem"),
    [
        ({"rest": lambda rest: rest + 100.0}, "not on the skin of mannequin.ply"),
        ({"bust_left": lambda point: point + 100.0}, "no nodes near a bust point"),
    ],
)
def test_a_case_that_does_not_fit_its_body_is_refused(
    body: Path, sling: Arrays, tmp_path: Path, changed: dict[str, Any], problem: str
) -> None:
    arrays = {name: change(sling[name]) for name, change in changed.items()}
    with pytest.raises(UserError, match=problem):
        compared(write_case(tmp_path, sling, body, **arrays))


def test_a_body_is_found_beside_the_case_among_the_samples_or_in_the_folder(
    body: Path, sling: Arrays, tmp_path: Path
) -> None:
    alone = read_case(write_case(tmp_path / "alone", sling))
    assert body_file(alone).parent.name == "samples"
    assert body_file(read_case(write_case(tmp_path / "beside", sling, body))).parent.name == "beside"
    other = read_case(write_case(tmp_path / "other", sling, body="other.ply"))
    with pytest.raises(UserError, match=r"other\.ply .* case was not found\. .*--bodies"):
        body_file(other, tmp_path)
    (tmp_path / "other.ply").touch()
    assert body_file(other, tmp_path) == tmp_path / "other.ply"


@pytest.mark.parametrize(
    ("model", "reference", "passed"),
    [
        (0.2, -0.29, True),
        (0.2, -0.31, False),
        (18.0, 21.0, True),
        (17.8, 21.0, False),
        (2.7, 3.1, True),
        (3.7, 3.1, False),
    ],
)
def test_a_rise_may_be_off_by_half_a_millimetre_or_a_share(
    model: float, reference: float, passed: bool
) -> None:
    assert Rise(model, reference).passed == passed


@pytest.mark.parametrize(
    ("kind", "off", "passed"),
    [
        *(("weight", 0.15, True), ("weight", 0.151, False)),
        *(("sling", 0.25, True), ("sling", 0.251, False)),
        *(("mid-bust", 0.40, True), ("mid-bust", 0.401, False)),
        *(("cup", 0.30, True), ("cup", 0.301, False)),
        *(("other", 0.40, True), ("other", 0.401, False)),
    ],
)
def test_a_case_passes_with_error_and_both_rises_within_their_limits(
    kind: str, off: float, passed: bool
) -> None:
    near, far = Rise(1.0, 1.0), Rise(1.0, 2.0)
    place = (0.0, 0.0, 0.0)
    assert CaseComparison("", kind, off, 1.0, near, near, 1.0, place, 10, 0).passed == passed
    assert not CaseComparison("", kind, off, 1.0, far, near, 1.0, place, 10, 0).passed
    assert not CaseComparison("", kind, off, 1.0, near, far, 1.0, place, 10, 0).passed


HALF: Arrays = {"cup": np.zeros(3), "cup_coverage": "half"}

WRONG: dict[str, Arrays] = {
    "'displacement' is missing": {"displacement": None},
    "'ratio' is missing": {"ratio": None},
    "'rest' does not have the expected shape": {"rest": np.zeros((4, 2))},
    "'displacement' does not have": {"displacement": np.zeros((4, 3))},
    "'gravity' does not have": {"gravity": np.array(["a", "b", "c"])},
    "'control_points' does not have": {"control_points": np.zeros((3, 3))},
    "'bust_left' contains values that are not finite": {"bust_left": np.array([np.nan, 0.0, 0.0])},
    "'ratio' is not positive": {"ratio": 0.0},
    "no node moves": {"rest": np.zeros((4, 3)), "displacement": np.zeros((4, 3))},
    "its control mesh is not that of a template": {"control_faces": np.array([[0, 1, 2]])},
    "a line leaves the control mesh": {"line_rows": np.array([[2, 99]]), "line_columns": np.array([[0, 0]])},
    "'line_columns' does not have": {"line_columns": np.array([[0, 0]])},
    "neither lines nor cups nor another gravity": {"line_rows": np.empty(0)},
    "'cup' does not have": {"cup": np.zeros(4), "cup_coverage": "half"},
    "'cup' contains values that are not finite": {"cup": np.full(3, np.nan), "cup_coverage": "half"},
    "'cup_coverage' is missing": {"cup": np.zeros(3)},
    "'cup_coverage' does not have": {"cup": np.zeros(3), "cup_coverage": np.array(["half", "full"])},
    "its cup is not one": {"cup": np.zeros(3), "cup_coverage": "double"},
    "its cup is not one that Busk can compute": {"cup": np.array([99.0, 0.0, 0.0]), "cup_coverage": "half"},
    "'cup_kind' does not have": {**HALF, "cup_kind": 1.0},
    "its cup is not one that Busk": {**HALF, "cup_kind": "knitted"},
    "'cup_sewn' is missing": {**HALF, "cup_kind": "sewn"},
    "'cup_sewn' does not have": {**HALF, "cup_kind": "sewn", "cup_sewn": np.ones(2)},
    "its cup is not one that Busk can": {**HALF, "cup_kind": "sewn", "cup_sewn": np.array([0.5, 1.0, 300.0])},
    "'cup_wire' does not have": {**HALF, "cup_wire": np.ones(2)},
    "'cup_wire' contains values that are not finite": {**HALF, "cup_wire": np.inf},
    "cup is not one that Busk can compute": {**HALF, "cup_wire": 2.0},
    "'body' is not a file name": {"body": "../mannequin.ply"},
    "is not a reference case": {"body": np.array({"an": "object"})},
}


@pytest.mark.parametrize("problem", WRONG)
def test_an_incomplete_file_is_refused(sling: Arrays, tmp_path: Path, problem: str) -> None:
    with pytest.raises(UserError, match=rf"^case\.npz .*{problem}"):
        read_case(write_case(tmp_path, sling, **WRONG[problem]))


def test_a_broken_or_missing_file_is_refused(
    sling: Arrays, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole, broken = write_case(tmp_path, sling), tmp_path / "broken.npz"
    for data in (b"", b"no zip", whole.read_bytes()[:-200]):
        broken.write_bytes(data)
        with pytest.raises(UserError, match=r"broken\.npz is not a reference case"):
            read_case(broken)
    with pytest.raises(UserError, match="does not exist"):
        read_case(tmp_path / "none.npz")
    with pytest.raises(UserError, match="cannot be read: not a file"):
        read_case(tmp_path)
    monkeypatch.setattr("core.analysis.model_check.reference_case._LARGEST", whole.stat().st_size + 1)
    with pytest.raises(UserError, match="is not a reference case"):
        read_case(whole)  # small as a file, large when unpacked


def test_a_case_is_named_or_is_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    included = {"sling": tmp_path / "sling.npz"}
    monkeypatch.setattr("core.analysis.model_check.reference_case.included_cases", lambda: included)
    assert case_file("sling") == tmp_path / "sling.npz"
    assert case_file("folder/own.npz") == Path("folder/own.npz")
    with pytest.raises(UserError, match=r"no reference case 'slnig'\. Choose one of: sling\."):
        case_file("slnig")
