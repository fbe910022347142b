"""Small marks that are told apart without colour: of pressures, of how a run stands, of lines."""

from __future__ import annotations

from app.rendering.palette import LIGHT
from app.report.painter import PagePainter
from core.garment.assessment import BAD, CAUTION, GOOD

LIGHTS = {"green": LIGHT.ok, "amber": LIGHT.warn_mark, "red": LIGHT.bad}
"""The colours of the lights; each has a shape of its own."""


def paint_light(paper: PagePainter, x: float, y: float, light: str) -> None:
    """Paint a light about a place [mm]: a ring for green, a triangle for amber, a full square for red."""
    ink = LIGHTS[light]
    if light == "green":
        paper.disc(x, y, 0.95, ink, filled=False)
    elif light == "amber":
        paper.shape([(x - 1.25, y + 1.0), (x + 1.25, y + 1.0), (x, y - 1.2)], ink)
    else:
        paper.box(x - 1.05, y - 1.05, 2.1, 2.1, ink)


def paint_level(paper: PagePainter, x: float, y: float, level: str) -> None:
    """Paint a level of an overall verdict about a place [mm]: a tick, a triangle, a square, or a ring."""
    light = {CAUTION: "amber", BAD: "red"}.get(level)
    if level == GOOD:
        paper.curve([(x - 1.1, y), (x - 0.3, y + 0.8), (x + 1.2, y - 0.9)], LIGHT.ok, 0.45)
    elif light:
        paint_light(paper, x, y, light)
    else:
        paper.disc(x, y, 0.95, LIGHT.text_quiet, filled=False)


def paint_chip(paper: PagePainter, x: float, y: float, colour: str) -> None:
    """Paint the colour of a line about a height [mm], with an edge where it is pale."""
    paper.box(x, y - 1.1, 3.2, 2.2, LIGHT.control, 0.5)
    paper.box(x + 0.12, y - 0.98, 2.96, 1.96, colour, 0.4)
