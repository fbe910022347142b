"""The manual page ``busk.1``, made of the parser of the command line itself, so that the two cannot part."""

from __future__ import annotations

import argparse
import time

from app.cli.parser import COMMANDS, command_parser, window_parser
from core import __version__

HEAD = r"""
.SH NAME
busk \- see how a foundation garment reshapes a body
.SH SYNOPSIS
.B busk
[\fB\-\-safe\-mode\fR] [\fIFILE\fR]
.br
.B busk
\fICOMMAND\fR [\fIOPTION\fR]...
.SH DESCRIPTION
Busk is a program for designers of tailor-made bras, bodysuits and girdles. It opens a body scan, detects the
bust landmarks, fits a control mesh to the body and builds a tensegric model on it. If the length of a
line of the garment changes, the body is reshaped at constant volume. Without a command Busk opens its
window; commands need no display.
"""

TAIL = r"""
.SH EXIT STATUS
.TP
0
The solver has converged, or the work is done.
.TP
1
A part of the self-test failed, or the reader closed the pipe.
.TP
2
The input cannot be used; one sentence on the standard error says why.
.TP
3
The solver has not converged, the body is folded, or targets were not reached.
.SH FILES
.TP
.I *.busk
A project: one zip with the design, the untouched scan and a picture.
.TP
.I ~/.config/Busk/
Settings of the window.
.TP
.I ~/.local/share/Busk/
Backups of projects, presets, elastics and tables of sizes of your own.
.TP
.I ~/.local/state/Busk/
Unsaved work, and the log. The log holds faults, never a scan or its measurements.
.TP
.I ~/.cache/Busk/
Compiled loops; made again when they are missing.
.SH EXAMPLES
.TP
.B busk person.ply
Open a scan in the window.
.TP
.B busk solve person.ply \-\-line mid\-bust=97% \-\-out result
Set one line to 97 % of its original length, and write the body, the control mesh, all
iterations and a report.
.TP
.B busk measure design.busk \-\-csv
Print the measurements before and after.
.SH SEE ALSO
The user guide: F1 in the window.
"""


def escaped(text: str) -> str:
    r"""Return text for roff: backslashes, hyphens that are typed, and no full stop or quote first in a line.

    >>> escaped("--line 'x'")
    "\\-\\-line 'x'"
    """
    safe = text.replace("\\", "\\e").replace("-", "\\-")
    return "\n".join("\\&" + line if line[:1] in (".", "'") else line for line in safe.split("\n"))


def value_of(action: argparse.Action) -> str:
    """Return what stands behind an option: its metavar or its choices, or nothing for a switch."""
    if action.nargs == 0:
        return ""
    if action.metavar is None and action.choices is not None:
        return "|".join(map(str, action.choices))
    return str(action.metavar or action.dest.upper())


def option_lines(parser: argparse.ArgumentParser) -> list[str]:
    """Return the options of a parser as tagged paragraphs; ``-h`` is said once, at the window's own."""
    lines = []
    for action in parser._actions:
        if isinstance(action, argparse._HelpAction):
            continue
        names = ", ".join(rf"\fB{escaped(name)}\fR" for name in action.option_strings)
        value = rf"\fI{escaped(value_of(action))}\fR" if value_of(action) else ""
        expand = parser._get_formatter()._expand_help
        words = expand(action) if action.help else ""
        lines += [".TP", " ".join(filter(None, (names, value))), escaped(words) or r"\&"]
    return lines


def command_lines(command: str) -> list[str]:
    """Return what stands under a command: what it does, then its options."""
    what = COMMANDS[command]
    return [
        f".SS busk {escaped(command)}",
        escaped(f"{what[:1].upper()}{what[1:]}."),
        *option_lines(command_parser(command)),
    ]


def man_page(epoch: int) -> str:
    """Return the page as roff; ``epoch`` is its date in seconds since 1970."""
    date = time.strftime("%Y-%m-%d", time.gmtime(epoch))
    return "\n".join(
        [
            f'.TH BUSK 1 {date} "Busk {__version__}" "User Commands"',
            HEAD.strip(),
            ".SH OPTIONS",
            *option_lines(window_parser()),
            ".TP",
            r"\fB\-h\fR, \fB\-\-help\fR",
            "Show a short help; behind a command, that of the command.",
            ".SH COMMANDS",
            *(line for command in COMMANDS for line in command_lines(command)),
            TAIL.strip(),
            "",
        ]
    )
