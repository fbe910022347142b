"""Constraining lines: lengths, and what a designer may write for them."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from models import pairs_of
from shapes import torso

from core.errors import LineError
from core.mechanics.constraint_lines import RATIO_LIMITS, length_ratio, line_on

POINTS = np.array([[0, 0, 0], [300, 0, 0], [300, 100, 0]], dtype=float)
BAND = line_on("mid-bust", (0, 1, 2), POINTS, free=np.array([1]), back_length=400.0)


def test_a_line_reads_its_natural_length_at_rest():
    np.testing.assert_array_equal(BAND.rest_lengths, [300, 100])
    assert BAND.rest_length == 400.0
    assert BAND.whole_length == 800.0
    assert pairs_of(BAND.across) == [(0, 1), (1, 2)]
    assert BAND.constrains


def test_length_follows_the_points_and_nothing_else():
    moved = POINTS.copy()
    moved[2] = [300, 0, 40]
    assert BAND.length(POINTS) == BAND.rest_length
    assert BAND.length(moved) == 340.0
    assert BAND.length(moved + np.array([5.0, -3.0, 1.0])) == pytest.approx(340.0)
    assert BAND.length(2.0 * moved) == pytest.approx(680.0)
    assert line_on("chord", (0, 2), moved, free=np.array([1])).rest_length == np.hypot(300, 40)


def test_a_line_on_fixed_points_alone_does_not_constrain():
    assert not line_on("under-bust", (0, 1), POINTS, free=np.array([2])).constrains


def test_the_line_of_a_torso_runs_from_right_to_left():
    control = torso()
    x = control.mesh.vertices[list(control.paths["mid-bust"]), 0]
    assert (np.diff(x) > 0).all()


@pytest.mark.parametrize(
    ("text", "ratio"),
    [
        ("97%", 0.97),
        ("97", 0.97),
        ("97.5 %", 0.975),
        ("97,5%", 0.975),
        ("-6%", 0.94),
        ("+6%", 1.06),
        ("- 6 %", 0.94),
        ("\N{MINUS SIGN}6%", 0.94),
        ("９７．５％", 0.975),
        ("－２０ｍｍ", 0.95),
        ("=390mm", 0.975),
        ("-20mm", 0.95),
        ("+2cm", 1.05),
        ("-2in", 1.0 - 50.8 / 400.0),
        ("380mm", 0.95),
        ("38cm", 0.95),
        ("15in", 15 * 25.4 / 400),
        ("380 MM", 0.95),
        ("  380mm  ", 0.95),
        ("520mm", 1.3),
        ("50%", 0.5),
        ("-50%", 0.5),
        ("130%", 1.3),
    ],
)
def test_lengths_that_are_understood(text, ratio):
    assert read(text) == pytest.approx(ratio, abs=1e-12)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "   ",
        "mm",
        "%",
        "abc",
        "97 kg",
        "9 7%",
        "1e2%",
        "nan%",
        "inf",
        "--6%",
        "97%%",
        "1.2.3mm",
        "97%\n9",
    ],
)
def test_nonsense_is_refused_with_an_example(text):
    with pytest.raises(LineError) as refused:
        read(text)
    assert "is not a valid length for mid-bust" in str(refused.value.message)
    assert "97%" in str(refused.value.hint)


@pytest.mark.parametrize(
    "text", ["49.9%", "131%", "-51%", "+31%", "0", "-300mm", "199mm", "560mm", "921mm", "9999"]
)
def test_lengths_out_of_range_name_the_range(text):
    with pytest.raises(LineError) as refused:
        read(text)
    assert "Enter 50 to 130 % (200 to 520 mm front length)" in str(refused.value.hint)


@settings(deadline=None)
@given(st.floats(*RATIO_LIMITS))
def test_every_way_of_writing_a_length_means_the_same(ratio):
    texts = (
        f"{100 * ratio:.9f}%",
        f"{100 * ratio - 100:+.9f}%",
        f"{400 * ratio - 400:+.9f}mm",
        f"{400 * ratio:.9f}mm",
        f"{40 * ratio:.9f}cm",
    )
    low, high = RATIO_LIMITS
    if low + 1e-9 < ratio < high - 1e-9:
        assert [read(text) for text in texts] == pytest.approx([ratio] * 5, abs=1e-9)


@pytest.mark.parametrize(
    ("text", "instead"), [("780mm", "380.0mm"), ("78cm", "380.0mm"), ("600mm", "200.0mm")]
)
def test_what_can_only_be_the_whole_band_is_refused_and_told_as_front_part(text, instead):
    with pytest.raises(LineError) as refused:
        read(text)
    assert str(refused.value.message) == (
        "Front length of mid-bust: 200 to 520 mm; full length: 600 to 920 mm."
    )
    assert f" {instead} gives" in str(refused.value.hint)
    assert read(instead) == pytest.approx(0.95 if instead == "380.0mm" else 0.5)


def test_where_both_readings_make_sense_it_is_the_front_part():
    assert length_ratio("42cm", "strap", 400.0, 440.0) == pytest.approx(1.05)


def test_without_a_back_an_absolute_length_is_that_of_the_line():
    assert length_ratio("38cm", "strap", 400.0, 400.0) == pytest.approx(0.95)
    with pytest.raises(LineError, match="Enter 50 to 130 %"):
        length_ratio("60cm", "strap", 400.0, 400.0)


def read(text: str) -> float:
    """Read the length of the mid-bust line as it is typed."""
    return length_ratio(text, BAND.name, BAND.rest_length, BAND.whole_length)
