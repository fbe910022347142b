"""The makers of test bodies: subdivision, mixing of macro factors, membranes over a bust."""

from __future__ import annotations

import gzip
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path[:0] = [str(Path(__file__).parents[2] / "benchmarks")]

from cloth import COLUMNS, membrane  # noqa: E402
from human_base import read_base, refined, subdivision  # noqa: E402

CUBE = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
CORNERS = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])


def test_subdivision_keeps_the_middle_and_closes() -> None:
    matrix, quads = subdivision(CUBE, 8)
    smooth = matrix @ CORNERS
    assert quads.shape == (24, 4)
    np.testing.assert_allclose(np.asarray(matrix.sum(axis=1)).ravel(), 1.0)
    np.testing.assert_allclose(smooth.mean(axis=0), 0.5)
    # Catmull and Clark (1978): a corner of valence 3 moves to (Q + 2 R) / 3 with S weighted by zero
    np.testing.assert_allclose(smooth[0], [2.0 / 9.0] * 3)


def test_subdivision_of_a_sheet_leaves_it_flat_and_its_sides_straight() -> None:
    sheet = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
    matrix, faces = refined(np.array([[0, 1, 2, 3]]), 4, 3)
    fine = matrix @ sheet
    assert len(faces) == 2 * 4**3
    assert np.abs(fine[:, 2]).max() == 0.0
    assert (fine.min(), fine.max()) > (0.0, 0.0)
    assert fine[:, :2].max() < 1.0


@pytest.fixture
def data(tmp_path: Path) -> Path:
    """A base mesh of one square with a target for the weight of a young and of an old woman."""
    (tmp_path / "3dobjs").mkdir()
    lines = [
        "v 0 0 0",
        "v 1 0 0",
        "v 1 1 0",
        "v 0 1 0",
        "g helper",
        "f 1 2 3 4",
        "g body",
        "f 1/1 2/2 3/3 4/4",
    ]
    (tmp_path / "3dobjs" / "base.obj").write_text("\n".join(lines), encoding="utf-8")
    return tmp_path


def test_base_is_read_in_millimetres_with_the_front_at_minus_y(data: Path) -> None:
    base = read_base(data)
    assert base.quads.tolist() == [[0, 1, 2, 3]]
    np.testing.assert_allclose(base.rest[2], [100.0, 0.0, 100.0])


def test_macro_factors_are_mixed_as_products(data: Path) -> None:
    class Every(dict):
        """Targets that all move vertex 0 by 1 mm to the left; each look-up is counted."""

        def __contains__(self, name: object) -> bool:
            return True

        def __missing__(self, name: str) -> tuple[np.ndarray, np.ndarray]:
            self[name] = (np.array([0]), np.array([[1.0, 0.0, 0.0]]))
            return self[name]

    base = read_base(data)
    base.__dict__["targets"] = names = Every()
    middling = base.mixed({"gender": 0.0, "age": 0.75, "weight": 0.6, "cup": 1.0, "firmness": 0.5}, {})
    body = [name for name in names if name.startswith("macrodetails/universal")]
    assert "macrodetails/universal-female-young-averagemuscle-maxweight" in body
    # race, body and breast targets add up to one millimetre each; height and proportions are average
    np.testing.assert_allclose(middling[0], [3.0, 0.0, 0.0])


def test_target_is_read_from_its_file(data: Path) -> None:
    (data / "targets" / "breast").mkdir(parents=True)
    packed = gzip.compress(b"# a comment\n2 0.1 0.2 -0.3\n")
    (data / "targets" / "breast" / "some.target.gz").write_bytes(packed)
    rows, move = read_base(data).target("breast/some")
    assert rows.tolist() == [2]
    np.testing.assert_allclose(move, [[10.0, 30.0, 20.0]])


def bumps(rows: int = 60) -> np.ndarray:
    """A cylinder of 120 mm with two bumps of 40 mm in front."""
    turn = (np.arange(COLUMNS) + COLUMNS // 2) % COLUMNS - COLUMNS // 2
    z = np.arange(rows)[:, None] - rows // 2
    each = [np.exp(-(((turn - at) / 10.0) ** 2) - (z / 20.0) ** 2) for at in (-22, 22)]
    return 120.0 + 40.0 * (each[0] + each[1])


def test_membrane_bridges_the_gap_and_never_enters_the_body() -> None:
    body = bumps()
    free = np.zeros_like(body)
    free[15:45] = 1.0
    cloth = membrane(body, free, around=0.9, soft=0.0)
    assert (cloth - body).min() > -1e-9
    np.testing.assert_array_equal(cloth[:15], body[:15])
    gap, peak = cloth[30, 0], body[30, 22]
    chord = peak * np.cos(22 * 2.0 * np.pi / COLUMNS)
    assert chord - 4.0 < gap < chord + 1.0 < peak


def test_soft_breast_gives_way_to_the_membrane() -> None:
    body, free = bumps(), np.ones_like(bumps())
    pressed = membrane(body, free, around=0.9, soft=15.0)
    assert pressed[30, 22] < body[30, 22] - 3.0
