"""What a sheet says, in words of the language in use: plain values for the painter."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from typing import Any

from app.panels.measure_view import plus_minus
from app.presenting.lines import line_title
from app.presenting.pressure import light_word
from app.showing.verdict_chip import state_title
from app.wording.measure_titles import measure_title
from app.wording.words import colon, listed, number, say, tr
from core.cutting import CutRow
from core.design_lines import partner_of
from core.measuring.definitions import definition_of
from core.measuring.own import OWN
from core.measuring.plus_minus import AFTER, BEFORE, CHANGE, CUT, MAX_KPA, TENSION
from core.press_list import PressRow
from core.sewing.comfort import comfort
from core.sheet import Sheet

NOTHING = "\N{EN DASH}"
"""What stands in a table where nothing is known."""


@dataclass(frozen=True)
class CutView:
    """A row of the cut list, as it is printed; ``marks`` are the numbers of its footnotes.

    The lengths of one that is ``front_only`` are no whole piece.
    """

    line: str
    title: str
    elastic: str
    figures: tuple[str, ...]
    light: str
    word: str
    marks: tuple[int, ...]
    front_only: bool = False


@dataclass(frozen=True)
class MeasureRow:
    """A row of the measures, as it is printed; one that is missing has no ``figures`` but a ``note``.

    ``off`` stands under the figures: how far each may be off.
    """

    title: str
    unit: str
    figures: tuple[str, ...]
    note: str = ""
    off: tuple[str, ...] = ()


def piece_title(line: str, title: str) -> str:
    """Return what a line is called: as the designer named it, else in the language in use."""
    if title == line:
        return line_title(line)
    side = {"left": tr("left"), "right": tr("right")}.get(line.rpartition(" ")[2]) if partner_of(line) else ""
    return listed((title, side)) if side else title


def project_words(sheet: Sheet) -> str:
    """Return of what the sheet is: the project, and which variant of it."""
    heading = sheet.heading
    variant = tr("Variant {name}").format(name=heading.variant) if heading.variant else ""
    return " · ".join(filter(None, (heading.project, variant)))


def state_words(sheet: Sheet) -> tuple[str, str]:
    """Return the word for the run, and why its figures are no result, if they are none."""
    word = state_title(sheet.state)
    if sheet.sound and sheet.state != "settling":
        return word, ""
    return word, tr("{state}: these figures are no result to sew for.").format(state=word)


def size_words(sheet: Sheet) -> str:
    """Return the size as each system writes it, and which others lie within what girths may be off."""
    within = sheet.sizes[0].get("within_off")
    words = tr("Within the ± also: {sizes}") if within else tr("No other size lies within the ±.")
    said = words.format(sizes=listed(within or ())) if within is not None and sheet.sizes[0]["inside"] else ""
    return "\n".join(filter(None, (said, other_sizes(sheet))))


def other_sizes(sheet: Sheet) -> str:
    """Return the size as each system writes it, the chosen one first; a star where others find another."""
    said = (
        f"{system_word(each)} {each['size'] or NOTHING}{'*' * bool(each['caution'])}" for each in sheet.sizes
    )
    # What belongs together is not parted at the end of a line, nor does a line begin with a dot.
    return "\N{NO-BREAK SPACE}· ".join(each.replace(" ", "\N{NO-BREAK SPACE}") for each in said)


def cut_views(sheet: Sheet, order: Sequence[str]) -> tuple[list[CutView], list[str]]:
    """Return the rows of the cut list in the ``order`` of the lines, and their footnotes.

    Of a shape that is no result no figure is told: nobody is to cut by it. What holds for each row is no
    footnote, see ``shared_notes``.
    """
    footnotes: list[str] = []
    views, shared = [], shared_notes(sheet)
    rows = zip(sheet.cuts.rows, sheet.pressures, strict=True)
    for cut, press in sorted(rows, key=lambda row: _place(row[0].line, order)):
        notes = [note for note in _row_notes(cut, press, sheet) if note not in shared]
        footnotes += [note for note in notes if note not in footnotes]
        view = _cut_view(cut, press, tuple(footnotes.index(note) + 1 for note in notes))
        views.append(view if sheet.sound else _without_figures(view))
    return views, footnotes


def shared_notes(sheet: Sheet) -> list[str]:
    """Return what is noted of every row of the cut list, if there are several."""
    rows = [_row_notes(*each, sheet) for each in zip(sheet.cuts.rows, sheet.pressures, strict=True)]
    return [note for note in rows[0] if all(note in notes for notes in rows)] if len(rows) > 1 else []


def _row_notes(cut: CutRow, press: PressRow, sheet: Sheet) -> list[str]:
    told = (*map(say, (*cut.notes, *press.notes)), *_within_words(cut, press, sheet))
    return list(dict.fromkeys(told)) if sheet.sound else []


def _within_words(cut: CutRow, press: PressRow, sheet: Sheet) -> Iterator[str]:
    """Yield where the figures of a piece lie in 95 % of cases, if that was worked out."""
    parts, off = [], sheet.off.get(f"{CUT}:{cut.line}")
    if off is not None and cut.cut_mm is not None:
        parts.append(tr("cut {off} mm").format(off=plus_minus(off)))
    for key, value, words in (
        (f"{TENSION}:{cut.line}", cut.tension_n, tr("tension {low} to {high} N")),
        (f"{MAX_KPA}:{cut.line}", press.max_kpa, tr("largest pressure {low} to {high} kPa")),
    ):
        ends = _ends(sheet, key, value)
        if ends is not None:
            low, high = (number(each, 1) for each in ends)
            parts.append(words.format(low=low, high=high))
    if parts:
        yield tr("In 95 % of cases: {figures}.").format(figures=listed(parts))


def _ends(sheet: Sheet, key: str, value: float | None) -> tuple[float, float] | None:
    """Return between what a force or pressure may lie, None where that is not known."""
    off, factor = sheet.off.get(key), sheet.off_factor.get(key)
    if value is not None and factor is not None:
        return value / factor, value * factor
    return None if value is None or off is None else (value - off, value + off)


def cut_pieces(sheet: Sheet, order: Sequence[str]) -> list[tuple[str, str, str]]:
    """Return line, title and length [mm] of whole pieces to be cut, in the ``order`` of the lines."""
    return [
        (row.line, piece_title(row.line, row.title), number(row.cut_mm, 0))
        for row in sorted(sheet.cuts.rows, key=lambda row: _place(row.line, order))
        if row.cut_mm is not None and not row.front_only
    ]


def measure_rows(sheet: Sheet) -> list[tuple[str, list[MeasureRow]]]:
    """Return the measures in groups; those that are missing for one reason stand in one row."""
    rows = [(_group(row["key"]), row) for row in sheet.measures]
    order = list(dict.fromkeys(group for group, _ in rows))
    found = []
    for group in order:
        those = [row for name, row in rows if name == group]
        shown = [_measure_row(row, sheet) for row in those if known(row)]
        missing = [row for row in those if not known(row)]
        for note, same in groupby(missing, key=lambda row: row["note"]):
            title = listed([measure_title(row) for row in same])
            shown.append(MeasureRow(title, "", (), f"{title}{colon()}{say(note)}"))
        found.append((group, shown))
    return found


def light_legend() -> list[tuple[str, str]]:
    """Return each light with what it says of the largest pressure."""
    limits = comfort()
    amber, red = number(limits.amber_kpa, 0), number(limits.red_kpa, 0)
    told = {
        "green": tr("below {kpa} kPa").format(kpa=amber),
        "amber": tr("from {kpa} kPa").format(kpa=amber),
        "red": tr("from {kpa} kPa").format(kpa=red),
    }
    return [(light, f"{light_word(light)}{colon()}{words}") for light, words in told.items()]


def foot_words(sheet: Sheet) -> str:
    """Return what was at work, for the foot of each page."""
    mesh = tr("control mesh {count}").format(count=sheet.model["template"])
    return " · ".join((f"Busk {sheet.versions['busk']}", mesh, sheet.scan))


def _cut_view(cut: CutRow, press: PressRow, marks: tuple[int, ...]) -> CutView:
    stretch = None if cut.elongation is None else 100.0 * cut.elongation
    width = None if cut.width_mm is None else f"{cut.width_mm:g}"
    figures = (
        width or NOTHING,
        _figure(cut.reached_whole_mm, 0),
        _figure(cut.cut_mm, 0),
        _figure(cut.allowance_mm, 0),
        _figure(stretch, 0),
        _figure(cut.tension_n, 1),
        _figure(press.max_kpa, 1),
        _figure(press.max_mmhg, 0),
    )
    word = light_word(press.light) if press.light else ""
    title = piece_title(cut.line, cut.title)
    return CutView(cut.line, title, _elastic(cut), figures, press.light, word, marks, cut.front_only)


def _elastic(cut: CutRow) -> str:
    """Return what a line is made of, without the width, which stands beside it."""
    return say(cut.elastic).removesuffix(f" {cut.width_mm or 0.0:g} mm") if cut.elastic else NOTHING


def _without_figures(view: CutView) -> CutView:
    width, *others = view.figures
    return replace(view, figures=(width, *(NOTHING for _ in others)), light="", word="")


def _measure_row(row: dict[str, Any], sheet: Sheet) -> MeasureRow:
    digits = 0 if row["unit"] == "ml" else 1
    figures = (
        _figure(row["before"], digits),
        _figure(row["after"], digits),
        _change(row, digits),
    )
    figures = figures if sheet.sound else (figures[0], NOTHING, NOTHING)
    offs = [sheet.off.get(f"{kind}:{row['key']}") for kind in (BEFORE, AFTER, CHANGE)] if sheet.sound else []
    told = tuple("" if off is None else plus_minus(off) for off in offs)
    told = told if any(told) else ()
    unit = row["unit"].replace("2", "\N{SUPERSCRIPT TWO}")
    unit = "" if unit == "mm" else unit
    if row["estimate"]:
        alone = row["plus_minus"] >= 0.5 and not told  # else it is in what stands below
        off = f" ± {number(row['plus_minus'], digits)}" if alone else ""
        unit = f"{unit} {tr('est.')}{off}".strip()
    return MeasureRow(measure_title(row), unit, figures, off=told)


def _change(row: dict[str, Any], digits: int) -> str:
    """Return the change of what is printed, so that the columns agree."""
    if row["before"] is None or row["after"] is None:
        return NOTHING if row["difference"] is None else number(row["difference"], digits, signed=True)
    return number(round(row["after"], digits) - round(row["before"], digits), digits, signed=True)


def _group(key: str) -> str:
    return tr("Your own") if key.startswith(OWN) else say(definition_of(key)[0].group)


def known(row: dict[str, Any]) -> bool:
    """Return whether a measure was found, before or after."""
    return row["before"] is not None or row["after"] is not None


def system_word(size: dict[str, Any]) -> str:
    """Return what a system of sizes is called beside a size."""
    key = str(size["key"])
    return key.upper() if len(key) == 2 else str(size["system"])


def _place(line: str, order: Sequence[str]) -> int:
    return order.index(line) if line in order else len(order)


def _figure(value: float | None, digits: int) -> str:
    return NOTHING if value is None else number(value, digits)
