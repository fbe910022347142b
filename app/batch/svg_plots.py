"""Plots of pages as SVG text: lines with error bars, curves, histograms and scatters; no library, no script.

Colours come from classes of the page, so that they follow its light or dark look. Series differ in colour and
in dashes.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape

import numpy as np

from app.presenters.plots import round_ticks

WIDTH, HEIGHT = 340, 220
_LEFT, _RIGHT, _TOP, _BOTTOM = 48, 12, 10, 36
SERIES = 8
"""Series that the style sheet of the page tells apart; further ones repeat them."""


@dataclass(frozen=True)
class Point:
    """A point of a series; ``half`` is half of its error bar, None where the error is not known."""

    x: float
    y: float
    half: float | None = None


@dataclass(frozen=True)
class Series:
    """Points with a name, and a ``line`` that belongs to them, which need not join them."""

    name: str
    points: tuple[Point, ...]
    line: tuple[tuple[float, float], ...] = ()


@dataclass(frozen=True)
class Axis:
    """An axis from ``low`` to ``high`` with places and texts of its ticks, and a title."""

    title: str
    low: float
    high: float
    ticks: tuple[tuple[float, str], ...]


def number_axis(title: str, values: Iterable[float], *, around: bool = False) -> Axis:
    """Return an axis of numbers that contains all values; with ``around`` also 0, as wide to both sides."""
    known = [value for value in values if np.isfinite(value)] or [0.0]
    low, high = min(known), max(known)
    if around:
        high = max(abs(low), abs(high))
        low = -high
    if high - low < 1e-9 * max(1.0, abs(high)):
        low, high = low - 0.5, high + 0.5
    margin = 0.06 * (high - low)
    low, high = low - margin, high + margin
    ticks = tuple((at, f"{at + 0.0:.6g}") for at in round_ticks(low, high) if low <= at <= high)
    return Axis(title, low, high, ticks)


def label_axis(title: str, labels: Sequence[str]) -> Axis:
    """Return an axis with labels at 0, 1, 2 ..., every few if there are many."""
    every = max(1, -(-len(labels) // 9))
    ticks = tuple((float(at), label) for at, label in enumerate(labels) if at % every == 0)
    return Axis(title, -0.5, len(labels) - 0.5, ticks)


def error_plot(title: str, x: Axis, y: Axis, series: Sequence[Series]) -> str:
    """Return points with error bars and the lines of their series, as SVG.

    Series are moved apart a little, so that their bars are seen; what leaves the axes is cut off.
    """
    parts = []
    for number, each in enumerate(series):
        aside = 0.5 * (number - 0.5 * (len(series) - 1)) / max(len(series), 2)
        path = "L".join(f"{_x(x, across):.1f} {_y(y, up):.1f}" for across, up in each.line)
        drawn = f'<path class="line" d="M{path}"/>' if path else ""
        for point in each.points:
            across, up = _x(x, point.x + aside), _y(y, point.y)
            drawn += f'<circle cx="{across:.1f}" cy="{up:.1f}" r="2.6"/>'
            if point.half is not None:
                ends = (min(max(point.y + sign * point.half, y.low), y.high) for sign in (-1.0, 1.0))
                low, high = (_y(y, end) for end in ends)
                drawn += f'<path class="error" d="M{across:.1f} {low:.1f}V{high:.1f}"/>'
        name = f"<title>{escape(each.name)}</title>" if each.name else ""
        parts.append(f'<g class="s{number % SERIES}">{name}{drawn}</g>')
    return _svg(title, [_frame(x, y), *parts])


def curve_plot(title: str, x: Axis, y: Axis, points: Sequence[tuple[float, float]], mark: float) -> str:
    """Return a curve that rises in steps, as SVG, with a level ``mark`` drawn across."""
    path = f"M{_x(x, points[0][0]):.1f} {_y(y, points[0][1]):.1f}"
    path += "".join(f"H{_x(x, across):.1f}V{_y(y, up):.1f}" for across, up in points[1:])
    level = f'<path class="mark" d="M{_LEFT} {_y(y, mark):.1f}H{WIDTH - _RIGHT}"/>'
    return _svg(title, [_frame(x, y), level, f'<g class="s0"><path class="line" d="{path}"/></g>'])


def histogram(title: str, x: Axis, values: Sequence[float], bins: int = 16) -> str:
    """Return how often values occur, as SVG; a line is drawn at 0."""
    counts, edges = np.histogram(values, bins, (x.low, x.high))
    y = number_axis("bodies", [0.0, float(counts.max(initial=1))])
    y = Axis("bodies", 0.0, y.high, tuple(each for each in y.ticks if each[0] >= 0 and each[0] % 1 == 0))
    bars = "".join(
        f'<rect x="{_x(x, low):.1f}" y="{_y(y, count):.1f}" width="{_x(x, high) - _x(x, low) - 1:.1f}" '
        f'height="{_y(y, 0.0) - _y(y, count):.1f}"/>'
        for low, high, count in zip(edges[:-1], edges[1:], map(float, counts), strict=True)
    )
    zero = (
        f'<path class="mark" d="M{_x(x, 0.0):.1f} {_TOP}V{HEIGHT - _BOTTOM}"/>'
        if x.low < 0.0 < x.high
        else ""
    )
    return _svg(title, [_frame(x, y), f'<g class="s0">{bars}</g>', zero])


def scatter(title: str, x: Axis, y: Axis, groups: Sequence[Series]) -> str:
    """Return points without lines, as SVG, with axes through 0; each point has the name of its series."""
    cross = f'<path class="mark" d="M{_x(x, 0.0):.1f} {_TOP}V{HEIGHT - _BOTTOM}'
    cross += f'M{_LEFT} {_y(y, 0.0):.1f}H{WIDTH - _RIGHT}"/>'
    parts = [_frame(x, y), cross]
    for number, each in enumerate(groups):
        spots = "".join(
            f'<circle cx="{_x(x, point.x):.1f}" cy="{_y(y, point.y):.1f}" r="3"/>' for point in each.points
        )
        parts.append(f'<g class="s{number % SERIES}"><title>{escape(each.name)}</title>{spots}</g>')
    return _svg(title, parts)


def legend(names: Sequence[str]) -> str:
    """Return the names of series with their colours, as HTML."""
    keys = "".join(
        f'<span class="s{number % SERIES}"><svg class="key" viewBox="0 0 24 8" aria-hidden="true">'
        f'<path class="line" d="M0 4H24"/><circle cx="12" cy="4" r="3"/></svg> {escape(name)}</span>'
        for number, name in enumerate(names)
    )
    return f'<p class="legend">{keys}</p>'


def _x(axis: Axis, value: float) -> float:
    return _LEFT + (value - axis.low) / (axis.high - axis.low) * (WIDTH - _LEFT - _RIGHT)


def _y(axis: Axis, value: float) -> float:
    return HEIGHT - _BOTTOM - (value - axis.low) / (axis.high - axis.low) * (HEIGHT - _TOP - _BOTTOM)


def _frame(x: Axis, y: Axis) -> str:
    base, middle = HEIGHT - _BOTTOM, (_TOP + HEIGHT - _BOTTOM) / 2.0
    across = (_LEFT + WIDTH - _RIGHT) / 2.0
    lines = "".join(f"M{_LEFT} {_y(y, at):.1f}H{WIDTH - _RIGHT}" for at, _ in y.ticks)
    texts = [
        *(f'<text x="{_LEFT - 5}" y="{_y(y, at) + 3:.1f}" text-anchor="end">{escape(text)}</text>'
          for at, text in y.ticks),
        *(f'<text x="{_x(x, at):.1f}" y="{base + 13}" text-anchor="middle">{escape(text)}</text>'
          for at, text in x.ticks),
        f'<text x="{across}" y="{HEIGHT - 6}" text-anchor="middle">{escape(x.title)}</text>',
        f'<text transform="translate(11 {middle}) rotate(-90)" text-anchor="middle">{escape(y.title)}</text>',
    ]  # fmt: skip
    grid = f'<path class="grid" d="{lines}"/>' if lines else ""
    return f'{grid}<path class="axis" d="M{_LEFT} {_TOP}V{base}H{WIDTH - _RIGHT}"/>' + "".join(texts)


def _svg(title: str, parts: Iterable[str]) -> str:
    head = f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="{escape(title)}">'
    return f"<figure>{head}{''.join(parts)}</svg><figcaption>{escape(title)}</figcaption></figure>"
