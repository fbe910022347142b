"""Format lines: titles, colours, widths, rows of the list, labels on the body."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cache

from app.i18n.catalog import number, tr
from app.i18n.lengths import length
from app.presenters.messages import elastic_title, kind_of, line_title, render, side_of
from app.rendering.band import OFF_WIDTH, Band, band_width
from core.analysis.length_limits.zones import LengthLimits
from core.control_mesh.embedding import embed
from core.control_mesh.straps import Tail
from core.control_mesh.template import Template, read_template
from core.document.design import Design
from core.document.lines import BUST, partner_of
from core.document.lower_trunk import GROUPS, line_group
from core.document.split_lines import can_split, is_split
from core.mechanics.constraint_lines import Line
from core.pipeline.build import Stages
from core.pipeline.live_solver import Frame

LOWER_COLOURS = {
    **dict.fromkeys(("above-waist", "waist", "below-waist"), "#E2A32F"),
    **dict.fromkeys(("belly", "belly-panel", "low-belly-panel", "belly-cross"), "#6FA3F5"),
    **dict.fromkeys(("high-hip", "hip", "under-hip"), "#8C8B2C"),
    **dict.fromkeys(("sling", "high-sling", "buttock-lift"), "#C2571A"),
    **dict.fromkeys(("leg-opening", "high-leg"), "#7A1F2E"),
}
"""Colours of the lines of the lower trunk, by kind."""

SEAMS = "#A9ABC9"
"""The colour of lines there that are seams or measured."""

LINE_COLOURS = {"full-bust": "#0A5F73", "mid-bust": "#E5536B", "under-bust": "#5A3F94"}
"""Colours of the template's lines in both themes, told apart by the colour-blind; top line first."""

OWN_COLOURS = ("#E2A32F", "#6FA3F5", "#7A1F2E", "#A9ABC9", "#8C8B2C", "#C2571A")
"""Colours of own lines, one after the other; a pair of lines for both sides shares one."""

Shown = tuple[LengthLimits, bool]
"""How far a line can go, and whether that was of the design before."""


def pair_title(name: str, design: Design) -> str:
    """Return what a line and its linked partner are called together."""
    kind = kind_of(name)
    titles = {
        "strap": tr("Straps"),
        "sling": tr("Slings"),
        "oblique": tr("Obliques"),
        "ring": tr("Rings"),
        **({kind: line_title(kind)} if kind in LINE_COLOURS or line_group(name) != "bust" else {}),
    }
    if kind == "strap" and not all(each.over_shoulder for each in design.own_lines if each.name == name):
        titles[kind] = tr("Upper-chest straps")
    return design.line_settings(name).title or titles.get(kind) or line_title(kind)


def row_title(name: str, design: Design) -> str:
    """Return what the row of a line is called: that of its pair if it is linked."""
    upper = design.band_of(name)[0]
    return pair_title(upper, design) if _is_linked(upper, design) else line_title(upper, design)


def _is_linked(name: str, design: Design) -> bool:
    return partner_of(name) in design.linked_lines(name)


def told_title(name: str, design: Design) -> str:
    """Return what the row of a line is called where others follow: "Mid-bust (left)", "Straps"."""
    side, name = side_of(name), design.band_of(name)[0]
    if not side or _is_linked(name, design):
        return row_title(name, design)
    kind = kind_of(name)
    titles = {"strap": tr("Strap"), "sling": tr("Sling"), "oblique": tr("Oblique"), "ring": tr("Ring")}
    line = design.line_settings(name).title or titles.get(kind) or line_title(kind)
    return tr("{line} ({side})").format(line=line, side=side)


def line_colours(names: Iterable[str], design: Design | None = None) -> dict[str, str]:
    """Return the colours of these lines in the order of the list: those of the template, top line first.

    The halves of a line that was split keep its colour.
    """
    given = list(names)
    halves = {name: LINE_COLOURS[kind_of(name)] for name in given if kind_of(name) in LINE_COLOURS}
    lower = sorted((name for name in given if line_group(name) != "bust"), key=_by_group)
    below = {name: LOWER_COLOURS.get(kind_of(name), SEAMS) for name in lower}
    own = {name: _own_kind(name, design) for name in given if name not in halves and name not in below}
    kinds = list(dict.fromkeys(own.values()))
    order = list(LINE_COLOURS)
    colours = {name: halves[name] for name in sorted(halves, key=lambda each: order.index(kind_of(each)))}
    colours |= {name: OWN_COLOURS[kinds.index(kind) % len(OWN_COLOURS)] for name, kind in own.items()}
    colours |= below
    if design is None:
        return colours
    return {name: design.line_settings(name).colour or colour for name, colour in colours.items()}


def _own_kind(name: str, design: Design | None) -> str:
    """Return what is common to the lines of one colour: the parts of a band, on both sides."""
    return kind_of(name if design is None else design.band_of(name)[0])


def _by_group(name: str) -> int:
    return GROUPS.index(line_group(name))


def line_views(
    design: Design, frame: Frame, hidden: Collection[str], leeways: Mapping[str, Shown] | None = None
) -> list[LineView]:
    """Return the rows of the list, top line first, then own lines; linked lines are one row.

    Those of the lower trunk follow, from above, if there is that region; own ones last in each group.
    """
    lines = {line.name: line for line in frame.stages.lines}
    rows = []
    for name, colour in line_colours(lines, design).items():
        pair = tuple(each for each in design.linked_lines(name) if each in lines)
        if name == pair[0]:
            view = _view(design, frame, [lines[each] for each in pair], colour)
            leeway, stale = (leeways or {}).get(name, (None, False))
            visible = not set(pair) <= set(hidden)
            # Of a line that lies under its own halves no length is worth trying.
            leeway = None if view.parted else leeway
            rows.append(replace(view, visible=visible, leeway=leeway, stale=stale))
    order = ("bust", *GROUPS)
    return sorted(rows, key=lambda row: (order.index(row.group), row.group != "bust" and row.own))


def _view(design: Design, frame: Frame, lines: list[Line], colour: str) -> LineView:
    """Return the row of a line, or of linked ones: lengths of whole bands, of a pair the mean of both."""
    name, traits = lines[0].name, design.line_settings(lines[0].name)
    tail = frame.stages.tails.get(name)
    own = {each.name for each in design.own_lines}
    group = design.line_group(name)
    bands = [[line for line in lines if line.name in design.band_of(each.name)] for each in lines]
    bands = [band for at, band in enumerate(bands) if band not in bands[:at]]
    sides = [_side(band, frame) for band in bands]
    partner = partner_of(name) if partner_of(name) in own or (group != "bust" and partner_of(name)) else ""
    return LineView(
        name,
        row_title(name, design),
        colour,
        design.ratio(name),
        sum(side.rest_mm for side in sides) / len(sides),
        sum(frame.line_lengths[line.name] for line in lines) / len(sides),
        any(line.constrains for line in lines),
        True,
        sum(line.whole_length for line in lines) / len(sides),
        name in own,
        partner=partner,
        sides=tuple(sides) if len(sides) > 1 else (),
        locked=traits.locked,
        own_title=traits.title,
        width_mm=band_width(name, design),
        stiffness=traits.stiffness,
        usual_stiffness=design.line_stiffness,
        apart=name[len(kind_of(name)) + 1 :] if partner and len(sides) == 1 else "",
        pair_title=pair_title(name, design),
        elastic=elastic_title(traits.elastic),
        splits=not partner and can_split(design, _template(design.template), name),
        parted=is_split(design, name),
        strap="" if tail is None else _strap_text(tail),
        over_shoulder=_over_shoulder(design, frame, name),
        group=group,
        whole_band=group != "bust" and lines[0].closed,
        worn=any(line.name in design.all_active_lines() for line in lines),
        below=tuple(part.name for band in bands for part in band[1:]),
    )


def _side(band: list[Line], frame: Frame) -> SideView:
    """Return one side of a row; the length of a band is that of all its parts."""
    rest = sum(line.rest_length for line in band)
    return SideView(side_of(band[0].name), rest, sum(frame.line_lengths[line.name] for line in band))


def _over_shoulder(design: Design, frame: Frame, name: str) -> bool | None:
    """Return whether a line runs over the shoulder, None for one that cannot.

    It can where its upper end is on the fixed body above the bust.
    """
    own = next((each for each in design.own_lines if each.name == name), None)
    if own is None or own.closed or own.region != BUST:
        return None
    if own.over_shoulder:
        return True
    control, bust_level = frame.stages.fitted, frame.stages.landmarks.bust_level
    if own.free:
        ends = embed(control.grid, (own.places[0], own.places[-1])).weights[[0, -1]]
        heights, held = ends @ control.mesh.vertices[:, 2], ends @ control.held > 1.0 - 1e-9
    else:
        points = [own.points[0], own.points[-1]]
        heights, held = control.mesh.vertices[points, 2], control.held[points]
    upper = int(heights.argmax())
    return False if held[upper] and heights[upper] > bust_level else None


def _strap_text(tail: Tail) -> str:
    """Return where a strap goes on from its upper end, or why it does not."""
    if tail.problem:
        return tr("{why} The line ends at the upper chest.").format(why=render(tail.problem))
    words = tr(
        "Over the shoulder to the under-bust band at the back; {length} of the path is on the "
        "fixed part of the body"
    )
    return words.format(length=length(tail.length, 0))


@cache
def _template(name: str) -> Template:
    return read_template(name)


@dataclass(frozen=True)
class SideView:
    """One line of a linked pair: its side in words, its length at rest and the one reached [mm]."""

    title: str
    rest_mm: float
    reached_mm: float | None


@dataclass(frozen=True)
class LineView:
    """What a row shows of a line; lengths [mm], ``ratio`` = set over rest length [1].

    ``rest_mm`` is the rest length of the free front part, ``whole_mm`` that of the whole closed band.
    ``reached_mm`` is None before a run. A line that is not ``constrained`` is only measured; an ``own`` one
    can be removed and led elsewhere. ``partner`` names its line of the other side, if there is one; the row
    of a linked pair has both ``sides``, and means of their lengths. ``own_title`` is empty for the usual one.
    One that is ``tried`` has a length that is only shown, and was not taken.
    One that ``splits`` goes across both sides and can be split into a left and a right line.
    One that was ``parted`` is off, and its two halves are worn in its place.
    ``apart`` is the side, "left" or "right", of a line that is set apart from its partner; ``pair_title``
    what both are called together.
    ``elastic`` is what it is made of, if anything: its length is then that of the elastic unstretched.
    ``pressed`` is what the line presses with and what that means, in the ``tone`` of its light; empty
    while it is not known.
    ``leeway`` is how far it can go, None while that is not known; ``stale`` that of the design before.
    ``strap`` is where it goes on over the shoulder, as words; its lengths are then those of all of it.
    ``over_shoulder``: whether it does, None for a line that cannot.
    ``width_mm`` is that of its band; ``stiffness`` [1] its own, or None for the ``usual_stiffness``.
    ``group`` is where the garment has it, "bust" or one of ``lower_trunk.GROUPS``; ``worn`` whether it acts.
    A ``whole_band`` is closed without a back that stays. ``below`` are the parts of it below the bust.
    """

    name: str
    title: str
    color: str
    ratio: float
    rest_mm: float
    reached_mm: float | None
    constrained: bool
    visible: bool
    whole_mm: float
    own: bool = False
    partner: str = ""
    sides: tuple[SideView, ...] = ()
    locked: bool = False
    own_title: str = ""
    width_mm: float = 12.0
    stiffness: float | None = None
    usual_stiffness: float = 16.0
    leeway: LengthLimits | None = None
    stale: bool = False
    apart: str = ""
    pair_title: str = ""
    elastic: str = ""
    pressed: str = ""
    tone: str = ""
    splits: bool = False
    tried: bool = False
    parted: bool = False
    strap: str = ""
    over_shoulder: bool | None = None
    group: str = "bust"
    whole_band: bool = False
    worn: bool = True
    below: tuple[str, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """Return the lines that this row stands for."""
        return (self.name, *([self.partner] if self.sides else []), *self.below)

    @property
    def settable(self) -> bool:
        """Return whether its length can be set."""
        return self.constrained and not self.locked


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
    design = stages.design
    worn = {name for region in design.regions for name in region.active_lines()}
    names = [line.name for line in stages.drawn_lines]
    # What cannot pull is not put on and taken off: it measures, and is drawn as it lies.
    off = {line.name for line in stages.lines if line.constrains} - worn
    routes = stages.all_routes
    return tuple(
        _Drawn(
            name,
            routes[name].path.tobytes() + routes[name].back.tobytes(),
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
    routes = stages.all_routes
    shown = [(line, routes[line.name]) for line in drawn(stages) if line.name not in hidden]
    return [
        Band(line.name, route.path, line.colour, line.width, route.back, line.off, route.drawn, route.sewn)
        for line, route in shown
    ]


def band_label(design: Design, frame: Frame, name: str) -> tuple[str, str]:
    """Return what stands beside a line on the body: its name and length, and how much shorter that is.

    Of an elastic, which is stretched far, the length that it reaches.
    """
    line = next(line for line in frame.stages.lines if line.name == name)
    title = line_title(name, design)
    if not line.constrains:
        return title, length(line.rest_length)
    ratio = design.ratio(name)
    if design.line_settings(name).elastic:
        stretch = frame.line_lengths[name] / (ratio * line.rest_length) - 1.0
        text = tr("elongation {value}").format(value=f"{number(100.0 * stretch)} %")
        return f"{title} {length(frame.line_lengths[name])}", text
    parts = (each for each in frame.stages.lines if each.name in design.band_of(name))
    change = (ratio - 1.0) * sum(part.rest_length for part in parts)
    return f"{title} {number(100.0 * ratio)} %", length(change, signed=True)
