"""Parts of a self-test that work without a screen: files, landmarks, the solver, projects."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from app.cli.self_test.checks import PartError, check
from app.cli.self_test.fixture import MOVED, Bench
from app.presenters.samples import sample_path
from core.document.storage.project_file import open_project, read_scan_file
from core.errors import ProjectError
from core.geometry import kernels
from core.geometry.mesh import Mesh
from core.pipeline.build import build
from core.pipeline.solve import solve
from core.scan.readers.registry import read_raw

BUST_POINT, FOLD = (107.25, -229.14, 346.95), (107.25, -178.96, 299.02)
"""Where both lie on the left of the mannequin as it was made [mm]."""

_NEAR = 8.0
"""Distance from there within which the landmarks of the sample are found [mm]; they are off by 4 mm."""


def scan_formats(bench: Bench) -> str:
    """Write the sample in every format and read it back: the same triangles."""
    name = "mannequin.ply"
    scan = read_raw(name, sample_path("mannequin").read_bytes())
    body = Mesh(scan.vertices, scan.faces)
    read = []
    for kind, data in _files(bench, body):
        again = read_raw(f"scan.{kind}", data)
        check(again.faces.shape == body.faces.shape, f"{kind} was reloaded with {len(again.faces)} triangles")
        apart = float(np.abs(again.vertices[again.faces] - body.vertices[body.faces]).max())
        check(apart < 0.01, f"{kind} was reloaded with vertices moved by {apart:.3g} mm")
        read.append(kind)
    return f"{', '.join(read)}: the same {len(body.faces):,} triangles"


def _files(bench: Bench, body: Mesh) -> Iterator[tuple[str, bytes]]:
    """Give the kind and the content of a file of every format."""
    from core.export.mesh import FORMATS, write_mesh  # noqa: PLC0415 (brings trimesh along)
    from core.export.units_and_axes import FileSpace  # noqa: PLC0415

    for kind in FORMATS:
        path = bench.folder / f"scan.{kind}"
        write_mesh(path, body, space=FileSpace("mm", "z-up"))
        yield kind, path.read_bytes()
    corners, triangles = _rows(body.vertices), _rows(body.faces)
    counts = f"{len(body.vertices)} {len(body.faces)} 0"
    threes = triangles.replace("\n", "\n3 ")
    yield "off", f"OFF\n{counts}\n{corners}\n3 {threes}\n".encode()
    ends = " ".join(map(str, range(3, 3 * len(body.faces) + 1, 3)))
    yield "vtp", _VTP.format(*counts.split(), corners, triangles, ends).encode()


def _rows(values: np.ndarray) -> str:
    return "\n".join(" ".join(map(str, row)) for row in values.tolist())


_VTP = """<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian"><PolyData>
<Piece NumberOfPoints="{0}" NumberOfPolys="{1}">
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">{3}</DataArray></Points>
<Polys><DataArray type="Int64" Name="connectivity" format="ascii">{4}</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">{5}</DataArray></Polys>
</Piece></PolyData></VTKFile>"""


def landmarks(bench: Bench) -> str:
    """Find the landmarks of the sample, and compare them with where they are known to be."""
    found, farthest = bench.stages.landmarks.points, 0.0
    for name, place in (("bust_point", BUST_POINT), ("fold", FOLD)):
        for side, sign in (("left", 1.0), ("right", -1.0)):
            away = float(np.linalg.norm(found[f"{name}_{side}"].position - np.multiply(place, (sign, 1, 1))))
            check(away < _NEAR, f"{name}_{side} is {away:.1f} mm from its known position")
            farthest = max(farthest, away)
    return f"bust points and inframammary folds within {farthest:.1f} mm of their known positions"


def solver(bench: Bench) -> str:
    """Solve the sample by turns and exactly, and compare both."""
    turns = bench.solution
    check(turns.verdict.motion == "settled", f"the iterations end with status {turns.verdict.words}")
    check(abs(turns.last.error_ml) < 1.0, f"the volume error is {turns.last.error_ml:.2f} ml")
    moved = np.abs(turns.control_points - bench.stages.control.mesh.vertices).max()
    check(bool(moved > 1.0), "the body did not follow the line")
    exact = solve(build(replace(bench.design, volume="exact"), bench.stages))
    check(exact.verdict.motion == "settled", f"the exact solution has status {exact.verdict.words}")
    apart = float(np.abs(exact.control_points - turns.control_points).max())
    check(apart < 0.3, f"iterations and exact solution differ by {apart:.3f} mm")
    count, off = turns.last.iteration, abs(turns.last.error_ml)
    return (
        f"converged in {count} iterations, volume error {off:.3f} ml, {apart:.2f} mm from the exact solution"
    )


def compiled_loops(bench: Bench) -> str:
    """Have the loops over the dense body compiled, and compare what they give with their definitions."""
    mesh = bench.stages.body.mesh
    corners = np.ascontiguousarray(mesh.faces.T)
    given = mesh.vertices, corners, np.zeros_like(mesh.vertices)
    if not kernels.warm():
        # Without numba they are slower, no more; with one that does not work something is amiss.
        check("No module named 'numba'" in kernels.state(), kernels.state())
        return "numba is not installed: numpy is used"
    apart = float(np.abs(kernels.normals(*given) - kernels.normals_plain(*given)).max())
    check(apart < 1e-9, f"compiled loops and their definitions differ by {apart:.2g}")
    return kernels.state()


def projects(bench: Bench) -> str:
    """Save a project, open it and solve it again: the same figures."""
    document = open_project(bench.project)
    check(document.design.ratio(MOVED) == bench.design.ratio(MOVED), "the reloaded line differs")
    check(read_scan_file(document.design.scan).data == bench.stages.scan.data, "the reloaded scan differs")
    again = solve(build(document.design)).control_points
    apart = float(np.abs(again - bench.solution.control_points).max())
    check(apart < 1e-9, f"the reopened body differs by {apart:.3g} mm")
    size = bench.project.stat().st_size / 1e6
    return f"saved {size:.1f} MB, opened, solved to the same values"


def damaged_projects(bench: Bench) -> str:
    """Cut a project short: it must be refused in a sentence."""
    path = bench.folder / "cut short.busk"
    whole = bench.project.read_bytes()
    path.write_bytes(whole[: len(whole) // 2])
    try:
        open_project(path)
    except ProjectError as refusal:
        return f"refused: {refusal.message}"
    finally:
        path.unlink()
    raise PartError("a truncated project was opened without an error")
