"""Format the cut list: pieces, notes, and the list as plain cells."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from app.i18n.catalog import joined, number, tr
from app.i18n.lengths import length_number, using_unit
from app.presenters.lines import line_colours
from app.presenters.messages import elastic_title, line_title, render_all
from app.rendering.band import band_width
from core.document.design import Design
from core.garment.cut_list import CutList, CutRow
from core.garment.pressure_list import PressureList
from core.pipeline.build import Stages
from core.pipeline.live_solver import Frame


def cut_list_view(frame: Frame, cuts: CutList) -> CutListView:
    """Return the pieces of a frame in the order of the list of lines."""
    design = frame.stages.design
    colours = line_colours((line.name for line in frame.stages.drawn_lines), design)
    pieces = {row.line: row for row in cuts.rows}
    still = {line.name for line in frame.stages.model.lines if not line.constrains}
    views = [
        _view(pieces[name], design, colour, name in still) if name in pieces else _off(name, design, colour)
        for name, colour in colours.items()
        if name in pieces or name in still
    ]
    return CutListView(
        tuple(views),
        tuple(render_all(cuts.notes, design)) if pieces else (),
        design.tissue_stiffness if design.tissue == "net" else None,
        worn=bool(pieces),
        bare=not any(row.elastic for row in cuts.rows),
    )


def as_table(
    stages: Stages, cuts: CutList, pressed: PressureList | None, keys: Iterable[str] | None = None
) -> list[list[str]]:
    """Return the cut list as plain cells, with a heading, in the order of the list of lines.

    ``pressed`` are the contact pressures of the same shape, if known; ``keys`` select columns, by default
    all. Lengths are in mm, as in files.
    """
    design = stages.design
    order = list(line_colours((line.name for line in stages.drawn_lines), design))
    rows = sorted(cuts.rows, key=lambda row: order.index(row.line))
    most = {row.line: row.max_kpa for row in pressed.rows} if pressed is not None else {}
    with using_unit("mm"):
        cells = [_columns(row, _most(row, most), design) for row in rows]
    titles = _titles()
    shown = list(titles if keys is None else keys)
    return [[titles[key] for key in shown], *([each[key] for key in shown] for each in cells)]


def _most(row: CutRow, most: Mapping[str, float | None]) -> float | None:
    """Return the largest pressure of a piece [kPa], None where it is not known."""
    known = [kpa for name in (row.line, *row.parts) if (kpa := most.get(name)) is not None]
    return max(known, default=None)


def _titles() -> dict[str, str]:
    """Return the columns of the table in order: their keys, and how each is headed."""
    return {
        "line": tr("Line"),
        "elastic": tr("Elastic"),
        "width": tr("Width mm"),
        "cut": tr("Cut mm"),
        "elongation": tr("Elongation %"),
        "tension": tr("Tension N"),
        "pressure": tr("Maximum contact pressure kPa"),
        "front": tr("Front on body mm"),
        "whole": tr("Full length on body mm"),
        "allowance": tr("Allowance mm"),
        "estimate": tr("Estimate"),
        "notes": tr("Notes"),
    }


def _columns(row: CutRow, kpa: float | None, design: Design) -> dict[str, str]:
    """Return what stands in each column of ``_titles``, by the same keys."""
    stretch = None if row.elongation is None else 100.0 * row.elongation
    return {
        "line": line_title(row.line, design),
        "elastic": elastic_title(row.elastic),
        "width": _figure(row.width_mm),
        "cut": _figure(row.cut_mm),
        "elongation": _figure(stretch),
        "tension": _figure(row.tension_n),
        "pressure": _figure(kpa),
        "front": _figure(row.reached_front_mm),
        "whole": _figure(row.reached_whole_mm),
        "allowance": _figure(row.allowance_mm),
        "estimate": tr("yes") if row.estimate else tr("no"),
        "notes": joined(render_all(row.notes, design)),
    }


def _figure(value: float | None) -> str:
    return "" if value is None else f"{value:.1f}"


def _off(name: str, design: Design, color: str) -> CutView:
    """Return the row of a band that can be cut although its line does not constrain the model."""
    notes = (tr("On the rib cage: no effect on the body. Choose an elastic for cut length and pressure."),)
    elastic = elastic_title(design.line_settings(name).elastic)
    return CutView(name, line_title(name, design), color, band_width(name, design), elastic, notes=notes)


def _view(row: CutRow, design: Design, color: str, still: bool) -> CutView:
    set_here = still and row.elongation is not None and design.line_hold == "spring"
    return CutView(
        row.line,
        line_title(row.line, design),
        color,
        band_width(row.line, design),
        elastic_title(row.elastic),
        "" if row.cut_mm is None else length_number(row.cut_mm, 0),
        "" if row.elongation is None else f"{number(100.0 * row.elongation, 0, signed=True)} %",
        "" if row.tension_n is None else number(row.tension_n, 1),
        tuple(render_all(row.notes, design)) if row.elastic else (),
        100.0 * row.elongation if set_here and row.elongation is not None else None,
        row.front_only,
        row.far,
    )


@dataclass(frozen=True)
class CutView:
    """One piece to cut: of which ``line``, of what, how long [mm], how far stretched [%], its tension [N].

    ``elastic`` is what it is called here, empty for none. What is not known is an empty text; ``notes`` are
    sentences that say why, or what to look at. ``stretch_percent`` is a number where the designer sets it.
    The lengths of one that is ``front_only`` are no whole piece; one that is ``far`` is stretched further
    than usual.
    """

    line: str
    title: str
    color: str
    width_mm: float
    elastic: str
    cut: str = ""
    stretch: str = ""
    tension: str = ""
    notes: tuple[str, ...] = ()
    stretch_percent: float | None = None
    front_only: bool = False
    far: bool = False


@dataclass(frozen=True)
class CutListView:
    """All pieces, and what holds for all of them; ``tissue`` [N/m] is what the newtons of a net rest on.

    ``worn`` tells whether any line is: bands on points that do not move can be cut all the same. ``bare``
    that no line is made of an elastic yet.
    """

    rows: tuple[CutView, ...]
    notes: tuple[str, ...] = ()
    tissue: float | None = None
    worn: bool = False
    bare: bool = False
