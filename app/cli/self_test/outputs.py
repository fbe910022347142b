"""Parts of a self-test that write what is handed on: pictures, files for other programs, the sheet."""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

import numpy as np

from app.cli.self_test.checks import check
from app.cli.self_test.fixture import Bench
from core.progress import in_one_go, quiet
from core.scan.readers.registry import read_raw

if TYPE_CHECKING:
    from PySide6.QtGui import QImage

    from app.report.pages import Pages

_PAGE = re.compile(rb"/Type\s*/Page\b")
_TYPE = re.compile(rb"/FontName\s*/(?:[A-Z]{6}\+)?([\w-]+)")
_FRAMES = 4


def drawing(bench: Bench) -> str:
    """Draw the reshaped body off-screen: there must be a body in the picture; tell what has drawn it."""
    from app.presenters.export import ExportOptions  # noqa: PLC0415

    pixels = _exported(bench, "picture", "body.png", ExportOptions(size=(400, 480)))
    covered = float((pixels[..., 3] > 250).mean())
    check(0.1 < covered < 0.9, f"the body covers {100 * covered:.0f} % of the picture")
    shown = pixels[pixels[..., 3] > 250][:, :3]
    colours, spread = len(np.unique(shown, axis=0)), float(shown.std(axis=0).max())
    check(colours > 500 and spread > 8.0, f"the body has only {colours} colours")
    return f"body covers {100 * covered:.0f} % of the picture, {colours} colours, rendered by {_renderer()}"


def _renderer() -> str:
    """Return what draws for VTK: a graphics card, or software."""
    import pyvista as pv  # noqa: PLC0415

    plotter = pv.Plotter(off_screen=True, window_size=[16, 16])
    try:
        plotter.ren_win.Render()
        told = plotter.ren_win.ReportCapabilities() or ""
        kind = plotter.ren_win.GetClassName()
    finally:
        plotter.close()
    named = re.search(r"renderer string:\s*(.+)", told)
    return f"{named[1].strip() if named else 'an unknown renderer'} ({kind})"


def exports(bench: Bench) -> str:
    """Write drawings, a body and measures for other programs, and open them again."""
    import ezdxf  # noqa: PLC0415

    from app.presenters.export import ExportOptions  # noqa: PLC0415

    _exported(bench, "lines", "lines.dxf", ExportOptions())
    drawn = len(ezdxf.readfile(bench.folder / "lines.dxf").modelspace())
    check(drawn > 0, "lines.dxf contains no lines")
    _exported(bench, "flat", "strips.svg", ExportOptions())
    marks = len(list(ElementTree.parse(bench.folder / "strips.svg").getroot().iter()))
    check(marks > 5, "strips.svg is empty")
    _exported(bench, "body", "body.glb", ExportOptions())
    triangles = len(read_raw("body.glb", (bench.folder / "body.glb").read_bytes()).faces)
    check(triangles == len(bench.stages.body.mesh.faces), f"body.glb contains {triangles} triangles")
    _exported(bench, "measures", "measures.smis", ExportOptions())
    measures = len(list(ElementTree.parse(bench.folder / "measures.smis").getroot().iter("m")))
    check(measures > 5, f"measures.smis contains {measures} measurements")
    return f"DXF with {drawn} curves, SVG, GLB with {triangles:,} triangles, {measures} measurements"


def turntable(bench: Bench) -> str:
    """Write a GIF of a few pictures, and open it again."""
    from PIL import Image, ImageSequence  # noqa: PLC0415

    from app.presenters.export import ExportOptions  # noqa: PLC0415

    _exported(
        bench, "turntable", "turntable.gif", ExportOptions(frames=_FRAMES, seconds=1.0, size=(160, 200))
    )
    with Image.open(bench.folder / "turntable.gif") as moving:
        pictures = [np.asarray(each.convert("L"), dtype=float) for each in ImageSequence.Iterator(moving)]
    count = len(pictures)
    check(count == _FRAMES, f"turntable.gif has {count} frames, not {_FRAMES}")
    turned = min(float(np.abs(one - other).mean()) for one, other in pairwise(pictures))
    check(turned > 1.0, "the body does not rotate")
    return f"GIF of {count} different frames"


def _exported(bench: Bench, what: str, name: str, manner: Any) -> Any:
    """Write a file of the outcome, and return what was drawn for it, if anything."""
    from app.presenters.export_preview import prepare_export  # noqa: PLC0415

    path = bench.folder / name
    ready = prepare_export(what, path, bench.outcome, manner)
    drawn = in_one_go(ready.draw()) if ready.draw else None
    ready.write(path, drawn, quiet)
    return drawn


def report(bench: Bench) -> str:
    """Write the sheet to work from in both languages: its pages, its type, ink on each."""
    from app.presenters.lines import line_colours  # noqa: PLC0415 (brings Qt along)
    from app.report.document import ReportDocument  # noqa: PLC0415
    from app.report.images import render_images  # noqa: PLC0415
    from app.report.pages import pages_of  # noqa: PLC0415
    from app.report.pdf import write_pdf  # noqa: PLC0415
    from core.export.report_data import Heading, make_report  # noqa: PLC0415

    solution = bench.solution
    sheet = make_report(solution, solution.records, Heading("self-test", "2000-01-01"))
    names = [line.name for line in solution.stages.model.lines]
    pictures = in_one_go(render_images(solution, bench.outcome.occlusion))
    handout = ReportDocument(sheet, pictures, line_colours(names, solution.stages.design))
    told = []
    for language, family in (("en", "Inter"), ("ja", "NotoSansJP")):
        path = bench.folder / f"sheet-{language}.pdf"
        pages = pages_of(handout, language)
        write_pdf(path, pages, "self-test")
        told.append(_judged(path, pages, family))
    return f"{len(pictures)} pictures; {'; '.join(told)}"


def _judged(path: Path, pages: Pages, family: str) -> str:
    """Check a PDF file, and return what it is in words."""
    data = path.read_bytes()
    check(data.startswith(b"%PDF-") and data.rstrip().endswith(b"%%EOF"), f"{path.name} is an incomplete PDF")
    count = len(_PAGE.findall(data))
    check(count == pages.count == 2, f"{path.name} has {count} pages, not 2")
    type_ = {name.decode() for name in _TYPE.findall(data)}
    check(any(name.startswith(family) for name in type_), f"{path.name} is not set in {family}: {type_}")
    for page in range(pages.count):
        ink = _ink(_painted(pages, page))
        check(0.01 < ink < 0.6, f"page {page + 1} of {path.name} is covered by {100 * ink:.1f} % only")
    return f"{path.name} of {count} pages, {len(data) / 1000:.0f} kB, in {', '.join(sorted(type_))}"


def _painted(pages: Pages, page: int) -> QImage:
    """Return a page as the painter of the file paints it."""
    from PySide6.QtCore import Qt  # noqa: PLC0415
    from PySide6.QtGui import QImage, QPainter  # noqa: PLC0415

    from app.report.painter import UNITS  # noqa: PLC0415

    image = QImage(420, 594, QImage.Format.Format_Grayscale8)
    image.fill(Qt.GlobalColor.white)
    painter = QPainter(image)
    painter.scale(2.0 / UNITS, 2.0 / UNITS)
    pages.paint(painter, page)
    painter.end()
    return image


def _ink(image: QImage) -> float:
    """Return the share of a picture that is not white [1]."""
    return float((np.frombuffer(image.constBits(), dtype=np.uint8) < 200).mean())
