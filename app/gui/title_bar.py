"""The bar above everything: menus, name of the project, undo and redo, export, what the work leads to."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QAction, QColor, QPainter, QPaintEvent
from PySide6.QtWidgets import QGridLayout, QHBoxLayout, QLayout, QMenuBar, QWidget

from app.gui.theme.stylesheet import label, tokens_of
from app.gui.widgets.basic import ToolButton, button
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr


class TitleBar(QWidget):
    """Word mark and menus on the left, the title in the middle, what is always wanted on the right."""

    def __init__(self, menu: QMenuBar, undo: QAction, redo: QAction, export: QAction) -> None:
        super().__init__()
        self.setFixedHeight(44)
        grid = QGridLayout(self)
        grid.setContentsMargins(16, 0, 14, 1)
        grid.setColumnStretch(0, 1)
        grid.setColumnStretch(2, 1)
        left = QHBoxLayout()
        self._right = right = QHBoxLayout()
        left.setSpacing(12)
        left.addWidget(label("Busk", "wordmark"))
        left.addWidget(menu, alignment=Qt.AlignmentFlag.AlignVCenter)
        left.addSpacing(16)  # a long menu bar must not touch the title
        left.addStretch(1)
        right.addStretch(1)
        right.addWidget(ToolButton("arrow-u-up-left", action=undo))
        right.addWidget(ToolButton("arrow-u-up-right", action=redo))
        right.addSpacing(8)
        self.export = button(tr("Export…"))
        self.export.setEnabled(export.isEnabled())
        set_tip(self.export, export.toolTip())
        self.export.clicked.connect(export.trigger)
        export.enabledChanged.connect(self.export.setEnabled)
        right.addWidget(self.export)
        grid.addLayout(left, 0, 0)
        grid.addLayout(self._middle(), 0, 1)
        grid.addLayout(right, 0, 2)

    def place(self, widget: QWidget) -> None:
        """Place what is always wanted between undo and the buttons at the end."""
        self._right.insertWidget(self._right.indexOf(self.export), widget)
        self._right.insertSpacing(self._right.indexOf(self.export), 8)

    def add_primary(self, action: QAction) -> None:
        """Place what the work leads to at the end."""
        self.primary = button(action.text(), "primary")
        self.primary.setEnabled(action.isEnabled())
        set_tip(self.primary, action.toolTip())
        self.primary.clicked.connect(action.trigger)
        action.enabledChanged.connect(self.primary.setEnabled)
        self._right.addSpacing(8)
        self._right.addWidget(self.primary)

    def set_title(self, title: str, unsaved: bool) -> None:
        """Show the name of the project, with a dot while it has unsaved changes."""
        self._title.setText(title)
        self._dot.setVisible(unsaved)

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.fillRect(0, self.height() - 1, self.width(), 1, QColor(tokens_of(self).line))

    def _middle(self) -> QLayout:
        middle = QHBoxLayout()
        middle.setSpacing(8)
        self._title = label("", "name")
        self._dot = _Dot()
        set_tip(self._dot, tr("Not saved"))
        self._dot.setAccessibleName(tr("Not saved"))
        middle.addWidget(self._title)
        middle.addWidget(self._dot)
        return middle


class _Dot(QWidget):
    """A small round mark."""

    def __init__(self) -> None:
        super().__init__()
        self.setFixedSize(8, 18)
        policy = self.sizePolicy()
        policy.setRetainSizeWhenHidden(True)
        self.setSizePolicy(policy)
        self.hide()

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(tokens_of(self).text_caption))
        painter.drawEllipse(0, 5, 8, 8)
