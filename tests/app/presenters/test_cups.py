"""Cups in words, and what choosing them changes."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.presenters.cups import AMOUNTS, amounts, change_text, cup_notes, kind_text, with_kind
from core.document.cup import CUP_RANGES, Cup
from core.document.design import Design, ScanSource

DESIGN = Design(ScanSource("a.ply"), line_contact="sliding")


@pytest.mark.parametrize("kind", ["moulded", "sewn"])
def test_cups_that_are_chosen_act_and_keep_what_was_set(kind: str) -> None:
    chosen = with_kind(DESIGN, kind)
    assert chosen.cup is not None
    assert (chosen.cup.kind, chosen.tissue, chosen.line_contact) == (kind, "solid", "glued")
    assert any(getattr(chosen.cup, key) != getattr(Cup(), key) for key in AMOUNTS[kind])
    set_by_hand = replace(chosen, cup=replace(chosen.cup, **{AMOUNTS[kind][0]: 1.05, "wire": True}))
    other = with_kind(set_by_hand, next(each for each in AMOUNTS if each != kind))
    again = with_kind(other, kind)
    assert again.cup == replace(other.cup, kind=kind)
    assert getattr(again.cup, AMOUNTS[kind][0]) == 1.05
    assert with_kind(chosen, "").cup is None
    assert with_kind(chosen, "").tissue == "solid"


def test_every_edit_has_a_name_and_the_tissue_is_told_before_it_changes() -> None:
    assert set(amounts()) == set(CUP_RANGES) - {"cloth"}
    assert change_text("lift", 25.0) == "Cups: Lift 25 mm"
    assert change_text("across", 0.97) == "Cups: Across 97 %"
    assert change_text("coverage", "half") == "Cups: Coverage Half"
    assert (change_text("wire", True), change_text("wire", False)) == ("Underwire added", "Underwire removed")
    assert (kind_text("sewn"), kind_text("")) == ("Cups: Sewn", "Cups removed")
    assert "solid" in cup_notes(DESIGN)
    assert cup_notes(replace(DESIGN, tissue="solid", line_contact="glued")) == ""
