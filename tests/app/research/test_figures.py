"""The figures of the paper: pictures with ink, tables whose values can be checked, a page without gaps."""

from __future__ import annotations

import csv
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest

from app.cli.main import main
from app.research.cases import Study, line_share, moved, reached_length
from app.research.commands.figures import FIGURES, draw, make_some
from app.research.fig_1_to_5 import figure_1, outward, profile
from app.research.figure_style import trimmed
from app.research.page import page_of
from app.research.parameter_study import RATIOS, Finding, Pair, mirrored_mean, pairs_of, routes, search_words
from core.errors import UserError
from core.geometry.mesh import Mesh


@pytest.fixture(scope="module")
def study() -> Study:
    return Study()


def table(path: Path) -> list[dict[str, str]]:
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def ink(path: Path) -> float:
    """The part of a picture that is not white."""
    picture = matplotlib.image.imread(path)[..., :3]
    return float((picture < 0.98).any(axis=2).mean())


def test_the_volume_error_stands_in_picture_and_table(study: Study, tmp_path: Path) -> None:
    """Fig. 7: a1, a2, b1, b2 over the turns, at two lengths."""
    figure = draw("7", study, tmp_path, lambda _: None)
    rows = table(tmp_path / f"{figure.name}.csv")
    assert {row["curve"] for row in rows} == {"a1", "a2", "b1", "b2"}
    at_rest = [row for row in rows if row["turn"] == "0"]
    assert len(at_rest) == 8
    assert all(abs(float(row["volume_error_ml"])) < 1e-6 for row in at_rest)
    for row in rows:
        rest = study.stages(row["body"]).model.volume.rest_volume / 1000.0
        percent, ml = float(row["volume_error_percent"]), float(row["volume_error_ml"])
        assert ml == pytest.approx(percent / 100.0 * rest, rel=1e-5, abs=1e-6)
    last = {row["curve"]: float(row["volume_error_percent"]) for row in rows if row["set_percent"] == "97"}
    assert abs(last["a2"]) < 1e-3 < abs(last["a1"])
    assert 0.02 < ink(tmp_path / f"{figure.name}.png") < 0.5
    assert "a2 at 97 %" in figure.caption


def test_the_meshes_are_drawn_and_counted(study: Study, tmp_path: Path) -> None:
    """Fig. 1: two bodies, each with two control meshes."""
    figure = figure_1(study)
    figure.save(tmp_path)
    rows = table(tmp_path / f"{figure.name}.csv")
    assert [(row["body"], row["control_polygons"]) for row in rows] == [
        ("mannequin", "120"),
        ("mannequin", "168"),
        ("person", "120"),
        ("person", "168"),
    ]
    assert [row["free_control_points"] for row in rows[:2]] == ["21", "36"]
    assert all(figure.columns == tuple(row) for row in rows)
    assert ink(tmp_path / f"{figure.name}.png") > 0.1


@pytest.mark.parametrize("part", [0.99, 1.01])
def test_a_waist_line_swings_beyond_its_gain_limit_alone(study: Study, part: float) -> None:
    """By how much a swing grows in an iteration is the gain over the limit, where it is small."""
    swings = study.lower.course(0.9, "conventional", part).swings
    assert (swings[90] / swings[30]) ** (1 / 60) == pytest.approx(part, abs=2e-3)


def test_one_volume_for_the_trunk_moves_the_seat_and_five_zones_do_not(study: Study) -> None:
    one, five = (study.lower.outward(0.9, together=together) for together in (True, False))
    seat = study.lower.at_seat()
    assert one[seat].max() > 2.0
    assert five[seat].max() < 1.4
    waist = list(study.lower.stages(0.9).control.paths["waist"])
    assert one[waist].max() < 0.0 < -five[waist].mean()


def test_a_figure_that_there_is_not_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="Unknown figure 12"):
        make_some(["12"], tmp_path)
    assert set(FIGURES) == set("123456789") | {"10", "11"}


def test_the_line_is_set_so_that_it_reaches_what_is_asked(study: Study) -> None:
    ratio = study.ratio_for("person", 0.97)
    assert ratio < 0.97
    assert reached_length(study.stages("person"), ratio) == pytest.approx(0.97, abs=1e-5)
    assert line_share(study.solved("person", ratio, "exact")) == pytest.approx(0.97, abs=1e-5)


def test_nothing_is_solved_twice(study: Study) -> None:
    assert study.solved("person", 0.97, "adaptive", 5) is study.solved("person", 0.97, "adaptive", 5)
    assert study.stages("person") is study.stages("person", "168")


def test_trimmed_pictures_keep_the_same_box() -> None:
    one, other = (np.full((50, 80, 3), 255, dtype=np.uint8) for _ in range(2))
    one[20, 30], other[25, 40] = 0, 0
    assert {picture.shape for picture in trimmed([one, other], margin=2)} == {(10, 15, 3)}


def test_the_front_of_a_ball_in_profile_and_how_far_a_larger_one_lies_outside() -> None:
    """A profile is the front half of the section, from top to bottom."""
    steps = np.linspace(0.0, 2.0 * np.pi, 361)[:-1]
    ring = np.stack([0.0 * steps, -50.0 * np.cos(steps), 50.0 * np.sin(steps)], axis=1)
    sides = np.array([[-5.0, 0.0, 0.0], [5.0, 0.0, 0.0]])
    count = len(ring)
    tube = np.concatenate([ring + sides[0], ring + sides[1]])
    at = np.arange(count)
    after = (at + 1) % count
    faces = np.concatenate(
        [np.stack([at, after, at + count], axis=1), np.stack([after, after + count, at + count], axis=1)]
    )
    shape = profile(Mesh(tube, faces), np.array([0.0, -50.0, 0.0]))
    assert shape[0, 1] == pytest.approx(50.0, abs=0.5)
    assert shape[-1, 1] == pytest.approx(-50.0, abs=0.5)
    assert (shape[:, 0] < 1.0).all()
    assert np.linalg.norm(shape, axis=1) == pytest.approx(50.0, abs=0.05)
    assert outward(shape, 1.02 * shape)[5:-5] == pytest.approx(1.0, abs=0.05)


@pytest.mark.parametrize("template", ["120", "168"])
def test_the_routes_lie_on_the_breasts(study: Study, template: str) -> None:
    control = study.stages("person", template).control
    tried = routes(control)
    assert len(tried) == 7
    for paths in tried.values():
        for path in paths.values():
            assert not control.fixed[list(path)].all()
    for name in ("straps", "slings", "oblique", "ring"):
        left, right = tried[name]["left"], tried[name]["right"]
        assert np.array_equal(control.row[list(left)], control.row[list(right)])
        assert np.array_equal(control.column[list(left)], -control.column[list(right)])
    ring = tried["ring"]["left"]
    assert ring[0] == ring[-1]
    assert control.bust_points[0] not in ring


def test_the_twin_is_symmetric_and_a_symmetric_mesh_its_own_twin(study: Study) -> None:
    control = study.stages("person").control
    twin = mirrored_mean(control)
    again = mirrored_mean(twin)
    assert np.abs(twin.mesh.vertices - control.mesh.vertices).max() > 1.0
    assert again.mesh.vertices == pytest.approx(twin.mesh.vertices, abs=1e-9)


def finding(body: str, ratio: float, higher: float, first_error: float) -> Finding:
    template = {"mannequin": "120", "person": "168"}[body]
    place = (body, template, "mid-bust 0.5", "force-density", "glued", 0.0, 100.0 * ratio)
    return Finding(
        *place, "vibrating", "settled", higher, 1.0, 1.0, 0.1, 1.0, first_error, 26.0 * first_error
    )


def test_a_statement_holds_only_if_it_holds_on_both_bodies() -> None:
    a, b = finding("mannequin", 0.97, 0.1, 0.2), finding("person", 0.97, -0.1, 0.3)
    assert not Pair(a, b).higher
    assert Pair(a, b).larger
    assert Pair(a, b).shakes
    assert Pair(a, replace(b, higher_mm=0.1)).higher
    assert pairs_of([a, replace(a, template="168"), b]) == [Pair(a, b)]


def test_the_page_leaves_no_blank(study: Study) -> None:
    found = [finding(b, ratio, 0.1, 0.2) for b in ("mannequin", "person") for ratio in RATIOS]
    page = page_of([], [], [], found, study)
    assert "{" not in page
    words = search_words(found, study)
    assert words["higher_always"] == "mid-bust 0.5, force-density, glued"
    assert words["larger_always"] == "none"
    assert words["pairs"] == "3"


def test_the_command_draws_what_is_asked(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["figures", "--only", "3", "--out", str(tmp_path)]) == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["fig-3-person.csv", "fig-3-person.png"]
    assert "Fig. 3" in capsys.readouterr().out
    assert main(["figures", "--only", "12", "--out", str(tmp_path)]) == 2
    assert "Unknown figure 12" in capsys.readouterr().err


def test_figures_need_no_window() -> None:
    code = (
        "import sys, app.research.commands.figures; "
        "sys.exit(any(name.startswith('PySide6') for name in sys.modules))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False, capture_output=True).returncode == 0


def test_the_heights_are_those_of_the_bust_points_on_the_body(study: Study) -> None:
    solution = study.solved("person", 0.9, "exact")
    rest = solution.stages.body.mesh.vertices
    marks = [solution.stages.landmarks.position(f"bust_point_{side}") for side in ("left", "right")]
    nearest = [int(np.linalg.norm(rest - mark, axis=1).argmin()) for mark in marks]
    rise = (solution.body.vertices[nearest, 2] - rest[nearest, 2]).mean()
    assert moved(solution)[0] == pytest.approx(rise, abs=1e-5)
    assert abs(rise) > 0.1
