"""The accuracy run: its table says what one computes by hand, and a failure is a row."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from body_truth import SIDES, KnownBody, known_again, stable_offset, true_girths
from PIL import Image
from worn_scans import Standing, axis_orders, ply_bytes

from app.cli.main import main
from app.research.accuracy import compared, judged, spreads
from app.research.commands.accuracy import run_accuracy
from app.research.ground_truth import FORM, TruthError, read_truths
from core.geometry.mesh import Mesh
from core.landmarks.as_dict import detection
from core.landmarks.detect import find_landmarks
from core.landmarks.lower_trunk.detect import find_lower_landmarks
from core.scan.body import read_scan

ROOT = Path(__file__).parents[3]
TRUTH = json.loads((ROOT / "tests/data/truth.json").read_text(encoding="utf-8"))
SHIFT = np.array([3.0, -4.0, 12.0])


@pytest.fixture(scope="module")
def found() -> dict[str, Any]:
    """What is found on the mannequin, once for all tests."""
    return detection(read_scan(ROOT / "resources/samples/mannequin.ply"))


@pytest.fixture
def folder(tmp_path: Path, mannequin: Path) -> Path:
    """A set of one body, one file that is no scan, one that is not there, and one object to refuse."""
    shutil.copy(mannequin, tmp_path / "mannequin.ply")
    (tmp_path / "broken.ply").write_bytes(b"ply\nformat")
    (tmp_path / "cube.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n")
    body = {**TRUTH["mannequin"], "file": "mannequin.ply", "kinds": ["smooth"]}
    body["girths"] = {**body["girths"], "waist": {"level_z": 100.0, "tape": 700.0}}
    scans = {
        "broken": {"file": "broken.ply", "landmarks_file": {"nipple_left": [0, 0, 0]}},
        "away": {"file": "away.ply"},
        "cube": {"file": "cube.obj", "refuse": True},
    }
    write(tmp_path, {"bodies": {"mannequin": body}, "scans": scans})
    return tmp_path


def write(folder: Path, content: object) -> None:
    (folder / "truth.json").write_text(json.dumps(content), encoding="utf-8")


def one_truth(folder: Path, entry: dict[str, Any], section: str = "scans") -> Any:
    write(folder, {section: {"it": {"file": "it.ply", **entry}}})
    return read_truths(folder)[0][0]


def test_errors_are_what_the_truth_was_moved_by(tmp_path: Path, found: dict[str, Any]) -> None:
    moved = {name: mark["file"] - SHIFT for name, mark in found["landmarks"].items()}
    theirs = {f"nipple_{s}": moved[f"bust_point_{s}"] for s in SIDES}
    theirs |= {f"bust_apex_{s}": moved[f"bust_point_{s}"] + [0.0, 0.0, 30.0] for s in SIDES}
    theirs |= {f"fold_{s}": moved[f"fold_{s}"] for s in SIDES}
    level, tape = found["levels"]["bust"], found["girths"]["bust"]["tape_mm"]
    known = {"level_z": level - 5.0, "tape": 0.8 * tape, "tape_by_offset_mm": {"-10": 500.0, "10": 700.0}}
    entry = {"landmarks": {k: v.tolist() for k, v in theirs.items()}, "girths": {"bust": known}}
    case = compared(one_truth(tmp_path, entry, "bodies"), found)
    for side in SIDES:
        assert case.errors[f"bust_point_{side}"] == pytest.approx(13.0)
        assert case.errors[f"bust_point_{side} to nipple-apex"] == pytest.approx(5.0)
        assert case.errors[f"fold_{side} height"] == pytest.approx(12.0)
    assert case.errors["bust level"] == pytest.approx(5.0)
    assert case.errors["bust girth"] == pytest.approx(0.2 * tape)
    assert case.errors["bust girth [%]"] == pytest.approx(25.0)
    assert case.errors["bust girth at its level"] == pytest.approx(tape - 650.0)
    off = {mark.name: mark.off for mark in case.marks}
    assert (off["fold_left"], off["bust_point_left"]) == pytest.approx((12.0, 5.0))
    assert case.right
    assert case.turned == pytest.approx(0.0)


@pytest.mark.parametrize("order", [0, 7, 22])
def test_a_turned_truth_in_another_unit_is_the_same_truth(
    tmp_path: Path, found: dict[str, Any], order: int
) -> None:
    stand = Standing(order, 33.0, 12.0, (1.0, 2.0, -1.0), "inch", (500.0, 0.0, 9.0))
    marks = found["landmarks"]
    in_file = {
        name: {**mark, "file": stand.matrix[:3, :3] @ mark["mm"] + stand.matrix[:3, 3]}
        for name, mark in marks.items()
    }
    matrix = np.eye(4)
    matrix[:3, :3] = np.linalg.inv(stand.matrix[:3, :3])
    seen = {**found, "landmarks": in_file, "file_to_mm": matrix.tolist()}
    at = {f"nipple_{s}": (in_file[f"bust_point_{s}"]["file"] + [0.0, 1.0, 0.0]).tolist() for s in SIDES}
    told = {"landmarks_file": at, "canonical_to_file": stand.matrix.tolist()}
    by_directions = {
        "landmarks_file": at,
        "unit": "inch",
        "up_direction_file": stand.matrix[:3, 2].tolist(),
        "front_direction_file": (-stand.matrix[:3, 1]).tolist(),
    }
    for entry in (told, by_directions, {"landmarks_file": at, "unit": "inch"}):
        case = compared(one_truth(tmp_path, entry), seen)
        assert case.errors["bust_point_left"] == pytest.approx(25.4)
        assert case.right
        assert case.turned == pytest.approx(0.0, abs=1e-4)
    case = compared(one_truth(tmp_path, {**by_directions, "unit": "cm"}), seen)
    assert not case.unit_right


def test_upside_down_and_swapped_sides_are_wrong(tmp_path: Path, found: dict[str, Any]) -> None:
    marks = {s: found["landmarks"][f"bust_point_{s}"]["mm"] for s in SIDES}
    entry = {"landmarks": {"nipple_left": marks["right"], "nipple_right": marks["left"]}}
    assert not compared(one_truth(tmp_path, entry, "bodies"), found).sides_right
    entry = {"up_direction_file": [0, 0, -1], "front_direction_file": [0, -1, 0]}
    case = compared(one_truth(tmp_path, {**entry, "landmarks_file": {"nipple_left": marks["left"]}}), found)
    assert case.turned == pytest.approx(180.0)
    assert not case.right
    assert spreads([case]) == []


def test_a_missing_breast_that_is_found_is_counted(tmp_path: Path, found: dict[str, Any]) -> None:
    left = found["landmarks"]["bust_point_left"]
    entry = {"landmarks": {"nipple_left": left["mm"], "nipple_right": None}, "flags": {"missing": "right"}}
    case = compared(one_truth(tmp_path, entry, "bodies"), found)
    assert [mark.name for mark in case.marks] == ["bust_point_left"]
    assert case.invented == {"bust_point_right": found["landmarks"]["bust_point_right"]["confidence"]}


def test_spreads_are_mean_percentile_and_worst(tmp_path: Path, found: dict[str, Any]) -> None:
    cases = []
    for down in (-1.0, 2.0, 6.0):
        at = {f"fold_{s}": (found["landmarks"][f"fold_{s}"]["mm"] - np.array([0, 0, down])) for s in SIDES}
        entry = {"landmarks": {name: point.tolist() for name, point in at.items()}}
        cases.append(compared(one_truth(tmp_path, entry, "bodies"), found))
    spread = {each.what: each for each in spreads(cases)}["fold height"]
    assert (spread.count, spread.mean, spread.worst) == (6, pytest.approx(3.0), pytest.approx(6.0))
    assert spread.bias == pytest.approx(7.0 / 3.0)
    assert spread.most == pytest.approx(np.percentile([1, 1, 2, 2, 6, 6], 95))


def test_the_run_lists_failures_and_draws_every_body(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_accuracy(folder, tmp_path / "out", json=False) == 3
    text = capsys.readouterr().out
    assert "3 bodies: 1 with correct orientation" in text
    assert "clean bodies (1) | degraded scans (2) |" in text
    assert "girth waist" in text
    assert "2 refused; 0 crashed" in text
    assert "1 file without a body: 1 " in text
    assert "* broken: broken.ply is not a PLY file" in text
    assert "away.ply does not exist" in text.partition("* away: ")[2].splitlines()[0]
    assert (tmp_path / "out/accuracy.md").read_text("utf-8") == text
    values = json.loads((tmp_path / "out/accuracy.json").read_text("utf-8"))
    assert [file["right"] for file in values["files"]] == [True, False, False, False]
    picture = np.asarray(Image.open(tmp_path / "out/accuracy-1.png").convert("L"))
    assert picture.shape == (430, 1950)
    first, broken = picture[60:300, :390], picture[60:300, 400:780]
    assert np.mean(first < 250) > 0.2
    assert np.mean(broken < 250) == 0.0


def test_of_one_body_it_says_body(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write(folder, {"bodies": {"mannequin": {**TRUTH["mannequin"], "file": "mannequin.ply"}}})
    assert main(["accuracy", str(folder)]) == 0
    assert "\n1 body: 1 with correct orientation" in capsys.readouterr().out


def test_who_has_no_truth_is_sent_to_the_page_of_the_guide(tmp_path: Path) -> None:
    with pytest.raises(TruthError, match=re.escape(str(FORM))):
        read_truths(tmp_path)
    title = (ROOT / "docs/contributors/validation.md").read_text("utf-8").splitlines()[0]
    assert title.removeprefix("# ") in str(FORM)


def test_the_command_prints_json(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write(folder, {"bodies": {"mannequin": {**TRUTH["mannequin"], "file": "mannequin.ply"}}})
    assert main(["accuracy", str(folder), "--json"]) == 0
    values = json.loads(capsys.readouterr().out)
    spread = {each["what"]: each for each in values["spreads"]}
    assert spread["fold height"]["worst"] < 2.0
    assert values["files"][0]["lacking"] == [] or "front_centre" in values["files"][0]["lacking"][0]


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ([1, 2], "no table"),
        ({"bodies": [1]}, "not a table of files"),
        ({}, "lists no files"),
        ({"scans": {"a": 3}}, "The entry 'a' of truth.json cannot be used: what it tells must be a table"),
    ],
)
def test_a_broken_truth_is_told_in_a_sentence(tmp_path: Path, content: object, said: str) -> None:
    write(tmp_path, content)
    with pytest.raises(TruthError, match=said):
        read_truths(tmp_path)


@pytest.mark.parametrize(
    ("entry", "said"),
    [
        ({"file": None}, "'file' must be a file name"),
        ({"file": "../a.ply"}, "'file' must be a file name"),
        ({"unit": "feet"}, "'unit' must be one of mm, cm, m, inch"),
        ({"unit": ["mm"]}, "'unit' must be one of"),
        ({"landmarks_file": {"fold_left": [1, 2]}}, "'landmarks_file: fold_left' must be 3 numbers"),
        ({"landmarks_file": {"fold_left": "x"}}, "'landmarks_file: fold_left' must be 3 numbers"),
        ({"landmarks_file": [1]}, "'landmarks_file' must be a table"),
        ({"canonical_to_file": np.zeros((4, 4)).tolist()}, "'canonical_to_file' must be a matrix"),
        (
            {"canonical_to_file": np.diag([-1.0, 1.0, 1.0, 1.0]).tolist()},
            "'canonical_to_file' must be a matrix",
        ),
        (
            {"canonical_to_file": np.diag([1.0, 2.0, 1.0, 1.0]).tolist()},
            "'canonical_to_file' must be a matrix",
        ),
        ({"canonical_to_file": [1, 0.1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}, "must be a matrix"),
        ({"canonical_to_file": [1, 2]}, "'canonical_to_file' must be 16 numbers"),
        ({"up_direction_file": [0, 0, 1], "front_direction_file": [0, 0, 2]}, "must be two directions"),
        ({"girths": {"bust": {"tape": 800.0}}}, "'girths: bust: level_z' must be a number"),
        ({"girths": {"bust": 800.0}}, "'girths: bust' must be a table"),
        ({"girths": {"bust": {"level_z": 1, "tape": 2, "tape_by_offset_mm": {"x": 1}}}}, "must be 2 numbers"),
        ({"flags": "left"}, "'flags' must be a table"),
    ],
)
def test_a_broken_entry_is_told_by_its_name_and_key(tmp_path: Path, entry: object, said: str) -> None:
    with pytest.raises(TruthError, match=f"The entry 'it' of truth.json cannot be used: .*{said}"):
        one_truth(tmp_path, entry)


def test_the_name_of_a_file_is_enough(tmp_path: Path, found: dict[str, Any]) -> None:
    in_inches = {**found, "file_to_mm": (np.diag([25.4, 25.4, 25.4, 1.0]) @ found["file_to_mm"]).tolist()}
    for entry in ({}, {"up_direction_file": [0, 0, 1], "front_direction_file": [0, -1, 0]}):
        case = compared(one_truth(tmp_path, entry), in_inches)
        assert case.right
        assert case.errors.get("turned [deg]", 0.0) < 0.5
    case = compared(one_truth(tmp_path, {"unit": "mm"}), in_inches)
    assert not case.unit_right
    at = {"nipple_left": [1.0, 2.0, 3.0]}
    case = compared(one_truth(tmp_path, {"landmarks_file": at}), in_inches)
    here = found["landmarks"]["bust_point_left"]["file"]
    assert case.errors["bust_point_left"] == pytest.approx(
        25.4 * np.linalg.norm(np.subtract(here, [1, 2, 3]))
    )


def test_no_truth_or_no_json_is_told_in_a_sentence(tmp_path: Path) -> None:
    with pytest.raises(TruthError, match=r"does not contain truth\.json"):
        read_truths(tmp_path)
    (tmp_path / "truth.json").write_bytes(b"\xff{")
    with pytest.raises(TruthError, match="is not valid JSON"):
        read_truths(tmp_path)


def test_a_crash_in_one_file_stops_no_other(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def crash(name: str, data: bytes) -> None:
        raise ZeroDivisionError(name)

    monkeypatch.setattr("app.research.accuracy.body_of", crash)
    cases = list(judged(folder, read_truths(folder)[0]))
    assert [case.crashed for case in cases] == [True, True, False, True]
    assert "ZeroDivisionError" in cases[0].failed


def test_the_makers_truth_is_the_known_truth() -> None:
    """The definitions by which altered bodies get their truth give that of the sample back."""
    mesh = trimesh.load(ROOT / "resources/samples/mannequin.ply", process=False)
    known = TRUTH["mannequin"]
    points = {name: np.array(point) for name, point in known["landmarks"].items()}
    body = known_again(KnownBody(Mesh(np.asarray(mesh.vertices), np.asarray(mesh.faces)), points))
    for name in ("nipple_left", "fold_left", "breast_lowest_right", "front_mid_bust"):
        assert np.linalg.norm(body.points[name] - points[name]) < 1.0
    girths = true_girths(body)
    assert girths["bust"]["tape"] == pytest.approx(known["girths"]["bust"]["tape"], abs=1.0)
    stable = known["girths"]["underbust_stable"]
    assert girths["underbust_stable"]["level_z"] == pytest.approx(stable["level_z"], abs=1.0)
    assert girths["underbust_stable"]["tape"] == pytest.approx(stable["tape"], abs=1.0)


def test_scans_are_turned_never_mirrored() -> None:
    assert len({tuple(turn.ravel()) for turn in axis_orders()}) == 24
    assert all(np.linalg.det(Standing(k, 20.0, 30.0).matrix[:3, :3]) > 0.0 for k in range(24))
    assert stable_offset({z: 700.0 + (0.5 if z <= 0 else 3.0) * z for z in range(-40, 16, 5)}) == 0
    triangle = np.eye(3), np.array([[0, 1, 2]])
    assert ply_bytes(triangle).endswith(b"\x03" + np.arange(3, dtype="<i4").tobytes())


def test_landmarks_of_the_lower_trunk_are_judged_by_their_heights(tmp_path: Path) -> None:
    shutil.copy(ROOT / "resources/samples/trunk.ply", tmp_path / "trunk.ply")
    body = read_scan(tmp_path / "trunk.ply")
    found = find_lower_landmarks(body, find_landmarks(body))
    told = {"crotch": 1.5, "waist_natural_front": -4.0, "gluteal_fold_left": 9.0}
    ours = {"waist_natural_front": "waist"}
    to_file = np.linalg.inv(body.pose.file_to_mm)
    points = {}
    for name, off in told.items():
        place = np.append(found.points[ours.get(name, name)].position - [0.0, 0.0, off], 1.0)
        points[name] = (to_file @ place)[:3].tolist()
    write(tmp_path, {"bodies": {"trunk": {"file": "trunk.ply", "landmarks_file": points}}})
    (truth,), strange = read_truths(tmp_path)
    assert strange == []
    (case,) = judged(tmp_path, [truth])
    heights = {name: error for name, error in case.errors.items() if name.endswith(" height")}
    assert heights == pytest.approx(
        {"crotch height": 1.5, "waist height": -4.0, "gluteal_fold_left height": 9.0}
    )
    assert {mark.name: mark.off for mark in case.marks}["waist"] == pytest.approx(4.0)
