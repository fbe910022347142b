"""A turntable: one turn round, whole or not at all, in every kind of file that says how it moves."""

from itertools import pairwise

import numpy as np
import pytest
from PIL import Image

from app.presenters.lines import bands
from app.rendering.offscreen import OffscreenRenderer, with_background
from app.rendering.turntable import FORMATS, Turntable, render_turntable, write_turntable
from core.errors import UserError
from core.pipeline.solve import solve
from core.progress import Cancelled, in_one_go

SMALL = Turntable(frames=4, size=(120, 100), seconds=2.0)


@pytest.fixture(scope="module")
def reshaped(built):
    """A body with its bands, and no soft shadows, which are another test's."""
    stages = built("mannequin")
    return stages, solve(stages).region_points, bands(stages, ()), np.ones(len(stages.body.mesh.vertices))


def shots_of(reshaped, turntable, hear=lambda *_: None):
    with OffscreenRenderer(*reshaped, dark=turntable.dark) as studio:
        in_one_go(studio.set_up())
        return in_one_go(render_turntable(studio, turntable), hear)


def pictures(reshaped, turntable):
    return [with_background(shot, turntable.dark).astype(float) for shot in shots_of(reshaped, turntable)]


@pytest.fixture(scope="module")
def shots(reshaped):
    return shots_of(reshaped, SMALL)


@pytest.mark.parametrize("kind", ["gif", "webp"])
def test_a_moving_picture_turns_once_in_its_time_and_goes_on(tmp_path, shots, kind):
    files = write_turntable(tmp_path / f"t.{kind}", shots, SMALL)
    with Image.open(files[0]) as picture:
        assert (picture.n_frames, picture.size, picture.info["loop"]) == (4, (120, 100), 0)
        shown = []
        for k in range(4):
            picture.seek(k)
            picture.load()
            shown.append((np.asarray(picture.convert("RGB"), dtype=float), picture.info["duration"]))
    assert [duration for _, duration in shown] == [500] * 4
    assert [path.name for path in tmp_path.iterdir()] == [f"t.{kind}"]
    for (first, _), (second, _) in pairwise(shown):
        assert np.abs(first - second).mean() > 1.0  # it has turned


def test_a_series_has_a_numbered_picture_a_step(tmp_path, reshaped):
    ten = Turntable(10, (64, 64))
    files = write_turntable(tmp_path / "t.png", shots_of(reshaped, ten), ten)
    assert [path.name for path in files] == [f"t-{k:02}.png" for k in range(1, 11)]
    assert sorted(tmp_path.iterdir()) == files
    with Image.open(files[9]) as picture:
        assert picture.size == (64, 64)


def test_it_begins_at_the_front_and_turns_to_the_left_side(reshaped):
    front, left, back, right = pictures(reshaped, SMALL)
    assert np.abs(front - front[:, ::-1]).mean() < 3.0  # a body from in front is even
    assert np.abs(back - back[:, ::-1]).mean() < 3.0
    assert np.abs(left - right[:, ::-1]).mean() < 3.0
    assert np.abs(left - left[:, ::-1]).mean() > 5.0
    assert np.abs(front - back).mean() > 1.0


def test_before_and_after_stand_side_by_side_and_bands_are_worn_after(tmp_path, reshaped):
    wide = Turntable(2, (200, 100), side_by_side=True)
    files = write_turntable(tmp_path / "t.png", shots_of(reshaped, wide), wide)
    with Image.open(files[0]) as picture:
        pixels = np.asarray(picture, dtype=float)
    assert pixels.shape == (100, 200, 3)
    assert bright(pixels[:80, :100]) == 0 < bright(pixels[:80, 100:])
    for half in (pixels[80:, :100], pixels[80:, 100:]):
        assert ((half.max(axis=2) < 120) & (np.ptp(half, axis=2) < 20)).sum() > 5, "each is named below"


def test_dark_ground_is_dark(reshaped):
    light, dark = (
        pictures(reshaped, Turntable(2, (64, 64), dark=is_dark))[0][:4].mean() for is_dark in (False, True)
    )
    assert dark < 0.4 * light


@pytest.mark.parametrize("kind", FORMATS)
@pytest.mark.parametrize("late", [0.0, 0.5])
def test_what_is_stopped_leaves_no_file(tmp_path, shots, kind, late):
    def stop(what, share):
        if share >= late:
            raise Cancelled

    with pytest.raises(Cancelled):
        write_turntable(tmp_path / f"t.{kind}", shots, SMALL, stop)
    assert list(tmp_path.iterdir()) == []


def test_progress_only_goes_on(tmp_path, reshaped):
    drawn, written = [], []
    shots = shots_of(reshaped, SMALL, lambda _, share: drawn.append(share))
    write_turntable(tmp_path / "t.gif", shots, SMALL, lambda _, share: written.append(share))
    for heard in (drawn, written):
        assert heard == sorted(heard)
        assert heard[-1] == 1.0
    assert len(drawn) >= SMALL.frames


@pytest.mark.parametrize(
    ("name", "said"), [("t.mp4", "gif, webp, png"), ("missing/t.gif", "missing does not exist")]
)
def test_other_names_are_refused(tmp_path, shots, name, said):
    with pytest.raises(UserError, match=said):
        write_turntable(tmp_path / name, shots, SMALL)


@pytest.mark.parametrize(
    ("wrong", "limits"),
    [
        ({"frames": 1}, "2 to 360"),
        ({"seconds": 0.0}, "0.5 to 60"),
        ({"size": (10, 600)}, "64 to 4096"),
        ({"size": (600, 9000)}, "64 to 4096"),
    ],
)
def test_what_cannot_be_made_is_refused_with_the_range(wrong, limits):
    with pytest.raises(UserError, match=f"is out of range. Enter a value from {limits}"):
        Turntable(**wrong)


def bright(picture: np.ndarray) -> int:
    """How many pixels are of a band's colour: skin and ground are pale."""
    return int((np.ptp(picture, axis=2) > 110).sum())
