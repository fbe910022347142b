"""The trial of every volume control: what each row means, and that the page says what the rows say."""

import csv

import numpy as np
import pytest
from shapes import torso

from app.cli.main import main
from app.research.control_study import TRIED_CONTROLS, TURNS, Subject, _stays_below, trials
from app.research.sphere import sphere_control
from core.mechanics.options import LAWS, ModelOptions

TORSO = Subject("torso", torso(), "mid-bust", ModelOptions(volume_of="both"))


def test_the_rows_of_one_length():
    made = {trial.control: trial for trial in trials(TORSO, (0.8,), TRIED_CONTROLS)}
    assert tuple(made) == TRIED_CONTROLS
    assert made["conventional 2.0"].motion == "vibrating"
    assert made["conventional 1.5"].gain == 1.5
    assert made["none"].gain == made["adaptive"].gain == 0.0
    errors = [made[control].error for control in ("none", "conventional", "accumulating", "exact")]
    assert errors == sorted(errors, reverse=True)
    assert made["none"].calm_at is None
    assert made["adaptive"].calm_at < made["accumulating"].calm_at < made["accumulating"].calmer_at
    assert made["adaptive"].away < 0.01
    assert made["exact"].away == 0.0
    assert made["adaptive"].reached == pytest.approx(made["exact"].reached, abs=1e-5)
    assert made["none"].reached < made["exact"].reached < 0.9
    assert all(trial.turns == TURNS for trial in made.values() if trial.control != "exact")


def test_an_adaptive_run_is_followed_until_it_rests():
    subject = Subject("torso", torso(), "mid-bust", ModelOptions(line_stiffness=200.0, volume_of="both"))
    (slow,) = trials(subject, (0.7,), ("adaptive",))
    assert slow.motion == "settling"
    assert slow.rest_at > slow.turns == TURNS


def test_a_free_sphere_may_drift_and_turn():
    sphere = Subject("sphere", sphere_control(), "horizontal", ModelOptions("co-rotated", volume_of="both"))
    (made,) = trials(sphere, (0.9,), ("adaptive",))
    assert made.away < 0.05


@pytest.mark.parametrize(
    ("errors", "turn"),
    [([0.1, 0.1, 0.1], None), ([2.0, 0.1, 2.0, 0.1, 0.1], 4), ([0.1, 0.2], 1), ([0.1, np.nan], None)],
)
def test_the_turn_from_which_on_an_error_stays_below(errors, turn):
    assert _stays_below(np.array(errors), 0.3 if turn == 1 else 0.15 if turn else 0.05) == turn


def test_the_command_writes_a_row_for_each_case_and_a_page(tmp_path, capsys):
    assert main(["sweep", "--quick", "--out", str(tmp_path)]) == 0
    rows = list(csv.DictReader((tmp_path / "sweep.csv").read_text("utf-8").splitlines()))
    assert len(rows) == (len(LAWS) + 1) * 2 * len(TRIED_CONTROLS)
    assert f"{len(rows)} of {len(rows)} cases" in capsys.readouterr().err
    page = (tmp_path / "sweep.md").read_text(encoding="utf-8")
    table = {
        cells[1].strip(): cells for cells in (line.split("|") for line in page.splitlines()) if cells[1:]
    }
    for control in TRIED_CONTROLS:
        of_it = [row for row in rows if row["control"] == control]
        assert int(table[control][2]) == len(of_it)
        assert int(table[control][3]) == sum(row["motion"] == "vibrating" for row in of_it)
    assert f"{len(rows)} cases" in page
    assert page.count("* kept: ") == 5
    assert "not kept" not in page
