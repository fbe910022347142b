"""Describe exports: kinds, formats and their options, and the choices that are remembered."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from app.i18n.catalog import tr
from app.presenters.messages import line_title
from app.presenters.model_options import Choice
from app.rendering.band import band_width
from app.rendering.camera import View
from core.document.design import Design
from core.export.units_and_axes import AXES, GLTF, UNITS
from core.geometry.mesh import Floats, Mesh, Points
from core.measurements.table import before_after, measure_rows
from core.mechanics.iteration import Record
from core.pipeline.build import Stages

Options = tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class Export:
    """Something to export: its title, its drawing, what it is, and each of its formats with what opens it."""

    what: str
    title: str
    drawing: str
    tip: str
    formats: dict[str, str]


def exports() -> tuple[Export, ...]:
    """Return all that can be exported, in the order of the list."""
    return *_meshes(), *_drawings(), _measures(), *_pictures(), _turns()


def _meshes() -> tuple[Export, ...]:
    meshes = {
        "glb": tr("glTF, always in metres with y up: Blender, viewers, web pages."),
        "obj": tr("For most 3D programs, including CLO. Choose the unit on import."),
        "ply": tr("Scanner format: MeshLab, CloudCompare, Blender. Choose the unit on import."),
        "stl": tr("For 3D printing and CAD. Choose the unit on import."),
    }
    return (
        Export("body", tr("Body"), "person", tr("Whole body, original or reshaped."), meshes),
        Export(
            "control",
            tr("Control mesh"),
            "control-mesh",
            tr("Coarse mesh on the body that carries the lines."),
            meshes | {"csv": tr("Table of control points in mm, with row and column.")},
        ),
    )


def _drawings() -> tuple[Export, ...]:
    return (
        Export(
            "lines",
            tr("Lines as curves"),
            "lines",
            tr(
                "Active lines as smooth curves on the skin. Lengths differ from the cut list: "
                "use the band strips for cutting."
            ),
            {
                "dxf": tr("For CAD and pattern programs: one layer for each part of a line."),
                "obj": tr("For 3D programs; aligned with a body exported with the same settings."),
            },
        ),
        Export(
            "flat",
            tr("Band strips"),
            "strips",
            tr(
                "Flat strip of each active line at full scale with marks; cut length where an elastic is "
                "chosen."
            ),
            {
                "svg": tr("For printing at full scale: Inkscape, Illustrator, cutters, browsers."),
                "dxf": tr("For CAD, pattern programs and plotters, in millimetres."),
            },
        ),
        Export(
            "cut",
            tr("Cut list"),
            "cut-list",
            tr("Elastic, cut length, tension and contact pressure of each active line."),
            {"csv": _table()},
        ),
    )


def _measures() -> Export:
    return Export(
        "measures", tr("Measurements"), "ruler", tr("Measurements of the body."), _measure_formats(_table())
    )


def _pictures() -> tuple[Export, ...]:
    return (
        Export(
            "picture",
            tr("Image"),
            "camera",
            tr("Image of the body with its bands in a choice of sizes."),
            {"png": tr("For all programs.")},
        ),
        Export(
            "turntable",
            tr("Turntable"),
            "arrow-counter-clockwise",
            tr("Animation of one full rotation of the body."),
            {
                "webp": tr("Full colour, small files: browsers and most viewers."),
                "gif": tr("For all programs, e-mails and slides; 256 colours, large files."),
                "png": tr("Image sequence for video editors."),
            },
        ),
    )


def _turns() -> Export:
    told = tr("Volume error, heights and lengths at each iteration.")
    return Export("turns", tr("Iterations"), "chart-line", told, {"csv": _table()})


def _table() -> str:
    return tr("Table for spreadsheets.")


def _measure_formats(table: str) -> dict[str, str]:
    return {
        "smis": tr("SeamlyMe and Seamly2D; lengths only."),
        "vit": tr("Valentina and Tape; lengths only."),
        "csv": table,
        "json": tr("For scripts and other programs."),
    }


def settings_of(export: Export, kind: str) -> tuple[Choice, ...]:
    """Return what can be chosen for something in one of its formats; where there are more, the format too."""
    formats = tuple((each, format_title(each)) for each in export.formats)
    format_ = Choice("format", tr("Format"), export.formats[kind], formats)
    in_space = (_shape(),) if kind in _OWN_SPACE else (_shape(), _unit(), _axes())
    chosen = {
        **dict.fromkeys(("body", "control", "lines"), in_space),
        "measures": (_shape(), _unit(("mm", "cm", "in") if kind in ("smis", "vit") else tuple(UNITS))),
        "picture": (_view(), _shape(), _bands(), _ground(clear=True), _size(_PICTURE_SIZES)),
        "turntable": (_shows(), _ground(), _frames(), _seconds(), _size(_TURNTABLE_SIZES)),
    }.get(export.what, ())
    return (format_, *chosen) if len(formats) > 1 else chosen


def format_title(kind: str) -> str:
    """Return a format as it is written."""
    return {"webp": "WebP"}.get(kind, kind.upper())


def default_value(what: str, key: str) -> str:
    """Return what holds until something else is chosen."""
    space = {"unit": "cm" if what == "measures" else "mm", "axes": "z-up"}
    sizes = {"picture": "2000x2250", "turntable": "640x720"}
    return {"size": sizes.get(what, ""), "frames": "36", "seconds": "6", "view": "now", **space}.get(key, "")


_OWN_SPACE = (*GLTF, "csv")  # formats that say themselves which unit and axes they have
_PICTURE_SIZES = ("1000x1125", "2000x2250", "3000x3375", "1920x1080", "3840x2160")
_TURNTABLE_SIZES = ("480x540", "640x720", "960x1080", "1280x720")


def _shape() -> Choice:
    options = (("", tr("Reshaped")), ("before", tr("Original")))
    return Choice("shape", tr("Shape"), tr("Reshaped or original body."), options)


def _unit(units: tuple[str, ...] = tuple(UNITS)) -> Choice:
    words = {
        "mm": tr("Millimetres"),
        "cm": tr("Centimetres"),
        "m": tr("Metres"),
        "in": tr("Inches"),
    }
    sentence = tr("Length unit of the file.")
    return Choice("unit", tr("Unit"), sentence, tuple((unit, words[unit]) for unit in units))


def _axes() -> Choice:
    words = {
        "z-up": tr("z-up, front to −y: Blender, CAD"),
        "y-up": tr("y-up, front to z: CLO, Maya"),
        "z-up-front-y": tr("z-up, front to y: some CAD"),
    }
    sentence = tr("Up and front directions in the file.")
    return Choice("axes", tr("Axes"), sentence, tuple((axes, words[axes]) for axes in AXES))


def _view() -> Choice:
    options = (
        ("now", tr("Current view")),
        ("front", tr("Front")),
        ("left", tr("Left")),
        ("right", tr("Right")),
        ("back", tr("Back")),
        ("three-quarter", tr("Three-quarter view")),
        ("top", tr("From above")),
    )
    return Choice("view", tr("View direction"), tr("View direction of the body."), options)


def _bands() -> Choice:
    options = (("", tr("Shown")), ("none", tr("Hidden")))
    return Choice("bands", tr("Bands"), tr("Bands hidden in the view stay hidden."), options)


def _ground(clear: bool = False) -> Choice:
    options: Options = (("", tr("Light")), ("dark", tr("Dark")))
    if clear:
        options = (*options, ("clear", tr("Transparent")))
    return Choice("ground", tr("Background"), tr("Background colour."), options)


def _size(sizes: tuple[str, ...]) -> Choice:
    options = tuple((size, size.replace("x", " × ")) for size in sizes)
    return Choice("size", tr("Size"), tr("Width and height in pixels."), options)


def _shows() -> Choice:
    options = (("", tr("Reshaped")), ("beside", tr("Before and after")))
    return Choice(
        "shows", tr("Content"), tr("Reshaped body alone, or before and after side by side."), options
    )


def _frames() -> Choice:
    options = tuple((count, count) for count in ("12", "24", "36", "72"))
    return Choice("frames", tr("Images"), tr("More images: smoother rotation, larger file."), options)


def _seconds() -> Choice:
    options = tuple((seconds, tr("{seconds} s").format(seconds=seconds)) for seconds in ("3", "6", "12"))
    return Choice("seconds", tr("Duration"), tr("Duration of one rotation."), options)


@dataclass(frozen=True)
class ExportOptions:
    """How something is written; each kind of file asks for what concerns it.

    ``unit`` and ``axes`` are None where the usual ones will do; ``before`` takes the body at rest in place of
    the reshaped one; ``frames``, ``seconds`` and ``beside`` are those of a turntable, ``size`` [px], ``dark``
    ground and ``bands`` those of pictures, ``clear`` ground and ``view``, by name or whole, of a single one.
    """

    unit: str | None = None
    axes: str | None = None
    before: bool = False
    frames: int = 36
    seconds: float = 6.0
    size: tuple[int, int] = (640, 720)
    dark: bool = False
    beside: bool = False
    clear: bool = False
    bands: bool = True
    view: str | View = "three-quarter"


@dataclass(frozen=True, eq=False)
class ExportSource:
    """A body at rest and as ``control_points``, (n, 3) [mm], reshape it, with the turns that led there.

    What is worked out for one file is kept for the next. ``hidden`` are lines that pictures leave out,
    ``material`` what the body looks made of in them, ``named`` project and customer, None as
    they were opened. ``lower_points`` (m, 3) [mm] are the control points of the lower trunk, if there is one.
    """

    stages: Stages
    control_points: Points
    records: Sequence[Record] = ()
    hidden: frozenset[str] = frozenset()
    material: str = "clay"
    named: tuple[str, str] | None = None
    lower_points: Points | None = None

    @property
    def whose(self) -> str:
        """Return the names of project and customer, as a drawing is headed."""
        named = self.named or (Path(self.design.scan.path).name, self.design.customer)
        return " · ".join(filter(None, named))

    @property
    def design(self) -> Design:
        """Return the design that this came out of."""
        return self.stages.design

    def points(self, before: bool) -> Points:
        """Return the control points at rest or reshaped, shape (n, 3) [mm]."""
        return self.stages.control.mesh.vertices if before else self.control_points

    def region_points(self, before: bool) -> tuple[Points, ...]:
        """Return the control points of each region at rest or reshaped, the bust's first."""
        lower = self.stages.lower
        if lower is None:
            return (self.points(before),)
        below = lower.control.mesh.vertices if before or self.lower_points is None else self.lower_points
        return self.points(before), below

    def body(self, before: bool) -> Mesh:
        """Return the whole body at rest or reshaped."""
        return self.stages.skin.body(self.region_points(before))

    @cached_property
    def measures(self) -> list[dict[str, Any]]:
        """Return the measures before and after, a row each."""
        return measure_rows(*before_after(self.stages, *self.region_points(before=False)))

    @cached_property
    def occlusion(self) -> Floats:
        """Return how open to light the body is at each vertex, (n,) [1]."""
        from app.rendering.ambient_occlusion import bake_occlusion  # noqa: PLC0415 (brings VTK along)

        return bake_occlusion(self.stages.body.mesh)

    @cached_property
    def looks(self) -> tuple[Mapping[str, str], Mapping[str, float]]:
        """Return titles and widths [mm] of the lines as the window shows them."""
        names = [line.name for line in self.stages.drawn_lines]
        titles = {name: line_title(name, self.design) for name in names}
        return titles, {name: band_width(name, self.design) for name in names}


_OF_FORMAT = ("unit", "axes")  # each program that opens a format asks for its own


class ExportSettings:
    """What was chosen, from the ``text`` of a former session; what in it is no choice is forgotten."""

    def __init__(self, text: str) -> None:
        self._exports = {export.what: export for export in exports()}
        try:
            kept = json.loads(text)
        except ValueError:
            kept = {}
        self._kept: dict[str, object] = kept if isinstance(kept, dict) else {}

    @property
    def text(self) -> str:
        """Return all choices as text for the settings."""
        return json.dumps(self._kept)

    @property
    def export(self) -> Export:
        """Return the last export, at first the body."""
        return self.find(str(self._kept.get("what")))

    def find(self, what: str) -> Export:
        """Return what can be exported by its word, else the first."""
        return self._exports.get(what, next(iter(self._exports.values())))

    def choose_export(self, what: str) -> None:
        """Export something else."""
        self._kept["what"] = what

    def kind(self, what: str) -> str:
        """Return the format that was chosen for something."""
        formats, kept = self.find(what).formats, self._kept.get(f"{what}/format")
        return kept if isinstance(kept, str) and kept in formats else next(iter(formats))

    def settings(self, what: str) -> tuple[Choice, ...]:
        """Return what can be chosen for something in its format."""
        return settings_of(self.find(what), self.kind(what))

    def values(self, what: str, kind: str = "") -> dict[str, str]:
        """Return what is chosen for something, in its format or another ``kind``, by the keys of settings."""
        kind = kind or self.kind(what)
        chosen = {}
        for setting in settings_of(self.find(what), kind):
            kept = self._kept.get(_key(what, kind, setting.key))
            known = any(kept == value for value, _ in setting.options)
            chosen[setting.key] = str(kept) if known else default_value(what, setting.key)
        return chosen | {"format": kind}

    def choose(self, what: str, key: str, value: str) -> None:
        """Record one choice for something."""
        self._kept[_key(what, self.kind(what), key)] = value

    def manner(self, what: str, kind: str = "", view: View | None = None) -> ExportOptions:
        """Return how to write something in its format or another ``kind``; ``view`` is the view now."""
        chosen = self.values(what, kind)
        manner = ExportOptions(
            unit=chosen.get("unit"),
            axes=chosen.get("axes"),
            before=chosen.get("shape") == "before",
            dark=chosen.get("ground") == "dark",
            beside=chosen.get("shows") == "beside",
            clear=chosen.get("ground") == "clear",
            bands=chosen.get("bands") != "none",
        )
        if "size" in chosen:
            wide, high = chosen["size"].split("x")
            manner = replace(manner, size=(int(wide), int(high)))
        if "frames" in chosen:
            manner = replace(manner, frames=int(chosen["frames"]), seconds=float(chosen["seconds"]))
        if chosen.get("view", "now") != "now":
            return replace(manner, view=chosen["view"])
        return manner if view is None else replace(manner, view=view)


def _key(what: str, kind: str, key: str) -> str:
    return f"{what}.{kind}/{key}" if key in _OF_FORMAT else f"{what}/{key}"
