"""What a line is made of, as a word that opens the choice."""

# ruff: noqa: N802 - Qt names its events and says what they are
from __future__ import annotations

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent
from PySide6.QtWidgets import QPushButton, QSizePolicy

from app.gui.theme.icons import paint_icon
from app.gui.theme.stylesheet import font, tokens_of
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr


class ElasticButton(QPushButton):
    """A word that opens the choice of elastics; of one that does not fit the width at its end stays."""

    def __init__(self) -> None:
        super().__init__()
        self.setFont(font("secondary"))
        self.setProperty("kind", "pick")
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.setFixedHeight(22)
        self._elastic = ""

    def show_elastic(self, line: str, elastic: str) -> None:
        """Show what a line is made of, or that it can be chosen."""
        self._elastic = elastic or tr("Choose an elastic…")
        set_tip(self, elastic or tr("What this line is made of: its length to cut follows"))
        self.setAccessibleName(tr("{line}: elastic, {elastic}").format(line=line, elastic=self._elastic))
        self.update()

    def sizeHint(self) -> QSize:
        """Ask for as much as the words take."""
        return QSize(self.fontMetrics().horizontalAdvance(self._elastic) + 26, 24)

    @property
    def words(self) -> str:
        """What stands on it."""
        return self._elastic

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint ground and ring as every button, and the words with their caret."""
        super().paintEvent(event)
        tokens, painter = tokens_of(self), QPainter(self)
        painter.setFont(self.font())
        painter.setPen(QColor(tokens.text_quiet if self.isEnabled() else tokens.text_caption))
        words = self.fontMetrics().elidedText(self._elastic, Qt.TextElideMode.ElideMiddle, self.width() - 24)
        painter.drawText(QRectF(5, 0, self.width() - 22, self.height()), Qt.AlignmentFlag.AlignVCenter, words)
        end = 5 + self.fontMetrics().horizontalAdvance(words) + 4
        paint_icon(painter, "caret-down", tokens.text_caption, QRectF(end, self.height() / 2 - 5, 10, 10))
