"""What leaves of a pattern: its pieces with elastics and strips, laid out, as files of every kind."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from app.i18n.catalog import tr
from app.presenters.messages import elastic_title, line_title, render
from app.rendering.band import band_width
from core import __version__
from core.document.garment_pattern import GarmentPattern
from core.errors import UserError
from core.export.avatar import seam_lines, write_avatar
from core.export.pattern_csv import write_pieces, write_seams
from core.export.pattern_data import pattern_values
from core.export.pattern_dxf import write_pattern_dxf
from core.export.pattern_plt import write_pattern_plt
from core.export.pattern_strips import strip_pieces, uncut_strips
from core.export.pattern_svg import write_pattern_svg
from core.export.report_data import Heading
from core.files.atomic_write import write_text
from core.garment.cut_list import cut_list_of
from core.geometry.mesh import Points
from core.messages import Message
from core.pattern.allowance import CutPiece, cut_piece
from core.pattern.edge_elastics import edge_elastics, lines_on_edges
from core.pattern.garment import Pattern, pattern_of, worn_skin
from core.pattern.layout import PAPERS, Tiling, lay_out, lay_out_on_tiles, whole_sheet
from core.pattern.piece import EdgeElastic, Piece, SideKey
from core.pipeline.build import Stages
from core.pipeline.warnings import ShownState

SHEET = "sheet"
"""One page that is as large as the layout."""

WIDTH = 1400.0
"""Of the cloth or paper that pieces are laid out on [mm]."""

ENDINGS = {
    "pdf": ".pdf",
    "dxf-aama": ".dxf",
    "dxf-astm": ".dxf",
    "svg": ".svg",
    "plt": ".plt",
    "pieces": ".csv",
    "seams": ".csv",
    "json": ".json",
    "obj": ".obj",
    "glb": ".glb",
}
"""Kinds of files and the endings of their names."""


@dataclass(frozen=True, eq=False)
class CutPattern:
    """A pattern with the ``pieces`` and ``strips`` to cut, and the ``elastics`` of its edges.

    ``uncut`` are lines of which no strip can be cut; ``worn`` (n, 3) [mm] is the skin of the body ``stages``
    as it is reshaped, without noise.
    """

    plan: GarmentPattern
    pattern: Pattern
    elastics: Mapping[SideKey, EdgeElastic]
    pieces: tuple[Piece, ...]
    strips: tuple[Piece, ...]
    uncut: tuple[str, ...]
    stages: Stages
    worn: Points

    @cached_property
    def shapes(self) -> tuple[CutPiece, ...]:
        """Return all pieces and strips with their allowances. Raises PatternError."""
        return tuple(cut_piece(piece) for piece in (*self.pieces, *self.strips))


def cut_pattern(
    pattern: Pattern, plan: GarmentPattern, shown: ShownState, vertices: Points, *, strips: bool
) -> CutPattern:
    """Return what is cut of a pattern of a shown design, with strips of its lines if they are wanted.

    ``vertices`` (n, 3) [mm] are those of the reshaped body.

    Raises LineError for control points that are not a valid shape.
    """
    cuts, design = cut_list_of(shown), shown.stages.design
    elastics = edge_elastics(pattern, cuts)
    names = [row.line for row in cuts.rows]
    titles = {name: line_title(name, design) for name in names}
    titles |= {row.elastic: elastic_title(row.elastic) for row in cuts.rows}
    widths = {name: band_width(name, design) for name in names}
    on_edges = lines_on_edges(pattern, cuts)
    pieces, worn = pattern.pieces(plan.allowance, elastics), worn_skin(shown.stages, vertices)
    taken = {piece.key for piece in pieces}
    straps = strip_pieces(shown, cuts, on_edges, titles, widths, taken) if strips else ()
    uncut = uncut_strips(cuts, on_edges) if strips else ()
    return CutPattern(plan, pattern, elastics, pieces, straps, uncut, shown.stages, worn)


def pattern_or_reason(stages: Stages, vertices: Points) -> Pattern | Message | None:
    """Return the pattern of a design on its reshaped body, vertices (n, 3) [mm], or why there is none.

    None for a design without a pattern.
    """
    plan = stages.design.pattern
    if plan is None:
        return None
    try:
        return pattern_of(stages, vertices, plan)
    except UserError as error:
        return error.text


def tiling_of(cut: CutPattern, paper: str) -> Tiling:
    """Return the pieces on sheets of one of PAPERS, or on one ``SHEET``. Raises PatternError."""
    shapes = cut.shapes
    return whole_sheet(shapes, WIDTH) if paper == SHEET else lay_out_on_tiles(shapes, PAPERS[paper])


def write_pattern(path: Path, kind: str, cut: CutPattern, heading: Heading, found: Mapping[str, Any]) -> None:
    """Write a file of one of the kinds of ENDINGS but a PDF; ``found`` is told beside the pieces in JSON.

    Raises UserError where it cannot be written.
    """
    if kind == "json":
        values = {
            **pattern_values(cut.pattern, cut.pieces, cut.elastics),
            **found,
            "versions": {"busk": __version__},
        }
        write_text(path, json.dumps(values, indent=1, ensure_ascii=False) + "\n")
    elif kind in ("obj", "glb"):
        skin = cut.stages.body.smoothed
        write_avatar(path, skin.moved(cut.worn), seam_lines(cut.pattern.garment.curves, skin, cut.worn), kind)
    elif kind in ("pieces", "seams"):
        (write_pieces if kind == "pieces" else write_seams)(path, (*cut.pieces, *cut.strips))
    else:
        layout = lay_out(cut.shapes, WIDTH)
        if kind.startswith("dxf"):
            write_pattern_dxf(path, layout, heading, kind.removeprefix("dxf-"))
        elif kind == "svg":
            write_pattern_svg(path, layout, heading, render)
        else:
            write_pattern_plt(path, layout)


def kind_titles() -> dict[str, tuple[str, str]]:
    """Return title and description of each kind of file."""
    return {
        "pdf": (tr("PDF 1:1"), tr("Pages to print at 100 % and join, with a square to check the scale")),
        "dxf-aama": (
            tr("DXF-AAMA"),
            tr("For apparel CAD: one block a piece, notches, grain lines"),
        ),
        "dxf-astm": (tr("DXF-ASTM"), tr("As DXF-AAMA, with the layers of ASTM D6673")),
        "svg": (tr("SVG 1:1"), tr("For drawing programs and laser cutters: a named path for each side")),
        "plt": (tr("HPGL"), tr("For plotters: cut lines, sew lines and marks with pens of their own")),
        "pieces": (tr("List of pieces (CSV)"), tr("Name, cloth, number, area and allowances of each piece")),
        "seams": (tr("List of seams (CSV)"), tr("Both lengths of each seam")),
        "json": (tr("Values (JSON)"), tr("Pieces, seams, strain and the verdict for other programs")),
        "obj": (
            tr("Avatar (OBJ)"),
            tr("The reshaped body with its seams as named groups, for CLO and VStitcher"),
        ),
        "glb": (tr("Avatar (GLB)"), tr("The reshaped body with its seams as named lines")),
    }


def paper_titles() -> dict[str, str]:
    """Return what each kind of paper is called."""
    return {"a4": "A4", "a3": "A3", "letter": "Letter", SHEET: tr("One page")}
