"""The command line: the same pipeline as the window, and no Qt until a window is asked for."""

from __future__ import annotations

import argparse
import gc
import json
import os
import re
import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NoReturn

from app.settings import dressed, help_text, settings_of
from core import __version__
from core.design import Design, ScanSource, cannot_hold
from core.errors import UserError
from core.own_lines import HELP, own_line
from core.project import is_project, open_project
from core.template import read_template
from core.volume import CONTROLS

SETTLED, PIPE_CLOSED, BAD_INPUT, NOT_SETTLED = 0, 1, 2, 3
RAN_AWAY = "The turns ran away: what is written is no body. Set line_stiffness lower, or --volume exact."


def main(arguments: Sequence[str] | None = None) -> int:
    """Run ``busk`` and return its exit code.

    It is 0 for settled or done, 3 for not settled or folded, 2 for bad input, with one sentence on stderr.
    """
    try:
        code = _run(list(sys.argv[1:] if arguments is None else arguments))
        print(end="", flush=True)
        return code
    except UserError as error:
        print(f"busk: {error}", file=sys.stderr)
        return BAD_INPUT
    except BrokenPipeError:
        # Who reads the answer has enough of it (busk detect ... | head): no error of ours.
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        return PIPE_CLOSED


def _run(words: list[str]) -> int:
    if words and words[0] in COMMANDS:
        options = _parser(words[0]).parse_args(_joined(words[1:]))
        return COMMANDS[words[0]][1](options)
    options = _window_parser().parse_args(words)
    if options.file is not None and not Path(options.file).exists():
        raise UserError(f"There is no file {options.file}, and no such command.", "See 'busk --help'.")
    # Thousands of modules come now and stay: looking for garbage among them costs a tenth of the start.
    gc.disable()
    from app.window import run_window

    return run_window(options.file)


def _joined(words: Sequence[str]) -> list[str]:
    """Join an axis to its option: in '--front -y' the parser takes -y for another option."""
    joined: list[str] = []
    for word in words:
        if joined and joined[-1] in ("--up", "--front"):
            joined[-1] = f"{joined[-1]}={word}"
        else:
            joined.append(word)
    return joined


class _Parser(argparse.ArgumentParser):
    """Says what is wrong with the words of a command as all other bad input is said."""

    def error(self, message: str) -> NoReturn:
        raise UserError(f"{message[:1].upper()}{message[1:]}.", f"See '{self.prog} --help'.")


def design_of(path: str, options: argparse.Namespace) -> Design:
    """Return the design of a project, or a new one for a scan, with what the options overrule."""
    design = open_project(path) if is_project(path) else Design(ScanSource(str(Path(path).absolute())))
    axes = {key: getattr(options, key) for key in ("unit", "up", "front") if getattr(options, key, None)}
    if axes:
        design = replace(design, scan=replace(design.scan, **axes))
    settings = settings_of(getattr(options, "settings", None) or [])
    design = replace(design.with_template(settings.pop("template", design.template)), **settings)
    for text in getattr(options, "path", None) or []:
        design = design.with_own_line(own_line(text, read_template(design.template)))
    return design


def solve(options: argparse.Namespace) -> int:
    """Solve a design with no window and write what came out."""
    from core.pipeline import build
    from core.report import shape_warnings, still_lines, write_solution
    from core.solution import run

    design = design_of(options.input, options)
    design = replace(design, volume=options.volume or design.volume)
    stages = build(design)
    design = dressed(design, stages.model.lines, options.line or [])
    solution = run(build(design, stages), options.turns)
    lost = ("diverging", "settling") if design.volume == "exact" else ("diverging",)
    if design.line_hold == "held" and solution.verdict.motion in lost:
        raise cannot_hold(design)
    out = _folder(options.out)
    figures = write_solution(solution, out)
    ran_away = [RAN_AWAY] * (solution.verdict.motion == "diverging")
    for sentence in [*still_lines(solution.stages), *shape_warnings(solution), *ran_away]:
        print(f"busk: {sentence}", file=sys.stderr)
    for name, line in figures["lines"].items():
        if line["worn"]:
            own = line["whole_band_rest_mm"] == line["rest_mm"]
            print(
                f"{name}: set {line['set_mm']:.1f} mm{'' if own else ' of the front part'} "
                f"({line['set_percent']:.1f} %), reached {line['reached_mm']:.1f} mm"
                + ("" if own else f"; whole band {line['whole_band_reached_mm']:.1f} mm")
            )
    volume, verdict, count = figures["volume"], solution.verdict, solution.last.turn
    step = "turn" if design.volume != "exact" else "Newton step"
    kept = "body_change" if design.volume == "exact" and design.dense_volume else "error"
    print(
        f"{verdict.words} after {count} {step}{'s' if count != 1 else ''}, volume error "
        f"{volume[f'{kept}_percent']:+z.4f} % ({volume[f'{kept}_ml']:+z.2f} ml); written to {out}"
    )
    return SETTLED if verdict.motion == "settled" and verdict.state != "folded" else NOT_SETTLED


def limits(options: argparse.Namespace) -> int:
    """Print how short each line can be made before the body strains, folds or turns inside out."""
    from app.limits import limits_text
    from core.limits import all_limits
    from core.pipeline import build

    design = design_of(options.input, options)
    stages = build(design)
    stages = build(dressed(design, stages.model.lines, options.line or []), stages)
    print(limits_text(list(all_limits(stages)), stages, options.json))
    return SETTLED


def sweep(options: argparse.Namespace) -> int:
    """Try every volume control on the sample bodies and the sphere, and write what comes of it."""
    from app.trials import run_trials

    run_trials(_folder(options.out), options.quick)
    print(f"written to {options.out}")
    return SETTLED


def detect(options: argparse.Namespace) -> int:
    """Find the landmarks of a scan and print them."""
    from core.detect import detection
    from core.pipeline import read_body

    _, body = read_body(design_of(options.input, options).scan)
    found = detection(body)
    if options.json:
        print(json.dumps(found, indent=1))
        return SETTLED
    print(f"unit {found['unit']}, up {found['up']}, front {found['front']}")
    for name, mark in found["landmarks"].items():
        x, y, z = mark["mm"]
        print(f"{name:18} {x:8.1f} {y:8.1f} {z:8.1f} mm  {100 * mark['confidence']:3.0f} %  {mark['rule']}")
    for name, girth in found["girths"].items():
        print(f"{name:18} tape {girth['tape_mm']:.1f} mm at height {girth['level_mm']:.1f} mm")
    return SETTLED


def picture(options: argparse.Namespace) -> int:
    """Render a scan or project to a PNG file with no display."""
    from app.picture import draw_picture, draw_window

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
    from app.demo import run_demo

    return run_demo(_folder(options.out))


def figures(options: argparse.Namespace) -> int:
    """Make the figures of the paper from the sample bodies and a sphere, with a page that judges them."""
    from app.figures import make_figures, make_some

    out = _folder(options.out)
    if options.only:
        make_some(options.only, out)
    else:
        make_figures(out)
    return SETTLED


def self_test(options: argparse.Namespace) -> int:
    """Check the installed program on the sample, one line a part."""
    from app.self_test import run_self_test

    return run_self_test()


def _folder(name: str) -> Path:
    if not name.strip():
        raise UserError("The place to write to has no name.", "Name a folder: --out result.")
    folder = Path(name)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as why:
        raise UserError(f"The folder {name} cannot be made: {why.strerror}.", "Choose another one.") from why
    return folder


def _window_parser() -> argparse.ArgumentParser:
    commands = "\n".join(f"  busk {name:10} {help_}" for name, (help_, _) in COMMANDS.items())
    parser = _Parser(
        prog="busk",
        description="See how a foundation garment reshapes a body.",
        epilog=f"without a window:\n{commands}\n\n'busk COMMAND --help' tells more.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("file", nargs="?", metavar="FILE", help="a project (.busk) or a scan to open")
    parser.add_argument("--version", action="version", version=f"busk {__version__}")
    return parser


def _parser(command: str) -> argparse.ArgumentParser:
    parser = _Parser(prog=f"busk {command}", description=COMMANDS[command][0])
    if command in ("solve", "limits", "detect", "picture"):
        parser.add_argument("input", metavar="SCAN_OR_PROJECT", help="PLY, OBJ, STL or .busk")
        parser.add_argument(
            "--unit", choices=("mm", "cm", "m", "inch"), help="the scan's unit, if not guessed well"
        )
        parser.add_argument("--up", help="the scan's axis that points up, like +z")
        parser.add_argument("--front", help="the scan's axis that the body faces, like -y")
    if command in ("solve", "limits", "picture"):
        parser.add_argument("--settings", action="append", metavar="KEY=VALUE", help=help_text())
        parser.add_argument("--path", action="append", metavar="NAME=POINTS", help=HELP)
    if command in ("solve", "limits"):
        parser.add_argument(
            "--line",
            action="append",
            metavar="NAME=LENGTH",
            help="97%% of the rest length, -20mm shorter, 400mm absolute; of the front part, side to side",
        )
    if command == "solve":
        parser.add_argument("--volume", choices=CONTROLS)
        parser.add_argument(
            "--turns", type=_turns, metavar="N", help="exactly N turns; else until settled, at most 300"
        )
    if command in ("limits", "detect"):
        parser.add_argument("--json", action="store_true", help="print JSON")
    if command == "picture":
        parser.add_argument(
            "--view", default="three-quarter", help="front, left, right, back, three-quarter, top, side"
        )
        parser.add_argument("--window", action="store_true", help="the whole window, not just the body")
        parser.add_argument("--dark", action="store_true")
        parser.add_argument("--language", choices=("en", "ja"), default="en")
        parser.add_argument("--size", type=_size, default=(1600, 1000), metavar="WIDTHxHEIGHT")
    if command == "sweep":
        parser.add_argument("--quick", action="store_true", help="a few cases only")
    if command == "figures":
        parser.add_argument("--only", action="append", metavar="N", help="this figure alone; may be repeated")
    if command in ("solve", "picture", "demo", "figures", "sweep"):
        parser.add_argument("--out", required=command != "demo", default="out", metavar="PLACE")
    return parser


def _turns(text: str) -> int:
    if not (text.isdecimal() and 1 <= int(text) <= 100_000):
        raise argparse.ArgumentTypeError(f"'{text}' is no number of turns from 1 to 100000")
    return int(text)


def _size(text: str) -> tuple[int, int]:
    match = re.fullmatch(r"([1-9]\d{1,3})x([1-9]\d{1,3})", text)
    if match is None:
        raise argparse.ArgumentTypeError(f"'{text}' is no size like 1600x1000")
    return int(match[1]), int(match[2])


COMMANDS: dict[str, tuple[str, Callable[[argparse.Namespace], int]]] = {
    "solve": ("solve a design and write body, control mesh, turns and report", solve),
    "limits": ("tell how short each line can be made", limits),
    "detect": ("find the bust landmarks of a scan", detect),
    "picture": ("render a scan or project to a PNG file", picture),
    "demo": ("do the sample session off-screen and write what comes out", demo),
    "figures": ("make the figures of the paper again, with their tables and a page", figures),
    "sweep": ("try every volume control on the samples and the sphere, with a table", sweep),
    "self-test": ("check this installation", self_test),
}
