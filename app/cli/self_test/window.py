"""Check everything that needs Qt: fonts, the report, the window with a project and a slider, its end."""

from __future__ import annotations

import re
import threading

from app.cli.self_test.checks import run_command
from app.cli.self_test.parts import LINE, SelfTestFixture, captured_faults, check
from app.rendering.display import off_screen

_NO_GLYPH = "\U0010fffd"
_DRAWN = {"Inter": "AaGgQq059%°±−×·…", "Noto Sans JP": "特徴点ライン"}
_FONT = re.compile(rb"/FontName\s*/(?:[A-Z]{6}\+)?([\w-]+)")


def toolkit(bench: SelfTestFixture) -> str:
    """Start Qt: on the display, or off-screen where there is none."""
    off_screen()
    from PySide6.QtGui import QGuiApplication  # noqa: PLC0415 (this part reports a missing Qt)

    from app.gui.application import application  # noqa: PLC0415

    app = application(language="en", dark=False)
    bench.faults = bench.held.enter_context(captured_faults())
    return f"{QGuiApplication.platformName()}, device pixel ratio {app.devicePixelRatio():g}"


def fonts(bench: SelfTestFixture) -> str:
    """Check that the bundled fonts are loaded, and that letters of both languages are rendered."""
    from app.gui.theme.stylesheet import load_fonts  # noqa: PLC0415 (brings Qt along)

    loaded = load_fonts()
    missing = [family for family in _DRAWN if family not in loaded]
    check(not missing, f"{', '.join(missing)} is not among the bundled fonts: {loaded}")
    for family, drawn in _DRAWN.items():
        pictures = {_rendered(letter) for letter in (*drawn, _NO_GLYPH)}
        check(len(pictures) == len(drawn) + 1, f"letters of {family} are rendered as placeholder boxes")
    return " and ".join(_DRAWN)


def _rendered(letter: str) -> bytes:
    """Return the pixels of a letter."""
    from PySide6.QtCore import Qt  # noqa: PLC0415
    from PySide6.QtGui import QImage, QPainter  # noqa: PLC0415

    from app.gui.theme.stylesheet import font  # noqa: PLC0415

    image = QImage(40, 40, QImage.Format.Format_Grayscale8)
    image.fill(Qt.GlobalColor.white)
    painter = QPainter(image)
    painter.setFont(font("hero"))
    painter.drawText(image.rect(), Qt.AlignmentFlag.AlignCenter, letter)
    painter.end()
    return bytes(image.constBits())


def report(bench: SelfTestFixture) -> str:
    """Write the report in both languages, and check that it has its fonts and pictures."""
    for language, family in (("en", b"Inter"), ("ja", b"NotoSansJP")):
        path = bench.folder / f"report-{language}.pdf"
        run_command("report", str(bench.project), "--language", language, "--out", str(path))
        data = path.read_bytes()
        used = set(_FONT.findall(data))
        check(any(name.startswith(family) for name in used), f"{path.name} does not use {family.decode()}")
        check(b"/Image" in data, f"{path.name} has no pictures")
    return "report-en.pdf, report-ja.pdf"


def window(bench: SelfTestFixture) -> str:
    """Open a project in the window, and check the 3D view."""
    from app.cli.commands.picture import save_window, settled_window  # noqa: PLC0415

    opened = bench.window = bench.held.enter_context(settled_window(str(bench.project)))
    check(opened.session.path == bench.project, f"the open file is {opened.session.path}")
    save_window(opened, bench.folder / "window.png")
    picture = opened.view.viewport.picture(labels=False)
    columns, rows = range(0, picture.width(), 4), range(0, picture.height(), 4)
    colours = len({picture.pixel(x, y) for x in columns for y in rows})
    check(colours > 200, f"the 3D view is empty: it has {colours} colours")
    bench.check_faults()
    return f"{opened.windowTitle()}, {colours} colours in the 3D view"


def slider(bench: SelfTestFixture) -> str:
    """Shorten a line with the keyboard, and wait until the body has followed."""
    from PySide6.QtCore import QEvent, Qt  # noqa: PLC0415
    from PySide6.QtGui import QKeyEvent  # noqa: PLC0415
    from PySide6.QtWidgets import QApplication  # noqa: PLC0415

    from app.cli.commands.picture import wait_until  # noqa: PLC0415

    opened = bench.window
    assert opened is not None
    session, handle = opened.session, opened.lines.rows[LINE].slider
    before = session.frame
    for kind in (QEvent.Type.KeyPress, QEvent.Type.KeyRelease) * 3:  # 1 % each
        event = QKeyEvent(kind, Qt.Key.Key_Left, Qt.KeyboardModifier.ShiftModifier)
        QApplication.sendEvent(handle, event)
    wait_until(lambda: session.frame is not before and opened.is_settled(), QApplication.processEvents)
    assert before is not None
    assert session.frame is not None
    moved = float(abs(session.frame.points - before.points).max())
    check(moved > 1.0, f"the body has moved by {moved:.2f} mm")
    bench.check_faults()
    return f"{LINE} at {100 * handle.ratio():.1f} % moved the body by {moved:.1f} mm"


def closing(bench: SelfTestFixture) -> str:
    """Close the window without a fault: its threads end."""
    from PySide6.QtWidgets import QApplication  # noqa: PLC0415

    bench.held.close()
    bench.window = None
    QApplication.processEvents()
    bench.check_faults()
    running = [each.name for each in threading.enumerate() if each.name.startswith("busk")]
    check(not running, f"running threads: {', '.join(running)}")
    return "no running threads"
