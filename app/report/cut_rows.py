"""The cut list of a sheet in words: what to cut of what, and what is to be known of each line."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import inf, sqrt

from app.i18n.catalog import joined, listed, number, tr
from app.i18n.lengths import length_number, length_unit, width, width_number
from app.presenters.measurements import length_uncertainty
from app.presenters.messages import elastic_title, render
from app.presenters.pressure import rating_text
from app.report.text import NOTHING, piece_title, value_text
from core.export.report_data import Report
from core.garment.cut_list import FRONT_ONLY, SLACK, UNCHOSEN, CutRow
from core.garment.pressure import SLACK_NOTE
from core.garment.pressure_list import PressureRow
from core.measurements.uncertain_value import CUT, MAX_KPA, TENSION

VAGUE, MOST_VAGUE = 2.0, 10.0
"""Factors to either side from which a range is no use to work by, and from which it tells nothing (ours)."""


@dataclass(frozen=True)
class CutRowText:
    """A row of the cut list, as it is printed.

    ``values`` are the figures by column, as keyed in ``EDGES`` of ``cut_table.py``.
    ``to_cut`` is False for a line of which no piece can be cut; ``remark`` states why, or what to mind. The
    lengths of one that is ``front_only`` are no whole piece.
    """

    line: str
    title: str
    elastic: str
    values: dict[str, str]
    rating: str
    word: str
    to_cut: bool
    remark: str = ""
    front_only: bool = False


def cut_views(sheet: Report, order: Sequence[str]) -> list[CutRowText]:
    """Return the rows of the cut list in the ``order`` of the lines.

    Of a shape that is no result no figure is told: nobody is to cut by it.
    """
    views = [_cut_view(*each) for each in _rows(sheet, order)]
    return views if sheet.is_valid else [_without_figures(view) for view in views]


def line_notes(sheet: Report, order: Sequence[str]) -> list[tuple[str, list[str]]]:
    """Return what is to be known of each line by its title; what holds for all stands first, without one."""
    if not sheet.is_valid:
        return []
    noted = [
        (piece_title(cut.line, cut.title), _notes(cut, press, sheet)) for cut, press in _rows(sheet, order)
    ]
    shared = [note for note in noted[0][1] if all(note in notes for _, notes in noted)] if noted[1:] else []
    own = [(title, [note for note in notes if note not in shared]) for title, notes in noted]
    return [(title, notes) for title, notes in (("", shared), *own) if notes]


def force_range_warning(sheet: Report) -> str:
    """Return that tension and pressure cannot be worked by, if their range is too wide for that."""
    worst = max((_factor(*each) for each in _forces(sheet)), default=1.0)
    if not sheet.is_valid or worst < VAGUE:
        return ""
    if worst > MOST_VAGUE:
        return tr("Tension and contact pressure are order-of-magnitude estimates: measure them on a sample.")
    text = tr("Tension and contact pressure are uncertain by a factor of {factor}: measure them on a sample.")
    return text.format(factor=number(worst, 0))


def _rows(sheet: Report, order: Sequence[str]) -> list[tuple[CutRow, PressureRow]]:
    """Return the rows of cut list and pressures, in the ``order`` of the lines."""
    return sorted(_with_pressures(sheet), key=lambda row: _place(row[0].line, order))


def _with_pressures(sheet: Report) -> list[tuple[CutRow, PressureRow]]:
    """Return the rows of the cut list, each with the pressure of its line, or the largest of its band."""
    pressed = {press.line: press for press in sheet.pressures}
    bands = ([pressed[name] for name in (cut.line, *cut.parts)] for cut in sheet.cuts.rows)
    most = (max(band, key=lambda press: press.max_kpa or 0.0) for band in bands)
    return list(zip(sheet.cuts.rows, most, strict=True))


def _notes(cut: CutRow, press: PressureRow, sheet: Report) -> list[str]:
    remarked = (SLACK, UNCHOSEN, SLACK_NOTE, FRONT_ONLY)  # beside the cut list already
    notes = (note for note in (*cut.notes, *press.notes) if note not in remarked)
    return list(dict.fromkeys((*map(render, notes), *_within_words(cut, press, sheet))))


def _within_words(cut: CutRow, press: PressureRow, sheet: Report) -> Iterator[str]:
    """Yield where the figures of a piece lie in 95 % of cases, if somebody can work by that."""
    parts = []
    # That of a band over both regions is known for its upper part alone.
    off = None if cut.parts else sheet.off.get(f"{CUT}:{cut.line}")
    if off is not None and cut.cut_mm is not None:
        parts.append(tr("cut {off} {unit}").format(off=length_uncertainty(off), unit=length_unit()))
    words = tr("tension {low} to {high} N"), tr("maximum contact pressure {low} to {high} kPa")
    for text, ends in zip(words, _force_ends(cut, press, sheet), strict=True):
        if ends is not None and _factor(*ends) < VAGUE:
            low, high = (number(each, 1) for each in ends)
            parts.append(text.format(low=low, high=high))
    if parts:
        yield tr("In 95 % of cases: {values}.").format(values=listed(parts))


def _forces(sheet: Report) -> Iterator[tuple[float, float]]:
    """Yield the ranges of all tensions and pressures."""
    for cut, press in _with_pressures(sheet):
        if not cut.slack:
            yield from filter(None, _force_ends(cut, press, sheet))


def _force_ends(
    cut: CutRow, press: PressureRow, sheet: Report
) -> tuple[tuple[float, float] | None, tuple[float, float] | None]:
    """Return the ranges of the tension [N] and of the largest pressure [kPa] of a line."""
    tension = _ends(sheet, f"{TENSION}:{cut.line}", cut.tension_n)
    return tension, _ends(sheet, f"{MAX_KPA}:{cut.line}", press.max_kpa)


def _factor(low: float, high: float) -> float:
    """Return by what factor the middle of a range may be off to either side [1]."""
    return sqrt(high / low) if low > 0.0 else inf if high > 0.0 else 1.0


def _ends(sheet: Report, key: str, value: float | None) -> tuple[float, float] | None:
    """Return between what a force or pressure may lie, None where that is not known."""
    off, factor = sheet.off.get(key), sheet.off_factor.get(key)
    if value is not None and factor is not None:
        return value / factor, value * factor
    return None if value is None or off is None else (max(value - off, 0.0), value + off)


def cut_pieces(sheet: Report, order: Sequence[str]) -> list[tuple[str, str, str]]:
    """Return line, title and shown length of whole pieces to be cut, in the ``order`` of the lines."""
    return [
        (row.line, piece_title(row.line, row.title), length_number(row.cut_mm, 0))
        for row in sorted(sheet.cuts.rows, key=lambda row: _place(row.line, order))
        if row.cut_mm is not None and not row.front_only
    ]


def _cut_view(cut: CutRow, press: PressureRow) -> CutRowText:
    stretch = None if cut.elongation is None else 100.0 * cut.elongation
    figures = {
        "width": NOTHING if cut.width_mm is None else width_number(cut.width_mm),
        "cut": _length(cut.cut_mm),
        "allowance": _length(cut.allowance_mm),
        "elongation": value_text(stretch, 0),
        "whole": _length(cut.reached_whole_mm),
        "height": _length(cut.height_mm, signed=True),
        "tension": value_text(cut.tension_n, 1),
        "pressure": value_text(press.max_kpa, 1),
    }
    word = rating_text(press.light) if press.light else ""
    title, to_cut = piece_title(cut.line, cut.title), cut.cut_mm is not None
    return CutRowText(
        *(cut.line, title, _elastic(cut), figures, press.light, word),
        to_cut,
        _remark(cut),
        cut.front_only,
    )


def _remark(cut: CutRow) -> str:
    """Return in a few words why no piece can be cut, or what to mind of it."""
    texts = [tr("Slack (no tension).")] if cut.slack else []
    if not cut.elastic:
        texts.append(tr("No elastic chosen: the value is the length on the body."))
    elif cut.refused:
        texts.append(tr("The elongation exceeds the curve of the elastic."))
    elif cut.cut_mm is None and not cut.slack:
        texts.append(tr("Tension unknown."))
    if cut.cut_mm is not None and cut.front_only:
        texts.append(tr("Front part only: add the part over shoulder or back."))
    return joined(texts)


def _length(mm: float | None, signed: bool = False) -> str:
    return NOTHING if mm is None else length_number(mm, 0, signed)


def _elastic(cut: CutRow) -> str:
    """Return what a line is made of, without the width, which stands beside it."""
    return (
        elastic_title(cut.elastic).removesuffix(f" {width(cut.width_mm or 0.0)}") if cut.elastic else NOTHING
    )


def _without_figures(view: CutRowText) -> CutRowText:
    remark = tr("No value: the shape is not valid.")
    nothing = dict.fromkeys(view.values, NOTHING) | {"width": view.values["width"]}
    return replace(view, values=nothing, rating="", word="", to_cut=False, remark=remark)


def _place(line: str, order: Sequence[str]) -> int:
    return order.index(line) if line in order else len(order)
