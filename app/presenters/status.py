"""What the window says about a design and its frame: plain values for the panels, worked out in one place."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

from app.i18n.catalog import number, tr
from app.i18n.lengths import length, length_unit
from app.presenters.lines import line_colours, line_title
from app.presenters.states import state_title
from app.rendering.band import OFF_WIDTH, Band, band_width
from core.document.design import Design
from core.pipeline.build import Stages
from core.pipeline.live_solver import Frame


@dataclass(frozen=True)
class _Drawn:
    """How a line is drawn; as long as all are the same, nothing has to be laid on the body anew."""

    name: str
    course: bytes
    colour: str
    width: float
    off: bool


def drawn(stages: Stages) -> tuple[_Drawn, ...]:
    """Return how the lines of a body are drawn, in the order of the list."""
    names, design = [line.name for line in stages.model.lines], stages.design
    # What cannot pull is not put on and taken off: it measures, and is drawn as it lies.
    off = {line.name for line in stages.model.lines if line.constrains} - design.worn()
    return tuple(
        _Drawn(
            name,
            stages.routes[name].path.tobytes() + stages.routes[name].back.tobytes(),
            colour,
            OFF_WIDTH if name in off else band_width(name, design),
            name in off,
        )
        for name, colour in line_colours(names, design).items()
    )


def bands(stages: Stages, hidden: Collection[str]) -> list[Band]:
    """Return what is drawn of the lines that are not ``hidden``.

    Those with a back are drawn as whole bands and straps over the shoulder; the others end where they end.
    """
    shown = [(line, stages.routes[line.name]) for line in drawn(stages) if line.name not in hidden]
    return [
        Band(line.name, route.path, line.colour, line.width, route.back, line.off, route.drawn)
        for line, route in shown
    ]


def band_label(design: Design, frame: Frame, name: str) -> tuple[str, str]:
    """Return what stands beside a line on the body: its name and length, and how much shorter that is.

    Of an elastic, which is stretched far, the length that it reaches.
    """
    line = next(line for line in frame.stages.model.lines if line.name == name)
    title = line_title(name, design)
    if not line.constrains:
        return title, length(line.rest_length)
    ratio = design.ratio(name)
    if design.traits_of(name).elastic:
        stretch = frame.lengths[name] / (ratio * line.rest_length) - 1.0
        said = tr("stretched by {value}").format(value=f"{number(100.0 * stretch)} %")
        return f"{title} {length(frame.lengths[name])}", said
    change = (ratio - 1.0) * line.rest_length
    return f"{title} {number(100.0 * ratio)} %", length(change, signed=True)


def facts(frame: Frame, current: bool = True) -> list[str]:
    """Return the plain facts of the status bar; a frame that is not ``current`` is of a former design."""
    return [
        length_unit(),
        tr("{count} triangles").format(count=number(len(frame.stages.body.mesh.faces), 0)),
        *([] if current else [state_title("stale")]),
    ]
