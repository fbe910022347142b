"""The head of a sheet: whose it is, the few figures that are looked for first, and the pictures."""

from __future__ import annotations

from app.i18n.catalog import joined, number, tr
from app.i18n.lengths import length_number, length_unit
from app.presenters.assessment import IDLE, AssessmentView
from app.presenters.bust_shift import forward_text
from app.presenters.measurements import length_uncertainty
from app.presenters.messages import render
from app.rendering.palette import LIGHT
from app.report.cut_rows import cut_pieces
from app.report.document import SHOT_SIZES, SHOTS, ReportDocument
from app.report.layout import Block
from app.report.painter import (
    A4,
    MARGIN,
    PagePainter,
    elide,
    line_height,
    paint_chip,
    paint_level,
    text_width,
    wrap,
)
from app.report.text import REASONS, assessment_text, project_words, size_words, system_word
from core.export.report_data import Report
from core.garment.assessment import BAD, CAUTION, GOOD, PENDING
from core.measurements.uncertain_value import LIFT, OUT

WIDE = A4[0] - 2 * MARGIN
"""What is between the margins of a page [mm]."""

_CELLS = (0.0, 28.0, 58.0, 121.0, 154.0)  # where band, cup, lengths to cut, lift and volume begin [mm]
_HERO, _LARGE = 28.0, 3
_USUAL = LIGHT.control  # of a line that has no colour
_TONES = {
    GOOD: (LIGHT.ok, LIGHT.ok_fill),
    CAUTION: (LIGHT.warn, LIGHT.warn_fill),
    BAD: (LIGHT.bad, LIGHT.bad_fill),
    PENDING: (LIGHT.info, LIGHT.info_fill),
    IDLE: (LIGHT.text_quiet, LIGHT.pressed),
}


def head_blocks(handout: ReportDocument, share: float = 1.0) -> list[Block]:
    """Return the head: title, overall verdict, the great figures, the pictures.

    Those have a ``share`` of their usual height.
    """
    sheet = handout.report
    return [_title(sheet), _verdict(assessment_text(sheet)), _hero(handout), _pictures(handout, share)]


def _title(sheet: Report) -> Block:
    heading, title = sheet.heading, tr("Fitting report")
    customer = elide(heading.customer or project_words(sheet), "name", 100.0)
    gap = text_width(customer, "name") + 3.0
    project = elide(project_words(sheet), "quiet", WIDE - gap) if heading.customer else ""

    def paint(paper: PagePainter, x: float, y: float) -> None:
        paper.text(x, y + 5.2, title, "title")
        paper.text(x + WIDE, y + 5.2, heading.date, "quiet", align="right")
        paper.text(x, y + 12.0, customer, "name")
        paper.text(x + gap, y + 12.0, project, "quiet")

    return Block(15.0, paint)


def _verdict(view: AssessmentView) -> Block:
    """Return the headline of the sheet: the overall verdict, and the worst of its reasons with what to do."""
    ink, fill = _TONES[view.level]
    reasons = [wrap(joined(each), "body", WIDE - 12.0) for each in view.reasons[:REASONS]]
    lines = [line for reason in reasons for line in reason]
    if more := len(view.reasons) - len(reasons):
        lines.append(tr("{count} more in the appendix.").format(count=more))
    height = 7.6 + len(lines) * line_height("body") + (1.4 if lines else 0.0)

    def paint(paper: PagePainter, x: float, y: float) -> None:
        paper.box(x, y, WIDE, height, fill, 1.2)
        paint_level(paper, x + 5.0, y + 3.9, view.level)
        paper.text(x + 9.5, y + 5.2, view.headline, "name", ink=ink)
        paper.lines(x + 9.5, y + 7.2, lines, "body")

    return Block(height + 3.0, paint)


def _hero(handout: ReportDocument) -> Block:
    """Return the row of great figures between two rules."""
    parts = _size(handout.report), _cuts(handout), _lift(handout.report), _volume(handout.report)

    def paint(paper: PagePainter, x: float, y: float) -> None:
        paper.rule(x, y, WIDE, ink=LIGHT.outline)
        for part in parts:
            part.paint(paper, x, y)
        for left in _CELLS[2:]:
            paper.stroke(x + left - 4.0, y + 3.0, y + _HERO - 3.0, ink=LIGHT.line)
        paper.rule(x, y + _HERO, WIDE, ink=LIGHT.outline)

    return Block(_HERO, paint)


def _great(
    left: float, width: float, caption: str, figure: str, below: str, unit: str = "", off: str = ""
) -> Block:
    """Return one figure with what it is over it and what belongs to it below, first how far it may be off."""
    kind = "hero" if text_width(figure, "hero") + text_width(unit, "name") + 1.2 <= width else "large"
    lines, end = wrap(below, "caption", width)[: 2 if off else 3], text_width(figure, kind) + 1.2

    def paint(paper: PagePainter, x: float, y: float) -> None:
        paper.text(x + left, y + 4.6, caption, "caption")
        paper.text(x + left, y + 12.8, figure, kind)
        paper.text(x + left + end, y + 12.8, unit, "name")
        down = paper.lines(x + left, y + 14.6, [off] if off else [], "figure strong")
        paper.lines(x + left, max(down, y + 14.8), lines, "caption")

    return Block(_HERO, paint)


def _size(sheet: Report) -> Block:
    chosen = sheet.sizes[0] if sheet.sizes else {"band": None, "cup": None}
    below = size_words(sheet) if sheet.sizes else render(sheet.no_size)
    nothing = "\N{EN DASH}"
    system = f" {system_word(chosen)}" if sheet.sizes else ""
    band = _great(_CELLS[0], _CELLS[2] - 6.0, tr("Band") + system, chosen["band"] or nothing, below)
    cup = _great(_CELLS[1], 20.0, tr("Cup"), chosen["cup"] or nothing, "")

    def paint(paper: PagePainter, x: float, y: float) -> None:
        band.paint(paper, x, y)
        cup.paint(paper, x, y)

    return Block(_HERO, paint)


def _cuts(handout: ReportDocument) -> Block:
    """Return the lengths to cut: one as large as the size, up to three below each other."""
    pieces, left = cut_pieces(handout.report, list(handout.colours)), _CELLS[2]
    room, caption = _CELLS[3] - left - 6.0, _cut_caption(handout.report)
    if not handout.report.is_valid:
        return _sentence(left, room, caption, tr("No value: the shape is not valid."))
    if len(pieces) == 1:
        line, title, length = pieces[0]
        one = _great(left, room, caption, length, "", length_unit())
        colour, name = handout.colours.get(line, _USUAL), elide(title, "strong", room - 5.0)

        def paint_one(paper: PagePainter, x: float, y: float) -> None:
            one.paint(paper, x, y)
            paint_chip(paper, x + left, y + 17.3, colour)
            paper.text(x + left + 4.6, y + 18.2, name, "strong")

        return Block(_HERO, paint_one)
    if not pieces:
        return _sentence(left, room, caption, _no_cut(handout.report))
    rows = [
        (handout.colours.get(line, _USUAL), elide(title, "strong", room - 31.0), length)
        for line, title, length in pieces[:_LARGE]
    ]
    more, end = len(pieces) - len(rows), max(text_width(length, "large") for *_, length in rows)
    if more:
        caption = elide(tr("{what}; {count} more below").format(what=caption, count=more), "caption", room)

    def paint(paper: PagePainter, x: float, y: float) -> None:
        paper.text(x + left, y + 4.6, caption, "caption")
        for place, (colour, title, length) in enumerate(rows):
            base = y + 10.6 + 5.9 * place
            paper.text(x + left + end, base, length, "large", align="right")
            paper.text(x + left + end + 1.0, base, length_unit(), "strong")
            paint_chip(paper, x + left + end + 9.0, base - 1.4, colour)
            paper.text(x + left + end + 13.6, base - 0.3, title, "strong")

    return Block(_HERO, paint)


def _no_cut(sheet: Report) -> str:
    """Return why there is no length to cut."""
    if not sheet.cuts.rows:
        return tr("No active lines: the cut list is empty.")
    if any(row.front_only and row.cut_mm is not None for row in sheet.cuts.rows):
        return tr("No full lengths: the cut list contains front lengths only.")
    return tr("No elastics chosen: choose one for each line to compute the cut lengths.")


def _cut_caption(sheet: Report) -> str:
    guessed = any(row.cut_mm is not None and row.estimate for row in sheet.cuts.rows)
    return tr("Cut length (estimate)") if guessed else tr("Cut length")


def _sentence(left: float, room: float, caption: str, text: str) -> Block:
    lines = wrap(text, "body", room)[:4]

    def paint(paper: PagePainter, x: float, y: float) -> None:
        paper.text(x + left, y + 4.6, caption, "caption")
        paper.lines(x + left, y + 6.8, lines, "body")

    return Block(_HERO, paint)


def _lift(sheet: Report) -> Block:
    left, room, caption = _CELLS[3], _CELLS[4] - _CELLS[3] - 6.0, tr("Bust point lift")
    if sheet.lift is None:
        return _sentence(left, room, caption, tr("No value: the shape is not valid."))
    off, below = sheet.off.get(LIFT), forward_text(sheet.lift.forward, sheet.off.get(OUT))
    figure = length_number(sheet.lift.up, signed=True)
    told = "" if off is None else f"{length_uncertainty(off)} {length_unit()}"
    return _great(left, room, caption, figure, below, length_unit(), told)


def _volume(sheet: Report) -> Block:
    kept, left, caption = sheet.volume, _CELLS[4], tr("Volume change")
    if not sheet.is_valid:
        return _sentence(left, WIDE - left, caption, tr("No value: the shape is not valid."))
    of = tr("of {ml} ml in the model").format(ml=number(kept.rest_ml, 0))
    figure = number(kept.error_ml, 1, signed=True)
    return _great(left, WIDE - left, caption, figure, of, "ml")


def _pictures(handout: ReportDocument, share: float) -> Block:
    """Return front and side, before and after, or a sentence where they could not be drawn."""
    if not all(name in handout.pictures for name in SHOTS):
        lines = wrap(
            tr("The images of the body could not be drawn. The curves show the changes."),
            "small",
            WIDE,
        )
        height = len(lines) * line_height("small")
        return Block(height, lambda paper, x, y: paper.lines(x, y, lines, "small"), gap=3.0)
    titles = dict(zip(SHOTS, _shot_titles(), strict=True))
    sizes = {name: SHOT_SIZES[name.partition(" ")[0]] for name in SHOTS}
    tall = share * max(height for _, height in sizes.values())

    def paint(paper: PagePainter, x: float, y: float) -> None:
        for name, (wide, high) in sizes.items():
            paper.picture(x, y, wide, share * high, handout.pictures[name])
            paper.text(x + 0.5 * wide, y + tall + 3.6, titles[name], "caption", align="middle")
            x += wide

    return Block(tall + 4.6, paint, gap=3.0)


def _shot_titles() -> list[str]:
    front, side, before, after = tr("Front"), tr("Left side"), tr("Before"), tr("After")
    return [f"{view} · {when}" for view in (front, side) for when in (before, after)]
