"""Parts of a self-test in the window itself: a project, a slider, a dialog of files, and its end."""

from __future__ import annotations

import tempfile
import threading
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.self_test.checks import PartError, check
from app.cli.self_test.fixture import MOVED, Bench
from app.cli.self_test.message_capture import hearing
from app.presenters.samples import sample_path
from app.rendering.display import off_screen

if TYPE_CHECKING:
    from PySide6.QtWidgets import QFileDialog

    from app.gui.features.lines.slider import LengthSlider

_SHORTER = 0.03
"""How much shorter the line is drawn [share of its rest length]."""


def toolkit(bench: Bench) -> str:
    """Begin with Qt: on the display, or off-screen where there is none."""
    off_screen()
    from PySide6.QtGui import QGuiApplication  # noqa: PLC0415 (that Qt is missing is told here)

    from app.gui.application import application  # noqa: PLC0415

    app = application(language="en", dark=False)
    bench.heard = bench.held.enter_context(hearing())
    return f"{QGuiApplication.platformName()}, {app.devicePixelRatio():g} pixels to one"


def window(bench: Bench) -> str:
    """Open a project in the window, and look at it."""
    from app.cli.commands.picture import save_window, settled_window  # noqa: PLC0415

    opened = bench.window = bench.held.enter_context(settled_window(str(bench.project)))
    check(opened.session.path == bench.project, f"the open file is {opened.session.path}")
    save_window(opened, bench.folder / "window.png")
    picture = opened.view.viewport.picture(labels=False)
    colours = {
        picture.pixel(x, y) for x in range(0, picture.width(), 4) for y in range(0, picture.height(), 4)
    }
    check(len(colours) > 200, f"the 3D view is empty: it has {len(colours)} colours")
    bench.check_silence()
    drawn_in = type(opened.view.viewport.overlay.parentWidget()).__name__
    return f"{opened.windowTitle()}, {len(colours)} colours in the 3D view, a {drawn_in}"


def slider(bench: Bench) -> str:
    """Drag the slider of a line as a hand does, and wait until the body has followed."""
    from PySide6.QtWidgets import QApplication  # noqa: PLC0415

    from app.cli.commands.picture import wait_until  # noqa: PLC0415

    opened = bench.shown()
    before, handle = opened.session.frame, opened.lines.rows[MOVED].slider
    assert before is not None
    start = handle.ratio()
    _drag(handle, start - _SHORTER / 2.0, start - _SHORTER)
    wait_until(lambda: opened.session.frame is not before and opened.is_settled(), QApplication.processEvents)
    after = opened.session.frame
    assert after is not None
    check(handle.ratio() < start, f"the slider is unchanged at {100 * handle.ratio():.1f} %")
    moved = float(abs(after.points - before.points).max())
    check(moved > 1.0, f"the body has moved by {moved:.2f} mm")
    check(after.verdict.motion == "settled", f"the solution is {after.verdict.words}")
    check(
        opened.session.undo_stack.count() == 1,
        f"{opened.session.undo_stack.count()} undo steps were created",
    )
    bench.check_silence()
    return f"{MOVED} from {100 * start:.1f} to {100 * handle.ratio():.1f} % moved the body by {moved:.1f} mm"


def _drag(handle: LengthSlider, first: float, last: float) -> None:
    """Press the groove of a slider at a length, move to another and let go, give or take a pixel."""
    from PySide6.QtCore import QEvent, QPointF, Qt  # noqa: PLC0415
    from PySide6.QtGui import QMouseEvent  # noqa: PLC0415
    from PySide6.QtWidgets import QApplication  # noqa: PLC0415

    left, none = Qt.MouseButton.LeftButton, Qt.MouseButton.NoButton
    span = handle.maximum() - handle.minimum()
    for kind, length, button, held in (
        (QEvent.Type.MouseButtonPress, first, left, left),
        (QEvent.Type.MouseMove, last, none, left),
        (QEvent.Type.MouseButtonRelease, last, left, none),
    ):
        share = (length / handle.ratio() * handle.value() - handle.minimum()) / span
        place = QPointF(share * handle.width(), handle.height() / 2)
        event = QMouseEvent(
            kind, place, handle.mapToGlobal(place), button, held, Qt.KeyboardModifier.NoModifier
        )
        QApplication.sendEvent(handle, event)


def file_dialog(bench: Bench) -> str:
    """Open a scan through the dialog that the window asks with, accepting a typed name."""
    from PySide6.QtCore import Qt, QTimer  # noqa: PLC0415
    from PySide6.QtWidgets import QApplication  # noqa: PLC0415

    from app.cli.commands.picture import wait_until  # noqa: PLC0415

    opened, seen = bench.shown(), list[str]()
    opened.session.undo_stack.setClean()  # else it would be asked whether the line is to be saved
    path = sample_path("person")
    clock = QTimer(interval=50)
    clock.timeout.connect(lambda: _answer(path, clock, seen))
    plain = Qt.ApplicationAttribute.AA_DontUseNativeDialogs
    before = QApplication.testAttribute(plain)
    QApplication.setAttribute(plain, True)
    clock.start()
    try:
        opened.project_controller.open()
    finally:
        clock.stop()
        QApplication.setAttribute(plain, before)
    check(bool(seen), "no dialog opened")
    wait_until(lambda: opened.session.name == path.stem and opened.is_settled(), QApplication.processEvents)
    bench.check_silence()
    return f"{seen[0]!r} accepted and opened {path.name}"


def _answer(path: Path, clock: object, seen: list[str]) -> None:
    """Type a name into the dialog that is open, and accept it."""
    from PySide6.QtWidgets import QApplication, QFileDialog, QLineEdit  # noqa: PLC0415

    asked = next((each for each in QApplication.topLevelWidgets() if isinstance(each, QFileDialog)), None)
    if asked is None or not asked.isVisible():
        return
    if seen:  # it was answered and still stands: nobody else will close it
        asked.reject()
        return
    seen.append(asked.windowTitle())
    line = asked.findChild(QLineEdit, "fileNameEdit")
    if isinstance(line, QLineEdit):
        line.setText(str(path))
        _accept(asked)
    else:
        asked.reject()


def _accept(asked: QFileDialog) -> None:
    from PySide6.QtWidgets import QDialogButtonBox  # noqa: PLC0415

    box = asked.findChild(QDialogButtonBox)
    assert box is not None
    box.button(QDialogButtonBox.StandardButton.Open).click()


def closing(bench: Bench) -> str:
    """Close the window: its threads end, and nothing of it stays behind in the folder of passing files."""
    from PySide6.QtWidgets import QApplication  # noqa: PLC0415

    from core.document.storage.recovery import recovery_folder  # noqa: PLC0415

    bench.held.close()
    bench.window = None
    QApplication.processEvents()
    bench.check_silence()
    running = [each.name for each in threading.enumerate() if each.name.startswith("busk")]
    if running:
        raise PartError(f"running threads: {', '.join(running)}")
    left = [each.name for each in Path(tempfile.gettempdir()).iterdir()]
    left += [str(each) for each in recovery_folder().rglob("*") if each.is_file()]
    left += [each.name for each in bench.folder.glob(".*")]
    check(not left, f"leftover files: {', '.join(left[:5])}")
    return "no running threads, no leftover files"
