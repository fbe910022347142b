"""The pipeline reuses what has not changed, and its stages fit together on the sample bodies."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from core.document.design import Design, ScanSource
from core.document.lines import ActiveLine
from core.errors import LandmarkError, LineError, ScanError, UserError
from core.landmarks.detect import find_landmarks
from core.messages import Message
from core.pipeline import build as pipeline
from core.pipeline.build import IncompleteBuildError, Stages, build
from core.pipeline.model_stages import line_targets
from core.progress import Cancelled

Built = Callable[[str], Stages]


def made_anew(design: Design, previous: Stages) -> list[str]:
    told: list[str] = []
    build(design, previous, lambda what, _: told.append(what))
    return told


def test_an_equal_design_makes_nothing_anew(built: Built) -> None:
    stages = built("mannequin")
    assert made_anew(replace(stages.design), stages) == []


def test_a_length_makes_nothing_anew(built: Built) -> None:
    stages = built("mannequin")
    assert made_anew(stages.design.with_line("mid-bust", 0.9), stages) == []


def test_a_line_that_is_put_on_changes_the_model_alone(built: Built) -> None:
    stages = built("mannequin")
    assert made_anew(stages.design.with_line("full-bust", 0.98), stages) == ["build model", "probe gain"]


def test_another_template_keeps_body_and_landmarks(built: Built) -> None:
    stages = built("mannequin")
    other = build(replace(stages.design, template="120"), stages)
    assert other.body is stages.body
    assert other.landmarks is stages.landmarks
    assert len(other.control.mesh.faces) == 120
    assert len(stages.control.mesh.faces) == 168


def test_a_failing_stage_leaves_the_former_ones_usable(built: Built) -> None:
    stages = built("mannequin")
    with pytest.raises(LineError, match="no line 'wing'"):
        build(replace(stages.design, lines=(ActiveLine("wing", 0.9),)), stages)
    assert made_anew(stages.design, stages) == []


def test_finding_landmarks_is_cancelled_between_its_steps(built: Built) -> None:
    heard = list[float]()

    def hear(what: str, share: float) -> None:
        heard.append(share)
        if len(heard) > 2:
            raise Cancelled

    with pytest.raises(Cancelled):
        find_landmarks(built("mannequin").body, progress=hear)
    assert len(heard) == 3
    assert heard == sorted(heard)


def test_a_stuck_scan_keeps_what_was_read_and_nothing_of_the_failure(
    built: Built, monkeypatch: pytest.MonkeyPatch
) -> None:
    def nothing(*_: object, **__: object) -> None:
        raise LandmarkError(Message("No bust is here."), Message("Place its points."))

    monkeypatch.setattr(pipeline, "detect_landmarks", nothing)
    design, told = replace(built("mannequin").design, lines=()), list[str]()
    with pytest.raises(IncompleteBuildError) as first:
        build(design)
    assert first.value.kind == "landmarks"
    assert (first.value.__cause__, first.value.__context__) == (None, None)
    placed = design.with_placed("fold_left", (60.0, -180.0, 300.0))
    with pytest.raises(IncompleteBuildError) as again:
        build(placed, first.value, lambda what, _: told.append(what))
    assert told == ["find landmarks"]
    assert again.value.body is first.value.body


def test_a_missing_scan_is_told_by_name(tmp_path: Path) -> None:
    with pytest.raises(ScanError, match=r"gone\.ply"):
        build(Design(ScanSource(str(tmp_path / "gone.ply"))))


@pytest.mark.parametrize("sample", ["mannequin", "person"])
def test_nothing_moves_at_rest(built: Built, sample: str) -> None:
    stages = built(sample)
    points, _ = stages.shape(stages.control.mesh.vertices)
    assert np.array_equal(points, stages.body.mesh.vertices[stages.moving.vertices])


@pytest.mark.parametrize("sample", ["mannequin", "person"])
def test_the_watched_points_are_the_landmarks(built: Built, sample: str) -> None:
    stages = built(sample)
    marks = stages.rest_marks
    assert marks.bust_point_left_z == pytest.approx(stages.landmarks.position("bust_point_left")[2], abs=1e-9)
    assert marks.bust_point_right_z == pytest.approx(
        stages.landmarks.position("bust_point_right")[2], abs=1e-9
    )
    # No bust point lies in front of the apex by more than the softness of its mean allows.
    foremost = -min(stages.landmarks.position(f"bust_point_{side}")[1] for side in ("left", "right"))
    border = stages.control.mesh.vertices[stages.control.border_points, 1].mean()
    assert marks.apex_protrusion > foremost + border - 2.0
    for side, out in (("left", marks.bust_point_left_out), ("right", marks.bust_point_right_out)):
        assert out == pytest.approx(border - stages.landmarks.position(f"bust_point_{side}")[1], abs=1e-9)


def test_targets_follow_the_design(built: Built) -> None:
    stages = built("mannequin")
    design = replace(stages.design, volume="conventional", gain=1.25).with_line("full-bust", 0.9)
    targets = line_targets(design, build(design, stages))
    names = [line.name for line in stages.model.lines]
    assert dict(zip(names, targets.ratios, strict=True)) == {
        "under-bust": 1.0,
        "mid-bust": 0.97,
        "full-bust": 0.9,
    }
    assert (targets.control, targets.gain) == ("conventional", 1.25)


def test_the_default_gain_lies_just_below_its_limit(built: Built) -> None:
    stages = built("mannequin")
    assert stages.gain == pytest.approx(0.97 * stages.gain_limit)
    assert 1.2 < stages.gain_limit < 2.0


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"template": "99"}, "no template '99'"),
        ({"volume": "magic"}, "no volume control"),
        ({"line_contact": "floating"}, "no skin contact"),
        ({"line_stiffness": 0.0}, "line stiffness 0"),
        ({"line_height": 0.9}, "line height"),
    ],
)
def test_what_a_design_cannot_be_is_said(built: Built, change: dict[str, object], sentence: str) -> None:
    with pytest.raises(UserError, match=sentence):
        replace(built("mannequin").design, **change)
