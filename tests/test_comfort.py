"""The traffic light of pressure: limits as data, with sources and doubts."""

from __future__ import annotations

from band_courses import ellipse

from core.pressure import LEFT_OUT, band_pressure
from core.sewing.comfort import AMBER, GREEN, RED, comfort

WIDTH = 15.0


def test_the_light_goes_by_the_largest_pressure() -> None:
    limits = comfort()
    lights = {kpa: limits.light(kpa) for kpa in (0.0, 1.99, 2.0, 3.99, 4.0, 12.0)}
    assert list(lights.values()) == [GREEN, GREEN, AMBER, AMBER, RED, RED]
    band = ellipse(160.0, 60.0)  # mean 2.8 kPa, 15 kPa at the narrow ends
    assert band_pressure(band, WIDTH).light == RED
    assert band_pressure(band, WIDTH).mean < limits.red_kpa
    assert band_pressure(band, 200.0).light == GREEN


def test_the_limits_are_told_with_sources_and_doubts_in_both_languages() -> None:
    limits = comfort()
    assert 0.0 < limits.amber_kpa < limits.red_kpa < 35.0 * 0.133322  # where wearers complained
    texts = [*limits.lights.values(), *limits.doubts, *(source.words for source in limits.sources)]
    assert len(limits.sources) >= 4
    assert all(words.en.endswith(".") and words.ja.endswith("。") for words in texts)
    assert "estimate" in limits.doubts[0].en
    assert any("42 %" in sentence for sentence in LEFT_OUT)
