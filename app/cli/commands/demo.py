"""Run the sample session off-screen: pictures of the window and the body, and all results as files."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from dataclasses import replace

from app.cli.commands.picture import draw_picture, draw_window
from app.cli.options import add_folder_output
from app.cli.output import DONE, make_folder
from app.presenters.samples import dressed_sample
from core.export.solution_report import write_solution
from core.pipeline.build import build
from core.pipeline.solve import solve


def add_options(parser: ArgumentParser) -> None:
    """Add the options of ``busk demo``."""
    add_folder_output(parser, required=False, default="out")


def run(options: Namespace) -> int:
    """Write pictures, reshaped body and report of the sample, and print their names."""
    out, design = make_folder(options.out), dressed_sample()
    print("No display available: the sample session is written to files.")
    draw_window(design, out / "window.png")
    print(f"  {out / 'window.png'}: the window")
    for lines, name in (((), "before"), (design.lines, "after")):
        draw_picture(replace(design, lines=lines), out / f"{name}.png", size=(1000, 900))
        print(f"  {out / f'{name}.png'}: the body {name}")
    solution = solve(build(design))
    write_solution(solution, out)
    print(f"  {out / 'body.ply'}: the reshaped body")
    print(f"  {out / 'turns.csv'}, {out / 'report.json'}: iterations and final values")
    last = solution.last
    print(f"{solution.verdict.words} after {last.iteration} iterations, volume error {last.error_ml:+.2f} ml")
    return DONE
