"""Check the installation without a window: versions, files, landmarks, solver, projects, exports, drawing."""

from __future__ import annotations

import platform
import sys
from collections.abc import Callable, Sized
from contextlib import redirect_stdout
from dataclasses import replace
from importlib import metadata, resources
from io import StringIO
from pathlib import Path

import numpy as np

from app.cli.output import DONE
from app.cli.parser import command_options, runner_of
from app.cli.self_test.parts import PartError, SelfTestFixture, check
from app.presenters.samples import WHOLE_TRUNK, sample_design
from core import __version__
from core.document.lower_trunk import LowerTrunk
from core.document.storage.project_file import open_project
from core.geometry import kernels
from core.measurements.lower_trunk import lower_before_after
from core.pipeline.build import build
from core.pipeline.solve import solve
from core.scan.readers.registry import read_raw

LIBRARIES = ("PySide6-Essentials", "vtk", "pyvista", "pyvistaqt", "numpy", "scipy")
BUST_POINT, FOLD = (107.25, -229.14, 346.95), (107.25, -178.96, 299.02)
"""Their known positions on the left of the mannequin [mm]."""

WAIST_RATIO, WAIST_CHANGE = 0.9, -42.0
"""A waist line of the whole trunk at this length [1] changes the tape at the waist by this [mm]."""

MOST_STEPS = 8
"""Newton steps in which the exact solution of a line of the lower trunk is found, on any body tried."""

_NEAR = 8.0  # mm: landmarks of the sample are detected within 4 mm


def is_frozen() -> bool:
    """Return whether this is the packaged program."""
    return bool(getattr(sys, "frozen", False))


def _home() -> Path:
    """Return the folder that contains the resources."""
    return Path(str(resources.files("resources"))).parent


def versions(bench: SelfTestFixture) -> str:
    """Return the versions of program and libraries, and the place of the program."""
    libraries = ", ".join(f"{name} {metadata.version(name)}" for name in LIBRARIES)
    kind = "packaged" if is_frozen() else "from source"
    made_of = f"Busk {__version__}, Python {platform.python_version()}, {libraries}"
    return f"{made_of}; {kind}, {platform.platform()}, in {_home()}"


def shipped_files(bench: SelfTestFixture) -> str:
    """Read all tables, words, icons, samples and licences, and find the user guide."""
    from app.i18n.catalog import translations  # noqa: PLC0415 (this part reports what cannot be imported)
    from app.i18n.licences import licences  # noqa: PLC0415
    from core.control_mesh.template import TEMPLATES, read_template  # noqa: PLC0415
    from core.garment import presets  # noqa: PLC0415
    from core.garment.elastic_library import built_in as elastics  # noqa: PLC0415
    from core.garment.pressure import pressure_limits  # noqa: PLC0415
    from core.measurements.sizes import built_in as sizes  # noqa: PLC0415
    from core.measurements.sizes import letter_sizes  # noqa: PLC0415

    counts = {
        "templates": _count("templates", lambda: [read_template(name) for name in TEMPLATES], 2),
        "presets": _count("presets", presets.built_in, 3),
        "elastics": _count("elastics", elastics, 6),
        "size charts": _count("size charts", sizes, 7),
        "letter sizes": _count("letter sizes", lambda: letter_sizes().tables, 1),
        "rating limits": _count("rating limits", lambda: [pressure_limits()], 1),
        "words": _count("words", lambda: [*translations("ja")], 1000),
        "icons": _count("icons", lambda: list(_home().glob("resources/icons/*.svg")), 40),
        "samples": _count("samples", lambda: list(_home().glob("resources/samples/*.ply")), 3),
        "licences": _count("licences", lambda: [text for _, text in licences() if len(text) > 500], 3),
    }
    page = _home() / "site" / "index.html"
    check(page.is_file() or not is_frozen(), f"no guide at {page}")
    guide = "the guide" if page.is_file() else "no guide in this checkout"
    return ", ".join([*(f"{count} {name}" for name, count in counts.items()), guide])


def _count(name: str, read: Callable[[], Sized], least: int) -> int:
    """Return the number of files, and name the kind that cannot be read or is incomplete."""
    try:
        count = len(read())
    except Exception as fault:
        raise PartError(f"{name} cannot be read: {type(fault).__name__}, {fault}") from fault
    check(count >= least, f"{count} {name}, not {least}")
    return count


def landmarks(bench: SelfTestFixture) -> str:
    """Detect the landmarks of the sample, and compare them with their known positions."""
    points = bench.stages.landmarks.points
    away = {
        f"{name}_{side}": float(
            np.linalg.norm(points[f"{name}_{side}"].position - np.multiply(place, (sign, 1, 1)))
        )
        for name, place in (("bust_point", BUST_POINT), ("fold", FOLD))
        for side, sign in (("left", 1.0), ("right", -1.0))
    }
    worst = max(away, key=away.__getitem__)
    check(away[worst] < _NEAR, f"{worst} is {away[worst]:.1f} mm from its known position")
    return f"bust points and inframammary folds within {away[worst]:.1f} mm of their known positions"


def solver(bench: SelfTestFixture) -> str:
    """Solve the sample by iterations and exactly, and compare both."""
    solution = bench.solution
    check(solution.verdict.motion == "settled", f"the iterations end with status {solution.verdict.words}")
    exact = solve(build(replace(bench.stages.design, volume="exact"), bench.stages))
    apart = float(np.abs(exact.control_points - solution.control_points).max())
    check(apart < 0.3, f"iterations and exact solution differ by {apart:.3f} mm")
    return f"converged in {solution.last.iteration} iterations, {apart:.2f} mm from the exact solution"


def lower_trunk(bench: SelfTestFixture) -> str:
    """Solve the waist line of the whole trunk exactly and by iterations: its waist changes as known."""
    design = replace(sample_design(WHOLE_TRUNK), lines=(), lower=LowerTrunk(), volume="exact")
    stages = build(design.with_line("waist", WAIST_RATIO))
    check(stages.lower is not None, f"no lower trunk: {stages.lower_problem}")
    exact = solve(stages).lower
    run = solve(build(replace(stages.design, volume="adaptive"), stages)).lower
    assert stages.lower is not None
    assert exact is not None
    assert run is not None
    steps = exact.verdict.iterations
    check(exact.verdict.motion == "settled" and steps <= MOST_STEPS, f"{exact.verdict.words}, {steps} steps")
    before, after = lower_before_after(stages.lower, exact.control_points)["waist"]
    change = after.tape_mm - before.tape_mm
    check(abs(change - WAIST_CHANGE) < 1.5, f"the waist changes by {change:.1f} mm, not {WAIST_CHANGE} mm")
    check(run.verdict.motion == "settled", f"the iterations end with status {run.verdict.words}")
    apart = float(np.abs(run.control_points - exact.control_points).max())
    check(apart < 0.3, f"iterations and exact solution differ by {apart:.3f} mm")
    return f"waist {change:+.1f} mm in {steps} steps; iterations end {apart:.2f} mm from there"


def compiled_loops(bench: SelfTestFixture) -> str:
    """Compile the loops over the dense body, and compare their results with the definitions."""
    mesh = bench.stages.body.mesh
    given = mesh.vertices, np.ascontiguousarray(mesh.faces.T), np.zeros_like(mesh.vertices)
    if not kernels.warm():
        # Without numba they are slower; a numba that does not work is a fault.
        check("No module named 'numba'" in kernels.state(), kernels.state())
        return "numba is not installed: numpy is used"
    apart = float(np.abs(kernels.normals(*given) - kernels.normals_plain(*given)).max())
    check(apart < 1e-9, f"compiled loops and their definitions differ by {apart:.2g}")
    return kernels.state()


def projects(bench: SelfTestFixture) -> str:
    """Save a project, open it and solve it again: the same values."""
    design = open_project(bench.project).design
    again = solve(build(design)).control_points
    apart = float(np.abs(again - bench.solution.control_points).max())
    check(apart < 1e-9, f"the reloaded body differs by {apart:.3g} mm")
    return f"saved {bench.project.stat().st_size / 1e6:.1f} MB, opened, solved to the same values"


def run_command(*words: str) -> None:
    """Run a command as the command line does, without its output. Raises PartError unless it is done."""
    with redirect_stdout(StringIO()):
        code = runner_of(words[0])(command_options(words[0], words[1:]))
    check(code == DONE, f"busk {words[0]} ends with {code}")


def exports(bench: SelfTestFixture) -> str:
    """Write bodies, drawings, measurements and a turntable for other programs, and read them."""
    from PIL import Image  # noqa: PLC0415

    from core.export.mesh import FORMATS, write_mesh  # noqa: PLC0415 (brings trimesh along)
    from core.export.units_and_axes import FileSpace  # noqa: PLC0415

    mesh, folder = bench.stages.body.mesh, bench.folder
    for kind in FORMATS:
        path = folder / f"body.{kind}"
        write_mesh(path, mesh, space=FileSpace("mm", "z-up"))
        count = len(read_raw(path.name, path.read_bytes()).faces)
        check(count == len(mesh.faces), f"{path.name} was reloaded with {count} triangles")
    names = {"lines": "lines.dxf", "strips": "strips.svg", "measurements": "m.smis", "turntable": "turn.gif"}
    files = [word for option, name in names.items() for word in (f"--{option}", str(folder / name))]
    run_command("export", str(bench.project), *files, "--frames", "4", "--seconds", "1", "--size", "160x200")
    with Image.open(folder / "turn.gif") as moving:
        frames = int(getattr(moving, "n_frames", 1))
    check(frames == 4, f"the turntable has {frames} frames, not 4")
    return f"{', '.join(FORMATS)} of {len(mesh.faces):,} triangles, {', '.join(names.values())}"


def drawing(bench: SelfTestFixture) -> str:
    """Render the reshaped body off-screen: the picture shows a shaded body."""
    from PIL import Image  # noqa: PLC0415

    run_command("picture", str(bench.project), "--out", str(bench.folder / "body.png"), "--size", "400x480")
    with Image.open(bench.folder / "body.png") as picture:
        colours = len(set(picture.convert("RGB").getdata()))
    check(colours > 500, f"the body has only {colours} colours")
    return f"a body of {colours} colours"
