"""List the commands, and read the arguments of each; former names are accepted."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Sequence
from importlib import import_module
from typing import NoReturn

from core import __version__
from core.errors import UserError
from core.messages import Message

COMMANDS = {
    "solve": "solve a design and write body, control mesh, iterations and report",
    "batch": "solve one design on many bodies and write a table of results",
    "grade": "compute size groups, increments and grade rules from the results of a batch run",
    "compare": "compare two designs body by body, from the results of a batch run",
    "target": "compute line lengths for target positions and measurements",
    "calibrate": "compare with a fitting scan and fit tissue and line stiffness",
    "diagnose": "find conflicting lines and suggest the smallest fix",
    "symmetry": "compare left and right in mm and ml, and balance them",
    "limits": "compute the length limits of each line and their reasons",
    "detect": "detect the landmarks of a scan",
    "measure": "measure a scan, or a project before and after",
    "cut": "compute the cut length of each active line",
    "pattern": "compute pattern pieces of a garment block and write them for plotters and CAD",
    "pressure": "compute the contact pressure of each active line in kPa and mmHg, and rate it",
    "uncertainty": "compute the uncertainty (±) of the results and list the model limitations",
    "report": "write a report (PDF): sizes, cut lengths, measurements, contact pressures, pictures",
    "export": "export the body, lines, pattern strips, measurements or a turntable",
    "picture": "render a scan or project to a PNG file",
    "demo": "run the sample session off-screen and write the results",
    "figures": "reproduce the figures and tables of the paper",
    "controls": "compare all volume controls on the samples and the sphere",
    "accuracy": "measure the accuracy of landmarks and girths on a folder of bodies with known values",
    "check-model": "compare the model with displacements of an independent finite-element model",
    "self-test": "check this installation; --out keeps the test files",
}
"""Every command with a short description."""

FORMER_COMMANDS = {
    "ask": "target",
    "doctor": "diagnose",
    "even": "symmetry",
    "press": "pressure",
    "spread": "uncertainty",
    "sweep": "controls",
}
"""Former names of commands, still accepted."""

FORMER_OPTIONS = {
    "--turns": "--iterations",
    "--want": "--target",
    "--make": "--balance",
    "--own": "--custom",
    "--as-worn": "--keep-fit",
    "--spread": "--uncertainty",
    "--control": "--control-mesh",
    "--flat": "--strips",
    "--measures": "--measurements",
    "--before": "--original",
    "--beside": "--side-by-side",
}
"""Former names of options, still accepted."""

_RESEARCH = ("figures", "controls", "accuracy")
"""Commands of the research package, which nothing else imports: it is found by its name."""


def module_of(command: str) -> str:
    """Return the module of a command: it has ``add_options`` and ``run``."""
    package = "app.research.commands" if command in _RESEARCH else "app.cli.commands"
    return f"{package}.{command.replace('-', '_')}"


def current_name(word: str) -> str:
    """Return the present name of a command; a word that is not a command is returned as it is."""
    return FORMER_COMMANDS.get(word, word)


def runner_of(command: str) -> Callable[[argparse.Namespace], int]:
    """Return the function that runs a command and returns its exit code."""
    run: Callable[[argparse.Namespace], int] = import_module(module_of(command)).run
    return run


def command_options(command: str, words: Sequence[str]) -> argparse.Namespace:
    """Read the arguments of a command. Raises UserError."""
    parser = command_parser(command)
    known = parser._option_string_actions
    return parser.parse_args(_joined([_renamed(word, known) for word in words]))


def window_options(words: Sequence[str]) -> argparse.Namespace:
    """Read the arguments without a command. Raises UserError."""
    return window_parser().parse_args(words)


def _renamed(word: str, known: Iterable[str]) -> str:
    """Return an option by its present name."""
    name, equals, value = word.partition("=")
    renamed = FORMER_OPTIONS.get(name, "")
    return f"{renamed}{equals}{value}" if renamed in known and name not in known else word


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
    """Reports wrong arguments as a UserError."""

    def error(self, message: str) -> NoReturn:
        raise UserError(
            Message("{text}.", text=message[:1].upper() + message[1:]),
            Message("See '{prog} --help'.", prog=self.prog),
        )


def window_parser() -> argparse.ArgumentParser:
    """Return the parser of the arguments without a command."""
    commands = "\n".join(f"  busk {name:12} {help_}" for name, help_ in COMMANDS.items())
    parser = _Parser(
        prog="busk",
        description="Simulate how a foundation garment reshapes a body.",
        epilog=f"commands without a window:\n{commands}\n\nSee 'busk COMMAND --help' for details.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("file", nargs="?", metavar="FILE", help="a project (.busk) or a scan to open")
    parser.add_argument(
        "--safe-mode", action="store_true", help="render the 3D view without the graphics driver"
    )
    parser.add_argument("--version", action="version", version=f"busk {__version__}")
    return parser


def command_parser(command: str) -> argparse.ArgumentParser:
    """Return the parser of the arguments of a command, by its present or former name."""
    command = current_name(command)
    parser = _Parser(prog=f"busk {command}", description=COMMANDS[command])
    import_module(module_of(command)).add_options(parser)
    return parser
