"""Writes the project files that this version leaves to later ones, with what it makes of them.

    python packaging/release_files.py           tests/releases/VERSION: the projects and their figures
    python packaging/release_files.py again 0.1.0    the figures alone, as the present program finds them

Later versions open every one of them: tests/end_to_end. Once a version is published its projects are
never written again; its figures are only where the method was changed on purpose, which the list of changes
then says.
"""

from __future__ import annotations

import gzip
import json
import math
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np

from app.cli.commands.picture import draw_picture
from core import __version__
from core.control_mesh.template import read_template
from core.document.calibration_record import Calibration, FittedParameter
from core.document.custom_measures import CustomMeasurement
from core.document.design import Design, ScanSource
from core.document.document import Document
from core.document.line_notation import parse_line
from core.document.lines import LineSettings
from core.document.storage.project_file import ScanFile, open_project, save_project
from core.export.mesh import write_mesh
from core.export.units_and_axes import FileSpace
from core.garment.cut_list import cut_list
from core.garment.elastic_library import find_elastic
from core.garment.presets import built_in, with_preset
from core.garment.pressure_list import pressure_list
from core.geometry.mesh import Mesh
from core.landmarks.manual import in_file
from core.measurements.table import before_after, measure_rows
from core.pipeline.build import build, detect_landmarks, read_body
from core.pipeline.solve import solve
from core.scan.readers.registry import read_triangles

ROOT = Path(__file__).resolve().parent.parent
RELEASES = ROOT / "tests" / "releases"

CORNERS = 2100
"""So many corners a scan has: few, and all that is looked for is still found on it."""


def small_scan(sample: str, name: str, space: FileSpace | None = None) -> ScanFile:
    """Return a sample with few corners, in a file of this name; packed if it ends in .gz."""
    path = ROOT / "resources" / "samples" / sample
    mesh = thinned(*read_triangles(path.name, path.read_bytes()))
    with tempfile.TemporaryDirectory() as folder:
        plain = Path(folder) / Path(name.removesuffix(".gz")).name
        write_mesh(plain, mesh, space=space)
        data = plain.read_bytes()
    return ScanFile(name, gzip.compress(data, mtime=0) if name.endswith(".gz") else data)


def thinned(points: np.ndarray, faces: np.ndarray) -> Mesh:
    """Return a mesh of about ``CORNERS`` corners: those in the same cell of a grid become one."""
    size = 1.15 * math.sqrt(float(Mesh(points, faces).face_areas.sum()) / CORNERS)
    _, place = np.unique(np.floor(points / size).astype(int), axis=0, return_inverse=True)
    place = place.ravel()
    middles = [np.bincount(place, weights=points[:, axis]) / np.bincount(place) for axis in range(3)]
    faces = place[faces]
    faces = faces[[len(set(face)) == 3 for face in faces.tolist()]]
    _, first = np.unique(np.sort(faces, axis=1), axis=0, return_index=True)
    return Mesh(np.stack(middles, axis=1), faces[np.sort(first)])


def first_save() -> tuple[Document, ScanFile]:
    """Return what a beginner saves: one line, nothing else."""
    scan = small_scan("mannequin.ply", "mannequin.ply")
    return Document.single(Design(ScanSource(scan.name)).with_line("mid-bust", 0.95)), scan


def everything() -> tuple[Document, ScanFile]:
    """Return three variants with all that a project can hold beside its settings."""
    scan = small_scan("mannequin.ply", "山田様 2回目.ply.gz")
    template = read_template("168")
    rest = Design(
        ScanSource(scan.name),
        customer="山田 花子 様",
        worn_tight_mm=12.0,
        tissue_stiffness=480.0,
        own_measures=(
            CustomMeasurement("前中心 Gore", "straight", ("bust_point_left", "front_centre")),
            CustomMeasurement("Arc", "skin", ("bust_point_left", "bust_point_right")),
            CustomMeasurement("Ribs", "girth", ("waist_front",), 60.0),
            CustomMeasurement("Chest", "girth", (), 500.0),
        ),
    )
    rest = rest.with_custom_line(parse_line("strap left=r2c3:r5c3", template))
    rest = rest.with_custom_line(parse_line("strap right=r2c-3:r5c-3", template))
    rest = rest.with_custom_line(parse_line("斜め=r1c-2,r2c-1,r3c0", template))
    rest = rest.with_line_settings(LineSettings("斜め", "斜めのライン", "#e5536b", True, True, 2.5, 8.0))
    plain = rest.with_line("mid-bust", 0.96).with_line("strap left", 0.97).with_line("strap right", 0.97)
    elastic = plain.with_elastic("mid-bust", find_elastic("picot 10")).with_line("mid-bust", 0.9)
    apart = elastic.with_line_settings(replace(elastic.line_settings("strap left"), linked=False, title="左"))
    placed = placed_off(rest.with_line("mid-bust", 0.96), scan)
    document = Document((("A", plain), ("B", elastic), ("C", apart.with_line("strap left", 0.95))), "B")
    return document.with_design(replace(document.design, placed=placed.placed)), scan


def placed_off(design: Design, scan: ScanFile) -> Design:
    """Return the design with the left bust point placed by hand, 6 mm nearer to the middle than found."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scan.busk"
        _, body = read_body(save_project(path, Document.single(design), scan, None).design.scan)
    place = detect_landmarks(body, ()).position("bust_point_left") - (6.0, 0.0, 0.0)
    return design.with_placed("bust_point_left", in_file(place, body.pose.file_to_mm))


def told_scan() -> tuple[Document, ScanFile]:
    """Return a scan in inches that lies as no guess would have it, with every choice of the model unusual."""
    scan = small_scan("person.ply", "Körper (2).ply", FileSpace("in", "y-up"))
    design = Design(
        ScanSource(scan.name, unit="inch", up="+y", front="+z"),
        template="120",
        line_height=0.6,
        volume="exact",
        line_stiffness=20.0,
        line_contact="sliding",
        weights="paper",
        scaled_normals=True,
        dense_volume=True,
        member_law="co-rotated",
        prestress=0.4,
        firm_chest=0.5,
        volume_of="both",
        line_force="explicit",
        line_hold="held",
    )
    return Document.single(design.with_line("mid-bust", 0.97)), scan


def preset_worn() -> tuple[Document, ScanFile]:
    """Return a set of lines as it comes with Busk, kept by the conventional control, on a packed OBJ."""
    scan = small_scan("person.ply", "person.obj.gz")
    usual = Design(ScanSource(scan.name), volume="conventional", gain=0.02)
    return Document.single(with_preset(usual, built_in()[-1])), scan


def calibrated() -> tuple[Document, ScanFile]:
    """Return a design whose numbers were found on a second scan, the garment on; one stayed as it was."""
    scan = small_scan("mannequin.ply", "mannequin.ply")
    design = Design(ScanSource(scan.name), line_stiffness=11.5, firm_chest=0.04).with_line("mid-bust", 0.92)
    numbers = (
        FittedParameter("line_stiffness", 16.0, 11.5, 0.75),
        FittedParameter("firm_chest", 0.0, 0.04, 0.003),
        FittedParameter("length of mid-bust", 0.92, 0.92, 0.0, kept=True),
    )
    record = Calibration("着用 2.ply", 3.1, 1.4, numbers, 0.8)
    return Document.single(replace(design, calibration=record)), scan


PROJECTS: Mapping[str, Callable[[], tuple[Document, ScanFile]]] = {
    "first": first_save,
    "everything": everything,
    "told": told_scan,
    "preset": preset_worn,
    "calibrated": calibrated,
}


def write_release(folder: Path) -> None:
    """Write the projects of this version, and beside each what is expected of it."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, make in PROJECTS.items():
        document, scan = make()
        project = folder / f"{name}.busk"
        inside = save_project(project, document, scan, None)
        save_project(project, document, scan, picture_of(inside.design))
        write_expected(project)


def picture_of(design: Design) -> bytes:
    """Return a small picture of a design that lies in a project."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "preview.png"
        draw_picture(design, path, size=(96, 120))
        return path.read_bytes()


def write_expected(project: Path) -> None:
    """Write what a project holds, every value even if it is the usual one, and what comes of its designs."""
    document = open_project(project)
    told = {
        "written_by": __version__,
        "shown": document.shown,
        "designs": {name: values_of(design) for name, design in document.designs},
        "figures": {name: dict(figures_of(design)) for name, design in document.designs},
    }
    text = json.dumps(told, indent=1, ensure_ascii=False) + "\n"
    project.with_suffix(".json").write_text(text, encoding="utf-8")


def values_of(design: Design) -> dict[str, Any]:
    """Return all values of a design, plain; the place of its file is nobody's business."""
    return dict(json.loads(json.dumps(asdict(replace(design, scan=replace(design.scan, path=""))))))


def figures_of(design: Design) -> Iterator[tuple[str, float | str]]:
    """Yield what comes of a design by name: verdict, lines, volume, measures, lengths to cut, pressures."""
    solution = solve(build(design))
    stages, points = solution.stages, solution.control_points
    yield "verdict", f"{solution.verdict.motion}, {solution.verdict.state}"
    yield "volume error [%]", 100.0 * solution.last.error
    yield "largest move [mm]", float(np.abs(points - stages.control.mesh.vertices).max())
    for line, reached in zip(stages.model.lines, solution.last.lengths, strict=True):
        yield f"{line.name} reached [mm]", float(reached)
    for row in measure_rows(*before_after(stages, *solution.region_points)):
        for when in ("before", "after"):
            if row[when] is not None:
                yield f"{row['key']} {when} [{row['unit']}]", float(row[when])
    for cut in cut_list(stages, points).rows:
        if cut.cut_mm is not None:
            yield f"{cut.line} to cut [mm]", cut.cut_mm
        if cut.tension_n is not None:
            yield f"{cut.line} tension [N]", cut.tension_n
    for press in pressure_list(stages, points).rows:
        if press.mean_kpa is not None:
            yield f"{press.line} presses [kPa]", press.mean_kpa


def main(words: list[str]) -> int:
    """Write this version's folder, or with ``again VERSION`` the figures of another's."""
    if words and words[0] == "again":
        for project in sorted((RELEASES / words[1]).glob("*.busk")):
            write_expected(project)
    elif not words:
        write_release(RELEASES / __version__)
    else:
        print(__doc__)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
