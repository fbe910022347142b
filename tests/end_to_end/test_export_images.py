"""Pictures for others: finer than the screen, without marks of the hand, saved, copied and printed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QSize
from PySide6.QtGui import QDesktopServices, QGuiApplication, QImage
from PySide6.QtPrintSupport import QPrintDialog, QPrinter
from PySide6.QtWidgets import QPushButton, QWidget
from pytestqt.qtbot import QtBot
from window_tools import Script, run_main

from app.gui.features.view import image_export as picture_desk
from app.gui.features.view.image_export import fitted
from app.gui.main_window import MainWindow
from app.gui.viewport import screenshot as fine_picture
from app.gui.viewport.split_view import SplitHandle

pytestmark = pytest.mark.usefixtures("empty_house")


def pixels(image: QImage) -> np.ndarray:
    image = image.convertToFormat(QImage.Format.Format_RGBX8888)
    rows = np.frombuffer(image.constBits(), np.uint8)
    return rows.reshape(image.height(), image.width(), 4)[..., :3].astype(int)


def test_pictures_are_fine_and_leave_by_three_ways(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    saved, paper, shown = tmp_path / "front.png", tmp_path / "front.pdf", []
    monkeypatch.setattr(picture_desk, "ask_save", lambda *_: str(saved))
    monkeypatch.setattr(
        QDesktopServices, "openUrl", lambda url: bool(shown.append(url.toLocalFile())) or True
    )

    def choose_file(dialog: QPrintDialog) -> bool:
        dialog.printer().setOutputFormat(QPrinter.OutputFormat.PdfFormat)
        dialog.printer().setOutputFileName(str(paper))
        return True

    monkeypatch.setattr(QPrintDialog, "exec", choose_file)

    def script(window: MainWindow) -> Script:
        yield lambda: window.is_settled() and window.view.is_shaded
        window.start_controller.tour.end()
        view = window.view
        room, size = view.panes.size(), view.panes.size() * view.devicePixelRatioF()
        view.tools.actions_by_name["picture"].trigger()
        assert QImage(str(saved)).size() == 2 * size
        notice = window.notices.notice()
        assert (notice.tone, notice.hint) == ("ok", str(tmp_path))
        next(
            each for each in window.notices.findChildren(QPushButton) if each.text() == "Show folder"
        ).click()
        assert shown == [str(tmp_path)]
        yield lambda: view.panes.size() == room
        the_selected_line_is_not_marked(window, pixels(QImage(str(saved))))
        action = next(action for _, action in window.actions_.all() if action.text() == "Copy image")
        action.trigger()
        window.notices.clear()
        assert np.array_equal(pixels(QGuiApplication.clipboard().image()), pixels(QImage(str(saved))))
        window.image_export_controller.print_out()
        assert paper.read_bytes().startswith(b"%PDF")
        assert paper.stat().st_size > 20_000
        a_map_takes_its_legend_along(window)

    run_main([], script)


def the_selected_line_is_not_marked(window: MainWindow, picture: np.ndarray) -> None:
    """What is marked on the screen stays so there, and is no part of the picture."""
    assert window.view.viewport.scene.bands.selected == "mid-bust"
    window.view.select_line("")
    assert np.abs(pixels(window.view.picture()) - picture).max() < 3
    window.view.select_line("mid-bust")


def a_map_takes_its_legend_along(window: MainWindow) -> None:
    window.maps_controller.choose("displacement")
    legend = window.maps_controller.legend
    place = legend.geometry().adjusted(12, 12, -12, -14)
    rows, columns = slice(2 * place.top(), 2 * place.bottom()), slice(2 * place.left(), 2 * place.right())
    with_legend = pixels(window.view.picture())[rows, columns]
    assert all(tool.isVisible() for tool in legend.findChildren(QPushButton))
    legend.setVisible(False)
    without = pixels(window.view.picture())[rows, columns]
    assert np.abs(with_legend - without).max() > 100


def test_the_view_is_as_before_when_a_picture_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> QImage:
        raise MemoryError

    def script(window: MainWindow) -> Script:
        yield window.is_settled
        window.view.tool_actions["section"].trigger()
        window.selection.select_line("mid-bust")
        panes, bands = window.view.panes, window.view.viewport.scene.bands
        seen = [each for each in panes.findChildren(QWidget) if not each.isHidden()]
        monkeypatch.setattr(fine_picture, "_rendered", fail)
        with pytest.raises(MemoryError):
            fine_picture.fine_picture(panes, 2.0)
        assert [each for each in panes.findChildren(QWidget) if not each.isHidden()] == seen
        assert bands.selected == "mid-bust"

    run_main([], script)


def test_a_picture_is_as_large_as_the_page() -> None:
    assert fitted(QSize(200, 100), QSize(1000, 800)).getRect() == (0, 0, 1000, 500)
    assert fitted(QSize(100, 200), QSize(1000, 800)).getRect() == (300, 0, 400, 800)


def test_a_wiped_picture_has_the_border_and_no_knob(qtbot: QtBot) -> None:
    handle = SplitHandle(room := QWidget())
    qtbot.addWidget(room)
    handle.resize(handle.width(), 120)

    def widths() -> list[int]:
        rows = pixels(handle.grab().toImage())
        return [len(np.unique(row, axis=0)) for row in rows]

    with_knob = widths()
    handle.set_bare(True)
    line = widths()
    assert len(set(line)) == 1, "one line from top to bottom"
    assert line[0] > 1
    handle.set_bare(False)
    assert widths() == with_knob != line


def test_the_knob_of_a_wipe_is_out_while_a_picture_is_made(
    mannequin: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    said: list[bool] = []
    monkeypatch.setattr(SplitHandle, "set_bare", lambda _, bare: said.append(bare))

    def script(window: MainWindow) -> Script:
        yield window.is_settled
        window.view.compare_by("wipe")
        window.view.picture()
        assert said == [True, False]

    run_main([str(mannequin)], script)
