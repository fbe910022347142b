"""Format target shapes: targets, reachability, conflicts, line changes."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from app.i18n.catalog import colon, joined, listed, number, tr
from app.i18n.lengths import length, length_number, length_unit
from app.presenters.lines import told_title
from core.analysis.inverse_design.bust_quantities import FURTHER_OUT, GIRTH, HIGHER, LIFT, OUT
from core.analysis.inverse_design.profile_quantities import is_signed, profile_deviations, section_of
from core.analysis.inverse_design.quantity import Goal
from core.document.design import Design
from core.geometry.mesh import Floats
from core.mechanics.mesh_quality import STRAINED_RANGE

if TYPE_CHECKING:
    from core.analysis.inverse_design.conflicts import Conflict
    from core.analysis.inverse_design.solve import InverseResult


_MET = 0.05  # [mm]
_LIKE = 0.5  # of a profile [mm]
_NEAR, _NEAREST = 1.0, 5.0  # of one that is as good as met, on average and anywhere: less is not drawn [mm]
_MUCH = 0.5  # of what a profile was off: an answer that leaves more has hardly brought it nearer [1]
_ABOUT = 1.015  # of a limit that counts as kept
SAME = 5e-4
"""Ratios that are this near to each other read the same [1]."""


def target_title(name: str) -> str:
    """Return what a figure that can be asked for is called in the window."""
    titles = {
        "lift": tr("Bust point lift"),
        "out": tr("Bust point, forward"),
        "apex lift": tr("Apex lift"),
        "apex out": tr("Apex, forward"),
        GIRTH: tr("Bust girth"),
        "waist girth": tr("Waist girth"),
        "belly girth": tr("Belly girth"),
        "hip girth": tr("Hip girth"),
        "belly out": tr("Belly, forward"),
        "buttock lift": tr("Buttock point lift"),
        "buttock out": tr("Buttock point, backward"),
        "fold lift": tr("Gluteal fold lift"),
        "left buttock higher": tr("Left buttock higher than right"),
        "left fold higher": tr("Left gluteal fold higher than right"),
        HIGHER: tr("Left higher than right"),
        FURTHER_OUT: tr("Left further forward than right"),
    }
    if name in titles:
        return titles[name]
    if name.startswith("profile "):
        return profile_title(name.split()[1])
    what, _, side = name.rpartition(" ")
    return listed((titles.get(what, what), tr("left") if side == "left" else tr("right")))


def profile_title(section: str) -> str:
    """Return what the profile of a section is called: "left", "right", or its x [mm]."""
    sides = {"left": tr("Profile through the left bust point")}
    sides["right"] = tr("Profile through the right bust point")
    if section in sides:
        return sides[section]
    x = float(section)
    return tr("Profile at {x}").format(x=length(x, 0 if x.is_integer() else 1))


def target_text(name: str, value: float) -> str:
    """Return a figure with its value: "Bust point up +12.0 mm"."""
    return tr("{quantity} {value}").format(
        quantity=target_title(name), value=length(value, 1, signed=is_signed(name))
    )


def targets_text(goals: Sequence[Goal]) -> str:
    """Return in a few words what is asked for."""
    single = [target_text(goal.name, goal.value) for goal in goals if not section_of(goal.name)]
    return listed((*single, *dict.fromkeys(target_title(g.name) for g in goals if section_of(g.name))))


def result_text(
    reply: InverseResult,
    goals: Sequence[Goal],
    limit: float | None = None,
    now: Mapping[str, float] | None = None,
) -> str:
    """Return in a sentence whether it can be reached, else what is nearest and why.

    With a ``limit`` [kPa] it was asked for that alone; ``goals`` are then what is to stay. ``now`` [mm] is
    what figures were before, if that is known.
    """
    most = max(reply.pressure.values(), default=0.0)
    if limit is not None and reply.agreed and most < _ABOUT * limit:
        text = tr("Contact pressure at most {kpa} kPa; result: {values}.")
        return text.format(kpa=number(most), values=listed(_come(reply, goals)))
    if reply.reachable:
        return tr("All targets reached.")
    if is_met(reply, goals):
        most = max(float(np.abs(off).max()) for off in profile_deviations(goals, reply.reached).values())
        return tr("Reached within {length}.").format(length=length(most))
    if is_near(reply, goals):
        return _near_text(reply, goals, now or {})
    nearest = closest_result_text(reply, goals, now or {})
    text = (
        tr("Not reachable. Closest result: {nearest}.") if reply.agreed else tr("Closest result: {nearest}.")
    )
    return joined((text.format(nearest=nearest), stop_text(reply)))


def _near_text(reply: InverseResult, goals: Sequence[Goal], now: Mapping[str, float]) -> str:
    """Return how nearly profiles are met, and what they were off if that was hardly more."""
    offs = profile_deviations(goals, reply.reached)
    section = max(offs, key=lambda each: float(np.abs(offs[each]).mean()))
    before = _off_before(goals, now, section)
    if before is None or float(np.abs(offs[section]).mean()) <= _MUCH * before:
        text, why = tr("Reached with a mean deviation of {mean}, maximum {most}."), ""
    else:
        text = tr("Closest result: mean deviation {mean}, maximum {most} (before: {before}).")
        why = stop_text(reply)
    values = {**_mean_and_most(offs[section]), "before": length(before or 0.0)}
    return joined((text.format(**values), why))


def _off_before(goals: Sequence[Goal], now: Mapping[str, float], section: str) -> float | None:
    """Return how far a profile was off on average [mm]; None where that is not known."""
    there = [goal for goal in goals if section_of(goal.name) == section]
    before = [abs(now[goal.name] - goal.value) for goal in there if goal.name in now]
    return float(np.mean(before)) if before else None


def _come(reply: InverseResult, goals: Sequence[Goal]) -> Iterable[str]:
    """Yield what figures come to that were to stay."""
    for goal in goals:
        if abs(reply.reached[goal.name] - goal.value) > _MET:
            yield _from_to(goal.name, goal.value, reply.reached[goal.name])
        else:
            yield target_text(goal.name, reply.reached[goal.name])


def closest_result_text(reply: InverseResult, goals: Sequence[Goal], now: Mapping[str, float]) -> str:
    """Return what targets that are missed come to, and how far profiles are off."""
    return listed(_nearest(reply, goals, now))


def _nearest(reply: InverseResult, goals: Sequence[Goal], now: Mapping[str, float]) -> Iterable[str]:
    missed = [goal for goal in goals if not section_of(goal.name)]
    missed = [goal for goal in missed if abs(reply.reached[goal.name] - goal.value) > _MET] or missed
    for goal in missed:
        yield target_text(goal.name, reply.reached[goal.name])
    profiles = profile_deviations(goals, reply.reached)
    for section, off in profiles.items():
        text = tr("profile deviation {mean} on average ({most} maximum)")
        if len(profiles) > 1:
            text = tr("{profile}: deviation {mean} on average ({most} maximum)")
        words = text.format(profile=target_title(section), **_mean_and_most(off))
        before = _off_before(goals, now, section)
        if before is not None:
            words += tr(", {before} before").format(before=length(before))
        yield words


def bust_movement_text(goals: Sequence[Goal], now: Mapping[str, float], then: Mapping[str, float]) -> str:
    """Return how the bust points move with a profile where they are free; empty where they stay.

    ``now`` and ``then`` [mm] are figures before and after.
    """
    if not any(section_of(goal.name) for goal in goals):
        return ""
    asked = {goal.name.removesuffix(" left").removesuffix(" right") for goal in goals}
    free = [name for name in (LIFT, OUT) if name not in asked and name in now and name in then]
    moved = [_from_to(name, now[name], then[name]) for name in free if abs(then[name] - now[name]) > _MET]
    return tr("Other changes: {values}").format(values=listed(moved)) if moved else ""


def _from_to(name: str, before: float, after: float) -> str:
    """Return a figure with what it was and what it comes to: "Bust point up +0.2 → +0.4 mm"."""
    text, signed = tr("{quantity} {before} → {after}"), is_signed(name)
    values = {"before": length_number(before, 1, signed=signed), "after": length(after, 1, signed=signed)}
    return text.format(quantity=target_title(name), **values)


def deviation_text(goals: Sequence[Goal], reached: Mapping[str, float], section: str) -> str:
    """Return how far what is ``reached`` is off the profile of a section: mean and largest distance."""
    off = profile_deviations(goals, reached).get(section)
    if off is None:
        return ""
    return tr("mean deviation {mean}, maximum {most}").format(**_mean_and_most(off))


def is_met(reply: InverseResult, goals: Sequence[Goal]) -> bool:
    """Return whether a result meets the targets, a profile within the accuracy of tailoring."""
    near = {goal.name: abs(reply.reached[goal.name] - goal.value) for goal in goals}
    within = all(off <= (_LIKE if section_of(name) else _MET) for name, off in near.items())
    return reply.reachable or (reply.agreed and not reply.at_pressure_limit and within)


def is_near(reply: InverseResult, goals: Sequence[Goal]) -> bool:
    """Return whether all but profiles is met, and these within the accuracy of drawing."""
    offs = [np.abs(off) for off in profile_deviations(goals, reply.reached).values()]
    single = [goal for goal in goals if not section_of(goal.name)]
    met = all(abs(reply.reached[goal.name] - goal.value) <= _MET for goal in single)
    near = all(off.mean() < _NEAR and off.max() < _NEAREST for off in offs)
    return bool(reply.agreed and offs and met and near)


def _mean_and_most(off: Floats) -> dict[str, str]:
    return {"mean": length(float(np.abs(off).mean())), "most": length(float(np.abs(off).max()))}


def stop_text(reply: InverseResult) -> str:
    """Return why the search ended before the targets, in one sentence."""
    if not reply.agreed:
        return tr("The iteration over lengths, elastics and contact pressure did not converge.")
    if limits := _limits(reply):
        return tr("Stopped at a limit: {limits}.").format(limits=tr("; ").join(limits))
    return tr("No limit is reached: the active lines cannot produce this movement.")


def reasons(reply: InverseResult) -> list[str]:
    """Return why an answer is not what was asked for, as parts of a sentence."""
    return _limits(reply) or [tr("the active lines cannot produce this movement")]


def _limits(reply: InverseResult) -> list[str]:
    """Return the limits that an answer has reached, with their values."""
    limits = []
    for title, name in _rows(reply.at_limit, reply.design):
        long = reply.may_not_be_longer(name)
        text = (
            tr("{line}: longest length, {percent} %") if long else tr("{line}: shortest length, {percent} %")
        )
        limits.append(text.format(line=title, percent=number(100.0 * reply.design.ratio(name))))
    slack = [name for name in reply.slack if name not in reply.at_limit]
    limits += [
        text.format(lines=_titles(names, reply.design), kpa=number(reply.limit))
        for names, text in (
            (slack, tr("{lines}: slack, the tension would be negative")),
            (reply.at_pressure_limit, tr("{lines}: contact pressure limit of {kpa} kPa")),
        )
        if names
    ]
    if reply.strained:
        percent = 100.0 * (STRAINED_RANGE[1] - 1.0)
        limits.append(tr("skin strain limit of {percent} %").format(percent=number(percent, 0)))
    return limits


def change_text(before: Design, reply: InverseResult) -> list[str]:
    """Return how lengths would change, row by row, what elastics press with, and if others were not asked."""
    after, texts = reply.design, []
    for title, name in _rows(sorted(after.all_active_lines()), after):
        one, other = before.ratio(name), after.ratio(name)
        if abs(one - other) >= SAME:
            words = tr("{line} {before} → {after} %") + " ({change})"
            values = {"before": number(100.0 * one), "after": number(100.0 * other)}
            values["change"] = number(100.0 * (other - one), 1, True)
            texts.append(words.format(line=title, **values))
    texts = texts or [tr("No line changes")]
    if reply.pressure:
        most = max(reply.pressure.values())
        texts.append(tr("contact pressure at most {kpa} kPa").format(kpa=number(most)))
    if reply.unchecked and reply.pressure:
        lines = _titles(reply.unchecked, after)
        texts.append(tr("contact pressure of {lines} not checked: see Garment").format(lines=lines))
    elif reply.unchecked:
        texts.append(tr("contact pressure not checked: see Garment"))
    return texts


def locked_lines_text(design: Design, kept: Collection[str]) -> str:
    """Return which worn lines stay because they are locked, if any do."""
    lines = _titles([name for name in sorted(design.all_active_lines()) if name in kept], design)
    return tr("Locked, not changed: {lines}.").format(lines=lines) if lines else ""


def missing_input_text(design: Design, moving: Collection[str]) -> str:
    """Return what has to be done before anything can be asked, if there is something; see ``free_lines``."""
    lines = design.all_active_lines() & set(moving)
    if not lines:
        return tr("Activate lines first: choose a preset or shorten a line.")
    if all(design.line_settings(name).locked for name in lines):
        return tr("All active lines are locked. Unlock at least one line.")
    return ""


def step_text(goals: Sequence[Goal], limit: float | None = None) -> str:
    """Return what the step of undo is called; a ``limit`` [kPa] was asked for besides, or alone."""
    wishes = [targets_text(goals)] if goals else []
    if limit is not None:
        wishes.append(tr("{kpa} kPa at most").format(kpa=number(limit)))
    return tr("Targets") + colon() + listed(wishes)


def _titles(names: Iterable[str], design: Design) -> str:
    return listed(title for title, _ in _rows(names, design))


def _rows(names: Iterable[str], design: Design) -> list[tuple[str, str]]:
    """Return titles of rows with the first of their lines."""
    rows: dict[str, str] = {}
    for name in names:
        rows.setdefault(told_title(name, design), name)
    return list(rows.items())


def formatted_value(value: float | None, signed: bool) -> str:
    """Return what a figure is now [mm], without its unit; nothing before it is known."""
    return "" if value is None else length_number(value, 1, signed=signed)


def target_result_text(now: Mapping[str, float], then: Mapping[str, float], name: str) -> str:
    """Return what a figure comes to with its change, as "+0.4 (+0.2)"; nothing before it is known."""
    if name not in then or name not in now:
        return ""
    return _with_change(then[name], then[name] - now[name], is_signed(name))


def _with_change(value: float, change: float, signed: bool) -> str:
    return f"{length_number(value, 1, signed=signed)} ({length_number(change, 1, signed=True)})"


def pressure_text(now: Mapping[str, float], then: Mapping[str, float]) -> tuple[str, str]:
    """Return what lines press with at most now [kPa], and what they come to with its change."""
    before = number(most := max(now.values())) if now else ""
    if not now or not then:
        return before, ""
    result = max(then.values())
    return before, f"{number(result)} ({number(result - most, 1, True)})"


def conflict_text(conflicts: Iterable[Conflict]) -> tuple[str, ...]:
    """Return one sentence per target that is missed: its value alone, and what another one loses."""
    return tuple(map(_sentence, conflicts))


def _sentence(conflict: Conflict) -> str:
    name, alone = target_title(conflict.name), _value(conflict.name, conflict.alone)
    if not conflict.against:
        return tr("{target}: the closest result is {value}, even with no other target.").format(
            target=name, value=alone
        )
    words = tr(
        "{target} conflicts with {other}. As the only target, {target} reaches {value}, but {other} "
        "changes from {kept} to {lost} ({price} {unit} lost per {unit} gained)."
    )
    lost, kept = (_value(conflict.against, value) for value in (conflict.lost, conflict.kept))
    other, price = target_title(conflict.against), number(conflict.price, 2)
    values = {"value": alone, "lost": lost, "kept": kept, "price": price, "unit": length_unit()}
    return words.format(target=name, other=other, **values)


def _value(name: str, value: float) -> str:
    size = length(value, 1, signed=is_signed(name))
    return tr("deviation {length}").format(length=size) if section_of(name) else size


def unlimited_text(free: InverseResult, goals: Sequence[Goal], now: Mapping[str, float]) -> str:
    """Return what targets come to without a limit of pressure, and what lines press with then."""
    most = number(max(free.pressure.values(), default=0.0))
    if is_met(free, goals):
        return tr("All targets are reached without the contact pressure limit, at {kpa} kPa.").format(
            kpa=most
        )
    words = tr("Closest result without the contact pressure limit: {values}, at {kpa} kPa.")
    return words.format(values=closest_result_text(free, goals, now), kpa=most)


def activated_text(before: Design, after: Design) -> str:
    """Return which lines an answer switches on, if it does."""
    lines = _titles(sorted(after.all_active_lines() - before.all_active_lines()), after)
    return tr("Activated: {lines}.").format(lines=lines) if lines else ""


def inactive_text(design: Design, names: Iterable[str]) -> str:
    """Return which lines that are off may be switched on; empty if there are none."""
    lines = _titles(sorted(names), design)
    words = tr("Activate inactive lines where they improve the result: {lines}")
    return words.format(lines=lines) if lines else ""
