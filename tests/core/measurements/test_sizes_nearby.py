"""Sizes that lie within what two girths may be off."""

import pytest

from core.measurements.sizes import built_in, neighbours_of, size


@pytest.mark.parametrize("table", built_in(), ids=lambda table: table.key)
def test_sizes_within_an_error_begin_where_the_next_one_does(table):
    """Each border is reached by an error a little larger than how far it is, and by none that is smaller."""
    answer = size(table, 742.0, 889.0)
    assert neighbours_of(answer, 0.0, 0.0) == ()
    tried = 0
    for each in answer.neighbours:
        if each.label:
            band = each.part == "band"
            offs = [(share * each.missing_mm, 0.0) for share in (0.9, 1.1)]
            below, beyond = (neighbours_of(answer, *(off if band else off[::-1])) for off in offs)
            assert each.label in beyond
            assert each.label not in below
            tried += 1
    assert tried >= 3
    both = neighbours_of(answer, 25.0, 25.0)
    assert len(both) > len(neighbours_of(answer, 25.0, 0.0))
    assert answer.label not in both
