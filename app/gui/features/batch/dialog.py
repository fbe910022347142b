"""The window of a batch run: setup, progress, results and their distributions. It is hidden when closed."""

# ruff: noqa: N802 - Qt names its events
from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QDragEnterEvent, QDropEvent, QGuiApplication, QResizeEvent
from PySide6.QtWidgets import QCheckBox, QHBoxLayout, QLineEdit, QVBoxLayout, QWidget

from app.gui.features.batch.distribution_card import DistributionCard
from app.gui.features.batch.row_details import RowDetails
from app.gui.features.batch.setup import BatchSetup
from app.gui.features.batch.table import BatchModel, BatchTable
from app.gui.status_bar import ProgressBar
from app.gui.theme.stylesheet import font, label
from app.gui.widgets.basic import EmptyState, Segment
from app.gui.widgets.dialog import Dialog
from app.gui.widgets.notification_bar import NotificationBar
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr
from app.presenters.batch import ALL, filter_titles

_SIZE, _LEAST = (1280, 800), (900, 600)
_LOW = 680  # of a window without room for pictures [px]


class BatchDialog(Dialog):
    """A window of its own beside the main window.

    ``dropped`` carries files and folders, the others are what its buttons request.
    """

    run_requested = Signal()
    stop_requested = Signal()
    open_requested = Signal()
    page_requested = Signal()
    show_folder_requested = Signal()
    report_requested = Signal()
    dropped = Signal(list)

    def __init__(self, model: BatchModel) -> None:
        super().__init__(None, tr("Batch run"))
        self.setWindowFlags(Qt.WindowType.Window)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose, False)
        self.setAcceptDrops(True)
        self.model, self.setup, self.notices = model, BatchSetup(), NotificationBar()
        self.table, self.card = BatchTable(model), DistributionCard()
        self.body.insertWidget(0, self.notices)
        self.body.addWidget(self.setup)
        self.body.addWidget(self._make_progress())
        self.body.addSpacing(4)
        self.empty = EmptyState(
            "result",
            tr("No results yet"),
            tr("Choose scans and a design, then click Run. Scans and folders can be dropped here."),
        )
        self.body.addWidget(self.empty)
        self.results = QWidget()
        column = QVBoxLayout(self.results)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(10)
        column.addLayout(self._make_tools())
        column.addLayout(self._make_results(), 1)
        self.body.addWidget(self.results, 1)
        self.body.addStretch()
        self._make_foot()
        self.table.marked.connect(self._show_row)
        room = QGuiApplication.primaryScreen().availableGeometry()
        self.setMinimumSize(*_LEAST)
        self.resize(min(_SIZE[0], room.width() - 20), min(_SIZE[1], room.height() - 60))
        self.show_rows(False)
        self.show_state(running=False)
        self.show_progress("", None, running=False)

    def _make_progress(self) -> QWidget:
        holder = QWidget()
        row = QHBoxLayout(holder)
        row.setContentsMargins(0, 4, 0, 0)
        row.setSpacing(12)
        self.bar, self.progress = ProgressBar(), label("", "secondary", tabular=True)
        self.bar.setFixedWidth(220)
        row.addWidget(self.bar)
        row.addWidget(self.progress)
        row.addStretch(1)
        self._progress_row = holder
        return holder

    def _make_tools(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(12)
        self.search = QLineEdit()
        self.search.setPlaceholderText(tr("Filter rows"))
        self.search.setAccessibleName(tr("Filter rows"))
        self.search.setClearButtonEnabled(True)
        self.search.setFixedSize(220, 28)
        self.only = Segment(filter_titles(), small=True)
        self.only.set_choice(ALL)
        self.doubtful = QCheckBox(tr("Doubtful first"))
        self.doubtful.setFont(font("body"))
        self.doubtful.setChecked(True)
        set_tip(self.doubtful, tr("List bodies with errors or warnings before the others"))
        self.counts = label("", "secondary", tabular=True)
        for each in (self.search, self.only, self.doubtful):
            row.addWidget(each)
        row.addStretch(1)
        row.addWidget(self.counts)
        self._filter = ALL
        self.search.textChanged.connect(lambda _: self._apply())
        self.only.chosen.connect(self._choose_filter)
        self.doubtful.toggled.connect(self.model.set_doubtful_first)
        return row

    def _make_results(self) -> QHBoxLayout:
        self.details = RowDetails()
        self.details.report_requested.connect(self.report_requested)
        column = QVBoxLayout()
        column.setSpacing(10)
        column.addWidget(self.table, 1)
        column.addWidget(self.details)
        row = QHBoxLayout()
        row.setSpacing(14)
        row.addLayout(column, 1)
        row.addWidget(self.card)
        return row

    def _make_foot(self) -> None:
        self.page = self.add_button(tr("Open page"), self.page_requested.emit, "quiet")
        set_tip(self.page, tr("Open the results as a page in the browser"))
        self.folder = self.add_button(tr("Show folder"), self.show_folder_requested.emit, "quiet")
        for place, each in enumerate((self.page, self.folder)):
            self.foot.removeWidget(each)
            self.foot.insertWidget(place, each)
        self.add_button(tr("Close"), self.reject)
        self.open_body = self.add_button(tr("Open body"), self.open_requested.emit)
        set_tip(self.open_body, tr("Open the selected body with this design in the main window"))
        self.open_body.setEnabled(False)
        self.stop = self.add_button(tr("Stop"), self.stop_requested.emit)
        set_tip(self.stop, tr("Stop the run and keep the results so far"))
        self.run = self.add_button(tr("Run"), self.run_requested.emit, "primary")
        self.run.setDefault(False)  # Enter opens a row, or ends a search

    def show_state(self, *, running: bool, stopping: bool = False) -> None:
        """Allow what is possible while a run goes on, is stopped, or none is there."""
        self.setup.setEnabled(not running)
        self.run.setVisible(not running)
        self.stop.setVisible(running)
        self.stop.setEnabled(not stopping)

    def show_progress(self, text: str, fraction: float | None, *, running: bool) -> None:
        """Show how far the run is, or what became of it; without a text nothing takes its place."""
        self.progress.setText(text)
        self.bar.set_fraction(fraction)
        self.bar.setVisible(running)
        self._progress_row.setVisible(bool(text))

    def show_outputs(self, *, page: bool, folder: bool) -> None:
        """Allow opening what is there."""
        self.page.setEnabled(page)
        self.folder.setEnabled(folder)

    def show_rows(self, some: bool) -> None:
        """Show table and distribution, or what to do first."""
        self.results.setVisible(some)
        self.empty.setVisible(not some)

    def _show_row(self, marked: bool) -> None:
        self.open_body.setEnabled(marked)
        self.details.show_row(self.table.current, self.setup.out)

    def _choose_filter(self, name: str) -> None:
        self._filter = name
        self._apply()

    def _apply(self) -> None:
        self.model.set_filter(self.search.text(), self._filter)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Leave the room to the table in a low window."""
        super().resizeEvent(event)
        self.details.set_low(self.height() < _LOW)

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        """Take scans and folders."""
        if self.setup.isEnabled() and any(url.isLocalFile() for url in event.mimeData().urls()):
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:
        """Choose the scans that are dropped."""
        event.setDropAction(Qt.DropAction.CopyAction)
        event.accept()
        self.dropped.emit([url.toLocalFile() for url in event.mimeData().urls() if url.isLocalFile()])
