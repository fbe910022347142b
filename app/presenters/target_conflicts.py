"""Words for targets that conflict and for lines that are switched on."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from app.i18n.catalog import listed, number, tr
from app.i18n.lengths import length, length_unit
from app.presenters.lines import told_title
from app.presenters.target_shape import figure_title, is_met, is_signed, nearest_words
from core.analysis.inverse_design.profile_quantity import section_of
from core.analysis.inverse_design.quantities import Goal
from core.document.design import Design

if TYPE_CHECKING:
    from core.analysis.inverse_design.conflicts import Conflict
    from core.analysis.inverse_design.solve import Reply


def conflict_words(conflicts: Iterable[Conflict]) -> tuple[str, ...]:
    """Return one sentence per target that is missed: its value alone, and what another one loses."""
    return tuple(map(_sentence, conflicts))


def _sentence(conflict: Conflict) -> str:
    name, alone = figure_title(conflict.name), _value(conflict.name, conflict.alone)
    if not conflict.against:
        return tr("{target}: {value} is the nearest even as the only target.").format(
            target=name, value=alone
        )
    words = tr(
        "{target} conflicts with {other}: as the only target {value}, with {other} at {lost} instead of "
        "{kept} ({price} {unit} per {unit})."
    )
    lost, kept = (_value(conflict.against, value) for value in (conflict.lost, conflict.kept))
    other, price = figure_title(conflict.against), number(conflict.price, 2)
    values = {"value": alone, "lost": lost, "kept": kept, "price": price, "unit": length_unit()}
    return words.format(target=name, other=other, **values)


def _value(name: str, value: float) -> str:
    size = length(value, 1, signed=is_signed(name))
    return tr("{length} off").format(length=size) if section_of(name) else size


def unlimited_words(free: Reply, goals: Sequence[Goal], now: Mapping[str, float]) -> str:
    """Return what targets come to without a limit of pressure, and what lines press with then."""
    most = number(max(free.pressure.values(), default=0.0))
    if is_met(free, goals):
        return tr("All targets are met without the pressure limit, with {kpa} kPa.").format(kpa=most)
    words = tr("Nearest without the pressure limit: {figures}, with {kpa} kPa.")
    return words.format(figures=nearest_words(free, goals, now), kpa=most)


def switched_words(before: Design, after: Design) -> str:
    """Return which lines an answer switches on, if it does."""
    lines = _titles(after.worn() - before.worn(), after)
    return tr("Switched on: {lines}.").format(lines=lines) if lines else ""


def inactive_words(design: Design, names: Iterable[str]) -> str:
    """Return which lines that are off may be switched on; empty if there are none."""
    lines = _titles(names, design)
    words = tr("Switch on inactive lines where they bring the targets nearer: {lines}")
    return words.format(lines=lines) if lines else ""


def _titles(names: Iterable[str], design: Design) -> str:
    return listed(dict.fromkeys(told_title(name, design) for name in sorted(names)))
