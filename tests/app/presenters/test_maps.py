"""Maps in words: their limits stand on the colour scale."""

from __future__ import annotations

from itertools import product

from app.presenters.maps import map_kinds
from core.garment.pressure import pressure_limits
from core.mechanics.mesh_quality import MeshQuality


def test_maps_with_limits_mark_them_where_the_verdict_changes() -> None:
    marks = {kind.name: [value for value, _, _ in kind.marks] for kind in map_kinds() if kind.marks}
    assert marks.keys() == {"strain", "pressure"}
    assert marks["pressure"] == [pressure_limits().amber_kpa, pressure_limits().red_kpa]
    for attribute, limit in zip(("strained", "overstrained"), marks["strain"], strict=True):
        for sign, off in product((1.0, -1.0), (-0.1, 0.1)):
            edge = 1.0 + sign * (limit + off) / 100.0
            quality = MeshQuality(1.0, min(1.0, edge), max(1.0, edge))
            assert getattr(quality, attribute) == (off > 0.0)


def test_a_limit_of_strain_beyond_the_range_of_colours_is_in_the_note() -> None:
    kind = next(kind for kind in map_kinds() if kind.name == "strain")
    assert all(f"{value:.0f} %" in kind.note for value, _, _ in kind.marks)
