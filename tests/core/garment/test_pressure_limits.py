"""The traffic light of pressure: limits as data, with sources and doubts."""

from __future__ import annotations

from band_courses import ellipse

from core.garment.pressure import AMBER, GREEN, LEFT_OUT, RED, band_pressure, pressure_limits

WIDTH = 15.0


def test_the_light_goes_by_the_largest_pressure() -> None:
    limits = pressure_limits()
    lights = {kpa: limits.rating(kpa) for kpa in (0.0, 1.99, 2.0, 3.99, 4.0, 12.0)}
    assert list(lights.values()) == [GREEN, GREEN, AMBER, AMBER, RED, RED]
    band = ellipse(160.0, 60.0)  # mean 2.8 kPa, 15 kPa at the narrow ends
    assert band_pressure(band, WIDTH).rating == RED
    assert band_pressure(band, WIDTH).mean < limits.red_kpa
    assert band_pressure(band, 200.0).rating == GREEN


def test_a_pressure_is_not_called_near_to_what_it_is_far_above() -> None:
    limits = pressure_limits()
    said = [
        limits.description(kpa).en.split(".")[0].split(",")[0]
        for kpa in (0.5, 2.0, 4.0, 4.6, 4.7, 9.0, 9.2, 374.7)
    ]
    assert said[2:4] == ["Near the pressure at which wearers complained"] * 2
    assert said[4:6] == ["Above the pressure at which wearers complained"] * 2
    assert said[6:] == ["Far above all pressures measured under garments"] * 2
    assert len(set(said)) == 5


def test_the_limits_are_told_with_sources_and_doubts_in_both_languages() -> None:
    limits = pressure_limits()
    assert 0.0 < limits.amber_kpa < limits.red_kpa < 35.0 * 0.133322  # where wearers complained
    beyond = [words for _, words in limits.beyond]
    texts = [*limits.lights.values(), *beyond, *limits.doubts, *(source.words for source in limits.sources)]
    assert len(limits.sources) >= 4
    assert all(words.en.endswith(".") and words.ja.endswith("。") for words in texts)
    assert "estimate" in limits.doubts[0].en
    assert any("42 %" in str(sentence) for sentence in LEFT_OUT)
