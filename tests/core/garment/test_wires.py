"""Underwires by size: the shipped lengths, and the sizes next to a root."""

from itertools import pairwise

import pytest

from core.garment.wires import nearest_wires, wire_types


def test_lengths_grow_with_the_size_by_steps_of_a_wire():
    for each in wire_types():
        assert each.source
        lengths = [each.lengths_mm[size] for size in sorted(each.lengths_mm, key=int)]
        assert all(5.0 < after - before < 25.0 for before, after in pairwise(lengths))


@pytest.mark.parametrize(("root", "size"), [(200.0, "34"), (233.0, "38"), (20.0, "30"), (900.0, "52")])
def test_the_size_next_to_a_root_is_found(root, size):
    wire = next(each for each in nearest_wires(root) if each.kind == "Regular")
    assert wire.size == size
