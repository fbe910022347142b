"""Run the program: a command, or the window if there is none. Qt is loaded for the window only."""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Sequence

from app.cli.environment import is_seen_in_window, path_of, report_error, set_up_streams
from app.cli.parser import COMMANDS, command_options, current_name, runner_of, window_options
from core.errors import UserError
from core.messages import Message

PIPE_CLOSED, BAD_INPUT, INTERRUPTED = 1, 2, 130


def main(arguments: Sequence[str] | None = None) -> int:
    """Run ``busk`` and return its exit code.

    It is 0 for converged or done, 3 for not converged, folded or missed targets, 2 for bad input, with one
    sentence on the standard error, and 130 after Ctrl+C.
    """
    words = list(sys.argv[1:] if arguments is None else arguments)
    set_up_streams()
    command = current_name(words[0]) if words else ""
    try:
        code = _run_command(command, words[1:]) if command in COMMANDS else _run_window(words)
        print(end="", flush=True)
        return code
    except UserError as error:
        report_error(error, in_window=command not in COMMANDS)
        return BAD_INPUT
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:
        # The reader has closed the pipe (busk detect ... | head): not an error of the program.
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        return PIPE_CLOSED


def _run_command(command: str, words: Sequence[str]) -> int:
    options = command_options(command, words)
    # Only a command needs them: version and help do not wait for them.
    import scipy.linalg  # noqa: F401, PLC0415  its BLAS must be there to be held to one thread
    from threadpoolctl import threadpool_limits  # noqa: PLC0415

    with threadpool_limits(1):  # two threads of BLAS wait for each other, and spin, over small products
        return runner_of(command)(options)


def _run_window(words: Sequence[str]) -> int:
    options = window_options(words)
    file = None if options.file is None else path_of(options.file)
    if file == "":
        raise UserError(
            Message("No file specified."), Message("Specify a scan or a project, or see 'busk --help'.")
        )
    if file is not None and not os.path.exists(file) and not is_seen_in_window(file):
        raise UserError(
            Message("{file} is neither a file nor a command.", file=file), Message("See 'busk --help'.")
        )
    # Thousands of modules come now and stay: looking for garbage among them costs a tenth of the start.
    gc.disable()
    from app.gui.startup import run_window  # noqa: PLC0415 (a command needs no Qt)

    return run_window(file, options.safe_mode)
