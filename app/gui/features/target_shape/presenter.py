"""Content of the target card: targets and resulting values."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from app.gui.features.target_shape.card import TargetCard
from app.gui.features.target_shape.row import TargetView
from app.gui.features.target_shape.targets import PRESSURE, Targets
from app.gui.features.target_shape.worker import TargetAnswer
from app.i18n.catalog import joined, listed, tr
from app.presenters.symmetry import balance_result_texts, has_balance_targets
from app.presenters.target_shape import (
    activated_text,
    bust_movement_text,
    change_text,
    conflict_text,
    deviation_text,
    formatted_value,
    is_met,
    is_near,
    locked_lines_text,
    pressure_text,
    profile_title,
    result_text,
    target_result_text,
    target_title,
    unlimited_text,
)
from core.analysis.inverse_design.profile_quantities import is_signed
from core.analysis.inverse_design.quantity import Goal
from core.document.design import Design
from core.garment.pressure import pressure_limits

if TYPE_CHECKING:
    from core.analysis.inverse_design.solve import InverseResult


def show_result(
    card: TargetCard, design: Design, wishes: Targets, answer: TargetAnswer | None, *, apart: str, busy: str
) -> None:
    """Show what came of wishes: ``busy`` is nothing, "soon" or "slow"; ``apart`` tells what is parted."""
    locked = {traits.name for traits in design.traits if traits.locked}
    note = joined([words for words in (apart, locked_lines_text(design, locked)) if words])
    goals = wishes.goals(answer.now if answer is not None else {})
    if busy == "slow":
        card.show_answer(tr("Computing…"), note=note, can_apply=True)
    elif answer is None or answer.reply is None or not goals:
        card.show_answer(note=note, can_apply=bool(busy and goals))
    else:
        reply, asked = answer.reply, answer.question.goals
        met = _is_met(wishes, reply, asked)
        text = result_text(reply, asked, wishes.only_limit, answer.now)
        price, why = bust_movement_text(asked, answer.now, answer.then), ""
        conflicts, switched = conflict_text(answer.conflicts), activated_text(design, reply.design)
        if has_balance_targets(asked) and wishes.only_limit is None:
            text, price, why = balance_result_texts(reply, asked, answer.now, answer.then)
            conflicts = ()  # that sentence names the price
        free = "" if answer.unlimited is None else unlimited_text(answer.unlimited, asked, answer.now)
        lines = listed(change_text(design, reply))
        changes = "\n".join(filter(None, (free, why, lines, switched, *conflicts)))
        tone = "ok" if met else "" if is_near(reply, asked) else "warn"
        card.show_answer(text, tone, price, changes, note, can_apply=True)


def meets_targets(wishes: Targets, answer: TargetAnswer) -> bool:
    """Return whether a result meets the targets within the accuracy of tailoring."""
    reply, asked = answer.reply, answer.question.goals
    return reply is not None and (_is_met(wishes, reply, asked) or is_near(reply, asked))


def _is_met(wishes: Targets, reply: InverseResult, asked: Sequence[Goal]) -> bool:
    return is_met(reply, asked) or (wishes.only_limit is not None and reply.agreed)


def target_views(wishes: Targets, answer: TargetAnswer | None) -> Iterator[TargetView]:
    """Yield the rows of the card: each what it is now, what is asked for, what it comes to and its change."""
    now = answer.now if answer is not None else {}
    then = answer.then if answer is not None else {}
    for name, value in wishes.figures.items():
        signed, priority = is_signed(name), wishes.priorities.get(name, "normal")
        before, result = formatted_value(now.get(name), signed), target_result_text(now, then, name)
        yield TargetView(name, target_title(name), value, before, result, signed=signed, priority=priority)
    for section, goals in wishes.curves.items():
        reply = answer.reply if answer is not None else None
        words = deviation_text(answer.question.goals, reply.reached, section) if answer and reply else ""
        title, priority = profile_title(section.split()[1]), wishes.priorities.get(section, "normal")
        asked = 0.0 if goals else None
        yield TargetView(section, title, asked, words, typed=False, priority=priority)
    yield _pressure(wishes, answer)


def _pressure(wishes: Targets, answer: TargetAnswer | None) -> TargetView:
    presses = answer.presses if answer is not None else {}
    reply = answer.reply if answer is not None else None
    then = reply.pressure if reply is not None else {}
    before, result = pressure_text(presses, then)
    tone = "bad" if result and max(then.values()) >= pressure_limits().red_kpa else ""
    on = not math.isinf(wishes.most_kpa)
    shown, title = wishes.most_kpa if on else None, tr("Contact pressure limit")
    return TargetView(
        PRESSURE, title, shown, before, result, "kPa", signed=False, kept=True, priority="", on=on, tone=tone
    )
