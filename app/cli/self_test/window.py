"""Check everything that needs Qt: fonts, the report, the window with a project and a slider, its end."""

from __future__ import annotations

import re
import tempfile
import threading
from importlib import resources
from pathlib import Path

from app.cli.self_test.checks import run_command
from app.cli.self_test.parts import LINE, SelfTestFixture, captured_faults, check
from app.rendering.display import off_screen

_NO_GLYPH = "\U0010fffd"
_DRAWN = {"Inter": "AaGgQq059%°±−×·…", "Noto Sans JP": "特徴点ライン"}
_PAGE = re.compile(rb"/Type\s*/Page\b")
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
    """Check that the bundled fonts have the letters of both languages, and that they are rendered."""
    from PySide6.QtGui import QRawFont  # noqa: PLC0415 (brings Qt along)

    from app.gui.theme.stylesheet import load_fonts  # noqa: PLC0415
    from app.i18n.catalog import translations  # noqa: PLC0415

    loaded = load_fonts()
    missing = [family for family in _DRAWN if family not in loaded]
    check(not missing, f"{', '.join(missing)} is not among the bundled fonts: {loaded}")
    words = [text for forms in translations("ja").values() for text in forms]
    letters = {chr(code) for code in range(33, 127)} | {x for x in "".join(words) if not x.isspace()}
    bundled = []
    for file in (resources.files("resources") / "fonts").iterdir():
        if "Regular" in file.name:
            font = QRawFont()
            font.loadFromData(file.read_bytes(), 13.0, font.hintingPreference())
            bundled.append(font)
    absent = sorted(x for x in letters if not any(font.supportsCharacter(ord(x)) for font in bundled))
    check(not absent, f"{len(absent)} glyphs are missing: {''.join(absent[:20])}")
    for family, drawn in _DRAWN.items():
        pictures = {_rendered(letter) for letter in (*drawn, _NO_GLYPH)}
        check(len(pictures) == len(drawn) + 1, f"letters of {family} are rendered as placeholder boxes")
    return f"{' and '.join(_DRAWN)}, {len(letters)} glyphs"


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
    """Write the report in both languages, and check its pages, fonts and pictures."""
    sizes = []
    for language, family in (("en", b"Inter"), ("ja", b"NotoSansJP")):
        path = bench.folder / f"report-{language}.pdf"
        run_command("report", str(bench.project), "--language", language, "--out", str(path))
        data = path.read_bytes()
        check(data.startswith(b"%PDF-") and data.rstrip().endswith(b"%%EOF"), f"{path.name} is incomplete")
        count, used = len(_PAGE.findall(data)), set(_FONT.findall(data))
        check(count == 2, f"{path.name} has {count} pages, not 2")
        check(any(name.startswith(family) for name in used), f"{path.name} does not use {family.decode()}")
        check(b"/Image" in data, f"{path.name} has no pictures")
        sizes.append(f"{path.name} {len(data) / 1000:.0f} kB")
    return ", ".join(sizes)


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
    before, handle = opened.session.frame, opened.lines.rows[LINE].slider
    assert before is not None
    start = handle.ratio()
    for kind in (QEvent.Type.KeyPress, QEvent.Type.KeyRelease) * 3:  # 1 % each
        event = QKeyEvent(kind, Qt.Key.Key_Left, Qt.KeyboardModifier.ShiftModifier)
        QApplication.sendEvent(handle, event)
    wait_until(lambda: opened.session.frame is not before and opened.is_settled(), QApplication.processEvents)
    after = opened.session.frame
    assert after is not None
    moved = float(abs(after.points - before.points).max())
    check(handle.ratio() < start, f"the slider is unchanged at {100 * handle.ratio():.1f} %")
    check(moved > 1.0, f"the body has moved by {moved:.2f} mm")
    check(opened.session.undo_stack.count() > 0, "no undo step was created")
    bench.check_faults()
    return f"{LINE} from {100 * start:.1f} to {100 * handle.ratio():.1f} % moved the body by {moved:.1f} mm"


def closing(bench: SelfTestFixture) -> str:
    """Close the window: its threads end, and no temporary file remains."""
    from PySide6.QtWidgets import QApplication  # noqa: PLC0415

    from core.document.storage.recovery import recovery_folder  # noqa: PLC0415

    bench.held.close()
    bench.window = None
    QApplication.processEvents()
    bench.check_faults()
    running = [each.name for each in threading.enumerate() if each.name.startswith("busk")]
    check(not running, f"running threads: {', '.join(running)}")
    left = [each.name for each in Path(tempfile.gettempdir()).iterdir()]
    left += [str(each) for each in recovery_folder().rglob("*") if each.is_file()]
    left += [each.name for each in bench.folder.glob(".*")]
    check(not left, f"leftover files: {', '.join(left[:5])}")
    return "no running threads, no leftover files"
