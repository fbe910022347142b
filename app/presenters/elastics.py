"""Format elastics: origin, forces at round elongations, and the effect of each on a line."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from app.i18n.catalog import joined, number, tr, tr_context
from app.i18n.lengths import length, length_number, width_number
from app.presenters.messages import elastic_title, render
from app.presenters.pressure import rating_text
from core.document.design import Design
from core.document.elastic import Elastic
from core.garment.elastic_options import KEEP_CUT, KEEP_FIT, ElasticOption, Outcome, nearest, strongest
from core.garment.pressure import pressure_limits


def elastic_views(
    own: Iterable[Elastic], built_in: Iterable[Elastic], kept: Iterable[Elastic]
) -> list[ElasticView]:
    """Return the designer's own first, those that a project brings along, then ours.

    One of the designer's own stands in the place of one of ours of the same name.
    """
    own, built_in = list(own), list(built_in)
    names = {each.name for each in own}
    brought = [each for each in kept if each not in own and each not in built_in]
    return [
        *(_view(each, tr("custom"), True) for each in own),
        *(_view(each, tr("this project"), False) for each in brought if each.name not in names),
        *(_view(each, "Busk", False) for each in built_in if each.name not in names),
    ]


def _view(elastic: Elastic, where: str, own: bool) -> ElasticView:
    forces = tuple(number(elastic.force(e), 1) if e <= elastic.max_elongation + 1e-9 else "" for e in TOLD_AT)
    return ElasticView(
        elastic.name,
        elastic.name if own else elastic_title(elastic.name),
        tr("{where}, estimate").format(where=where) if elastic.estimate else where,
        width_number(elastic.width_mm),
        forces,
        width_number(elastic.allowance_mm),
        tr_context("elastic", elastic.source),
        elastic.estimate,
        own,
        elastic.curve,
    )


TOLD_AT = (0.2, 0.4, 0.6, 0.8)
"""Elongations that the table has forces at [1]."""


@dataclass(frozen=True)
class ElasticView:
    """One elastic: its ``name`` as it is kept and ``title`` as it is shown, ``where`` it comes from.

    ``curve`` are points (elongation [1], force [N]); ``forces`` those at TOLD_AT as they are read, empty
    beyond the end of the curve. ``own`` ones can be taken away.
    """

    name: str
    title: str
    where: str
    width: str
    forces: tuple[str, ...]
    allowance: str
    source: str
    estimate: bool
    own: bool
    curve: tuple[tuple[float, float], ...]


LEAST_LIFT = 0.5
"""A lift below this is not compared in percent [mm]."""

LEAST_LENGTH = 0.5
"""A band that is longer by less than this counts as equally long [mm]."""

Options = Mapping[int, ElasticOption]
"""What is known of the elastics of a list, by place."""


def mode_titles() -> list[tuple[str, str]]:
    """Return both modes with their titles."""
    return [(KEEP_FIT, tr("Keep length on body")), (KEEP_CUT, tr("Keep cut length"))]


def mode_text(mode: str, design: Design) -> str:
    """Return what a mode means for cutting the garment."""
    if design.line_hold == "held":
        return tr("Line lengths are fixed in this design: an elastic changes the cut length, not the shape.")
    if mode == KEEP_FIT:
        return tr("Keep the length on the body: softer elastics are cut shorter.")
    return tr(
        "Cut the elastic to the set length of the line: on the body the band is longer and shapes less."
    )


def effect_text(outcome: Outcome, rigid: Outcome) -> str:
    """Return the lift with an elastic against that of a band that does not stretch."""
    with_it, without = (length(each.lift, signed=True) for each in (outcome, rigid))
    if kept := kept_text(outcome, rigid):
        words = tr("Lift {lift}: {kept} of the {rigid} obtained with an inextensible band.")
        return words.format(lift=with_it, kept=kept, rigid=without)
    return tr("Lift {lift}; with an inextensible band {rigid}.").format(lift=with_it, rigid=without)


def kept_text(outcome: Outcome, rigid: Outcome) -> str:
    """Return the share of the lift that is kept, or nothing where there is none to compare with."""
    if rigid.lift < LEAST_LIFT:
        return ""
    return f"{number(100.0 * max(outcome.lift, 0.0) / rigid.lift, 0)} %"


def choice_view(
    title: str, option: ElasticOption | None, rigid: Outcome | None, names: Sequence[str], design: Design
) -> ChoiceView:
    """Return a row of the chooser; ``rigid`` is the outcome with bands that do not stretch, once known."""
    if option is None:
        return ChoiceView(title, note=tr("Computing…"))
    outcome = option.outcome or option.closest
    if outcome is None:
        return ChoiceView(title, note=render(option.reason, design))
    rows = [outcome.rows[name] for name in names if name in outcome.rows]
    far, usable = any(row.far for row in rows), option.outcome is not None
    stretch = [row.elongation for row in rows if row.elongation is not None]
    one = rows[0] if rows and set(names) <= set(design.linked_lines(names[0])) else None
    name = one.line if one is not None else ""
    kpa = max((outcome.kpa[each] for each in names if each in outcome.kpa), default=None)
    light = "" if kpa is None else pressure_limits().rating(kpa)
    return ChoiceView(
        title,
        number(100.0 * max(stretch), 0) if stretch else "",
        length_number(one.cut_mm, 0) if one is not None and one.cut_mm is not None else "",
        length_number(one.reached_front_mm) if one is not None else "",
        length_number(outcome.lift, signed=True),
        "" if kpa is None else f"{rating_text(light)} · {number(kpa)}",
        light,
        _note(option, rigid, far, name) if usable else render(option.reason, design),
        usable,
        far and usable,
    )


def _longer(outcome: Outcome, rigid: Outcome, name: str) -> float:
    """Return how much longer a line is on the body than a band that does not stretch [mm]."""
    if not {name} <= outcome.rows.keys() & rigid.rows.keys():
        return 0.0
    return outcome.rows[name].reached_front_mm - rigid.rows[name].reached_front_mm


def _note(option: ElasticOption, rigid: Outcome | None, far: bool, name: str) -> str:
    """Return what is lost with an elastic; ``name`` is that of the line, empty for several."""
    if option.elastic is None:
        return tr("Inextensible; no cut length")
    notes = []
    assert option.outcome is not None
    longer = _longer(option.outcome, rigid, name) if rigid is not None and name else 0.0
    if longer > LEAST_LENGTH:
        notes.append(tr("{length} longer on body").format(length=length(longer)))
    if far:
        end = f"{100 * option.elastic.max_elongation:g}"
        notes.append(tr("High elongation: the curve ends at {end} %").format(end=end))
    kept = kept_text(option.outcome, rigid) if rigid is not None else ""
    if kept:
        notes.append(tr("Lift: {kept}").format(kept=kept))
    return " · ".join(notes)


def advice_view(
    place: int, options: Options, titles: Sequence[str], names: Sequence[str], design: Design
) -> AdviceView:
    """Return what the elastic at a place does, or the nearest that can be used in its stead."""
    option, rigid = options.get(place), options[0].outcome if 0 in options else None
    if option is None:
        return AdviceView("")
    if option.outcome is not None:
        told = option.elastic is not None and rigid is not None
        return AdviceView(effect_text(option.outcome, rigid) if told and rigid is not None else "")
    lines, offers = [render(option.reason, design)], []
    if option.closest is not None:
        lines = [joined((*lines, effect_text(option.closest, rigid) if rigid is not None else ""))]
        offers.append((tr("Use maximum elongation"), place, True))
    other = _other(option, options, titles, names)
    if other is not None:
        at, limited = other
        offers.append((_offer(titles[at], limited), at, limited))
        lines.append(_other_text(options[at], titles[at], limited, rigid))
    elif (
        option.closest is None
        and option.problem is not None
        and option.problem.hint not in option.reason.sentences
    ):
        lines.append(render(option.problem.hint, design))
    return AdviceView("\n".join(each for each in lines if each), tuple(offers), "warn")


def next_step(option: ElasticOption, options: Sequence[ElasticOption], names: Sequence[str]) -> str:
    """Return what to do about an elastic that cannot be used, among those of a list."""
    assert option.elastic is not None
    other = nearest(options, option.elastic)
    if other is not None and other.elastic is not None:
        return tr("Nearest suitable elastic: {elastic}.").format(elastic=elastic_title(other.elastic.name))
    best = strongest(options, names)
    if best is None or best.elastic is None:
        return ""
    words = tr("No elastic is suitable at this length; {elastic} is nearest.")
    return words.format(elastic=elastic_title(best.elastic.name))


def _other(
    option: ElasticOption, options: Options, titles: Sequence[str], names: Sequence[str]
) -> tuple[int, bool] | None:
    """Return the place of the nearest elastic that can be used, or that comes nearest at its limit."""
    if len(options) < len(titles) or option.elastic is None:
        return None  # not all are known yet
    known = list(options.values())
    found, limited = nearest(known, option.elastic), False
    if found is None:
        found, limited = strongest(known, names), True
    at = next((at for at, each in options.items() if each is found), None)
    return None if at is None or found is option else (at, limited)


def _offer(title: str, limited: bool) -> str:
    words = tr("Use {elastic} at maximum elongation") if limited else tr("Use {elastic}")
    return words.format(elastic=title)


def _other_text(option: ElasticOption, title: str, limited: bool, rigid: Outcome | None) -> str:
    outcome = option.closest if limited else option.outcome
    assert outcome is not None
    words = tr("Nearest suitable elastic: {elastic}.")
    if limited:
        words = tr("No elastic is suitable at this length; {elastic} is nearest.")
    effect = effect_text(outcome, rigid) if rigid is not None else ""
    return joined((words.format(elastic=title), effect))


def title_of(elastic: Elastic | None) -> str:
    """Return what an elastic is called, or that there is none."""
    return elastic_title(elastic.name) if elastic is not None else tr("No elastic")


@dataclass(frozen=True)
class ChoiceView:
    """One elastic as it is read: stretch [%], lengths to cut and on the body, lift, and a note on it.

    ``pressure`` is the contact pressure with the word of its ``light``, see ``core.garment.pressure``. One
    that is not ``usable`` is grey, and its note states why. A value that is not known is an empty text.
    """

    title: str
    stretch: str = ""
    cut: str = ""
    reached: str = ""
    lift: str = ""
    pressure: str = ""
    light: str = ""
    note: str = ""
    usable: bool = False
    far: bool = False


@dataclass(frozen=True)
class AdviceView:
    """What the marked elastic does, or what to do where it cannot be used.

    ``offers`` are choices by one click: label, row, and whether it is used at its limit.
    """

    words: str
    offers: tuple[tuple[str, int, bool], ...] = ()
    tone: str = ""
