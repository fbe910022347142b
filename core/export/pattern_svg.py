"""Pieces as SVG at full size: a group a piece, a path a side with its name, classes by kind of line."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from xml.etree import ElementTree as Xml

import numpy as np

from core.document.printable_name import printable
from core.export.report_data import Heading
from core.files.atomic_write import atomic_path
from core.geometry.mesh import Floats
from core.pattern.allowance import CutPiece
from core.pattern.annotation import (
    STRETCH,
    STRETCH_LETTERS,
    Annotation,
    Say,
    annotate,
    arrow_heads,
    piece_words,
)
from core.pattern.layout import MARGIN, SQUARE, SQUARE_WORDS, Layout
from core.pattern.piece import Points2, SideKey

STYLE = """
.cut { fill: none; stroke: #111111; stroke-width: 0.5; stroke-linejoin: miter }
.sew { fill: none; stroke: #c0392b; stroke-width: 0.25; stroke-dasharray: 3 1.5 }
.notch { fill: none; stroke: #111111; stroke-width: 0.5 }
.internal { fill: none; stroke: #2e6da4; stroke-width: 0.25; stroke-dasharray: 6 1.5 1 1.5 }
.grain, .square { fill: none; stroke: #111111; stroke-width: 0.3 }
.head { fill: #111111; stroke: none }
.stretch { fill: none; stroke: #2e6da4; stroke-width: 0.3 }
text { font-family: sans-serif; fill: #111111; text-anchor: middle }
.name { font-weight: bold }
.stretch-word { fill: #2e6da4 }
"""
"""Weights of lines [mm] and colours, by which laser cutters and other programs tell lines apart."""


def write_pattern_svg(path: Path, layout: Layout, heading: Heading, say: Say = str) -> None:
    """Write the pieces of a layout 1:1, whole or not at all; ``say`` puts words into another language.

    Raises ProjectError.
    """
    size = np.array([layout.width, layout.height]) + 2.0 * MARGIN
    page = {
        "width": f"{size[0]:.3f}mm",
        "height": f"{size[1]:.3f}mm",
        "viewBox": f"0 0 {size[0]:.3f} {size[1]:.3f}",
    }
    root = Xml.Element("svg", {"xmlns": "http://www.w3.org/2000/svg", "version": "1.1", **page})
    Xml.SubElement(root, "title").text = printable(heading.project)
    Xml.SubElement(root, "style").text = STYLE
    _square(root, layout.square)
    about = (heading.customer, heading.date)
    names = _ids([each.piece.key for each in layout.pieces])
    sides = {
        (each.piece.key, number): ident
        for name, each in zip(names, layout.pieces, strict=True)
        for number, ident in enumerate(_ids([f"{name}.{side.name}" for side in each.piece.sides]))
    }
    for name, each in zip(names, layout.pieces, strict=True):
        _piece(root, name, each, sides, annotate(each, piece_words(each.piece, say, about)), say)
    drawing = Xml.ElementTree(root)
    Xml.indent(drawing)
    with atomic_path(path) as partial:
        drawing.write(partial, encoding="utf-8", xml_declaration=True)


def _piece(
    root: Xml.Element, name: str, cut: CutPiece, sides: Mapping[SideKey, str], note: Annotation, say: Say
) -> None:
    """Add the group of a piece: cut line, a path a side, lines inside, notches, arrows, words.

    ``sides`` are the identifiers of the sides of all pieces.
    """
    piece = cut.piece
    group = Xml.SubElement(root, "g", {"id": name})
    Xml.SubElement(group, "title").text = printable(piece.key)
    _path(group, cut.cut, "cut", f"{name}.cut", closed=True)
    for number, side in enumerate(piece.sides):
        drawn = _path(group, side.points, "sew", sides[piece.key, number])
        drawn.set("data-seam", printable(side.name))
        if side.partner is not None and side.partner in sides:
            drawn.set("data-sewn-to", sides[side.partner])
    for kind, points in piece.internal:
        _path(group, points, "internal").set("data-kind", printable(kind))
    for points in cut.notches:
        _path(group, points, "notch")
    _path(group, note.grain, "grain")
    for head in arrow_heads(note.grain):
        _path(group, head, "head", closed=True)
    _path(group, note.stretch, "stretch")
    for head in arrow_heads(note.stretch):
        _path(group, head, "stretch")
    _text(group, note.stretch_word, say(STRETCH), STRETCH_LETTERS, "stretch-word")
    for number, (line, base) in enumerate(zip(note.lines, note.bases, strict=True)):
        _text(group, base, line, note.size, "" if number else "name")


def _square(root: Xml.Element, corner: Floats) -> None:
    group = Xml.SubElement(root, "g", {"id": "test-square"})
    corners = corner + SQUARE * np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    _path(group, corners, "square", closed=True)
    _text(group, corners.mean(axis=0), f"{SQUARE_WORDS}, 1:1", 4.0)


def _path(
    parent: Xml.Element, points: Points2, kind: str, ident: str = "", closed: bool = False
) -> Xml.Element:
    places = " L".join(f"{x:.4f} {y:.4f}" for x, y in _on_page(points))
    values = {"id": ident} if ident else {}
    return Xml.SubElement(parent, "path", {**values, "class": kind, "d": f"M{places}{' Z' * closed}"})


def _text(parent: Xml.Element, place: Floats, text: str, size: float, kind: str = "") -> None:
    x, y = _on_page(place[None])[0]
    values = {"class": kind} if kind else {}
    at = {"x": f"{x:.3f}", "y": f"{y:.3f}", "font-size": f"{size:g}"}
    Xml.SubElement(parent, "text", {**values, **at}).text = printable(text)


def _on_page(points: Points2) -> Points2:
    """Return places of the layout on the page, whose y goes down [mm]."""
    return points * [1.0, -1.0] + MARGIN


def _ids(names: Sequence[str]) -> list[str]:
    """Return identifiers of these names, numbered where two are the same."""
    found: list[str] = []
    for name in names:
        plain = ident = _id(name)
        count = 1
        while ident in found:
            count += 1
            ident = f"{plain}-{count}"
        found.append(ident)
    return found


def _id(name: str) -> str:
    """Return a name as an identifier: letters of every language, digits, dots and hyphens."""
    return re.sub(r"[^\w.]+", "-", name).strip("-") or "piece"
