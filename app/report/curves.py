"""The curves of a sheet: the body cut before and after on a grid of millimetres, and the turns of the run."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from app.i18n.catalog import number, tr
from app.i18n.lengths import length, length_number, length_unit, shown_value
from app.presenters.plots import digits_of, round_ticks
from app.rendering.palette import LIGHT
from app.report.document import ReportDocument
from app.report.header import WIDE
from app.report.layout import Block
from app.report.painter import PagePainter, elide, text_width, wrap
from app.report.tables import heading
from core.export.report_data import IterationCurve, Pair, Report, SectionCurves
from core.geometry.mesh import Floats

LOWEST, HIGHEST = 52.0, 116.0
"""How high the curves are at least, and at most [mm]."""

LEVEL = 62.0
"""How high the levels of waist and hip are [mm]."""

_SIDE, _GAP, _AXIS, _FOOT = 62.0, 8.0, 9.0, 3.6
_METRIC = (5.0, 10.0, 20.0, 50.0, 100.0, 200.0)
_GRID = {"mm": _METRIC, "cm": _METRIC, "in": tuple(25.4 * each for each in (0.25, 0.5, 1.0, 2.0, 4.0, 8.0))}
"""Between two lines of a grid, by the unit in use [mm on the body]."""

_NARROWEST = 7.0  # mm on paper between two lines of a grid


def curve_block(handout: ReportDocument, height: float) -> Block:
    """Return the side of the body, and beside it its level at the bust over the plots of the run."""
    sheet = handout.report
    side, bust = sheet.sections
    title = heading(tr("Before and after"), WIDE)
    top, right = title.height, _SIDE + _GAP
    half = (0.5 if _plotted(sheet) else 0.85) * (height - top)
    wide = 0.5 * (WIDE - right - _GAP)
    where = (
        tr("Side view through the left bust point"),
        tr("Top view at bust point level (front at the bottom)"),
    )
    names = [elide(each, "caption", room) for each, room in zip(where, (_SIDE, WIDE - right), strict=True)]
    marks = _bust_points(sheet)
    parts = [
        (0.0, top, _section(side, marks, names[0], (_SIDE, height - top), _from_bust_point())),
        (right, top, _section(bust, [], names[1], (WIDE - right, half - 2.0), _from_bust_point())),
        *_plots(sheet, right, top + half, wide, height - top - half),
    ]
    legend = _legend()

    def paint(paper: PagePainter, x: float, y: float) -> None:
        title.paint(paper, x, y)
        legend.paint(paper, x, y)
        for left, down, part in parts:
            part.paint(paper, x + left, y + down)

    return Block(height, paint, gap=4.0)


def lower_section_blocks(sheet: Report, width: float) -> Iterator[Block]:
    """Yield the levels of waist and hip, ``width`` [mm] wide, where the design has the lower trunk."""
    titles = {"waist": tr("Top view at waist level"), "hip": tr("Top view at hip level")}
    for at, cut in enumerate(sheet.lower_sections):
        block = _section(cut, [], titles[cut.name], (width, LEVEL), tr("grid {length}, origin at the middle"))
        yield replace(block, gap=4.0 if at else 0.0)


def _from_bust_point() -> str:
    return tr("grid {length}, origin at bust point")


def _legend() -> Block:
    """Return the names of both curves, at the right of the title."""
    names = (tr("before"), LIGHT.text_caption, 0.3, True), (tr("after"), LIGHT.accent, 0.5, False)

    def paint(paper: PagePainter, x: float, y: float) -> None:
        right = x + WIDE
        for name, ink, weight, dashed in reversed(names):
            paper.text(right, y + 3.6, name, "caption", align="right")
            end = right - text_width(name, "caption") - 1.4
            paper.curve([(end - 7.0, y + 2.7), (end, y + 2.7)], ink, weight, dashed=dashed)
            right = end - 11.0

    return Block(0.0, paint)


def _bust_points(sheet: Report) -> list[tuple[float, float]]:
    """Return the bust point on the side before and after [mm], if the shape is one."""
    side = sheet.sections[0]
    return [side.bust_point, side.bust_point_after] if sheet.is_valid else []


def _section(cut: SectionCurves, marks: Sequence[Pair], title: str, size: Pair, origin: str) -> Block:
    """Return a cut on a grid, as large as its ``size`` [mm] allows; ``origin`` says where that begins."""
    width, height = size
    box, zero = np.array(cut.box), np.array(cut.bust_point)
    room = np.array([width - _AXIS, height - 4.0 - _FOOT])
    scale = float((room / (box[1] - box[0])).min())
    centre, step = box.mean(axis=0), next(each for each in _GRID[length_unit()] if each * scale >= _NARROWEST)
    low, high = centre - zero + np.array([[-0.5], [0.5]]) * room / scale
    text = elide(origin.format(length=length(step, 0)), "caption", width)
    bands = [_band(curve, off) for curve, off in zip(cut.after, cut.off_mm, strict=False) if len(curve) > 2]

    def paint(paper: PagePainter, x: float, y: float) -> None:
        paper.text(x, y + 2.6, title, "caption")
        left, top = x + _AXIS, y + 4.0

        def on_page(places: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
            away = (np.array(places) - centre) * [scale, -scale]
            return [(a, b) for a, b in (away + 0.5 * room + [left, top]).tolist()]

        _paint_grid(paper, (left, top), room, (low, high), step)
        paper.clip(left, top, *room)
        for band in bands:
            paper.area(on_page(band), LIGHT.accent)
        for curve in cut.before:
            paper.curve(on_page(curve), LIGHT.text_caption, 0.3, dashed=True)
        for curve in cut.after:
            paper.curve(on_page(curve), LIGHT.accent, 0.5)
        for place, ink in zip(
            on_page(marks) if marks else [], (LIGHT.text_caption, LIGHT.accent), strict=False
        ):
            paper.disc(*place, 0.8, ink)
        paper.unclip()
        paper.text(x + width, y + height - 0.6, text, "caption", align="right")

    return Block(height, paint)


def _paint_grid(
    paper: PagePainter, corner: tuple[float, float], room: Floats, ends: tuple[Floats, Floats], step: float
) -> None:
    """Draw a grid of ``step`` [mm] of the body on ``room`` (2,) [mm] of the paper, between ``ends``."""
    (left, top), (low, high) = corner, ends
    scale = float(room[0] / (high[0] - low[0]))
    for across in _rounds(low[0], high[0], step):
        at = left + (across - low[0]) * scale
        paper.stroke(at, top, top + room[1], ink=LIGHT.outline if across == 0.0 else LIGHT.line)
    for up in _rounds(low[1], high[1], step):
        at = top + (high[1] - up) * scale
        paper.rule(left, at, room[0], ink=LIGHT.outline if up == 0.0 else LIGHT.line)
        paper.text(left - 1.4, at + 0.75, length_number(up, 0, signed=True), "axis", align="right")


def _band(curve: Sequence[tuple[float, float]], off: Sequence[float]) -> list[tuple[float, float]]:
    """Return what lies round a curve within ``off`` to either side [mm]."""
    places = np.array(curve)
    along = np.gradient(places, axis=0)
    across = np.stack([along[:, 1], -along[:, 0]], axis=1)
    across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-9)
    step = np.array(off)[:, None] * across
    return [(a, b) for a, b in np.concatenate([places + step, (places - step)[::-1]]).tolist()]


def _rounds(low: float, high: float, step: float) -> list[float]:
    """Return the multiples of a step between two values."""
    return [step * k for k in range(math.ceil(low / step), math.floor(high / step) + 1)]


def _plots(
    sheet: Report, left: float, top: float, width: float, height: float
) -> list[tuple[float, float, Block]]:
    """Return the plots of the run with where they stand, or why there are none."""
    turns, text = sheet.turns, tr("No iterations to plot: the exact solution is computed directly.")
    if not sheet.cuts.rows:
        text = tr("No iterations to plot: no active lines.")
    if not _plotted(sheet):
        return [(left, top, _sentence(text, 2.0 * width + _GAP))]
    error, up = tr("Volume error, %"), tr("Bust point lift, {unit}").format(unit=length_unit())
    heights = [shown_value(each) for each in turns.up_mm]
    if not sheet.is_valid:
        return [(left, top, _plot(turns, turns.error_percent, error, 2.0 * width + _GAP, height))]
    return [
        (left, top, _plot(turns, turns.error_percent, error, width, height)),
        (left + width + _GAP, top, _plot(turns, heights, up, width, height)),
    ]


def _plotted(sheet: Report) -> bool:
    return len(sheet.turns.turn) > 1 and bool(sheet.cuts.rows)


def _sentence(text: str, width: float) -> Block:
    lines = wrap(text, "small", width)
    return Block(8.0, lambda paper, x, y: paper.lines(x, y + 1.0, lines, "small"))


def _plot(turns: IterationCurve, values: Sequence[float], title: str, width: float, height: float) -> Block:
    """Return a figure over the turns of the run."""
    text, last = (
        elide(title, "caption", width),
        tr("iteration {iteration}").format(iteration=number(turns.turn[-1], 0)),
    )
    x_of, seen = np.array(turns.turn, dtype=np.float64), np.array(values, dtype=np.float64)
    low, high = float(seen.min()), float(seen.max())
    if high - low < 1e-3:
        low, high = low - 0.05, high + 0.05
    ticks = round_ticks(low, high, 3)
    digits = digits_of(ticks)
    room = height - 4.0 - _FOOT

    def paint(paper: PagePainter, x: float, y: float) -> None:
        paper.text(x, y + 2.6, text, "caption")
        left, top = x + _AXIS, y + 4.0

        def down(value: Floats | float) -> Floats:
            return np.asarray(top + room * (0.96 - 0.92 * (np.asarray(value) - low) / (high - low)))

        for tick in ticks:
            at = float(down(tick))
            paper.rule(left, at, width - _AXIS, weight=0.1)
            paper.text(left - 1.4, at + 0.75, number(tick, digits), "axis", align="right")
        paper.rule(left, top + room, width - _AXIS, ink=LIGHT.outline)
        across = left + (width - _AXIS) * (x_of - x_of[0]) / (x_of[-1] - x_of[0])
        paper.curve(zip(across.tolist(), down(seen).tolist(), strict=True), LIGHT.accent, 0.35)
        paper.text(left, y + height - 0.6, number(turns.turn[0], 0), "axis")
        paper.text(x + width, y + height - 0.6, last, "caption", align="right")

    return Block(height, paint)
