"""The sample session with no display: the same window off-screen, and everything that it can write."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from app.cli.commands.picture import draw_picture, draw_window
from app.presenters.samples import lifted_sample
from core.export.solution_report import write_solution
from core.pipeline.build import build
from core.pipeline.solve import run


def run_demo(out: Path) -> int:
    """Write pictures, deformed body and report of the sample to ``out``, and say so."""
    design = lifted_sample()
    print("No display available: the sample session is written to files.")
    draw_window(design, out / "window.png")
    print(f"  {out / 'window.png'}: the window")
    for view, lines, name in (("three-quarter", (), "before"), ("three-quarter", design.lines, "after")):
        draw_picture(replace(design, lines=lines), out / f"{name}.png", view=view, size=(1000, 900))
        print(f"  {out / f'{name}.png'}: the body {name}")
    solution = run(build(design))
    write_solution(solution, out)
    print(f"  {out / 'body.ply'}: the deformed body")
    print(f"  {out / 'turns.csv'}, {out / 'report.json'}: iterations and final values")
    last = solution.last
    print(f"{solution.verdict.words} after {last.turn} iterations, volume error {last.error_ml:+.2f} ml")
    return 0
