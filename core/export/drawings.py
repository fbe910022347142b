"""Drawings for pattern programs: curves in space as DXF or OBJ, strips at full size as SVG or DXF."""

from __future__ import annotations

import os
import re
import sys
import unicodedata
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, nullcontext
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from xml.etree import ElementTree as Xml

from core.document.printable_name import printable
from core.errors import UserError
from core.export.band_geometry import NOT_TO_CUT, LineCurve, Strip
from core.export.units_and_axes import FileSpace
from core.files.atomic_write import atomic_path
from core.geometry.mesh import Points
from core.messages import Length, Message, length_of

UNIT_NUMBERS = {"mm": 4, "cm": 5, "m": 6, "in": 1}
"""The units of a drawing as DXF numbers them."""


Say = Callable[[Message], str]
"""Returns a message as it is to be written."""

CURVE_FORMATS = ("dxf", "obj")

STRIP_FORMATS = ("svg", "dxf")

SCALE_BAR = 100.0
"""Length of the bar that tells whether a drawing was printed at its size [mm]."""

_MARGIN, _HEAD, _LETTER = 10.0, 24.0, 4.0  # round the drawing, for the scale bar, of the text [mm]

_APART = 120.0  # between two words across a strip that is not to be cut [mm]

_LAYER = re.compile(r'[<>/\\":;?*|=`,\x00-\x1f]')

_INK = ("#111111", "#777777")  # of what is cut, and of what is only told


def new_dxf(unit: str) -> Any:
    """Return an empty drawing of DXF R2010 in a unit, "mm", "cm", "m" or "in"."""
    with nullcontext() if "ezdxf" in sys.modules else _without_fonts():
        import ezdxf  # noqa: PLC0415 (it takes long to load, and is needed here alone)

    drawing = ezdxf.new("R2010")
    drawing.header["$INSUNITS"] = UNIT_NUMBERS[unit]
    drawing.header["$MEASUREMENT"] = 0 if unit == "in" else 1
    return drawing


@contextmanager
def _without_fonts() -> Iterator[None]:
    """Let the library find a list of fonts without any.

    Else it reads every font of the system while it loads, which may take seconds, and leaves their list in
    the user's folder; what is drawn here needs none.
    """
    variable = "XDG_CACHE_HOME"
    before = os.environ.get(variable)
    with TemporaryDirectory() as folder:
        known = Path(folder) / "ezdxf" / "font_manager_cache.json"
        known.parent.mkdir()
        known.write_text('{"version": 0, "font-faces": []}', encoding="utf-8")
        os.environ[variable] = folder
        try:
            yield
        finally:
            del os.environ[variable]
            if before is not None:
                os.environ[variable] = before


def write_curves(path: str | os.PathLike[str], curves: Sequence[LineCurve], space: FileSpace) -> None:
    """Write worn lines in space: DXF with 3D polylines on a layer for each part, or OBJ with lines.

    Raises UserError for another ending, or a place that cannot be written to.
    """
    target, kind = Path(path), drawing_kind(path, CURVE_FORMATS)
    parts = [(curve.name, part, space.places(each)) for curve in curves for part, each in curve.parts.items()]
    with atomic_path(target) as partial:
        if kind == "obj":
            partial.write_text("\n".join(_obj_lines(parts, space)) + "\n", encoding="utf-8")
        else:
            drawing = new_dxf(space.unit)
            layers = _layers([f"{name} {part}" for name, part, _ in parts])
            for layer, (_, _, places) in zip(layers, parts, strict=True):
                drawing.layers.add(layer, color=1 + layers.index(layer) // 2 % 6)
                drawing.modelspace().add_polyline3d(places.tolist(), dxfattribs={"layer": layer})
            drawing.saveas(partial)


def write_strips(
    path: str | os.PathLike[str], strips: Sequence[Strip], heading: str = "", say: Say = str
) -> None:
    """Write strips at their size, 1:1 in millimetres, with a scale bar: SVG, or DXF with a layer a strip.

    ``say`` puts what stands beside them into another language. Raises UserError for another ending, or a
    place that cannot be written to.
    """
    target, kind, heading = Path(path), drawing_kind(path, STRIP_FORMATS), printable(heading)
    with atomic_path(target) as partial:
        if kind == "svg":
            drawing = Xml.ElementTree(_svg(strips, heading, say))
            Xml.indent(drawing)
            drawing.write(partial, encoding="utf-8", xml_declaration=True)
        else:
            _strips_dxf(strips, heading, say).saveas(partial)


def drawing_kind(path: str | os.PathLike[str], formats: Sequence[str]) -> str:
    """Return which of ``formats`` a name ends in. Raises UserError if it is none."""
    kind = Path(path).suffix.lower().lstrip(".")
    if kind not in formats:
        raise UserError(
            Message("Lines cannot be exported as .{kind}.", kind=kind),
            Message("Choose one of: {choices}.", choices=", ".join(formats)),
        )
    return kind


def strip_label(strip: Strip) -> Message:
    """Return what stands beside a strip."""
    length, width = Length(strip.length, 1), length_of(strip.width)
    if not strip.note:
        return Message("{title}: {length} long, {width} wide", title=strip.title, length=length, width=width)
    return Message(
        "{title}: {length} long, {width} wide; {note}",
        title=strip.title,
        length=length,
        width=width,
        note=strip.note,
    )


def _obj_lines(parts: Iterable[tuple[str, str, Points]], space: FileSpace) -> Iterable[str]:
    yield f"# lines of a garment, {space.unit}, {space.axes}"
    count = 0
    for name, part, places in parts:
        yield f"o {'_'.join(name.split())}_{part}"
        yield from (f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in places)
        yield "l " + " ".join(str(count + k + 1) for k in range(len(places)))
        count += len(places)


def _svg(strips: Sequence[Strip], heading: str, say: Say) -> Xml.Element:
    words = [_wide(text) for text in (heading, *(say(strip_label(strip)) for strip in strips))]
    ends = [
        strip.length + (0.75 * _wide(say(strip.marks[-1][1])) if strip.marks else 0.0) for strip in strips
    ]
    width = 2 * _MARGIN + max([1.3 * SCALE_BAR, *words, *ends])
    tops = _tops(strips)
    size = {
        "width": f"{width:.3f}mm",
        "height": f"{tops[-1]:.3f}mm",
        "viewBox": f"0 0 {width:.3f} {tops[-1]:.3f}",
    }
    root = Xml.Element("svg", {"xmlns": "http://www.w3.org/2000/svg", "version": "1.1", **size})
    style = {"fill": "none", "stroke": _INK[0], "stroke-width": "0.2", "font-family": "sans-serif"}
    page = Xml.SubElement(root, "g", {**style, "font-size": f"{_LETTER:g}"})
    _svg_text(page, _MARGIN, _MARGIN, f"{heading}  " * bool(heading) + "1:1, mm")
    bar = Xml.SubElement(page, "g", {"id": "scale-bar"})
    for (x0, y0), (x1, y1) in _bar(_MARGIN, _MARGIN + 6.0):
        _svg_line(bar, (x0, y0), (x1, y1))
    _svg_text(page, _MARGIN + SCALE_BAR + 3.0, _MARGIN + 7.0, f"{SCALE_BAR:g} mm")
    for strip, name, top in zip(strips, _layers([s.name for s in strips]), tops, strict=False):
        group = Xml.SubElement(page, "g", {"id": f"strip {name}".replace(" ", "-")})
        Xml.SubElement(group, "title").text = say(strip_label(strip))
        _svg_text(group, _MARGIN, top - 2.5, say(strip_label(strip)))
        box = {"x": _MARGIN, "y": top, "width": strip.length, "height": strip.width}
        dashed = {} if strip.to_cut else {"stroke-dasharray": "3 2"}
        Xml.SubElement(group, "rect", {key: f"{value:.4f}" for key, value in box.items()} | dashed)
        for at in _across(strip):
            letter = _across_size(strip)
            down = top + 0.5 * (strip.width + 0.7 * letter)
            _svg_text(group, _MARGIN + at, down, say(NOT_TO_CUT), letter)
        for at, what in strip.marks:
            _svg_line(
                group, (_MARGIN + at, top), (_MARGIN + at, top + strip.width + 2.0), {"stroke-dasharray": "1"}
            )
            _svg_text(group, _MARGIN + at + 0.8, top + strip.width + 3.5, say(what), 3.0)
    return root


def _wide(text: str) -> float:
    """Return about how wide a text is [mm]: letters of the East are as wide as they are high."""
    return _LETTER * sum(1.0 if unicodedata.east_asian_width(each) in "WF" else 0.6 for each in text)


def _svg_line(
    parent: Xml.Element,
    start: tuple[float, float],
    end: tuple[float, float],
    extra: dict[str, str] | None = None,
) -> None:
    ends = {"x1": start[0], "y1": start[1], "x2": end[0], "y2": end[1]}
    Xml.SubElement(parent, "line", {key: f"{value:.4f}" for key, value in ends.items()} | (extra or {}))


def _svg_text(parent: Xml.Element, x: float, y: float, text: str, size: float = _LETTER) -> None:
    place = {"x": f"{x:.3f}", "y": f"{y:.3f}", "font-size": f"{size:g}", "fill": _INK[1], "stroke": "none"}
    Xml.SubElement(parent, "text", place).text = text


def _strips_dxf(strips: Sequence[Strip], heading: str, say: Say) -> Any:
    drawing = new_dxf("mm")
    space, tops = drawing.modelspace(), _tops(strips)
    drawing.layers.add("scale bar", color=8)
    for start, end in _bar(0.0, 0.0):
        space.add_line(start, end, dxfattribs={"layer": "scale bar"})
    note = f"{SCALE_BAR:g} mm, 1:1  {heading}".strip()
    space.add_text(note, height=_LETTER, dxfattribs={"layer": "scale bar", "insert": (SCALE_BAR + 5.0, 0.0)})
    for k, (strip, layer) in enumerate(zip(strips, _layers([s.name for s in strips]), strict=True)):
        on, y = {"layer": layer}, _HEAD - tops[k] - strip.width
        drawing.layers.add(layer, color=1 + k % 6)
        corners = [(0.0, y), (strip.length, y), (strip.length, y + strip.width), (0.0, y + strip.width)]
        space.add_lwpolyline(corners, close=True, dxfattribs=on)
        space.add_text(
            say(strip_label(strip)), height=_LETTER, dxfattribs=on | {"insert": (0.0, y + strip.width + 2.0)}
        )
        for at in _across(strip):
            size = _across_size(strip)
            place = {"insert": (at, y + 0.5 * (strip.width - size))}
            space.add_text(say(NOT_TO_CUT), height=size, dxfattribs=on | place)
        for at, what in strip.marks:
            space.add_line((at, y - 2.0), (at, y + strip.width), dxfattribs=on)
            space.add_text(say(what), height=3.0, dxfattribs=on | {"insert": (at + 0.8, y - 4.0)})
    return drawing


def _across(strip: Strip) -> list[float]:
    """Return where along a strip it is printed that it is not to be cut [mm]: again and again."""
    if strip.to_cut:
        return []
    return [_APART * k + 4.0 for k in range(max(1, int(strip.length // _APART)))]


def _across_size(strip: Strip) -> float:
    """Return how high that is printed [mm]."""
    return min(0.7 * strip.width, 2.0 * _LETTER)


def _tops(strips: Sequence[Strip]) -> list[float]:
    """Return how far down each strip begins, and last how high the whole drawing is [mm]."""
    tops, below = [], _MARGIN + _HEAD
    for strip in strips:
        tops.append(below)
        below += strip.width + 18.0
    return [*tops, below - 18.0 + 8.0 + _MARGIN if strips else below]


def _bar(x: float, y: float) -> list[tuple[tuple[float, float], tuple[float, float]]]:
    """Return the lines of the scale bar from a place on, first the one that is as long as it says."""
    ticks = [(x + 10.0 * k, 3.0 if k % 5 == 0 else 1.5) for k in range(11)]
    return [((x, y), (x + SCALE_BAR, y)), *(((at, y), (at, y - high)) for at, high in ticks)]


def _layers(names: Sequence[str]) -> list[str]:
    """Return names that a drawing takes for layers, each another one."""
    layers: list[str] = []
    for name in names:
        plain = layer = _LAYER.sub("_", name).strip()[:80] or "line"
        count = 1
        while layer.casefold() in {each.casefold() for each in (*layers, "0", "scale bar")}:
            count += 1
            layer = f"{plain} {count}"
        layers.append(layer)
    return layers
