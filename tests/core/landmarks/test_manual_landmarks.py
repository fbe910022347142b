"""Landmarks placed by hand: written, read, kept with the design, and the same from every door."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh

from app.cli.main import main
from app.i18n.catalog import use_language
from app.presenters.messages import render
from core.document.design import Design, ScanSource
from core.document.serialization import from_json, to_json
from core.errors import LandmarkError, ProjectError
from core.landmarks.manual import PlacedMark, in_file, in_mm, placed_mark
from core.pipeline.build import Stages, build, detect_landmarks

Built = Callable[[str], Stages]


def test_a_place_is_read_as_it_is_written() -> None:
    assert placed_mark("Bust-Point-Left = 1.5,−20,3e2") == PlacedMark("bust_point_left", (1.5, -20.0, 300.0))


@pytest.mark.parametrize(
    "text", ["fold_left", "fold_left=", "fold_left=1,2", "fold_left=1,2,x", "wing=1,2,3", "fold_left=1,2,nan"]
)
def test_what_is_no_place_is_refused(text: str) -> None:
    with pytest.raises(LandmarkError):
        placed_mark(text)


def test_there_and_back_between_file_and_body() -> None:
    turn = np.array(
        [[0.0, 0.0, 25.4, 1.0], [-25.4, 0.0, 0.0, 2.0], [0.0, -25.4, 0.0, 3.0], [0.0, 0.0, 0.0, 1.0]]
    )
    mark = PlacedMark("fold_left", (4.0, -5.0, 6.0))
    place = in_mm([mark], turn)["fold_left"]
    assert place == pytest.approx([6.0 * 25.4 + 1.0, -4.0 * 25.4 + 2.0, 5.0 * 25.4 + 3.0])
    assert in_file(place, turn) == pytest.approx(mark.position)


def test_a_design_keeps_one_place_a_landmark() -> None:
    design = Design(ScanSource("a.ply")).with_placed("fold_right", (1.0, 2.0, 3.0))
    design = design.with_placed("bust_point_left", (4.0, 5.0, 6.0)).with_placed("fold_right", (7.0, 8.0, 9.0))
    assert [mark.name for mark in design.placed] == ["bust_point_left", "fold_right"]
    assert from_json(to_json(design)) == design
    assert design.with_placed("fold_right", None).placed == design.placed[:1]
    with pytest.raises(LandmarkError, match="specified twice"):
        replace(design, placed=design.placed * 2)


@pytest.mark.parametrize("broken", [{"name": "fold_left"}, {"name": "fold_left", "position": [1, 2]}, 7])
def test_a_broken_place_in_a_project_is_told(broken: object) -> None:
    values = {**json.loads(to_json(Design(ScanSource("a.ply")))), "placed": [broken]}
    with pytest.raises(ProjectError):
        from_json(json.dumps(values))


def test_only_what_follows_is_made_anew(built: Built) -> None:
    stages = built("mannequin")
    place = np.add(stages.landmarks.position("bust_point_left"), (0.0, 0.0, 6.0))
    told: list[str] = []
    moved = build(
        stages.design.with_placed("bust_point_left", in_file(place, stages.body.pose.file_to_mm)),
        stages,
        lambda what, _: told.append(what),
    )
    assert told[0] == "find landmarks"
    assert moved.body is stages.body
    assert moved.landmarks.points["bust_point_left"].by_hand
    assert moved.control is not stages.control


def test_the_command_line_places_as_the_design_does_in_any_frame(
    mannequin: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The scan in inches, y up and facing +x: the numbers of the file are those that are given."""
    scan = trimesh.load(mannequin, process=False)
    turn = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]])
    path = tmp_path / "turned.ply"
    trimesh.Trimesh(np.asarray(scan.vertices) @ turn.T / 25.4, scan.faces, process=False).export(path)
    told = ["detect", str(path), "--up", "+y", "--front", "+x", "--json"]
    assert main(told) == 0
    before = json.loads(capsys.readouterr().out)
    place = np.add(before["landmarks"]["fold_left"]["file"], (0.0, 0.1, 0.0))
    assert main([*told, "--landmark", "fold_left=" + ",".join(map(str, place))]) == 0
    found = json.loads(capsys.readouterr().out)
    mark = found["landmarks"]["fold_left"]
    assert mark["rule"] == "Placed manually."
    assert np.linalg.norm(np.array(mark["file"]) - place) * 25.4 < 4.0, "it is laid on the skin nearby"
    stages = build(Design(ScanSource(str(path), up="+y", front="+x")).with_placed("fold_left", tuple(place)))
    assert stages.landmarks.position("fold_left") == pytest.approx(mark["mm"], abs=1e-9)
    assert detect_landmarks(stages.body, stages.design.placed).position("fold_left") == pytest.approx(
        mark["mm"]
    )


@pytest.mark.parametrize(
    ("name", "place"), [("bust_point_left", (-95.0, -200.0, 345.0)), ("fold_left", (9e3, 0.0, 0.0))]
)
def test_what_is_wrong_with_placed_points_is_said_in_words(
    built: Built, name: str, place: tuple[float, float, float]
) -> None:
    with pytest.raises(LandmarkError) as wrong:
        detect_landmarks(built("mannequin").body, (PlacedMark(name, place),))
    assert "_" not in str(wrong.value.message)
    use_language("ja")
    said = render(wrong.value.message)
    use_language("en")
    assert not re.search("[a-z]{3}", said)


def test_a_landmark_on_no_skin_is_refused(mannequin: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["detect", str(mannequin), "--landmark", "fold_left=900,0,0"]) == 2
    assert "landmark inframammary fold left is more than 30 mm off the skin" in capsys.readouterr().err
