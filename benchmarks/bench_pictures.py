"""What pictures for files cost, piece by piece: `python benchmarks/bench_pictures.py`, half a minute.

The mannequin is drawn off-screen as exports draw it, in pieces twice as fine as the picture; beside it, in
turns, by VTK's own smoothing of the whole picture at once (SSAA), as turntables were drawn before. What
counts for a window is the longest piece: so long it does not answer. Medians and longest of wall time [ms].
"""

from __future__ import annotations

import statistics
import time
from pathlib import Path

import pyvista as pv

from app.presenters.lines import bands
from app.rendering.ambient_occlusion import bake_occlusion
from app.rendering.display import off_screen
from app.rendering.offscreen import OffscreenRenderer
from app.rendering.scene import Scene
from core.document.design import Design, ScanSource
from core.pipeline.build import build
from core.pipeline.solve import solve
from core.progress import in_one_go

SAMPLE = Path(__file__).parents[1] / "resources" / "samples" / "mannequin.ply"
SIZES = ((480, 540), (640, 720), (960, 1080), (2000, 2250))
ROUNDS = 8


def pieces(studio: OffscreenRenderer, size: tuple[int, int]) -> list[float]:
    """Return what each piece of one picture takes [ms]."""
    taken: list[float] = []
    begun = time.perf_counter()

    def hear(what: str, share: float) -> None:
        nonlocal begun
        taken.append(1e3 * (time.perf_counter() - begun))
        begun = time.perf_counter()

    in_one_go(studio.render(size), hear)
    return taken


def at_once(scene: Scene, size: tuple[int, int]) -> float:
    """Return what VTK takes for one picture with its outlines smoothed [ms]."""
    scene.plotter.window_size = list(size)
    begun = time.perf_counter()
    scene.plotter.ren_win.Render()
    scene.plotter.screenshot(return_img=True)
    return 1e3 * (time.perf_counter() - begun)


def main() -> None:
    off_screen()
    stages = build(Design(ScanSource(str(SAMPLE))).with_line("mid-bust", 0.95))
    points, worn = solve(stages).region_points, bands(stages, ())
    begun = time.perf_counter()
    studio = OffscreenRenderer(stages, points, worn, bake_occlusion(stages.body.mesh))
    in_one_go(studio.set_up())
    print(f"soft shadows and setting up: {1e3 * (time.perf_counter() - begun):.0f} ms")
    plotter = pv.Plotter(off_screen=True, lighting="none")
    scene = Scene(plotter)
    scene.show_body(stages.body.mesh)
    scene.show_bands(worn)
    plotter.enable_anti_aliasing("ssaa")
    with studio:
        for size in SIZES:
            studio.frame_bust(size, "front")
            scene.set_camera(studio.scene.view)
            pieces(studio, size), at_once(scene, size)
            rounds = [(pieces(studio, size), at_once(scene, size)) for _ in range(ROUNDS)]
            longest = max(max(taken) for taken, _ in rounds)
            whole, other = (
                statistics.median(each) for each in zip(*((sum(a), b) for a, b in rounds), strict=True)
            )
            print(
                f"{size[0]} x {size[1]}: {len(rounds[0][0])} pieces, {whole:.0f} ms a picture, "
                f"longest piece {longest:.0f} ms; by VTK at once {other:.0f} ms"
            )
    plotter.close()


if __name__ == "__main__":
    main()
