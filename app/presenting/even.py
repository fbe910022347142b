"""What the window says of left and right: figures with their sides, and what making them even begins with."""

from __future__ import annotations

from app.panels.even_card import EvenSummary, EvenView
from app.presenting.lines import line_title, pair_title
from app.wording.words import joined, listed, number, say, tr
from core.advice.parting import ENOUGH, moves_one_side, partable
from core.design import Design
from core.evenness import BeforeAfter, Evenness, EvenRow, even_rows
from core.pipeline import Stages
from core.template import read_template

_FULL = {"mm": 10.0, "ml": 60.0}
"""What fills half a bar."""


def even_summary(told: BeforeAfter, stages: Stages, doubt: str = "", off: float | None = None) -> EvenSummary:
    """Return what the card says of a body; with a ``doubt`` there is nothing to be told after.

    ``off`` [ml] is how far the difference of the volumes may be off by all that is not sure, if it is known.
    """
    now = told.before if doubt else told.after
    rows = {row.key: row for row in even_rows(told.before, told.after)}
    hint, possible = _hint(stages, now) if not doubt else (doubt, False)
    return EvenSummary(
        _sentence(now),
        tuple(_view(rows[key], bool(doubt), off) for key in _titles()),
        (*map(say, told.notes), *_rests_on()),
        hint,
        possible,
    )


def map_note(told: BeforeAfter | None, after: bool) -> str:
    """Return what the legend of the map says in ml; empty where it is not known."""
    skin = None if told is None else (told.after if after else told.before).skin
    if skin is None:
        return ""
    words = tr("+ stands out more than the other side: left {left} ml, right {right} ml")
    return words.format(left=number(skin.left_more, 0), right=number(skin.right_more, 0))


def _sentence(now: Evenness) -> str:
    if now.furthest < ENOUGH:
        return tr("Both bust points lie alike within {mm} mm.").format(mm=number(ENOUGH))
    parts = []
    for value, left, right in (
        (now.higher, tr("left {mm} mm higher"), tr("right {mm} mm higher")),
        (now.further_out, tr("left {mm} mm further out"), tr("right {mm} mm further out")),
    ):
        if abs(value) >= ENOUGH:
            parts.append((left if value > 0.0 else right).format(mm=number(abs(value))))
    return tr("Bust points: {how}.").format(how=listed(parts))


def _view(row: EvenRow, doubtful: bool, off: float | None) -> EvenView:
    title, tip = _titles()[row.key]
    after = None if doubtful else row.after
    shares = tuple(
        None if not row.sided or value is None else value / _FULL[row.unit] for value in (row.before, after)
    )
    if row.plus_minus:
        sure = (
            tr("An estimate, ± {off} ml by the roots alone.")
            if off is None
            else tr("An estimate, ± {off} ml.")
        )
        tip = joined((tip, sure.format(off=number(row.plus_minus if off is None else off, 0))))
    return EvenView(
        f"{title} [{row.unit}]", _written(row, row.before), _written(row, after), tip, (shares[0], shares[1])
    )


def _written(row: EvenRow, value: float | None) -> str:
    """Return a figure with the side that is more, as it stands in the table."""
    digits = 0 if row.unit == "ml" else 1
    if value is None:
        return "\N{EN DASH}"
    size = number(abs(value), digits)
    if not row.sided or size == number(0.0, digits):
        return size
    return (tr("L {size}") if value > 0.0 else tr("R {size}")).format(size=size)


def _titles() -> dict[str, tuple[str, str]]:
    """Return what each figure is called, and what it is; the most telling first."""
    return {
        "higher": (tr("Bust point higher"), tr("Which bust point is higher, and by how much.")),
        "further_out": (tr("Further out"), tr("Which bust point is further to the front, and by how much.")),
        "larger": (tr("Breast larger"), tr("At rest measured; after it with what the skin has gained.")),
        "mean": (
            tr("Skin apart, mean"),
            tr("How far the skin of one breast is from that of the other one, mirrored; mean of both."),
        ),
        "further_aside": (tr("Further aside"), tr("Which bust point is further from the mirror.")),
        "largest": (tr("Skin apart, most"), tr("Where one side stands out most beyond the mirrored other.")),
        "left_more": (tr("Left stands out"), tr("What lies between the skins where it is the left.")),
        "right_more": (tr("Right stands out"), tr("What lies between the skins where it is the right.")),
    }


def _rests_on() -> tuple[str, ...]:
    return (
        tr("L: the left is more; R: the right. The tick in the bar is before."),
        tr("The mirror stands where the trunk without the breasts matches best."),
        tr("Lines move tissue and keep its volume: what one breast has more they do not take away."),
    )


def _hint(stages: Stages, now: Evenness) -> tuple[str, bool]:
    """Return what is done before lengths are looked for, or why they are not; and whether they can be."""
    if now.furthest < ENOUGH:
        return "", False
    if moves_one_side(stages):
        return "", True
    design = stages.design
    names = partable(design, read_template(design.template))
    if not names:
        return tr(
            "To make it even, wear a line that moves one side, or one across both that is unlocked."
        ), False
    return tr("Make even begins by setting left and right apart: {lines}.").format(
        lines=listed(parted_titles(design, names))
    ), True


def parted_titles(design: Design, names: tuple[str, ...]) -> list[str]:
    """Return what lines that are parted are called, a pair once."""
    titles = [
        pair_title(name, design) if len(design.linked(name)) > 1 else line_title(name, design)
        for name in names
    ]
    return list(dict.fromkeys(titles))


def left_as_it_is(gained: float, lost: float) -> tuple[str, str]:
    """Return why a design is not made even, and what could be done; both in mm, see ``Evened``."""
    said = tr("These lines cannot make it more even: {gained} mm nearer would move both sides by {lost} mm.")
    hint = tr("Other lines may do more: a strap lifts one side alone.")
    return said.format(gained=number(max(gained, 0.0)), lost=number(lost)), hint
