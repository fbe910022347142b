"""Names come from files of others: whatever they look like, the window shows them as plain text."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import QEvent, QPoint, Qt
from PySide6.QtGui import QHelpEvent
from PySide6.QtWidgets import QAbstractItemView, QApplication, QLabel, QWidget
from pytestqt.qtbot import QtBot
from window_tools import Script, run_undrawn, settled

from app.gui.features.project.recent_files import remember_file
from app.gui.main_window import MainWindow
from app.gui.widgets.menu import Menu
from app.gui.widgets.tooltip import set_tip, shown_tip
from app.presenters.samples import sample_path
from core.document.custom_measures import CustomMeasurement
from core.document.design import Design, ScanSource
from core.document.document import Document
from core.document.elastic import Elastic
from core.document.lines import CustomLine, LineSettings
from core.document.storage.project_file import ScanFile, save_project

HOSTILE = '<img src="//127.0.0.1/a.png"><h1>A</h1>'
"""A name that a label with a guess would take for HTML, and fetch a picture for."""


@pytest.fixture
def hostile_project(tmp_path: Path) -> Path:
    """A project on the sample body in which every name looks like HTML, and its path too."""
    elastic = Elastic(HOSTILE, 12.0, ((0.0, 0.0), (0.5, 6.0), (1.5, 20.0)), 20.0, "", True)
    design = (
        Design(ScanSource(sample_path("mannequin")), customer=HOSTILE)
        .with_line("mid-bust", 0.97)
        .with_custom_measurement(CustomMeasurement(HOSTILE, "girth", (), 200.0))
    )
    traits = LineSettings("mid-bust", title=HOSTILE, elastic=HOSTILE)
    own = CustomLine(HOSTILE, (40, 41, 42, 43), closed=False)
    design = replace(design, traits=(traits,), own_lines=(own,), elastics=(elastic,)).with_line(HOSTILE, 0.95)
    folder = tmp_path / "<img src=x>"
    folder.mkdir()
    path = folder / "<b>A.busk"
    scan = ScanFile("<img src=x>.ply", Path(sample_path("mannequin")).read_bytes())
    save_project(path, Document.single(design), scan, b"")
    return path


@pytest.mark.usefixtures("empty_house")
def test_no_label_and_no_tooltip_of_the_window_is_read_as_html(hostile_project: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        remember_file(str(hostile_project))
        window.notices.show_notice("bad", HOSTILE, HOSTILE, [(HOSTILE, lambda: None)], lasting=True)
        taken: set[str] = set()
        for step in ("scan", "landmarks", "lines", "result"):
            window.navigation.show_step(step)
            for name in window.lines.rows:
                window.selection.select_line(name)
                yield lambda: True
            taken |= read_as_html()
        for panel in ("garment", "variants", "history", "model"):
            window.navigation.show_panel(panel)
            yield lambda: True
            taken |= read_as_html()
        window.report_controller.open()
        yield lambda: True
        taken |= read_as_html()
        window.start_controller.show_page()
        yield lambda: True
        taken |= read_as_html()
        assert not taken, "\n".join(sorted(taken))

    assert run_undrawn([str(hostile_project)], script) == 0


def read_as_html() -> set[str]:
    """Return where any widget reads a text of others as HTML, in a label or in a tooltip."""
    taken = set()
    for widget in QApplication.allWidgets():
        where = f"{type(widget).__name__} in {type(widget.parent()).__name__}"
        if isinstance(widget, QLabel) and widget.text():
            kind = widget.textFormat()
            rich = kind != Qt.TextFormat.PlainText and "<img src=" in widget.text()
            if rich or kind == Qt.TextFormat.AutoText:  # whatever it shows now, another name may come
                taken.add(f"label: {where}: {widget.text()}")
        if widget.isVisible():
            taken |= {f"tooltip: {where}: {tip}" for tip in map(tip_by_qt, asked_of(widget)) if tip}
    return taken


def asked_of(widget: QWidget) -> list[tuple[QWidget, QPoint]]:
    """Return the places of a widget that a tooltip is asked for at."""
    if isinstance(widget, QAbstractItemView) and widget.model() is not None:
        rows = (widget.model().index(row, 0) for row in range(widget.model().rowCount()))
        return [(widget.viewport(), widget.visualRect(row).center()) for row in rows]
    return [(widget, widget.rect().center())] if widget.toolTip() else []


def tip_by_qt(asked: tuple[QWidget, QPoint]) -> str:
    """Ask for the tooltip at a place; return its text if Qt shows it, which guesses whether it is HTML."""
    widget, place = asked
    QApplication.sendEvent(widget, QHelpEvent(QEvent.Type.ToolTip, place, widget.mapToGlobal(place)))
    labels = [each for each in QApplication.topLevelWidgets() if each.inherits("QTipLabel")]
    return next((each.text() for each in labels if isinstance(each, QLabel) and each.isVisible()), "")


def test_a_tooltip_is_shown_letter_by_letter_and_goes_with_the_pointer(qtbot: QtBot) -> None:
    widget = QWidget()
    qtbot.addWidget(widget)
    set_tip(widget, HOSTILE)
    widget.show()
    assert tip_by_qt((widget, QPoint(1, 1))) == ""
    assert shown_tip(widget) == HOSTILE
    QApplication.sendEvent(widget, QEvent(QEvent.Type.Leave))
    assert shown_tip(widget) == ""


def test_an_entry_of_a_menu_shows_a_tooltip_of_its_own_alone(qtbot: QtBot) -> None:
    menu = Menu()
    qtbot.addWidget(menu)
    told, bare = menu.addAction("Open"), menu.addAction("Save…")
    set_tip(told, HOSTILE)
    menu.popup(QPoint(0, 0))
    for action, tip in ((told, HOSTILE), (bare, "")):
        assert tip_by_qt((menu, menu.actionGeometry(action).center())) == ""
        assert shown_tip(menu) == tip


def test_the_program_has_no_other_way_to_show_tooltips_and_menus() -> None:
    others = re.compile(r"\.setToolTip\(|\bQToolTip\.|\bQMenu\(|\.setToolTipsVisible\(")
    here = Path(__file__).parents[2] / "app"
    allowed = {here / "gui" / "widgets" / name for name in ("tooltip.py", "menu.py")}
    places = set(here.rglob("*.py")) - allowed
    found = [file.name for file in places if others.search(file.read_text(encoding="utf-8"))]
    assert not found


def test_every_label_of_the_program_says_how_its_text_is_read() -> None:
    here = Path(__file__).parents[2] / "app"
    files = {file: file.read_text(encoding="utf-8") for file in here.rglob("*.py")}
    makes = {file: text for file, text in files.items() if re.search(r"\bQLabel\(|\(QLabel\)", text)}
    unsaid = {file.name for file, text in makes.items() if ".setTextFormat(" not in text}
    assert makes
    assert not unsaid
