"""Render the body from one side, or the whole window, to a PNG file without a display."""

from __future__ import annotations

import time
from argparse import ArgumentParser, Namespace
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.design import design_of
from app.cli.options import add_scan, add_settings, picture_size
from app.cli.output import DONE
from app.rendering.display import off_screen
from core.document.design import Design
from core.errors import UserError
from core.files.atomic_write import atomic_path
from core.messages import Message
from core.progress import in_one_go, quiet

if TYPE_CHECKING:
    from app.gui.main_window import MainWindow

_PATIENCE, _LONGEST = 300.0, 1800.0
"""Processor time and real time [s] after which waiting ends: a busy machine gives little of the first."""


def add_options(parser: ArgumentParser) -> None:
    """Add the options of ``busk picture``."""
    add_scan(parser)
    add_settings(parser)
    what = parser.add_mutually_exclusive_group()
    views = "front, left, right, back, three-quarter, top, side"
    what.add_argument("--view", default="three-quarter", help=views)
    what.add_argument("--window", action="store_true", help="render the whole window")
    parser.add_argument("--dark", action="store_true", help="use the dark theme")
    parser.add_argument("--language", choices=("en", "ja"), default="en", help="language of the window")
    size = "size of the picture in pixels"
    parser.add_argument("--size", type=picture_size, default=(1600, 1000), metavar="WIDTHxHEIGHT", help=size)
    parser.add_argument("--out", required=True, metavar="PLACE", help="output picture (.png)")


def run(options: Namespace) -> int:
    """Render the picture."""
    design, out = design_of(options), Path(options.out)
    how = {"dark": options.dark, "size": options.size}
    if options.window:
        draw_window(design, out, language=options.language, **how)
    else:
        draw_picture(design, out, view=options.view, **how)
    print(f"written to {options.out}")
    return DONE


def draw_picture(
    design: Design,
    out: Path,
    *,
    view: str = "three-quarter",
    dark: bool = False,
    size: tuple[int, int] = (1600, 1000),
) -> None:
    """Write a PNG of the reshaped body from one side. Raises UserError."""
    _check_name(out)
    from app.presenters.export import ExportOptions, ExportSource
    from app.presenters.export_preview import prepare_export
    from app.rendering.camera import VIEWS
    from core.pipeline.build import build
    from core.pipeline.solve import solve

    side = {"side": "left"}.get(view, view)
    if side not in VIEWS:
        raise UserError(
            Message("There is no view '{view}'.", view=view),
            Message("Choose one of: {choices}, side.", choices=", ".join(VIEWS)),
        )
    solution = solve(build(design))
    lower = None if solution.lower is None else solution.lower.control_points
    outcome = ExportSource(solution.stages, solution.control_points, lower_points=lower)
    ready = prepare_export("picture", out, outcome, ExportOptions(view=side, size=size, dark=dark))
    assert ready.draw is not None
    ready.write(out, in_one_go(ready.draw()), quiet)


def draw_window(
    design: Design,
    out: Path,
    *,
    dark: bool = False,
    language: str = "en",
    size: tuple[int, int] = (1600, 1000),
) -> None:
    """Write a PNG of the whole window on a settled design. Raises UserError, that of a stuck scan too."""
    _check_name(out)
    with settled_window(design, dark=dark, language=language, size=size) as window:
        save_window(window, out)
        if window.session.stuck is not None:
            raise window.session.stuck


@contextmanager
def settled_window(
    what: str | Design, *, dark: bool = False, language: str = "en", size: tuple[int, int] = (1600, 1000)
) -> Iterator[MainWindow]:
    """Yield a window on a file or design, converged and fully drawn; it is closed afterwards.

    A scan that cannot go on is shown as far as it came, and stays in ``window.session.stuck``.
    """
    off_screen()
    from app.gui.application import application
    from app.gui.startup import open_window

    app = application(language=language, dark=dark)
    window = open_window(what)
    failures: list[Exception] = []
    window.session.failed.connect(failures.append)
    window.view.viewport.motion = False
    window.resize(*size)
    window.show()

    def ready() -> bool:
        view = window.view
        seen = window.session.stuck is not None or window.session.is_converged
        return bool(failures) or (seen and view.is_shaded and not window.scan_controller.painting)

    try:
        wait_until(ready, app.processEvents)
        if failures:
            raise failures[0]
        yield window
    finally:
        window.session.undo_stack.setClean()
        window.close()


def save_window(window: MainWindow, out: Path) -> None:
    """Write a PNG of a window as it stands. Raises UserError."""
    from PySide6.QtWidgets import QApplication

    from app.gui.session.project_thumbnail import png_of

    window.throttled.flush()
    wait_until(lambda: not window.jobs.at_work(), QApplication.processEvents)
    # The view smooths its outlines once it has been still for a while.
    still = time.monotonic() + 0.6
    wait_until(lambda: time.monotonic() > still, QApplication.processEvents)
    with atomic_path(out) as partial:
        partial.write_bytes(png_of(window.grab().toImage()))


def _check_name(out: Path) -> None:
    if out.suffix.lower() != ".png":
        raise UserError(
            Message("'{out}' is not a picture file name.", out=out), Message("Choose a name ending in .png.")
        )
    if not out.parent.is_dir():
        raise UserError(
            Message("Folder {parent} does not exist.", parent=out.parent),
            Message("Create the folder, or choose another one."),
        )


def wait_until(ready: Callable[[], bool], turn: Callable[[], None]) -> None:
    """Let events pass until ``ready``. Raises UserError if that takes too long."""
    patience, longest = time.process_time() + _PATIENCE, time.monotonic() + _LONGEST
    while not ready():
        if time.process_time() > patience or time.monotonic() > longest:
            raise UserError(Message("The rendering timed out."), Message("Try again, or report the problem."))
        turn()
        time.sleep(0.005)
