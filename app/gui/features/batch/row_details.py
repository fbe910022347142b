"""The selected row of a batch run: picture of the reshaped body, name, verdict and remarks."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QPixmap
from PySide6.QtWidgets import QFrame, QHBoxLayout, QVBoxLayout

from app.batch.stored_rows import written_file
from app.gui.theme.stylesheet import label, set_tag
from app.gui.widgets.basic import ElidedLabel, button, sentence
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr
from app.presenters.batch import BatchRow, row_heading

_HEIGHT, _LOW_HEIGHT, _PICTURE = 116, 74, (72, 96)


class RowDetails(QFrame):
    """Shows one row, or how to select one; ``report_requested`` by its button."""

    report_requested = Signal()

    def __init__(self) -> None:
        super().__init__()
        set_tag(self, "kind", "card")
        self.setFixedHeight(_HEIGHT)
        self.picture, self.heading = label(), ElidedLabel()
        self.picture.setFixedSize(*_PICTURE)
        self.picture.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.heading.setFont(label("", "name").font())
        self.remarks = sentence("", "secondary")
        self.report = button(tr("Open report"), "quiet")
        self.report.clicked.connect(self.report_requested)
        words, row = QVBoxLayout(), QHBoxLayout(self)
        words.setSpacing(3)
        words.addWidget(self.heading)
        words.addWidget(self.remarks, 1)
        row.setContentsMargins(12, 10, 12, 10)
        row.setSpacing(14)
        row.addWidget(self.picture)
        row.addLayout(words, 1)
        row.addWidget(self.report, alignment=Qt.AlignmentFlag.AlignTop)
        self._row: BatchRow | None = None
        self._low = False
        self.show_row(None, None)

    def show_row(self, row: BatchRow | None, folder: Path | None) -> None:
        """Show a row with its files in a folder of results."""
        if row is not None and row is self._row:
            return
        self._row = row
        missing = tr("Select a row to see its remarks. Double-click a row to open the body.")
        self.heading.setText(row_heading(row) if row is not None else "")
        self.heading.setVisible(row is not None)
        self.remarks.setText(row.remarks if row is not None else missing)
        set_tip(self.remarks, row.remarks if row is not None else "")
        self.report.setVisible(row is not None and bool(row.report))
        picture = QPixmap()
        file = (
            written_file(folder, "picture", row.picture) if row is not None and folder is not None else None
        )
        if file is not None:
            picture.load(str(file))
        if not picture.isNull():
            ratio = self.devicePixelRatioF()
            picture = picture.scaled(
                round(_PICTURE[0] * ratio),
                round(_PICTURE[1] * ratio),
                Qt.AspectRatioMode.KeepAspectRatio,
                Qt.TransformationMode.SmoothTransformation,
            )
            picture.setDevicePixelRatio(ratio)
        self.picture.setPixmap(picture)
        self._place_picture()

    def set_low(self, low: bool) -> None:
        """Take less height, without the picture."""
        self._low = low
        self.setFixedHeight(_LOW_HEIGHT if low else _HEIGHT)
        self._place_picture()

    def _place_picture(self) -> None:
        self.picture.setVisible(not self._low and not self.picture.pixmap().isNull())
