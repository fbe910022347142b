"""A look at all widgets together, with invented data: python tests/gallery.py FOLDER writes the pictures."""

from __future__ import annotations

import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtGui import QAction, QColor, QPainter
from PySide6.QtWidgets import (
    QApplication,
    QGridLayout,
    QMenuBar,
    QStackedWidget,
    QVBoxLayout,
    QWidget,
)

from app.gui.features.landmarks.panel import LandmarksPanel, LandmarkView
from app.gui.features.lines.panel import LinesPanel, LineView
from app.gui.features.measurements.panel import MeasurementsPanel
from app.gui.features.model.panel import ModelPanel
from app.gui.features.scan.panel import ScanPanel
from app.gui.plots.convergence_panel import ConvergencePanel
from app.gui.status_bar import StatusBar
from app.gui.step_navigation import StepNavigation
from app.gui.theme.stylesheet import apply_theme, tokens_of
from app.gui.title_bar import TitleBar
from app.gui.viewport.toolbar import CompareTools, ViewTools
from app.gui.widgets.notification_bar import NotificationBar
from app.i18n import catalog as words
from app.i18n.catalog import tr
from app.presenters.landmarks import GROUPS, kind_of, landmark_title
from app.presenters.measurements import MeasureView
from app.presenters.model_options import defaults
from app.presenters.plots import Exact, Track
from app.presenters.scan import ScanView
from app.rendering.palette import LINE_COLORS

LINES = (
    ("bust", "Mid-bust line", 0.965, 454.0, 440.9, True, True, 896.0),
    ("upper_edge", "Upper edge", 1.0, 412.4, 412.4, True, False, 812.0),
    ("waist", "Waist line", 0.94, 371.2, 355.4, True, True, 702.5),
    ("under_bust", "Under-bust line", 1.0, 389.0, None, False, True, 745.0),
)
LANDMARKS = (
    ("bust_point_left", 0.97),
    ("bust_point_right", 0.96),
    ("lowest_left", 0.88),
    ("lowest_right", 0.21),
    ("fold_left", 0.61),
    ("fold_right", 0.42),
)


@dataclass(frozen=True)
class Said:
    """An invented verdict."""

    level: str
    headline: str
    state: str
    numbers: list[tuple[str, str]]
    pace: str
    hint: str = ""
    effort: str = ""
    settling: bool = False


def invented_tracks() -> dict[str, Track]:
    """Return a settling and a vibrating run."""
    turns = np.arange(120.0)
    calm = 1.4 * np.exp(-turns / 5) * np.cos(turns / 4)
    wild = 1.6 + (-1.0) ** turns * (0.9 + 0.008 * turns) * (1 - np.exp(-turns / 9))
    rise = 24 * (1 - np.exp(-turns / 16))
    return {
        "adaptive": Track(turns, calm, calm * 46, rise, rise),
        "conventional": Track(turns, wild, wild * 46, *[0.8 * rise + 2 * (wild - 1.6)] * 2),
    }


class Mock(QWidget):
    """The window without its view."""

    def __init__(self, page: str, vibrating: bool) -> None:
        super().__init__()
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setSpacing(0)
        self.inspector = self._inspector(page)
        self.notice, self.strip, self.view = NotificationBar(), ConvergencePanel(), QWidget()
        middle = QVBoxLayout()
        middle.setSpacing(0)
        middle.addWidget(self.notice)
        middle.addWidget(self.view, 1)
        middle.addWidget(self.strip)
        grid.addWidget(self._top(), 0, 0, 1, 3)
        grid.addWidget(self._rail(page), 1, 0)
        grid.addLayout(middle, 1, 1)
        grid.addWidget(self.inspector, 1, 2)
        grid.addWidget(self._status(), 2, 0, 1, 3)
        grid.setColumnStretch(1, 1)
        grid.setRowStretch(1, 1)
        self.tools, self.compare = ViewTools(self.view), CompareTools(self.view)
        self.tools.set_view("three-quarter")
        self.tools.set_shown("bands", True)
        self._fill_strip(vibrating)
        if vibrating:
            self.notice.show_notice(
                "warn",
                tr("This design vibrates with the conventional force."),
                tr("Mid-bust line and volume pull against each other."),
                [(tr("Use adaptive"), self.notice.clear), (tr("Why?"), self.notice.clear)],
                lasting=True,
            )

    def place(self) -> None:
        """Put the floating tools where the window would."""
        self.compare.adjustSize()
        self.compare.move(2, 4)
        self.tools.adjustSize()
        self.tools.move((self.view.width() - self.tools.width()) // 2, self.view.height() - 62)

    def paintEvent(self, event: object) -> None:  # noqa: N802
        painter = QPainter(self)
        tokens = tokens_of(self)
        painter.fillRect(self.rect(), QColor(tokens.panel))
        painter.fillRect(self.view.geometry(), QColor("#2E3036" if tokens.dark else "#EDEAE6"))
        painter.fillRect(self.inspector.x(), 44, 1, self.height() - 70, QColor(tokens.line))

    def _top(self) -> TitleBar:
        menu = QMenuBar()
        for title in ("File", "Edit", "View", "Solve", "Help"):
            menu.addMenu(tr(title))
        undo, redo, export = QAction(tr("Undo"), self), QAction(tr("Redo"), self), QAction("", self)
        redo.setEnabled(False)
        bar = TitleBar(menu, undo, redo, export)
        bar.set_title("Customer 0412", unsaved=True)
        return bar

    def _rail(self, page: str) -> StepNavigation:
        rail = StepNavigation()
        rail.set_state("scan", "done")
        rail.set_state("landmarks", "look", 2)
        rail.set_state("lines", "available")
        rail.set_current("lines" if page == "model" else page)
        return rail

    def _status(self) -> StatusBar:
        bar = StatusBar()
        bar.set_facts(["mm", tr("{count} triangles").format(count="65,742")])
        bar.set_volume(-0.02, -1.1)
        bar.set_job(tr("Finding landmarks"), 0.64)
        bar.set_saved(tr("Saved {time}").format(time="14:02"))
        return bar

    def _inspector(self, page: str) -> QStackedWidget:
        stack = QStackedWidget()
        pages = {
            "scan": ScanPanel(),
            "landmarks": LandmarksPanel(),
            "lines": LinesPanel(),
            "result": MeasurementsPanel(),
            "model": ModelPanel(),
        }
        for each in pages.values():
            stack.addWidget(each)
        pages["scan"].set_scan(
            ScanView(
                file="person.ply",
                unit="m",
                reason=tr("A trunk of 0.9 m around can only be in metres."),
                sure=True,
                up="+z",
                front="-y",
                triangles=65742,
                repairs=(tr("3 holes filled, the largest 42 mm wide."), tr("118 loose specks left out.")),
            )
        )
        rule = tr("The deepest fold in the side view section through the bust point.")
        pages["landmarks"].set_landmarks(
            [LandmarkView(n, landmark_title(n), c, rule, GROUPS[kind_of(n)]) for n, c in LANDMARKS]
        )
        pages["landmarks"].select("fold_right")
        views = [
            LineView(name, tr(title), color, *rest)
            for (name, title, *rest), color in zip(LINES, LINE_COLORS[1:], strict=False)
        ]
        pages["lines"].set_lines(views)
        pages["lines"].select("waist")
        rows = [
            ("Girth at bust level", "cm", 89.6, 86.9),
            ("Girth under the bust", "cm", 74.5, 74.5),
            ("Bust point height", "mm", 1182.4, 1201.0),
            ("Bust point distance", "mm", 196.2, 181.5),
            ("Projection of the bust", "mm", 58.1, 60.3),
            ("Volume inside the control mesh", "ml", 4612.0, 4611.0),
        ]
        pages["model"].set_values({**defaults(), "member_law": "prestressed", "line_contact": "sliding"})
        pages["model"].set_gain(1.9, 1.76)
        pages["result"].set_rows([MeasureView(tr(name), *rest) for name, *rest in rows])
        stack.setCurrentWidget(pages[page])
        self.pages = pages
        return stack

    def _fill_strip(self, vibrating: bool) -> None:
        numbers = [
            (tr("Volume error"), "1.6 ± 1.8 %" if vibrating else "−0.02 % · −1.1 ml"),
            (tr("Bust point"), "14.4 mm up, 2.1 mm forward"),
        ]
        said = ("bad", "Do not use", "vibrating") if vibrating else ("good", "No problems found", "settled")
        self.strip.set_verdict(Said(*said, numbers, "0.9 s"))
        main = "conventional" if vibrating else "adaptive"
        self.strip.set_control(main)
        self.strip.set_run(invented_tracks(), main, Exact(0.0, 0.0, 24.3, 24.3))


def main(folder: Path) -> None:
    """Write pictures of all pages, themes, languages and sizes into ``folder``."""
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    app = QApplication([])
    folder.mkdir(parents=True, exist_ok=True)
    for width, height, dark, language, page, vibrating in (
        (1600, 1000, False, "en", "lines", False),
        (1600, 1000, True, "en", "lines", True),
        (1280, 800, False, "ja", "lines", True),
        (1280, 800, True, "ja", "landmarks", False),
        (1280, 800, False, "en", "scan", False),
        (1280, 800, True, "en", "result", True),
        (1180, 700, False, "ja", "result", True),
    ):
        words.use_language(language)
        apply_theme(app, dark)
        window = Mock(page, vibrating)
        window.setAttribute(Qt.WidgetAttribute.WA_QuitOnClose, False)
        window.inspector.setFixedWidth(364 if width >= 1400 else 340)
        window.resize(width, height)
        window.show()
        app.processEvents()
        window.place()
        window.view.setFocus()
        app.processEvents()
        name = f"{page}_{'dark' if dark else 'light'}_{language}_{width}.png"
        window.grab().save(str(folder / name))
        window.close()


if __name__ == "__main__":
    main(Path(sys.argv[1]))
