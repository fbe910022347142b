"""What can be exported and how, in plain words: what each kind of file is for, and what opens it."""

from __future__ import annotations

from dataclasses import dataclass

from app.i18n.catalog import tr
from app.presenters.model_options import Choice
from core.export.units_and_axes import AXES, UNITS

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
        "obj": tr("Opened by nearly every 3D program, CLO among them. Tell it the unit."),
        "ply": tr("The format of scanners: MeshLab, CloudCompare, Blender. Tell it the unit."),
        "stl": tr("For 3D printing and CAD. Tell it the unit."),
    }
    return (
        Export("body", tr("Body"), "person", tr("The whole body, as it was scanned or reshaped."), meshes),
        Export(
            "control",
            tr("Control mesh"),
            "control-mesh",
            tr("The coarse mesh that lies on the body and carries the lines."),
            meshes | {"csv": tr("A table of the control points in mm, with row and column.")},
        ),
    )


def _drawings() -> tuple[Export, ...]:
    return (
        Export(
            "lines",
            tr("Lines as curves"),
            "lines",
            tr("The worn lines, smooth on the skin. Lengths differ from the cut list: cut by strips."),
            {
                "dxf": tr("For CAD and pattern programs: a layer for each part of a line."),
                "obj": tr("For 3D programs, to lie on the body that is exported likewise."),
            },
        ),
        Export(
            "flat",
            tr("Bands as flat strips"),
            "strips",
            tr("A strip for each worn line at its size, to cut where its elastic is known, with marks."),
            {
                "svg": tr("Prints at its size: Inkscape, Illustrator, cutters, browsers."),
                "dxf": tr("For CAD, pattern programs and plotters, in millimetres."),
            },
        ),
    )


def _measures() -> Export:
    return Export(
        "measures", tr("Measures"), "ruler", tr("What the body measures."), _measure_formats(_table())
    )


def _pictures() -> tuple[Export, ...]:
    return (
        Export(
            "picture",
            tr("Picture"),
            "camera",
            tr("The body with its bands, as large as you like."),
            {"png": tr("Opened by everything.")},
        ),
        Export(
            "turntable",
            tr("Turntable"),
            "arrow-counter-clockwise",
            tr("The body turns once round."),
            {
                "webp": tr("All colours, small: browsers and most viewers."),
                "gif": tr("Moves everywhere, in mails and slides too; 256 colours, large."),
                "png": tr("A series of pictures, for programs that cut films."),
            },
        ),
    )


def _turns() -> Export:
    told = tr("Volume error, heights and lengths, turn by turn.")
    return Export("turns", tr("Turns of the run"), "chart-line", told, {"csv": _table()})


def _table() -> str:
    return tr("A table for spreadsheets.")


def _measure_formats(table: str) -> dict[str, str]:
    return {
        "smis": tr("SeamlyMe and Seamly2D; lengths alone."),
        "vit": tr("Valentina and Tape; lengths alone."),
        "csv": table,
        "json": tr("For programs of your own."),
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


def usual(what: str, key: str) -> str:
    """Return what holds until something else is chosen."""
    space = {"unit": "cm" if what == "measures" else "mm", "axes": "z-up"}
    sizes = {"picture": "2000x2250", "turntable": "640x720"}
    return {"size": sizes.get(what, ""), "frames": "36", "seconds": "6", "view": "now", **space}.get(key, "")


_OWN_SPACE = ("glb", "csv")  # formats that say themselves which unit and axes they have
_PICTURE_SIZES = ("1000x1125", "2000x2250", "3000x3375", "1920x1080", "3840x2160")
_TURNTABLE_SIZES = ("480x540", "640x720", "960x1080", "1280x720")


def _shape() -> Choice:
    options = (("", tr("Reshaped")), ("before", tr("At rest")))
    return Choice("shape", tr("Shape"), tr("The body after, or before it was reshaped."), options)


def _unit(units: tuple[str, ...] = tuple(UNITS)) -> Choice:
    words = {
        "mm": tr("Millimetres"),
        "cm": tr("Centimetres"),
        "m": tr("Metres"),
        "in": tr("Inches"),
    }
    said = tr("The unit of lengths in the file.")
    return Choice("unit", tr("Unit"), said, tuple((unit, words[unit]) for unit in units))


def _axes() -> Choice:
    words = {
        "z-up": tr("z up, face to −y: Blender, CAD"),
        "y-up": tr("y up, face to z: CLO, Maya"),
        "z-up-front-y": tr("z up, face to y: some CAD"),
    }
    said = tr("Which way is up, and where the body faces.")
    return Choice("axes", tr("Axes"), said, tuple((axes, words[axes]) for axes in AXES))


def _view() -> Choice:
    options = (
        ("now", tr("As the view is now")),
        ("front", tr("Front")),
        ("left", tr("Left")),
        ("right", tr("Right")),
        ("back", tr("Back")),
        ("three-quarter", tr("Three-quarter view")),
        ("top", tr("From above")),
    )
    return Choice("view", tr("Look from"), tr("From where the body is seen."), options)


def _bands() -> Choice:
    options = (("", tr("Shown")), ("none", tr("Left out")))
    return Choice("bands", tr("Bands"), tr("Those that the view hides stay hidden."), options)


def _ground(clear: bool = False) -> Choice:
    options: Options = (("", tr("Light")), ("dark", tr("Dark")))
    if clear:
        options = (*options, ("clear", tr("Transparent")))
    return Choice("ground", tr("Background"), tr("What the body stands before."), options)


def _size(sizes: tuple[str, ...]) -> Choice:
    options = tuple((size, size.replace("x", " × ")) for size in sizes)
    return Choice("size", tr("Size"), tr("Width and height in pixels."), options)


def _shows() -> Choice:
    options = (("", tr("Reshaped")), ("beside", tr("Before and after")))
    return Choice("shows", tr("Shows"), tr("The reshaped body alone, or both side by side."), options)


def _frames() -> Choice:
    options = tuple((count, count) for count in ("12", "24", "36", "72"))
    return Choice("frames", tr("Pictures"), tr("More of them turn more smoothly, in a larger file."), options)


def _seconds() -> Choice:
    options = tuple((seconds, tr("{seconds} s").format(seconds=seconds)) for seconds in ("3", "6", "12"))
    return Choice("seconds", tr("Time"), tr("How long one turn takes."), options)
