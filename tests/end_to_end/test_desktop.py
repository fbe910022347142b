"""What belongs to any desktop program, through the real main(): keys, layout, wishes, faults."""

from __future__ import annotations

import shutil
import threading
from collections import Counter
from pathlib import Path

import pytest
from PySide6.QtCore import QByteArray, QPoint, QSettings, Qt, QTimer
from PySide6.QtGui import QDesktopServices, QGuiApplication
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget
from window_tools import Script, drag, run_bodiless, settled

from app.gui.application import log_folder
from app.gui.features.help.about import AboutDialog, DiagnosticsDialog
from app.gui.features.help.command_palette import CommandPalette
from app.gui.features.help.crash_handler import CrashDialog
from app.gui.features.preferences.dialog import PreferencesDialog
from app.gui.main_window import MainWindow
from app.gui.widgets.dialog import Dialog
from app.gui.widgets.splitter import STEP
from app.rendering.palette import DARK
from core.document.storage.backups import backups_folder
from core.document.storage.recovery import recovery_folder

pytestmark = pytest.mark.usefixtures("empty_house")


def sheet_of(window: MainWindow, kind: type[Dialog]) -> Dialog:
    return next(each for each in window.findChildren(kind) if each.isVisible())


def test_help_finds_keys_commands_versions_and_licences() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        no_key_means_two_things(window)
        window.activateWindow()
        yield window.isActiveWindow
        QTest.keyClick(window, Qt.Key.Key_K, Qt.KeyboardModifier.ControlModifier)
        found = sheet_of(window, CommandPalette)
        assert isinstance(found, CommandPalette)
        found.search.setText("no such thing")
        assert found.list.chosen() is None
        found.search.setText("環境設定")  # Japanese in the English window
        QTest.keyClick(found.search, Qt.Key.Key_Return)
        preferences = sheet_of(window, PreferencesDialog)
        assert isinstance(preferences, PreferencesDialog)
        preferences.fields["theme"].chosen.emit("dark")
        assert window.palette().window().color().name().upper() == DARK.panel
        preferences.fields["autosave"].chosen.emit(2.0)
        assert (QSettings().value("theme"), QSettings().value("autosave")) == ("dark", "5")
        preferences.fields["material"].chosen.emit("plaster")
        assert window.view.viewport.scene.material == "plaster"
        preferences.fields["mouse"].chosen.emit("blender")
        preferences.accept()
        the_hand_of_another_program_is_understood(window)
        window.help_controller.show_keys()
        keys = sheet_of(window, CommandPalette)
        assert isinstance(keys, CommandPalette)
        said = {
            keys.list.topLevelItem(row).text(2): keys.list.topLevelItem(row).text(0)
            for row in range(keys.list.topLevelItemCount())
        }
        assert said["Ctrl+O"] == "Open"
        assert said["Shift+Middle drag"] == "Move body"
        assert said["L"] == "Link or unlink"
        assert {"Backspace", "← →, - +", "← → ↑ ↓", "Home, End", "Page Up, Page Down", "Del"} <= said.keys()
        keys.accept()
        recovery_folder().mkdir(parents=True, exist_ok=True)
        shutil.rmtree(backups_folder(), ignore_errors=True)
        window.help_controller.show_machine()
        machine = sheet_of(window, DiagnosticsDialog)
        assert isinstance(machine, DiagnosticsDialog)
        machine.copy.click()
        copied = QGuiApplication.clipboard().text()
        assert "vtk" in copied
        assert "Renderer" in copied or "OpenGL" in copied
        the_folders_are_named_and_opened(window, machine, copied)
        machine.accept()
        window.help_controller.show_about()
        about = sheet_of(window, AboutDialog)
        assert isinstance(about, AboutDialog)
        texts = [about.texts.widget(place).toPlainText() for place in range(about.texts.count())]
        assert ["Apache License" in texts[0], "shiboken6" in texts[1], "SIL OPEN FONT" in texts[2]] == [
            True
        ] * 3
        about.accept()

    run_bodiless([], script)


def the_folders_are_named_and_opened(window: MainWindow, sheet: DiagnosticsDialog, said: str) -> None:
    assert all(str(each()) in said for each in (log_folder, recovery_folder, backups_folder))
    asked: list[str] = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(QDesktopServices, "openUrl", lambda url: not asked.append(url.toLocalFile()))
        for opener in sheet.openers.values():
            opener.click()
    assert asked[:2] == [str(log_folder()), str(recovery_folder())]
    assert str(backups_folder()) not in asked, "nothing was ever saved over"
    assert not sheet.openers["Backups"].isEnabled()
    assert window.notices.notice() is None


def no_key_means_two_things(window: MainWindow) -> None:
    keys = Counter(key.toString() for _, action in window.actions_.all() for key in action.shortcuts())
    assert [key for key, count in keys.items() if count > 1] == []
    assert {"Ctrl+K", "F6", "Shift+F1", "Ctrl+,", "Ctrl+I", "Ctrl+J", "Ctrl+1", "Space"} <= keys.keys()


def the_hand_of_another_program_is_understood(window: MainWindow) -> None:
    """As in Blender the middle button turns the body, and with Shift moves it."""
    viewport = window.view.viewport
    canvas, middle = viewport.overlay.parentWidget(), Qt.MouseButton.MiddleButton
    assert canvas is not None
    start = viewport.scene.view
    for held in (Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.ShiftModifier):
        QTest.mousePress(canvas, middle, held, QPoint(200, 150))
        QTest.mouseMove(canvas, QPoint(240, 150))
        QTest.mouseRelease(canvas, middle, held, QPoint(240, 150))
        if held is Qt.KeyboardModifier.NoModifier:
            turned = viewport.scene.view
            assert abs(turned.azimuth - start.azimuth) > 10.0
            assert tuple(turned.focus) == tuple(start.focus)
    assert viewport.scene.view.azimuth == turned.azimuth
    assert tuple(viewport.scene.view.focus) != tuple(turned.focus)


def test_the_room_is_shared_out_by_keys() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.activateWindow()
        yield window.isActiveWindow
        window.strip.set_folded(False)
        fitted: list[bool] = []
        window.view.tools.actions_by_name["fit"].triggered.connect(fitted.append)
        focus = QApplication.focusWidget
        for name, key, part, size in (
            ("Live plot height", Qt.Key.Key_Up, window.strip, QWidget.height),
            ("Inspector width", Qt.Key.Key_Left, window.inspector, QWidget.width),
        ):
            for _ in range(60):
                if focus().accessibleName() == name:
                    break
                QTest.keyClick(focus(), Qt.Key.Key_Tab)
            before = size(part)
            QTest.keyClick(focus(), key)
            assert size(part) == before + STEP, name
            QTest.keyClick(focus(), Qt.Key.Key_Home)
            assert size(part) == getattr(part, f"maximum{size.__name__.title()}")(), "as far as it goes"
            QTest.keyClick(focus(), Qt.Key.Key_End)
            assert size(part) < before
        assert not fitted, "Home shows all of the body elsewhere"
        window.strip.set_folded(True)
        assert "Live plot height" not in [each.accessibleName() for each in window.layout_._stops()]

    run_bodiless([], script)


def test_the_layout_is_shared_out_by_hand_and_kept(mannequin: Path) -> None:
    def first(window: MainWindow) -> Script:
        yield settled(window)
        window.activateWindow()
        yield window.isActiveWindow
        assert window.inspector.width() == 340
        handle = window.layout_._across.handle(1)
        QTest.mousePress(handle, Qt.MouseButton.LeftButton, pos=QPoint(0, 200))
        QTest.mouseMove(handle, QPoint(-80, 200))
        QTest.mouseRelease(handle, Qt.MouseButton.LeftButton, pos=QPoint(-80, 200))
        assert 400 < window.inspector.width() < 440
        window.strip.set_folded(True)
        assert window.strip.height() == 36
        window.view.viewport.setFocus()
        QTest.keyClick(window.view.viewport, Qt.Key.Key_Tab)
        assert [part.isVisible() for part in (window.rail, window.inspector, window.strip)] == [False] * 3
        QTest.keyClick(window.view.viewport, Qt.Key.Key_Tab)
        assert [part.isVisible() for part in (window.rail, window.inspector, window.strip)] == [True] * 3
        window.inspector.tabs.button("result").click()
        assert window.result.isVisible()
        QTest.keyClick(window, Qt.Key.Key_1, Qt.KeyboardModifier.ControlModifier)
        assert (window.scan.isVisible(), window.inspector.tabs.isVisible()) == (True, False)

    def second(window: MainWindow) -> Script:
        yield settled(window)
        assert 400 < window.inspector.width() < 440
        assert (window.strip.is_folded(), window.strip.height()) == (True, 36)
        window.actions_.reset_layout.trigger()
        assert (window.inspector.width(), window.strip.is_folded()) == (340, False)

    def third(window: MainWindow) -> Script:
        yield settled(window)
        assert window.screen().geometry().intersects(window.frameGeometry())

    run_bodiless([], first)
    run_bodiless([str(mannequin)], second)
    QSettings().setValue("window/geometry", QByteArray(b"no geometry"))
    QSettings().setValue("window/inspector", "-7")
    run_bodiless([str(mannequin)], third)


def test_a_fault_is_told_once_and_the_work_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    rescued = []

    def script(window: MainWindow) -> Script:
        yield settled(window)
        monkeypatch.setattr(window.crash_handler, "_rescue", lambda: rescued.append(1) or "/a/safe/place")
        storm = QTimer(window, interval=0)
        storm.timeout.connect(lambda: {}["nothing"])
        storm.start()
        thread = threading.Thread(target=lambda: 1 // 0, name="faulty")
        thread.start()
        thread.join()
        yield (
            lambda: (
                window.crash_handler.sheet is not None
                and "ZeroDivisionError" in window.crash_handler.sheet.report()
            )
        )
        for _ in range(20):
            QApplication.processEvents()
        storm.stop()
        sheets = window.findChildren(CrashDialog)
        assert len(sheets) == 1
        assert len(rescued) == 1
        assert "/a/safe/place" in sheets[0].said.text()
        assert {"KeyError", "vtk"} <= set(sheets[0].report().replace(":", " ").split())
        sheets[0].go_on.click()
        drag(window, "mid-bust", -30)
        yield settled(window)
        design = window.session.design
        assert design is not None
        assert design.ratio("mid-bust") < 0.95

    run_bodiless([], script, expected=(KeyError, ZeroDivisionError))


def test_a_fault_in_a_slot_or_thread_fails_the_test_that_does_not_expect_it() -> None:
    def in_slot(window: MainWindow) -> Script:
        yield lambda: True
        QTimer.singleShot(0, window, lambda: {}["nothing"])
        yield lambda: window.crash_handler.sheet is not None

    def in_thread(window: MainWindow) -> Script:
        yield lambda: True
        threading.Thread(target=lambda: 1 // 0, name="faulty").start()
        yield lambda: window.crash_handler.sheet is not None

    with pytest.raises(KeyError):
        run_bodiless([], in_slot)
    with pytest.raises(ZeroDivisionError):
        run_bodiless([], in_thread, expected=(KeyError,))
