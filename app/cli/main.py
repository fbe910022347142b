"""The command line: the same pipeline as the window, and no Qt until a window is asked for."""

from __future__ import annotations

import argparse
import gc
import json
import os
import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

import scipy.linalg  # noqa: F401  its BLAS must be there to be held to one thread
from threadpoolctl import threadpool_limits

from app.cli.analysis import ADVICE
from app.cli.environment import is_seen_in_window, path_of, settle_in, tell
from app.cli.exit_code import NOT_SETTLED, SETTLED, told, warn
from app.cli.input import design_of
from app.cli.parser import command_options, window_options
from core.document.custom_measures import own_measure
from core.document.storage.project_file import is_project
from core.errors import UserError

PIPE_CLOSED, BAD_INPUT, INTERRUPTED = 1, 2, 130


def main(arguments: Sequence[str] | None = None) -> int:
    """Run ``busk`` and return its exit code.

    It is 0 for settled or done, 3 for not settled or folded, 2 for bad input, with one sentence on stderr,
    and 130 where Ctrl+C stopped it.
    """
    words = list(sys.argv[1:] if arguments is None else arguments)
    settle_in()
    try:
        code = _run(words)
        print(end="", flush=True)
        return code
    except UserError as error:
        tell(error, of_window=not (words and words[0] in COMMANDS))
        return BAD_INPUT
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:
        # Who reads the answer has enough of it (busk detect ... | head): no error of ours.
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        return PIPE_CLOSED


def _run(words: list[str]) -> int:
    if words and words[0] in COMMANDS:
        with threadpool_limits(1):  # two threads of BLAS wait for each other, and spin, over small products
            return COMMANDS[words[0]](command_options(words[0], words[1:]))
    options = window_options(words)
    file = None if options.file is None else path_of(options.file)
    if file == "":
        raise UserError("No file is named.", "Specify a scan or a project, or see 'busk --help'.")
    if file is not None and not os.path.exists(file) and not is_seen_in_window(file):
        raise UserError(f"{file} is neither a file nor a command.", "See 'busk --help'.")
    # Thousands of modules come now and stay: looking for garbage among them costs a tenth of the start.
    gc.disable()
    from app.gui.startup import run_window

    return run_window(file, options.safe_mode)


def _form(options: argparse.Namespace) -> str:
    return "csv" if options.csv else "json" if options.json else ""


def solve(options: argparse.Namespace) -> int:
    """Solve a design with no window and write what came out."""
    from app.cli.commands.solve import run_solve

    design = design_of(options.input, options)
    design = replace(design, volume=options.volume or design.volume)
    place = partial(_folder, options.out)
    found = run_solve(design, options.line or [], options.elastic or [], options.turns, place)
    return told("\n".join(found.lines), found.settled, found.warnings)


def sweep(options: argparse.Namespace) -> int:
    """Try every volume control on the sample bodies and the sphere, and write what comes of it."""
    from app.research.control_study_command import run_trials

    run_trials(_folder(options.out), options.quick)
    print(f"written to {options.out}")
    return SETTLED


def detect(options: argparse.Namespace) -> int:
    """Find the landmarks of a scan and print them."""
    from app.cli.commands.detect import found_text
    from core.landmarks.as_dict import detection
    from core.pipeline.build import find, read_body

    design = design_of(options.input, options)
    _, body = read_body(design.scan)
    found = detection(body, find(body, design.placed))
    print(json.dumps(found, indent=1) if options.json else found_text(found), flush=True)
    warn(found["warnings"])
    return SETTLED


def measure(options: argparse.Namespace) -> int:
    """Measure a scan, or a project before and after, and print or write what comes of it."""
    from app.cli.commands.measure import measured_text, run_measure

    design = design_of(options.input, options)
    for own in map(own_measure, options.own or []):
        design = design.with_own_measure(own)
    found = run_measure(design, solved=is_project(options.input))
    return told(measured_text(found, _form(options), options.out), found.settled, found.warnings)


def cut(options: argparse.Namespace) -> int:
    """Print or write how long the elastic of each worn line of a project is to be cut."""
    from app.cli.commands.cut import cut_text, run_cut

    design = design_of(options.input, options)
    if options.elastics is not None:
        from app.cli.elastic_list import elastics_text, run_elastics

        lines, made = options.line or [], options.elastic or []
        listed = partial(run_elastics, design, lines, made, options.elastics, options.as_worn)
        return told(elastics_text(listed, _form(options), options.out), True, [])
    found = run_cut(design, options.line or [], options.elastic or [], options.as_worn)
    return told(cut_text(found, _form(options), options.out), found.worn.settled, found.worn.warnings)


def press(options: argparse.Namespace) -> int:
    """Print or write what each worn line of a project presses the skin with."""
    from app.cli.commands.pressure import press_text, run_press

    design = design_of(options.input, options)
    found = run_press(design, options.line or [], options.elastic or [])
    return told(press_text(found, _form(options), options.out), found.worn.settled, found.worn.warnings)


def report(options: argparse.Namespace) -> int:
    """Write the sheet to work from: measures, sizes, cut list, pressures and pictures."""
    from app.cli.commands.report import SheetWishes, run_report

    wishes = SheetWishes(**{name: getattr(options, name) for name in SheetWishes.__dataclass_fields__})
    design = design_of(options.input, options)
    found = run_report(options.input, design, options.line or [], options.elastic or [], wishes)
    print("\n".join([*found.verdict, f"written to {', '.join(found.files)}"]), flush=True)
    warn(found.warnings)
    return SETTLED if found.settled else NOT_SETTLED


def export(options: argparse.Namespace) -> int:
    """Write what other programs open: a body, its lines, strips, measures, a turntable."""
    from app.cli.commands.export import KINDS, run_export
    from app.presenters.export import Manner

    files = {kind: getattr(options, kind) for kind in KINDS}
    told = ("axes", "before", "frames", "seconds", "size", "dark", "beside")
    manner = Manner(options.file_unit, **{name: getattr(options, name) for name in told})
    design = design_of(options.input, options)
    done = run_export(design, options.line or [], options.elastic or [], files, manner, print)
    warn(done.warnings)
    return SETTLED if done.settled else NOT_SETTLED


def picture(options: argparse.Namespace) -> int:
    """Render a scan or project to a PNG file with no display."""
    from app.cli.commands.picture import draw_picture, draw_window

    design = design_of(options.input, options)
    if options.window:
        draw_window(
            design, Path(options.out), dark=options.dark, language=options.language, size=options.size
        )
    else:
        draw_picture(design, Path(options.out), view=options.view, dark=options.dark, size=options.size)
    print(f"written to {options.out}")
    return SETTLED


def demo(options: argparse.Namespace) -> int:
    """Do the sample session with no display, and leave pictures, body and report in a folder."""
    from app.cli.commands.demo import run_demo

    return run_demo(_folder(options.out))


def figures(options: argparse.Namespace) -> int:
    """Make the figures of the paper from the sample bodies and a sphere, with a page that judges them."""
    from app.research.figures import make_figures, make_some

    out = _folder(options.out)
    if options.only:
        make_some(options.only, out)
    else:
        make_figures(out)
    return SETTLED


def accuracy(options: argparse.Namespace) -> int:
    """Measure how well a folder of bodies with known answers is understood."""
    from app.research.accuracy_command import run_accuracy

    return int(run_accuracy(options.folder, options.out, options.json) or SETTLED)


def self_test(options: argparse.Namespace) -> int:
    """Check the installed program on the sample, one line a part."""
    from app.cli.commands.self_test import run_self_test

    return run_self_test(_folder(options.out) if options.out is not None else None)


def _folder(name: str) -> Path:
    if not name.strip():
        raise UserError("The output folder has no name.", "Specify a folder: --out result.")
    folder = Path(name)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as why:
        raise UserError(
            f"The folder {name} cannot be created: {why.strerror}.", "Choose another folder."
        ) from why
    return folder


COMMANDS: dict[str, Callable[[argparse.Namespace], int]] = {
    "solve": solve,
    **ADVICE,
    "detect": detect,
    "measure": measure,
    "export": export,
    "cut": cut,
    "press": press,
    "report": report,
    "picture": picture,
    "demo": demo,
    "figures": figures,
    "sweep": sweep,
    "accuracy": accuracy,
    "self-test": self_test,
}
