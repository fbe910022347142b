"""Compute the pattern pieces of a garment block on the reshaped body, and write them as files."""

from __future__ import annotations

import os
from argparse import ArgumentParser, Namespace
from collections.abc import Iterator
from dataclasses import replace
from datetime import date
from pathlib import Path

from app.cli.design import design_of
from app.cli.options import add_lines, add_scan
from app.cli.output import DONE, finish, table_lines
from app.cli.pattern_advice import check_piece, dart_lines, fix_lines
from app.cli.solved_design import SolvedDesign, solve_design
from app.presenters.pattern import piece_rows, seam_rows
from app.presenters.pattern_files import SHEET, CutPattern, cut_pattern, tiling_of, write_pattern
from core.document.design import Design
from core.document.garment_pattern import GarmentPattern
from core.document.lower_trunk import LowerTrunk
from core.errors import PatternError
from core.export.avatar import avatar_kind, check_kind
from core.export.report_data import Heading
from core.messages import Message
from core.pattern.annotation import elastic_words
from core.pattern.block_library import built_in_blocks, find_block, read_block, write_block
from core.pattern.cloth_csv import read_cloth, write_cloth, write_template
from core.pattern.cloth_library import ALL_PIECES, built_in, find_cloth, with_cloth
from core.pattern.garment import pattern_of, worn_skin
from core.pattern.layout import PAPERS, Tiling
from core.pattern.piece import sewn_length

_FILES = ("dxf", "svg", "pdf", "plt", "pieces", "seams", "json", "save_block", "avatar")
_DRAWN = ("dxf", "svg", "pdf", "plt")


def add_options(parser: ArgumentParser) -> None:
    """Add the options of ``busk pattern``."""
    parser.add_argument("--list", action="store_true", help="list blocks and cloths; no scan is read")
    table = (
        "write a table in which a cloth of your own is entered after a 10 cm test, or with --cloth NAME the "
        "table of that cloth; no scan is read"
    )
    parser.add_argument("--save-cloth", metavar="FILE", help=table)
    add_scan(parser, required=False)
    add_lines(parser)
    block = "garment block: see --list, or a file .json of your own (default: that of the project)"
    parser.add_argument("--block", metavar="NAME", help=block)
    parser.add_argument("--save-block", metavar="FILE", help="write the block as a file to be changed")
    cloth = (
        f"cloth of a piece, named without its side, or of '{ALL_PIECES}': one of the library or the project "
        "by name or unique words ('wing=stretch lace'), or a table of your own ('wing=net.csv'); repeatable"
    )
    parser.add_argument("--cloth", action="append", metavar="PIECE=CLOTH", help=cloth)
    allowance = "allowance of seams without their own (default: that of the project, or 7)"
    parser.add_argument("--allowance", type=float, metavar="MM", help=allowance)
    parser.add_argument("--dart-chart", metavar="PIECE", help="print the dart chart of a piece: 'cup left'")
    fixes = "print verified fixes for pieces over their limit: a dart, another cloth, one more seam"
    parser.add_argument("--fixes", action="store_true", help=fixes)
    strips = "add straps and bands of the cut list as pieces, apart from elastics of edges"
    parser.add_argument("--strips", action="store_true", help=strips)
    _add_files(parser)


def _add_files(parser: ArgumentParser) -> None:
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
    avatar = "output the reshaped body with the seams as named lines: OBJ (mm) or GLB (m), y up"
    parser.add_argument("--avatar", metavar="FILE", help=avatar)


def run(options: Namespace) -> int:
    """Print the pieces and their strain, and write the files that are asked for."""
    if options.list:
        print("\n".join(_listed()))
        return DONE
    if options.save_cloth:
        return _save_cloth(options)
    if not options.input:
        raise _missing()
    design = design_of(options)
    plan = _plan(options, design)
    _check(options, plan)
    if plan.block.needs_lower_trunk:
        design = replace(design, lower=design.lower or LowerTrunk())
    solved = solve_design(design, options.line or [], options.elastic or [], bare=True)
    shown = solved.solution
    pattern = pattern_of(shown.stages, shown.body.vertices, plan)
    cut = cut_pattern(pattern, plan, shown, shown.body.vertices, strips=options.strips)
    advice: list[str] = []  # before files are written, as it may fail
    if options.dart_chart:
        advice += ["", *dart_lines(pattern, shown.stages, options.dart_chart)]
    if options.fixes:
        advice += ["", *fix_lines(pattern, shown.stages, worn_skin(shown.stages, shown.body.vertices))]
    lines = [*solved.verdict, "", *_text(cut), *_write(cut, solved, options), *advice]
    return finish("\n".join(lines), solved.converged and cut.pattern.fits_cloths, solved.warnings)


def _save_cloth(options: Namespace) -> int:
    """Write the table of a cloth, or one to be filled in."""
    path, wanted = Path(options.save_cloth), options.cloth or []
    if len(wanted) > 1:
        raise PatternError(
            Message("One table holds one cloth."), Message("Enter --cloth once with --save-cloth.")
        )
    if wanted:
        plan = design_of(options).pattern if options.input else None
        write_cloth(path, find_cloth(wanted[0].rpartition("=")[2].strip(), plan.cloths if plan else ()))
    else:
        write_template(path)
    print(f"written to {path}")
    return DONE


def _check(options: Namespace, plan: GarmentPattern) -> None:
    """Raise PatternError for what would fail only after the design is solved and files are written."""
    if options.dart_chart:
        check_piece(plan.block, options.dart_chart)
    if options.avatar:
        check_kind(avatar_kind(options.avatar))
    taken = {Path(options.input).resolve()}
    for name in filter(None, (getattr(options, kind) for kind in _FILES)):
        path = Path(name).resolve()
        if path in taken:
            raise PatternError(
                Message("The file {name} is used twice.", name=path.name),
                Message("Enter another name for each file."),
            )
        taken.add(path)


def _missing() -> PatternError:
    return PatternError(
        Message("A scan or project and a block are required."),
        Message("Enter busk pattern SCAN --block NAME; busk pattern --list shows the blocks."),
    )


def _plan(options: Namespace, design: Design) -> GarmentPattern:
    """Return what the pieces are cut by: the pattern of the design, changed by the options."""
    plan, name = design.pattern, options.block
    if name:
        own = name.lower().endswith(".json")
        block = read_block(Path(name)) if own else find_block(name)
        plan = replace(plan, block=block) if plan else GarmentPattern(block)
    if plan is None:
        raise _missing()
    for text in options.cloth or []:
        piece, equals, wanted = (part.strip() for part in text.partition("="))
        if not equals:
            raise PatternError(
                Message("'{text}' is not a piece and its cloth.", text=text),
                Message("Enter PIECE=CLOTH, as in --cloth 'wing=stretch lace'."),
            )
        table = wanted.lower().endswith(".csv")
        cloth = read_cloth(Path(wanted)) if table else find_cloth(wanted, plan.cloths)
        plan = with_cloth(plan, piece, cloth)
    return plan if options.allowance is None else replace(plan, allowance=options.allowance)


def _listed() -> Iterator[str]:
    rows = [("block", "garment"), *((block.name, block.title) for block in built_in_blocks())]
    yield from table_lines(rows)
    yield ""
    cloths = [(each.name, each.title, f"{100.0 * each.limit:.0f}") for each in built_in()]
    yield from table_lines([("cloth", "title", "limit %"), *cloths])


def _text(cut: CutPattern) -> Iterator[str]:
    pattern, pieces, seams = cut.pattern, piece_rows(cut.pattern), seam_rows(cut.pattern)
    rows = [("piece", "cloth", "area cm2", "strain %", "limit %", "")]
    for piece in pieces:
        values = f"{piece.area_cm2:.0f}", f"{piece.strain_percent:.1f}", f"{piece.limit_percent:.0f}"
        rows.append((piece.name, piece.cloth, *values, "" if piece.fits else "does not fit"))
    yield from table_lines(rows)
    yield from (f"{each.title}: {said}" for each in pieces for said in (each.reason, each.note) if said)
    yield from dict.fromkeys(f"{each.title}: {each.note}" for each in seams if each.note)
    known = {piece.key: piece for piece in cut.pieces}
    sewn = [(side.length, sewn_length(known, side)) for piece in cut.pieces for side in piece.sides]
    worst = max((abs(own - other) for own, other in sewn if other is not None), default=0.0)
    yield f"Seam lengths match within {worst:.2f} mm."
    yield "Strain: worn cloth beyond its ease, on 95 % of the area."
    if not pattern.fits_cloths:
        yield "Add a seam or a dart, or choose a cloth that stretches further."
    yield from _elastics(cut)


def _elastics(cut: CutPattern) -> Iterator[str]:
    """Yield what is said of elastics on edges, and of strips."""
    for (piece, number), each in cut.elastics.items():
        flat = next(flat for flat in cut.pattern.flats if flat.panel.name == piece)
        words = elastic_words(each.line, each.part_mm, each.cut_mm)
        yield f"{piece}, {flat.panel.sides[number].name}: {words}"
    yield from (f"Strip: {each.title}, {each.cloth_title}" for each in cut.strips)
    yield from (f"No strip for {name}. Run busk cut for the reason." for name in cut.uncut)


def _write(cut: CutPattern, solved: SolvedDesign, options: Namespace) -> Iterator[str]:
    """Write the files that are asked for, and yield a line for each."""
    asked = {kind: Path(name) for kind in _FILES if (name := getattr(options, kind))}
    design = solved.solution.stages.design
    heading = Heading(Path(options.input).stem, date.today().isoformat(), design.customer)
    found = {"assessment": solved.assessment.as_data()}
    if not asked.keys().isdisjoint(_DRAWN):
        _ = cut.shapes  # raises PatternError before any file is written
    for kind, path in asked.items():
        if kind == "pdf":
            _write_pdf(path, tiling_of(cut, options.paper), heading)
        elif kind == "save_block":
            write_block(path, cut.plan.block)
        elif kind == "avatar":
            write_pattern(path, avatar_kind(path), cut, heading, found)
        else:
            write_pattern(path, f"dxf-{options.dxf_standard}" if kind == "dxf" else kind, cut, heading, found)
        yield f"written to {path}"


def _write_pdf(path: Path, tiling: Tiling, heading: Heading) -> None:
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")  # pages need no screen
    from app.gui.application import application  # noqa: PLC0415 (Qt is loaded for a PDF alone)
    from app.report.pattern_sheets import pattern_sheets  # noqa: PLC0415
    from app.report.pdf_file import write_pdf  # noqa: PLC0415

    application()
    write_pdf(path, pattern_sheets(tiling, heading, "en"), heading.project)
