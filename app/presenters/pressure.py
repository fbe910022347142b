"""Format contact pressure: ratings and limits, values and places."""

from __future__ import annotations

from dataclasses import dataclass, replace

from app.i18n.catalog import colon, joined, language, listed, number, tr
from app.i18n.lengths import length
from app.presenters.lines import LineView, line_colours
from app.presenters.messages import line_title, render, render_all
from app.rendering.palette import CUP_COLOUR
from core.document.design import Design
from core.garment.assessment import UNKNOWN_PRESSURE
from core.garment.pressure import AMBER, GREEN, LEFT_OUT, NOT_FOR_STRAPS, RED, mmhg, pressure_limits
from core.garment.pressure_list import PressureList, PressureRow


def rating_text(light: str) -> str:
    """Return in a word what "green", "amber" or "red" means."""
    return {GREEN: tr("gentle"), AMBER: tr("snug"), RED: tr("too tight")}[light]


def rating_limits() -> RatingLimits:
    """Return the limits of the light in words."""
    limits = pressure_limits()
    told = [f"{each.named(language())}{colon()}{each.words.told(language())}" for each in limits.sources]
    doubts = [words.told(language()) for words in limits.doubts]
    return RatingLimits(
        limits.amber_kpa,
        limits.red_kpa,
        (rating_text(GREEN), rating_text(AMBER), rating_text(RED)),
        limits.sources[0].named(language()),
        (*doubts, *told),
        tuple(map(render, LEFT_OUT)),
    )


def limit_marks() -> tuple[tuple[float, str, str], ...]:
    """Return the limits as marks on a legend: pressure [kPa], tone and word."""
    limits = pressure_limits()
    marks = (limits.amber_kpa, AMBER), (limits.red_kpa, RED)
    return tuple((kpa, TONES[light], rating_text(light)) for kpa, light in marks)


def pressure_views(listed: PressureList, design: Design, stale: bool) -> dict[str, PressureView]:
    """Return what each line presses with, by line; figures of a former shape are ``stale`` and no light."""
    return {row.line: _view(row, design, stale) for row in listed.rows}


def _view(row: PressureRow, design: Design, stale: bool) -> PressureView:
    notes = render_all(row.notes, design)
    if row.max_kpa is None:
        return PressureView("", "", "", "\n".join(notes))
    light = "" if stale else row.light
    word = rating_text(row.light) if light else ""
    told = [*_figures(row), *notes, pressure_limits().description(row.max_kpa).told(language())]
    return PressureView(number(row.max_kpa), light, word, "\n".join(told), stale)


def line_pressure_view(view: LineView, listed: PressureList | None) -> LineView:
    """Return the row of a line with what it presses with, if that is known; of a pair the larger one."""
    known = () if listed is None else listed.rows
    rows = [row for row in known if row.line in view.names and row.max_kpa is not None]
    if not rows:
        return view
    most = max(rows, key=lambda row: row.max_kpa or 0.0)
    words = f"{number(most.max_kpa or 0.0)} kPa · {rating_text(most.light)}"
    return replace(view, pressed=words, tone=TONES[most.light])


def _unmeant(row: PressureRow) -> list[str]:
    """Return that the limits were set for other bands, of a line of which that holds."""
    return [render(note) for note in row.notes if note == NOT_FOR_STRAPS]


def _figures(row: PressureRow) -> list[str]:
    assert row.max_kpa is not None
    assert row.mean_kpa is not None
    most = tr("Maximum {kpa}").format(kpa=kpa_text(row.max_kpa))
    mean = tr("Mean on the skin {kpa}").format(kpa=kpa_text(row.mean_kpa))
    force = tr("Total force on the skin {force} N").format(force=number(row.force_n or 0.0))
    where = listed((most, place_text(row))) if row.where else most
    return [where, mean, force]


def kpa_text(kpa: float) -> str:
    """Return a pressure in kPa and in mmHg."""
    return f"{number(kpa)} kPa · {number(mmhg(kpa), 0)} mmHg"


def side_text(where: str) -> str:
    """Return which side of the body is meant by one of ``core.garment.body_location``."""
    return {
        "front": tr("front"),
        "front left": tr("front left"),
        "left side": tr("left side"),
        "back left": tr("back left"),
        "back": tr("back"),
        "back right": tr("back right"),
        "right side": tr("right side"),
        "front right": tr("front right"),
        "left shoulder": tr("left shoulder"),
        "right shoulder": tr("right shoulder"),
    }[where]


def place_text(row: PressureRow) -> str:
    """Return where a line presses most, in words."""
    height = length(row.height_mm or 0.0, 0)
    words = tr("{side}, {length} above the lowest point of the scan")
    return words.format(side=side_text(row.where), length=height)


def unknown_pressure() -> str:
    """Return that the pressures of a shape were not computed, and what to do."""
    return joined((render(UNKNOWN_PRESSURE.message), render(UNKNOWN_PRESSURE.action)))


def pressure_summary(listed: PressureList | None, design: Design, doubt: str = "") -> PressureSummary:
    """Return the pressures of all bands; None is not known yet, or not a result for the reason ``doubt``."""
    if listed is None:
        return _nothing(doubt or tr("Computed when the solver has converged."))
    most = listed.highest
    if most is None or most.max_kpa is None:
        return _nothing(tr("No active line with known tension presses on the skin."))
    colours = line_colours([row.line for row in listed.rows], design)
    colours |= {row.line: CUP_COLOUR for row in listed.rows if row.is_cup}
    marks = tuple(
        (line_title(row.line, design), colours[row.line], row.max_kpa)
        for row in listed.rows
        if row.max_kpa is not None
    )
    place = tr("{line}, {side}").format(line=line_title(most.line, design), side=side_text(most.where))
    look = tr("Show location on the contact pressure map")
    return PressureSummary(
        kpa_text(most.max_kpa),
        most.light,
        rating_text(most.light),
        place,
        f"{place_text(most)}\n{look}",
        joined((pressure_limits().description(most.max_kpa).told(language()), *_unmeant(most))),
        total_text(listed),
        marks,
    )


def total_text(listed: PressureList) -> str:
    """Return the total force of bands and cups on the skin in words: of those whose tension is known."""
    if listed.force_n is None:
        return tr("Total force on the skin unknown")
    words = tr("Total force on the skin: {force} N")
    if not listed.complete:
        words = tr("Total force on the skin where tensions are known: {force} N")
    return words.format(force=number(listed.force_n, 1))


def _nothing(why: str) -> PressureSummary:
    return PressureSummary("", "", "", "", "", why, "", ())


TONES = {"green": "ok", "amber": "warn", "red": "bad"}
"""The tones in which lights are shown."""


@dataclass(frozen=True)
class RatingLimits:
    """From which pressures [kPa] the light is amber and red, what the lights are called, and how sure it is.

    ``source`` is the first of the ``sources``, short; those and what is ``left_out`` are sentences.
    """

    amber_kpa: float
    red_kpa: float
    words: tuple[str, str, str]
    source: str
    sources: tuple[str, ...]
    left_out: tuple[str, ...]


@dataclass(frozen=True)
class PressureSummary:
    """The pressures of all bands: the ``largest``, its ``light`` with a ``word``, and what that means.

    ``place`` is where it is, short, ``place_tip`` longer; ``force`` all of the force.

    ``marks`` are the lines with a pressure, each its title, colour and largest pressure [kPa]. Without any
    ``largest`` is empty and ``says`` tells why.
    """

    largest: str
    light: str
    word: str
    place: str
    place_tip: str
    says: str
    force: str
    marks: tuple[tuple[str, str, float], ...]


@dataclass(frozen=True)
class PressureView:
    """What a line presses with: ``kpa`` as it is read, ``light`` "green", "amber" or "red", empty for none.

    ``word`` says in short what the light means, ``tip`` where it comes from. ``stale`` figures are those of
    a former shape.
    """

    kpa: str
    light: str
    word: str
    tip: str
    stale: bool = False
