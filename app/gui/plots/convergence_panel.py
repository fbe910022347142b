"""The strip under the view: does the model come to rest, with which force, and how far it is."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Protocol

from PySide6.QtCore import QEvent, QObject, QPoint, QSize, Qt, Signal
from PySide6.QtWidgets import QGridLayout, QHBoxLayout, QLabel, QSizePolicy, QVBoxLayout, QWidget

from app.gui.plots.canvas import Turns
from app.gui.plots.live_plot import LivePlot
from app.gui.plots.painting import ROLE_COLORS, Entry, Legend, legend_entries, legend_width, zone_entries
from app.gui.plots.status_chip import StatusChip, StatusLine
from app.gui.theme.stylesheet import label
from app.gui.widgets.basic import Segment, ToolButton, sentence
from app.gui.widgets.menu import Menu
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr
from app.i18n.lengths import shown_value
from app.presenters.model_options import control_texts
from app.presenters.plots import (
    Curve,
    ErrorTrack,
    Event,
    Exact,
    LowerRun,
    Track,
    error_quantities,
    height_quantities,
    tolerance_of,
    zone_quantities,
)
from app.presenters.zones import zone_title


def control_segment() -> Segment:
    """Return the segment of the volume controls that have a button."""
    offered = {control: text for control, text in control_texts().items() if text.button}
    result = Segment(tuple((control, text.button) for control, text in offered.items()), small=True)
    for control, text in offered.items():
        set_tip(result.button(control), text.tip)
    return result


def region_segment() -> Segment:
    """Return the segment of the regions whose runs can be plotted."""
    result = Segment((("bust", tr("Bust")), ("lower", tr("Waist and hips"))), small=True)
    set_tip(result.button("bust"), tr("Plot volume error and height of the bust"))
    set_tip(result.button("lower"), tr("Plot the volume errors of waist, hips and seat, also by zone"))
    result.set_choice("bust")
    return result


_HIGH, _LOW, _FOLDED = 184, 150, 36


class VerdictView(Protocol):
    """Level and headline of the overall verdict, up to three (label, value) pairs, what to do; then the run's
    state, with the time and effort it took, and whether it is still on its way.
    """

    @property
    def level(self) -> str: ...
    @property
    def headline(self) -> str: ...
    @property
    def state(self) -> str: ...
    @property
    def numbers(self) -> list[tuple[str, str]]: ...
    @property
    def hint(self) -> str: ...
    @property
    def pace(self) -> str: ...
    @property
    def effort(self) -> str: ...
    @property
    def settling(self) -> bool: ...


class ConvergencePanel(QWidget):
    """Verdict and method on the left, volume error and a height over the turns live beside it.

    With a lower trunk its volume error, in all and by zone, can be plotted instead of those of the bust.
    ``export_requested`` carries csv, png or svg; ``quantity_chosen`` the name of what a plot shows now;
    ``why_requested`` wants to know more of a verdict that is no good.
    """

    control_chosen = Signal(str)
    quantity_chosen = Signal(str)
    export_requested = Signal(str)
    folded = Signal(bool)
    why_requested = Signal()

    def __init__(self) -> None:
        super().__init__()
        self._state, self._settling = "stale", False
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Preferred)
        self.chip, self._small_chip = StatusChip(), StatusChip(small=True)
        for chip in (self.chip, self._small_chip):
            chip.clicked.connect(self.why_requested)
        self.error_plot, self.height_plot = LivePlot(error_quantities()), LivePlot(height_quantities())
        self.zone_plot = LivePlot(zone_quantities())
        self.region = region_segment()
        self.region.chosen.connect(self._choose_region)
        self._run: tuple[Mapping[str, Track], str, Exact | None] = ({}, "adaptive", None)
        self._lower: LowerRun | None = None
        self._of_lower = False
        self._events: tuple[tuple[Event, ...], tuple[Event, ...]] = ((), ())
        self._connect_plots()
        self._entries: list[Entry] = []
        # Beside the title of the first plot, below both, or beside the choice of the region.
        self._legends = Legend(), Legend(), Legend()
        self._zone_legend = Legend()
        self.error_plot.head.addWidget(self._legends[0])
        for plot in self.all_plots:
            plot.setMinimumWidth(120)  # a legend gives way, the plot does not
            plot.installEventFilter(self)
        self._body, self._line, self._turns = QWidget(), QWidget(), label("", "secondary", tabular=True)
        self._build_body()
        self._build_line()
        self._build_menu()
        outer = QVBoxLayout(self)
        outer.setContentsMargins(0, 0, 0, 0)
        outer.setSpacing(0)
        outer.addWidget(self._body)
        outer.addWidget(self._line)
        self.set_folded(False)
        self._place_region()
        self._show_emptiness(True)

    def sizeHint(self) -> QSize:
        return QSize(800, _FOLDED if self.is_folded() else _HIGH)

    def set_run(
        self, tracks: Mapping[str, Track], main: str, exact: Exact | None, lower: LowerRun | None = None
    ) -> None:
        """Draw the runs by control; ``main`` is the one on the body, and may be ``"exact"``.

        ``lower`` are those of the lower trunk, which can be chosen if there is one.
        """
        self._run, self._lower = (tracks, main, exact), lower
        if (lower is not None) == self._top.isHidden():
            self._place_region()
        self._draw(refit=not self._settling)
        self._show_emptiness(exact is None and not any(len(track.turns) for track in tracks.values()))

    def set_events(self, events: Sequence[Event], of_lower: Sequence[Event] = ()) -> None:
        """Mark from now on where something was changed, in the runs of the bust and of the lower trunk."""
        self._events = tuple(events), tuple(of_lower)
        self._draw(refit=not self._settling)

    def show_turns(self, turns: Turns | None) -> None:
        """Show these turns in all plots, or all turns."""
        for plot in self.all_plots:
            plot.show_turns(turns)

    @property
    def shows_lower(self) -> bool:
        """Return whether the runs of the lower trunk are plotted."""
        return self._of_lower and self._lower is not None

    @property
    def plots(self) -> tuple[LivePlot, LivePlot]:
        """Return the plots in use: the volume error, and the height or the volume errors of zones."""
        return self.error_plot, self.zone_plot if self.shows_lower else self.height_plot

    @property
    def all_plots(self) -> tuple[LivePlot, ...]:
        """Return all plots, in use or not."""
        return self.error_plot, self.height_plot, self.zone_plot

    @property
    def legend(self) -> list[Entry]:
        """Return the names of the curves as they are drawn."""
        return [*self._entries, *self._zone_legend.entries]

    def _draw_anew(self) -> None:
        self._draw(refit=True)

    def _draw(self, refit: bool) -> None:
        tracks, main, exact = self._run
        shown: Mapping[str, ErrorTrack] = tracks
        zones: Mapping[str, ErrorTrack] = {}
        if self._of_lower and self._lower is not None:
            shown, zones = self._lower.tracks, self._lower.zones
        strong = "warning" if self._state in ("vibrating", "diverging") else "main"
        roles = {name: strong if name == main else "ghost" for name in shown}
        some, texts = shown.get(main) or next(iter(shown.values()), None), control_texts()
        runs = [(track, roles[name], texts[name].curve) for name, track in shown.items()]
        parts = [(track, name, zone_title(name)) for name, track in zones.items()]
        for plot, drawn in zip(self.plots, (runs, parts if self.shows_lower else runs), strict=True):
            quantity = plot.quantity.name
            scale = shown_value(1.0, "mm" if quantity.endswith("_mm") else "")
            plot.set_curves(
                [Curve(track.turns, scale * getattr(track, quantity), *names) for track, *names in drawn],
                None if exact is None else scale * getattr(exact, quantity),
                exact_is_main=main == "exact",
                tolerance=tolerance_of(quantity, some),
                events=self._events[self.shows_lower],
                refit=refit,
            )
        self._entries = legend_entries(roles, exact is not None, main == "exact")
        self._zone_legend.show_entries(zone_entries(zones))
        self._share_legend()

    def show_region(self, region: str) -> None:
        """Plot the runs of a region, "bust" or "lower", once there are any."""
        self.region.set_choice(region)
        self._choose_region(region)

    def _choose_region(self, region: str) -> None:
        self._of_lower = region == "lower"
        self._place_region()
        self._draw_anew()

    def _place_region(self) -> None:
        """Show the plots of the chosen region, below the choice if there is any."""
        self._top.setVisible(self._lower is not None)
        for plot in (self.height_plot, self.zone_plot):
            plot.setVisible(plot in self.plots and self._nothing.isHidden())
        self._zone_legend.setVisible(self.shows_lower)

    def _share_legend(self) -> None:
        """Name the runs in one place: beside the choice of the region, where there is none beside the first
        plot's title, or below both plots if that is narrow.
        """
        entries = self._entries
        room = self.error_plot.width() - self.error_plot.title.width() - 8
        place = 2 if self._lower is not None else 0 if legend_width(entries) <= room else 1
        if place == 2 and legend_width(entries) > self._top.width() - self.region.sizeHint().width() - 8:
            entries = [entry for entry in entries if entry[1] != ROLE_COLORS["ghost"]]
        for each, legend in enumerate(self._legends):
            legend.show_entries(entries if each == place else [])
            legend.setVisible(each == place)

    def set_verdict(self, verdict: VerdictView) -> None:
        """Show how the run stands; call it before ``set_run``, which takes its colour from it."""
        self._state, self._settling = verdict.state, verdict.settling
        self.chip.set_state(verdict.level, verdict.headline)
        self._small_chip.set_state(verdict.level, verdict.headline)
        self._turns.setText(verdict.pace)
        set_tip(self._turns, verdict.effort)
        pairs = verdict.numbers[: len(self._pairs)]
        for place, (name, value) in enumerate(self._pairs):
            pair = pairs[place] if place < len(pairs) else ("", "")
            for each, text in zip((name, value), pair, strict=True):
                each.setText(text)
                each.setVisible(bool(text))
        self.hint.setText(verdict.hint)
        figures = (f"{name} {value}" for name, value in pairs[:2])
        self._said.show_parts((verdict.hint, *figures, verdict.pace))  # what to do stands first

    def set_control(self, control: str) -> None:
        """Show which of the controls is on; nothing is emitted."""
        self._segment.set_choice(control)

    def is_folded(self) -> bool:
        """Return whether only the verdict line is shown."""
        return self._body.isHidden()

    def set_folded(self, folded: bool) -> None:
        """Collapse the plots to the verdict line, or expand them."""
        self._body.setHidden(folded)
        self._line.setHidden(not folded)
        self.setMinimumHeight(_FOLDED if folded else _LOW)
        self.setMaximumHeight(_FOLDED if folded else 320)
        self.updateGeometry()
        self.folded.emit(folded)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Resize:
            self._share_legend()
        return False

    def _connect_plots(self) -> None:
        """Let all plots show the same turns, and read the same one."""
        for plot, name in zip(self.all_plots, ("error", "height", "zones"), strict=True):
            plot.setObjectName(name)
            for other in self.all_plots:
                plot.pointed.connect(other.point_at)
                plot.zoomed.connect(other.show_turns)
            plot.quantity_chosen.connect(self._draw_anew)
            plot.quantity_chosen.connect(self.quantity_chosen)
            plot.menu_requested.connect(self._show_menu)

    def _build_body(self) -> None:
        row = QHBoxLayout(self._body)
        row.setContentsMargins(14, 7, 6, 7)
        row.setSpacing(18)
        row.addLayout(self._verdict())
        self._nothing = sentence(tr("Plots appear while you drag a line."))
        self._nothing.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._top = QWidget()
        top = QHBoxLayout(self._top)
        top.setContentsMargins(0, 0, 0, 2)
        top.setSpacing(2)
        top.addWidget(self.region)
        top.addStretch(1)
        top.addWidget(self._legends[2])
        plots = QGridLayout()
        plots.setHorizontalSpacing(18)
        plots.setVerticalSpacing(0)
        for column, plot in ((0, self.error_plot), (1, self.height_plot), (1, self.zone_plot)):
            plots.addWidget(plot, 1, column)
            plots.setColumnStretch(column, 1)
        plots.addWidget(self._top, 0, 0, 1, 2)
        plots.addWidget(self._legends[1], 2, 0, 1, 2, Qt.AlignmentFlag.AlignHCenter)
        plots.addWidget(self._zone_legend, 2, 0, 1, 2, Qt.AlignmentFlag.AlignRight)
        row.addLayout(plots, 2)
        row.addWidget(self._nothing, 1)
        row.addLayout(self._tools())

    def _tools(self) -> QVBoxLayout:
        """Return the buttons at the right edge; the window adds its own to them."""
        self.tools = QVBoxLayout()
        self.tools.setSpacing(2)
        fold = ToolButton("caret-down", tr("Collapse plots (Ctrl+J)"), size=14, room=26)
        fold.clicked.connect(lambda: self.set_folded(True))
        self.save = ToolButton("export", tr("Export plots or their values"), size=16, room=26)
        self.save.clicked.connect(lambda: self._show_menu(self.save.mapToGlobal(self.save.rect().topLeft())))
        for each in (fold, self.save):
            self.tools.addWidget(each)
        self.tools.addStretch(1)
        return self.tools

    def _show_menu(self, at: QPoint) -> None:
        self.menu.exec(at)

    def _build_menu(self) -> None:
        self.menu = Menu(self)
        for kind, text in (
            ("csv", tr("Export iterations as CSV…")),
            ("png", tr("Export plots as PNG…")),
            ("svg", tr("Export plots as SVG…")),
        ):
            self.menu.addAction(text, partial(self.export_requested.emit, kind))
        self.menu.addSeparator()
        self.menu.addAction(tr("Show all iterations"), partial(self.show_turns, None))

    def _verdict(self) -> QVBoxLayout:
        column = QVBoxLayout()
        column.setSpacing(0)
        head = QHBoxLayout()
        head.addWidget(self.chip)
        head.addSpacing(10)
        head.addStretch(1)
        head.addWidget(self._turns)
        column.addLayout(head)
        column.addSpacing(4)
        grid = QGridLayout()
        grid.setHorizontalSpacing(12)
        grid.setVerticalSpacing(2)
        grid.setColumnStretch(1, 1)
        self._pairs: list[tuple[QLabel, QLabel]] = []
        for place in range(3):
            name, value = label("", "secondary"), label("", "title", tabular=True)
            grid.addWidget(name, place, 0)
            grid.addWidget(value, place, 1)
            self._pairs.append((name, value))
        column.addLayout(grid)
        self.hint = sentence("", "secondary")
        self.hint.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        column.addSpacing(2)
        column.addWidget(self.hint)
        column.addSpacing(4)
        column.addStretch(1)
        self._segment = control_segment()
        self._segment.chosen.connect(self.control_chosen)
        column.addWidget(self._segment)
        return column

    def _build_line(self) -> None:
        row = QHBoxLayout(self._line)
        row.setContentsMargins(14, 4, 6, 4)
        row.setSpacing(12)
        self._said = StatusLine()
        unfold = ToolButton("caret-up", tr("Show plots (Ctrl+J)"), size=14, room=26)
        unfold.clicked.connect(lambda: self.set_folded(False))
        row.addWidget(self._small_chip)
        row.addWidget(self._said, 1)
        row.addWidget(unfold)

    def _show_emptiness(self, empty: bool) -> None:
        self._nothing.setVisible(empty)
        for each in (self.chip, self._small_chip, *self.plots):
            each.setVisible(not empty)
        self._top.setVisible(not empty and self._lower is not None)
