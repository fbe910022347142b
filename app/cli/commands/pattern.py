"""Compute the pattern pieces of a garment block on the reshaped body, and write them as files."""

from __future__ import annotations

import json
import os
from argparse import ArgumentParser, Namespace
from collections.abc import Iterator
from dataclasses import replace
from datetime import date
from pathlib import Path
from typing import Any

import numpy as np

from app.cli.design import design_of
from app.cli.options import add_lines, add_scan
from app.cli.output import DONE, finish, table_lines
from app.cli.pattern_advice import dart_lines, remedy_lines
from app.cli.solved_design import SolvedDesign, solve_design
from core import __version__
from core.document.garment_pattern import ALLOWANCE
from core.document.lower_trunk import LowerTrunk
from core.errors import PatternError
from core.export.pattern_csv import write_pieces, write_seams
from core.export.pattern_data import pattern_values, piece_values, seam_values
from core.export.pattern_dxf import write_pattern_dxf
from core.export.pattern_plt import write_pattern_plt
from core.export.pattern_svg import write_pattern_svg
from core.export.report_data import Heading
from core.files.atomic_write import write_text
from core.geometry.mesh import Points
from core.messages import Message
from core.pattern.allowance import cut_piece
from core.pattern.block_library import built_in_blocks, find_block
from core.pattern.cloth_library import built_in
from core.pattern.garment import Pattern, cut_garment
from core.pattern.layout import PAPERS, Tiling, lay_out, lay_out_on_tiles, whole_sheet
from core.pattern.places import BodyPlaces
from core.pattern.seam_curves import SeamDrawing

SHEET = "sheet"
"""One page that is as large as the layout."""

_WIDTH = 1400.0  # of the cloth or paper that pieces are laid out on [mm]
_FILES = ("dxf", "svg", "pdf", "plt", "pieces", "seams", "json")


def add_options(parser: ArgumentParser) -> None:
    """Add the options of ``busk pattern``."""
    parser.add_argument("--list", action="store_true", help="list blocks and cloths; no scan is read")
    add_scan(parser, required=False)
    add_lines(parser)
    parser.add_argument("--block", metavar="NAME", help="garment block: see --list")
    parser.add_argument("--dart-chart", metavar="PIECE", help="print where a dart helps: 'cup left'")
    out = "print ways out for pieces over their limit, each tried: a dart, another cloth, one more seam"
    parser.add_argument("--ways-out", action="store_true", help=out)
    parser.add_argument("--allowance", type=float, default=ALLOWANCE, metavar="MM", help="seam allowance")
    parser.add_argument("--dxf", metavar="FILE", help="output DXF, one block for each piece")
    parser.add_argument("--dxf-standard", choices=("aama", "astm"), default="aama", help="default: aama")
    parser.add_argument("--svg", metavar="FILE", help="output SVG 1:1, a named path for each side")
    parser.add_argument("--pdf", metavar="FILE", help="output PDF 1:1")
    paper = "paper of the PDF: pages to be joined, or one page of any size (default: a4)"
    parser.add_argument("--paper", choices=(*PAPERS, SHEET), default="a4", help=paper)
    parser.add_argument("--plt", metavar="FILE", help="output HPGL for plotters")
    parser.add_argument("--pieces", metavar="FILE", help="output the list of pieces as CSV")
    parser.add_argument("--seams", metavar="FILE", help="output the list of seams as CSV")
    parser.add_argument("--json", metavar="FILE", help="output pieces, seams and the verdict as JSON")


def run(options: Namespace) -> int:
    """Print the pieces and their strain, and write the files that are asked for."""
    if options.list:
        print("\n".join(_listed()))
        return DONE
    if not options.block or not options.input:
        raise PatternError(
            Message("A scan or project and a block are required."),
            Message("Enter busk pattern SCAN --block NAME; busk pattern --list shows the blocks."),
        )
    block = find_block(options.block)
    design = design_of(options)
    if block.needs_lower_trunk:
        design = replace(design, lower=design.lower or LowerTrunk())
    solved = solve_design(design, options.line or [], options.elastic or [], bare=True)
    garment = cut_garment(SeamDrawing(BodyPlaces.of(solved.solution.stages)), block)
    pattern = garment.flat(_worn_skin(solved), {cloth.name: cloth for cloth in built_in()})
    written = _write(pattern, solved, options)
    lines = [*solved.verdict, "", *_text(pattern), *written]
    stages = solved.solution.stages
    if options.dart_chart:
        lines += ["", *dart_lines(pattern, stages, options.dart_chart)]
    if options.ways_out:
        lines += ["", *remedy_lines(pattern, stages, _worn_skin(solved))]
    return finish("\n".join(lines), solved.converged and pattern.fits_cloths, solved.warnings)


def _worn_skin(solved: SolvedDesign) -> Points:
    """Return the vertices of the reshaped body without the noise of the scanner, (n, 3) [mm]."""
    body = solved.solution.stages.body
    return np.asarray(body.smoothed.vertices + solved.solution.body.vertices - body.mesh.vertices)


def _listed() -> Iterator[str]:
    rows = [("block", "garment"), *((block.name, block.title) for block in built_in_blocks())]
    yield from table_lines(rows)
    yield ""
    cloths = [(each.name, each.title, f"{100.0 * each.limit:.0f}") for each in built_in()]
    yield from table_lines([("cloth", "title", "limit %"), *cloths])


def _text(pattern: Pattern) -> Iterator[str]:
    rows = [("piece", "cloth", "area cm2", "strain %", "limit %", "")]
    for piece in piece_values(pattern):
        fits = "" if piece["fits"] else "more than its cloth takes up"
        values = (piece["area_mm2"] / 100.0, piece["strain_p95_percent"], piece["limit_percent"])
        rows.append((f"{piece['name']} {piece['side']}".rstrip(), piece["cloth"], *_rounded(values), fits))
    yield from table_lines(rows)
    worst = max((abs(a - b) for a, b in (seam["lengths_mm"] for seam in seam_values(pattern))), default=0.0)
    yield f"Seams agree within {worst:.2f} mm. Strain: of the worn piece beyond its ease, on 95 % of it."
    if not pattern.fits_cloths:
        yield "Add a seam or a dart, or choose a cloth that stretches further."


def _rounded(values: tuple[float, float, float]) -> tuple[str, str, str]:
    area, strain, limit = values
    return f"{area:.0f}", f"{strain:.1f}", f"{limit:.0f}"


def _write(pattern: Pattern, solved: SolvedDesign, options: Namespace) -> Iterator[str]:
    """Write the files that are asked for, and yield a line for each."""
    asked = {kind: Path(name) for kind in _FILES if (name := getattr(options, kind))}
    design = solved.solution.stages.design
    heading = Heading(Path(options.input).stem, date.today().isoformat(), design.customer)
    pieces = pattern.pieces(options.allowance)
    cut = [cut_piece(piece) for piece in pieces]
    writers = {
        "dxf": lambda path: write_pattern_dxf(path, lay_out(cut, _WIDTH), heading, options.dxf_standard),
        "svg": lambda path: write_pattern_svg(path, lay_out(cut, _WIDTH), heading),
        "plt": lambda path: write_pattern_plt(path, lay_out(cut, _WIDTH)),
        "pdf": lambda path: _write_pdf(path, _tiling(cut, options.paper), heading),
        "pieces": lambda path: write_pieces(path, pieces),
        "seams": lambda path: write_seams(path, pieces),
        "json": lambda path: write_text(path, _json(pattern, solved)),
    }
    for kind, path in asked.items():
        writers[kind](path)
        yield f"written to {path}"


def _tiling(cut: list[Any], paper: str) -> Tiling:
    return whole_sheet(cut, _WIDTH) if paper == SHEET else lay_out_on_tiles(cut, PAPERS[paper])


def _write_pdf(path: Path, tiling: Tiling, heading: Heading) -> None:
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")  # pages need no screen
    from app.gui.application import application  # noqa: PLC0415 (Qt is loaded for a PDF alone)
    from app.report.pattern_sheets import pattern_sheets  # noqa: PLC0415
    from app.report.pdf_file import write_pdf  # noqa: PLC0415

    application()
    write_pdf(path, pattern_sheets(tiling, heading, "en"), heading.project)


def _json(pattern: Pattern, solved: SolvedDesign) -> str:
    found = {"assessment": solved.assessment.as_data(), "versions": {"busk": __version__}}
    return json.dumps({**pattern_values(pattern), **found}, indent=1, ensure_ascii=False) + "\n"
