"""The strip under the view: does the model come to rest, with which force, and how far it is."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

from PySide6.QtCore import QPointF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QFontMetrics, QPainter, QPaintEvent, QPen, QResizeEvent
from PySide6.QtWidgets import QGridLayout, QHBoxLayout, QLabel, QSizePolicy, QVBoxLayout, QWidget

from app.dress.parts import Segment, ToolButton, sentence
from app.dress.theme import font, label, tokens_of
from app.showing.live_plot import Curve, LivePlot, Numbers
from app.showing.verdict_chip import VerdictChip
from app.wording.words import tr

CONTROLS = ("adaptive", "conventional", "none", "exact")
"""Ways to control the volume, as named in the run."""

TOLERANCE_PERCENT = 0.1
"""Volume error that the paper calls kept [%]."""

_HIGH, _LOW, _FOLDED = 172, 150, 36
_LEGEND_FROM = 1100  # narrower, the legend has no room beside the titles


@dataclass(frozen=True, eq=False)
class Track:
    """A run over its ``turns``: volume error [%] and [ml], height of the bust point [mm]; all (n,)."""

    turns: Numbers
    error_percent: Numbers
    error_ml: Numbers
    apex_mm: Numbers


@dataclass(frozen=True)
class Exact:
    """The exact answer: volume error [%] and height of the bust point [mm]."""

    error_percent: float
    apex_mm: float


class VerdictView(Protocol):
    """What the strip says of a run: a state of the chip, up to three (label, value) pairs, what to do.

    Then what it took, and whether the run is still on its way.
    """

    @property
    def state(self) -> str: ...
    @property
    def numbers(self) -> list[tuple[str, str]]: ...
    @property
    def hint(self) -> str: ...
    @property
    def pace(self) -> str: ...
    @property
    def settling(self) -> bool: ...


class Strip(QWidget):
    """Verdict and method on the left, volume error and bust point height live beside it."""

    control_chosen = Signal(str)
    folded = Signal(bool)

    def __init__(self) -> None:
        super().__init__()
        self._state, self._settling = "stale", False
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Preferred)
        self.chip, self._small_chip = VerdictChip(), VerdictChip(small=True)
        self.error_plot = LivePlot(tr("Volume error"), "%", 0.4, TOLERANCE_PERCENT)
        self.apex_plot = LivePlot(tr("Bust point height"), "mm", 2.0)
        for plot in (self.error_plot, self.apex_plot):
            self.error_plot.pointed.connect(plot.point_at)
            self.apex_plot.pointed.connect(plot.point_at)
        self._legend = _Legend()
        self.apex_plot.head.addWidget(self._legend)
        self._body, self._line = QWidget(), QWidget()
        self._build_body()
        self._build_line()
        outer = QVBoxLayout(self)
        outer.setContentsMargins(0, 0, 0, 0)
        outer.setSpacing(0)
        outer.addWidget(self._body)
        outer.addWidget(self._line)
        self.set_folded(False)
        self._show_emptiness(True)

    def sizeHint(self) -> QSize:
        return QSize(800, _FOLDED if self.is_folded() else _HIGH)

    def set_run(self, tracks: Mapping[str, Track], main: str, exact: Exact | None) -> None:
        """Draw the runs by control; ``main`` is the one on the body, and may be ``"exact"``."""
        strong = "warning" if self._state in ("vibrating", "diverging") else "main"
        roles = {name: strong if name == main else "ghost" for name in tracks}
        refit = not self._settling
        is_main = main == "exact"
        for plot, quantity in ((self.error_plot, "error_percent"), (self.apex_plot, "apex_mm")):
            curves = [
                Curve(track.turns, getattr(track, quantity), roles[name]) for name, track in tracks.items()
            ]
            answer = None if exact is None else getattr(exact, quantity)
            plot.set_curves(curves, answer, exact_is_main=is_main, refit=refit)
        self._legend.show_tracks(roles, exact is not None, is_main)
        self._show_emptiness(exact is None and not any(len(track.turns) for track in tracks.values()))

    def set_verdict(self, verdict: VerdictView) -> None:
        """Show how the run stands; call it before ``set_run``, which takes its colour from it."""
        self._state, self._settling = verdict.state, verdict.settling
        self.chip.set_state(verdict.state)
        self._small_chip.set_state(verdict.state)
        self._turns.setText(verdict.pace)
        pairs = verdict.numbers[: len(self._pairs)]
        for place, (name, value) in enumerate(self._pairs):
            pair = pairs[place] if place < len(pairs) else ("", "")
            for each, text in zip((name, value), pair, strict=True):
                each.setText(text)
                each.setVisible(bool(text))
        self._hint.setText(verdict.hint)
        said = "   ".join(f"{name} {value}" for name, value in pairs[:2])
        self._said.setText(f"{verdict.pace}     {said}     {verdict.hint}")

    def set_control(self, control: str) -> None:
        """Show which of ``CONTROLS`` is on; nothing is emitted."""
        self._segment.set_choice(control)

    def is_folded(self) -> bool:
        """Return whether only the verdict line is shown."""
        return self._body.isHidden()

    def set_folded(self, folded: bool) -> None:
        """Fold the strip to the verdict line, or unfold it."""
        self._body.setHidden(folded)
        self._line.setHidden(not folded)
        self.setMinimumHeight(_FOLDED if folded else _LOW)
        self.setMaximumHeight(_FOLDED if folded else 320)
        self.updateGeometry()
        self.folded.emit(folded)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._legend.setVisible(self.width() >= _LEGEND_FROM)

    def _build_body(self) -> None:
        row = QHBoxLayout(self._body)
        row.setContentsMargins(14, 8, 6, 8)
        row.setSpacing(18)
        row.addLayout(self._verdict())
        self._nothing = sentence(tr("The plots fill while you drag a line."), "secondary")
        self._nothing.setAlignment(Qt.AlignmentFlag.AlignCenter)
        row.addWidget(self.error_plot, 1)
        row.addWidget(self.apex_plot, 1)
        row.addWidget(self._nothing, 1)
        fold = ToolButton("caret-down", tr("Fold the plots away (Ctrl+J)"), size=14, room=26)
        fold.clicked.connect(lambda: self.set_folded(True))
        row.addWidget(fold, alignment=Qt.AlignmentFlag.AlignTop)

    def _verdict(self) -> QVBoxLayout:
        column = QVBoxLayout()
        column.setSpacing(0)
        head = QHBoxLayout()
        head.addWidget(self.chip)
        head.addStretch(1)
        self._turns = label("", "secondary", tabular=True)
        head.addWidget(self._turns)
        column.addLayout(head)
        column.addSpacing(6)
        grid = QGridLayout()
        grid.setHorizontalSpacing(12)
        grid.setVerticalSpacing(3)
        grid.setColumnStretch(1, 1)
        self._pairs: list[tuple[QLabel, QLabel]] = []
        for place in range(3):
            name, value = label("", "secondary"), label("", "title", tabular=True)
            grid.addWidget(name, place, 0)
            grid.addWidget(value, place, 1)
            self._pairs.append((name, value))
        column.addLayout(grid)
        self._hint = sentence("", "secondary")
        self._hint.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        column.addSpacing(4)
        column.addWidget(self._hint)
        column.addStretch(1)
        titles = (tr("Adaptive"), tr("Conventional"), tr("None"), tr("Exact"))
        self._segment = Segment(tuple(zip(CONTROLS, titles, strict=True)), small=True)
        for control, tip in zip(CONTROLS, _control_tips(), strict=True):
            self._segment.button(control).setToolTip(f"<p>{tip}</p>")  # a paragraph wraps
        self._segment.chosen.connect(self.control_chosen)
        column.addWidget(self._segment)
        return column

    def _build_line(self) -> None:
        row = QHBoxLayout(self._line)
        row.setContentsMargins(14, 4, 6, 4)
        row.setSpacing(12)
        self._said = label("", "secondary", tabular=True)
        self._said.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        unfold = ToolButton("caret-up", tr("Show the plots (Ctrl+J)"), size=14, room=26)
        unfold.clicked.connect(lambda: self.set_folded(False))
        row.addWidget(self._small_chip)
        row.addWidget(self._said, 1)
        row.addWidget(unfold)

    def _show_emptiness(self, empty: bool) -> None:
        self._nothing.setVisible(empty)
        self.chip.setVisible(not empty)
        self._small_chip.setVisible(not empty)
        self.error_plot.setVisible(not empty)
        self.apex_plot.setVisible(not empty)


def _control_tips() -> tuple[str, str, str, str]:
    return (
        tr("Adaptive force: it learns from each turn how strong it must be to keep the volume"),
        tr("Conventional force: in proportion to the volume error; it may vibrate"),
        tr("No force: the volume is not kept"),
        tr("Exact answer: the balance with the volume kept, solved at once"),
    )


class _Legend(QWidget):
    """The names of the curves, each behind a piece of its line."""

    def __init__(self) -> None:
        super().__init__()
        self._entries: list[tuple[str, str, bool]] = []
        self.setFont(font("caption"))

    def show_tracks(self, roles: Mapping[str, str], exact: bool, exact_is_main: bool) -> None:
        """Name these runs by their roles, and the exact answer if there is one."""
        titles = {
            "adaptive": tr("Adaptive"),
            "conventional": tr("Conventional"),
            "accumulating": tr("Accumulating"),
            "none": tr("None"),
        }
        colors = {"main": "accent", "warning": "warn_mark", "ghost": "ghost_curve"}
        self._entries = [(titles[name], colors[role], False) for name, role in roles.items()]
        if exact:
            self._entries.append((tr("Exact"), "accent" if exact_is_main else "exact_curve", True))
        wide = QFontMetrics(self.font())
        self.setFixedSize(sum(wide.horizontalAdvance(title) + 38 for title, _, _ in self._entries), 18)
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens = tokens_of(self)
        painter = QPainter(self)
        x, middle = 0.0, self.height() / 2
        for title, token, dashed in self._entries:
            pen = QPen(QColor(getattr(tokens, token)), 2)
            if dashed:
                pen.setDashPattern([2.5, 1.5])
            painter.setPen(pen)
            painter.drawLine(QPointF(x + 2, middle), QPointF(x + 18, middle))
            painter.setPen(QColor(tokens.text_quiet))
            painter.drawText(QPointF(x + 23, middle + 4), title)
            x += painter.fontMetrics().horizontalAdvance(title) + 38
