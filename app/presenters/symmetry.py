"""Format the comparison of left and right: values with their sides, and the steps that balance them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from app.i18n.catalog import joined, listed, number, tr
from app.i18n.lengths import length, length_number, length_unit, shown_digits, shown_unit, shown_value
from app.presenters.lines import row_title
from app.presenters.measurements import length_uncertainty, plus_minus
from app.presenters.messages import render
from app.presenters.target_shape import is_met, stop_text, target_title
from core.analysis.inverse_design.bust_quantities import FURTHER_OUT, HIGHER
from core.analysis.inverse_design.profile_quantities import is_signed, section_of
from core.analysis.inverse_design.quantity import Goal
from core.analysis.symmetry.compare import BeforeAfter, SideDifference, SymmetryRow, symmetry_rows
from core.analysis.symmetry.split_sides import (
    BUST_PAIR,
    ENOUGH,
    SEAT_PAIR,
    moves_one_side,
    splittable_lines,
    uneven_pairs,
)
from core.control_mesh.template import read_template
from core.document.design import Design
from core.landmarks.warnings import edit_warnings
from core.measurements.uncertain_value import AFTER, OutputUncertainties
from core.pipeline.build import Stages

if TYPE_CHECKING:
    from core.analysis.inverse_design.solve import InverseResult

_SEEN = 0.05  # what differs less reads the same [mm]

_FULL = {"mm": 10.0, "ml": 60.0}
"""What fills half a bar."""


_SURE = {"higher": "asymmetry_height", "further_out": "asymmetry_forward"}
"""The measures whose ± is that of a figure."""


def symmetry_view(
    told: BeforeAfter, stages: Stages, doubt: str = "", spread: OutputUncertainties | None = None
) -> SymmetryView:
    """Return the summary of a body; with a ``doubt`` there are no values after.

    ``spread`` tells how far figures may be off, if all of that is known.
    """
    now = told.before if doubt else told.after
    rows = {row.key: row for row in symmetry_rows(told.before, told.after)}
    hint, possible = _hint(stages, now) if not doubt else (doubt, False)
    offs = _offs(spread)
    text = _sentence(now, {}, tr("Bust points before: {position}.")) if doubt else _sentence(now, offs)
    return SymmetryView(
        joined((*map(render, edit_warnings(stages.body)), text, *(() if doubt else _seat_sentences(now)))),
        tuple(_view(rows[key], bool(doubt), offs.get(key)) for key in _titles() if key in rows),
        (*map(render, told.notes), *_rests_on()),
        hint,
        possible,
    )


def map_note(told: BeforeAfter | None, after: bool) -> str:
    """Return the note of the legend of the map, in ml; empty where it is not known."""
    skin = None if told is None else (told.after if after else told.before).skin
    if skin is None:
        return ""
    words = tr("+ protrudes beyond the other side: left {left} ml, right {right} ml")
    return words.format(left=number(skin.left_more, 0), right=number(skin.right_more, 0))


def _offs(spread: OutputUncertainties | None) -> dict[str, float]:
    known = {key: spread.plus_minus(f"{AFTER}:{of}") if spread else None for key, of in _SURE.items()}
    return {key: off for key, off in known.items() if off is not None}


def _sentence(now: SideDifference, offs: Mapping[str, float], words: str = "") -> str:
    if now.largest_difference < ENOUGH:
        return tr("Bust points are symmetric within {length}.").format(length=length(ENOUGH))
    parts, within = [], True
    for key, value, left, right in (
        ("higher", now.higher, tr("left {length} higher"), tr("right {length} higher")),
        (
            "further_out",
            now.further_out,
            tr("left {length} further forward"),
            tr("right {length} further forward"),
        ),
    ):
        if abs(value) >= ENOUGH:
            off = offs.get(key)
            size = (
                length(abs(value))
                if off is None
                else f"{length_number(abs(value))} {length_uncertainty(off)} {length_unit()}"
            )
            parts.append((left if value > 0.0 else right).format(length=size))
            within &= off is not None and abs(value) <= off
    text = (words or tr("Bust points: {position}.")).format(position=listed(parts))
    return joined((text, tr("No significant difference in position."))) if within else text


def _seat_sentences(now: SideDifference) -> Iterator[str]:
    """Yield how the heights of the seat differ, if they do."""
    if now.seat is None:
        return
    for value, left, right in (
        (
            now.seat.higher,
            tr("Left buttock point {length} higher."),
            tr("Right buttock point {length} higher."),
        ),
        (
            now.seat.fold_higher,
            tr("Left gluteal fold {length} higher."),
            tr("Right gluteal fold {length} higher."),
        ),
    ):
        if abs(value) >= ENOUGH:
            yield (left if value > 0.0 else right).format(length=length(abs(value)))


def _view(row: SymmetryRow, doubtful: bool, off: float | None) -> SymmetryRowView:
    title, tip = _titles()[row.key]
    after = None if doubtful else row.after
    within = off is not None and after is not None and abs(after) <= off
    shares = tuple(
        None if not row.sided or value is None else value / _FULL[row.unit] for value in (row.before, after)
    )
    return SymmetryRowView(
        f"{title} [{shown_unit(row.unit)}]",
        _written(row, row.before),
        _written(row, after),
        joined((tip, tr("No significant difference."))) if within else tip,
        (shares[0], shares[1]),
        "" if off is None else (length_uncertainty(off) if row.unit == "mm" else plus_minus(off)),
        within,
    )


def _written(row: SymmetryRow, value: float | None) -> str:
    """Return a figure with the side that is more, as it stands in the table."""
    digits = shown_digits(0 if row.unit == "ml" else 1, row.unit)
    if value is None:
        return "\N{EN DASH}"
    size = number(shown_value(abs(value), row.unit), digits)
    if not row.sided or size == number(0.0, digits):
        return size
    return (tr("L {size}") if value > 0.0 else tr("R {size}")).format(size=size)


def _titles() -> dict[str, tuple[str, str]]:
    """Return what each figure is called, and what it is; the most telling first."""
    return {
        "higher": (tr("Height"), tr("Difference in height of the bust points.")),
        "further_out": (tr("Protrusion"), tr("Difference in forward position of the bust points.")),
        "in_all": (
            tr("Excess volume"),
            tr("Net volume by which one breast protrudes beyond the mirror image of the other, in ml."),
        ),
        "mean": (
            tr("Mean distance"),
            tr(
                "Distance between the skin of one breast and the mirror image of the other; mean of both "
                "sides."
            ),
        ),
        "further_aside": (
            tr("Lateral offset"),
            tr("Difference in distance of the bust points from the symmetry plane."),
        ),
        "largest": (
            tr("Max. distance"),
            tr("Largest distance between one side and the mirror image of the other side."),
        ),
        "seat_higher": (tr("Buttock height"), tr("Difference in height of the buttock points.")),
        "seat_further_back": (
            tr("Buttock protrusion"),
            tr("Difference in backward position of the buttock points."),
        ),
        "seat_fold_higher": (tr("Gluteal fold height"), tr("Difference in height of the gluteal folds.")),
        "left_more": (
            tr("Left excess"),
            tr("Volume between the skin and its mirror image where the left side protrudes."),
        ),
        "right_more": (
            tr("Right excess"),
            tr("Volume between the skin and its mirror image where the right side protrudes."),
        ),
    }


def _rests_on() -> tuple[str, ...]:
    return (
        tr("L, R: side with the larger value. Tick in the bar: value of the original body."),
        tr("The symmetry plane is the best fit to the trunk without the breasts."),
        tr("Lines move tissue at constant volume: they do not reduce the volume difference of the breasts."),
    )


def _hint(stages: Stages, now: SideDifference) -> tuple[str, bool]:
    """Return what is done before lengths are looked for, or why they are not; and whether they can be."""
    pairs, design = uneven_pairs(stages, now), stages.design
    if not pairs:
        return "", False
    linked = [each for each in pairs if not moves_one_side(stages.regions[each.region])]
    template = read_template(design.template)
    names = tuple(name for each in linked for name in splittable_lines(design, template, each))
    if len(linked) < len(pairs) and not names:
        return "", True
    if not names:
        return tr(
            "To balance the sides, activate a line on one side, or an unlocked line across both."
        ), False
    return tr("Balancing unlinks left and right: {lines}.").format(
        lines=listed(split_titles(design, names))
    ), True


def split_titles(design: Design, names: tuple[str, ...]) -> list[str]:
    """Return what lines that are parted are called, a pair once."""
    return list(dict.fromkeys(row_title(name, design) for name in names))


def not_balanced_reason(gained: float, lost: float) -> tuple[str, str]:
    """Return why a design is not made even, and what could be done; both in mm, see ``Evened``."""
    text = tr(
        "The active lines cannot reduce the asymmetry further: {gained} gain would move both sides by {lost}."
    )
    hint = tr("Add a line that acts on one side only, such as a strap.")
    return text.format(gained=length(max(gained, 0.0)), lost=length(lost)), hint


def has_balance_targets(goals: Sequence[Goal]) -> bool:
    """Return whether the targets are equal sides, and no profile."""
    names = [goal.name for goal in goals]
    return not {*BUST_PAIR.even, *SEAT_PAIR.even}.isdisjoint(names) and not any(map(section_of, names))


def balance_result_texts(
    reply: InverseResult, goals: Sequence[Goal], now: Mapping[str, float], then: Mapping[str, float]
) -> tuple[str, str, str]:
    """Return in short lines what an answer brings nearer; then what that costs, and why it is no nearer.

    ``now`` and ``then`` [mm] are figures before and after: what both sides do together is to stay.
    """
    met = is_met(reply, goals)
    come = {**then, **reply.reached}
    wanted = {goal.name: goal.value for goal in goals}
    kept = (*BUST_PAIR.kept, *SEAT_PAIR.kept)
    wanted |= {name: now[name] for name in kept if name in now and name not in wanted}
    nearer = {name: abs(come[name] - mm) - abs(now[name] - mm) for name, mm in wanted.items() if name in now}
    line = tr("{quantity}: {before} → {after}")
    lines = [_way(name, now[name], come[name], line) for name, by in nearer.items() if by < -_SEEN]
    beside = tr("{quantity} {before} → {after}")
    price = listed(_way(name, now[name], come[name], beside) for name, by in nearer.items() if by > _SEEN)
    costs = tr("Trade-off: {values}").format(values=price) if price else ""
    of_bust = not wanted.keys().isdisjoint(BUST_PAIR.even)
    by_turns = _by_turns(reply.design) if of_bust else ""
    why = "\n".join(filter(None, ("" if met else stop_text(reply), by_turns)))
    return "\n".join((_outcome(reply, met), *lines)), costs, why


def _by_turns(design: Design) -> str:
    """Return why the measures of a design will tell other figures than its exact answer, if they will."""
    if design.volume in ("exact", "none") or design.volume_of == "both":
        return ""
    return tr(
        "Values of the exact solution, which conserves the volume of each breast. Iterations conserve the "
        "combined volume: in Measurements, lengths may differ by up to {length} and volumes by 10 to 20 "
        "ml."
    ).format(length=length(1.0, 0))


def _outcome(reply: InverseResult, met: bool) -> str:
    if met:
        return tr("All targets reached.")
    return tr("Not reachable. Closest result:") if reply.agreed else tr("Closest result:")


def _way(name: str, before: float, after: float, text: str) -> str:
    """Return the change of a value, in the form ``said``: with its side in place of a sign, if it has one."""
    titles = {
        HIGHER: (tr("Left higher"), tr("Right higher")),
        FURTHER_OUT: (tr("Left further forward"), tr("Right further forward")),
        "left buttock higher": (tr("Left buttock point higher"), tr("Right buttock point higher")),
        "left fold higher": (tr("Left gluteal fold higher"), tr("Right gluteal fold higher")),
    }
    if name not in titles:
        signed = is_signed(name)
        values = {"before": length_number(before, 1, signed), "after": length(after, 1, signed)}
        return text.format(quantity=target_title(name), **values)
    one, other = (titles[name][each < 0.0] for each in (before, after))
    values = {"before": length_number(abs(before)), "after": length(abs(after))}
    if min(abs(before), abs(after)) < _SEEN:  # even has no side
        one = other = one if abs(before) >= abs(after) else other
    if one != other:
        text = tr("{quantity} {before} → {other} {after}")
        values["before"] = length(abs(before))
    return text.format(quantity=one, other=other, **values)


@dataclass(frozen=True)
class SymmetryRowView:
    """One figure: its title, the ``before`` and ``after`` as they are written, and its tooltip.

    ``shares`` say how far the bar goes before and after, -1 to 1: positive towards the left; None where
    there is no side or it is not known. ``off`` is how far it may be off, as it is written; a difference
    ``within`` that may be none.
    """

    title: str
    before: str
    after: str
    tip: str
    shares: tuple[float | None, float | None] = (None, None)
    off: str = ""
    within: bool = False


@dataclass(frozen=True)
class SymmetryView:
    """The summary: a sentence, values, ``notes`` on them, and the first step of balancing.

    ``hint`` says what is done first, or why nothing can be; ``possible`` whether anything can.
    """

    says: str
    views: tuple[SymmetryRowView, ...]
    notes: tuple[str, ...]
    hint: str
    possible: bool
