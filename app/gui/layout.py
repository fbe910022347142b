"""Layout of the window: inspector, notifications, splitters and sizes kept between sessions."""

# ruff: noqa: N802 - Qt names its events

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, QSettings, Qt, QTimer
from PySide6.QtWidgets import QApplication, QHBoxLayout, QStackedWidget, QVBoxLayout, QWidget

from app.gui.context import Navigation
from app.gui.widgets.basic import OverlayCard, Segment, announce
from app.gui.widgets.focus_chain import FocusRing, next_stop, stops
from app.gui.widgets.overlay_layout import APART, GAP
from app.gui.widgets.splitter import Splitter
from app.gui.widgets.tooltip import set_tip
from app.gui.widgets.window_geometry import put_as_last
from app.i18n.catalog import language, tr

if TYPE_CHECKING:
    from app.gui.main_window import MainWindow


_LEAST = 440
"""Width that notices need beside the tools at the upper edge of the view [px]."""

NARROW, WIDE = 340, 364
"""First width of the inspector in windows narrower and wider than 1400 pixels."""

VIEW, BESIDE_PIECES = 480, 544
"""Least width of the view, and that beside the pieces, where its tools need all of it [px]."""

KEPT_AFTER = 1000
"""Stillness after which the place of the window is remembered [ms]."""

LOW, HIGH = 190, 184
"""First height of the strip in windows lower and higher than 850 pixels."""

TALLER = {"ja": 14}
"""How much higher the strip is where the lines of a language are taller [px]."""


class Inspector(QWidget):
    """Holds the panels by name; ``tabs`` are offered at the head while one of them is shown."""

    LEAST, MOST = 330, 480

    def __init__(self) -> None:
        super().__init__()
        self.setMinimumWidth(self.LEAST)
        self.setMaximumWidth(self.MOST)
        self._panels: dict[str, QWidget] = {}
        self._titled: set[str] = set()
        self.tabs = Segment((), small=True, wide=True)
        set_tip(self.tabs, tr("Lengths, measurements, elastics and cut list, variants, history"))
        self._head = QWidget()
        row = QHBoxLayout(self._head)
        row.setContentsMargins(8, 10, 8, 0)
        row.addWidget(self.tabs)
        self._stack = QStackedWidget()
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self._head)
        column.addWidget(self._stack, 1)

    def add(self, name: str, panel: QWidget, tab: str = "") -> None:
        """Take a panel in; one with the title of a ``tab`` is offered beside the others that have one."""
        self._panels[name] = panel
        self._stack.addWidget(panel)
        if tab:
            self._titled.add(name)
            self.tabs.add(name, tab)
        if len(self._panels) == 1:
            self.open(name)

    def open(self, name: str) -> None:
        """Show the panel of this name; the keyboard goes over to it, and not to a button of it."""
        has, former = QApplication.focusWidget(), self._stack.currentWidget()
        goes_over = has is not None and former is not None and former.isAncestorOf(has)
        self._stack.setCurrentWidget(self._panels[name])
        self._head.setVisible(name in self._titled)
        self.tabs.set_choice(name)
        if goes_over:
            self._panels[name].setFocus(Qt.FocusReason.OtherFocusReason)

    def panel(self) -> QWidget | None:
        """Return the panel that is shown."""
        return self._stack.currentWidget()


class NotificationArea(QObject):
    """Keeps the notices on what is shown; on the view they never change its size."""

    def __init__(self, window: MainWindow, pages: QStackedWidget, work: QWidget, head: QVBoxLayout) -> None:
        super().__init__(window)
        self._window, self._pages, self._work, self._head = window, pages, work, head
        self._on_view = False
        window.view.installEventFilter(self)
        window.view.compare.installEventFilter(self)
        pages.currentChanged.connect(self.carry)

    def carry(self) -> None:
        """Place the notices on the view, or above the page that is shown in the place of the work."""
        view, notices = self._window.view, self._window.notices
        on_view = self._pages.currentWidget() is self._work
        if on_view == self._on_view:
            return
        self._on_view, shown = on_view, not notices.isHidden()
        if on_view:
            self._head.removeWidget(notices)
            self._fit()
            view.place(notices, "top")
        else:
            view.floating.remove(notices)
            notices.set_room(None, self._window.height())
            self._head.insertWidget(0, notices)
        notices.setVisible(shown)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Handle the size of the view and of the tools beside the notices."""
        if event.type() in (QEvent.Type.Resize, QEvent.Type.Show, QEvent.Type.Hide):
            self._fit()
        return False

    def _fit(self) -> None:
        if not self._on_view:
            return
        view = self._window.view
        whole = view.width() - 2 * GAP
        beside = whole - view.compare.sizeHint().width() if not view.compare.isHidden() else whole
        self._window.notices.set_room(beside - APART if beside >= _LEAST else whole, view.height())


class Layout(QObject):
    """Places the parts: top bar, rail, the work beside it, status bar.

    ``pages`` holds the work (view, strip and inspector) and whatever may take its place, such as the start.
    Esc calls ``closers`` until one returns that it has closed something.
    """

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._width: int | None = None  # of the inspector and
        self._height: int | None = None  # of the strip, once the user has chosen them
        self._keeps = QTimer(window, interval=KEPT_AFTER, singleShot=True)
        self._keeps.timeout.connect(self.keep)
        self._restored = False
        self.closers: Sequence[Callable[[], bool]] = ()
        self._folded_as_low = False
        self.pages = QStackedWidget()
        self._across = Splitter(Qt.Orientation.Horizontal, tr("Inspector width"))
        self._down = Splitter(Qt.Orientation.Vertical, tr("Live plot height"))
        self._beside = Splitter(Qt.Orientation.Horizontal, tr("Width of the pattern pieces"))
        self._middle, self._right = QVBoxLayout(), QVBoxLayout()
        self._ring = FocusRing(window)
        self._build()
        self._notices = NotificationArea(window, self.pages, self._across, self._right)
        self._notices.carry()
        self._across.splitterMoved.connect(self._note_width)
        self._down.splitterMoved.connect(self._note_height)
        window.strip.folded.connect(self._fit_strip)
        self._follow(window.navigation)
        window.view.viewport.addAction(window.actions_.alone)
        window.installEventFilter(self)

    def _build(self) -> None:
        window, work, right, central = self._window, QWidget(), QWidget(), QWidget()
        for column, holder in ((self._middle, work), (self._right, right)):
            column.setContentsMargins(0, 0, 0, 0)
            column.setSpacing(0)
            holder.setLayout(column)
        window.view.setMinimumSize(VIEW, 300)
        # Tab goes past the view, where it hides what lies around it: F6 and the pointer lead in.
        window.view.viewport.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        window.view.viewport.setAccessibleName(tr("3D view"))
        window.pieces.hide()  # until the step Pattern is open
        for place, each in enumerate((window.view, window.pieces)):
            self._beside.addWidget(each)
            self._beside.setStretchFactor(place, 1)
        for splitter, parts in (
            (self._down, (self._beside, window.strip)),
            (self._across, (work, window.inspector)),
        ):
            for stretch, part in zip((1, 0), parts, strict=True):
                splitter.addWidget(part)
                splitter.setStretchFactor(splitter.count() - 1, stretch)
        self._middle.addWidget(self._down, 1)
        self.pages.addWidget(self._across)
        self._right.addWidget(self.pages, 1)
        across, down = QHBoxLayout(), QVBoxLayout(central)
        for row in (across, down):
            row.setContentsMargins(0, 0, 0, 0)
            row.setSpacing(0)
        across.addWidget(window.rail)
        across.addWidget(right, 1)
        down.addWidget(window.top)
        down.addLayout(across, 1)
        down.addWidget(window.status)
        window.setCentralWidget(central)

    def _follow(self, navigation: Navigation) -> None:
        """Show what is navigated to."""
        window = self._window
        navigation.step_shown.connect(self._show_step)
        navigation.panel_shown.connect(window.inspector.open)
        navigation.page_shown.connect(lambda page: self.pages.setCurrentWidget(page or self._across))
        navigation.panel_focused.connect(self.enter)
        navigation.step_marked.connect(window.rail.set_state)
        window.rail.step_chosen.connect(navigation.show_step)
        window.inspector.tabs.chosen.connect(navigation.show_panel)

    # -- what is shown

    def _show_step(self, step: str) -> None:
        if self._window.actions_.alone.isChecked():
            self.show_alone(False)
        pieces = step == "pattern"
        self._window.pieces.setVisible(pieces)
        self._window.view.setMinimumWidth(BESIDE_PIECES if pieces else VIEW)
        if pieces:
            self._beside.setSizes([self._beside.width() // 2] * 2)
        self._window.strip.setVisible(not pieces)
        self._window.rail.set_current(step)
        self._window.actions_.steps[step].setChecked(True)

    def show_inspector(self, shown: bool) -> None:
        """Show or hide the inspector."""
        self._window.inspector.setVisible(shown)
        self._window.actions_.inspector.setChecked(shown)

    def show_alone(self, alone: bool) -> None:
        """Hide all but the view, or bring the rest back as it was."""
        window = self._window
        window.navigation.show_page(None)
        window.rail.setVisible(not alone)
        pieces = window.navigation.step == "pattern"
        window.strip.setVisible(not alone and not pieces)
        window.pieces.setVisible(not alone and pieces)
        window.inspector.setVisible(not alone and window.actions_.inspector.isChecked())
        window.actions_.alone.setChecked(alone)
        window.view.viewport.setFocus()

    def show_full_screen(self, full: bool) -> None:
        """Let the window fill the screen, or let it be as it was."""
        state, flag = self._window.windowState(), Qt.WindowState.WindowFullScreen
        self._window.setWindowState(state | flag if full else state & ~flag)

    def reset(self) -> None:
        """Restore default sizes and positions."""
        self._width = self._height = None
        self.show_alone(False)
        self.show_inspector(True)
        self._window.strip.set_folded(False)
        self.fit()

    def next_pane(self) -> None:
        """Move the keyboard focus in the next part of the window that takes it."""
        panes, has = self._panes(), QApplication.focusWidget()
        at = next((place for place, pane in enumerate(panes) if has and pane.isAncestorOf(has)), -1)
        for pane in (panes[(at + step) % len(panes)] for step in range(1, len(panes) + 1)):
            viewport = self._window.view.viewport
            target = viewport if pane is self._window.view else next(iter(stops(pane)), None)
            if target is not None:
                target.setFocus(Qt.FocusReason.TabFocusReason)
                if target is viewport:
                    self._ring.show_round(target)
                return

    def next_stop(self, forward: bool) -> bool:
        """Move the keyboard focus to the next field or button, through all panes; returns whether it did."""
        return next_stop(self._stops(), forward)

    def enter(self) -> None:
        """Set the keyboard focus in the inspector: Tab goes on to what its panel has.

        No button has the keyboard meanwhile, so the space bar still flips the body.
        """
        panel = self._window.inspector.panel()
        if panel is not None and panel.isVisible() and not self._over():
            panel.setFocus(Qt.FocusReason.OtherFocusReason)

    def go_on_in(self, step: str) -> None:
        """Select a step by key: the keyboard focus moves there, and a ring marks it."""
        self._window.navigation.show_step(step)
        self.enter()
        if self._window.inspector.isVisible():
            self._ring.show_round(self._window.inspector)
            announce(self._window.inspector, self._window.actions_.steps[step].text())

    def give_up(self) -> bool:
        """Let Esc take away what lies over the window or in the place of it; returns whether anything did."""
        over = self._over()
        if over:
            over[-1].given_up.emit()
            return True
        return any(close() for close in self.closers)

    def _over(self) -> list[OverlayCard]:
        """Return the cards that lie over the whole window."""
        cards = self._window.findChildren(OverlayCard, options=Qt.FindChildOption.FindDirectChildrenOnly)
        return [card for card in cards if card.isVisible()]

    def _stops(self) -> list[QWidget]:
        """Return what takes the keyboard, and before strip and inspector the line that gives them room."""
        order: list[QWidget] = []
        lines: dict[QWidget, QWidget] = {
            self._window.strip: self._down.handle(1),
            self._window.inspector: self._across.handle(1),
        }
        for pane in self._panes():
            line = lines.get(pane)
            fixed = pane is self._window.strip and self._window.strip.is_folded()
            if line is not None and line.isVisible() and not fixed:
                order.append(line)
            for part in self._parts(pane):
                order += stops(part)
        return order

    def _parts(self, pane: QWidget) -> list[QWidget]:
        """Return what is read one after the other in a pane: on the view one floating panel at a time."""
        if pane is not self._window.view:
            return [pane]
        apart = self._window.notices  # a pane of its own
        parts = [e for e in pane.children() if isinstance(e, QWidget) and e.isVisible() and e is not apart]
        return sorted(parts, key=lambda each: (each.y(), each.x()))

    def _panes(self) -> list[QWidget]:
        """Return the parts of the window in the order in which they are read."""
        window, page = self._window, self.pages.currentWidget()
        if page is None or page is self._across:
            pieces = [] if window.pieces.isHidden() else [window.pieces]
            strip = [] if window.strip.isHidden() else [window.strip]
            work = [window.notices, window.view, *pieces, *strip, window.inspector]
        else:
            work = [window.notices, page]
        return [*self._over(), window.top, window.rail, *work]

    # -- sizes

    def fit(self) -> None:
        """Give inspector and strip the sizes that the user chose, or those that suit the window's."""
        window = self._window
        width = self._width or (WIDE if window.width() >= 1400 else NARROW)
        self._across.setSizes([max(sum(self._across.sizes()) - width, 1), width])
        self._fit_strip(window.strip.is_folded())

    def _fit_strip(self, folded: bool) -> None:
        self._folded_as_low = self._folded_as_low and folded
        first = (HIGH if self._window.height() >= 850 else LOW) + TALLER.get(language(), 0)
        unfolded = self._height or first
        height = self._window.strip.maximumHeight() if folded else unfolded
        self._down.setSizes([max(sum(self._down.sizes()) - height, 1), height])

    def _note_width(self) -> None:
        self._width = self._window.inspector.width()

    def _note_height(self) -> None:
        if not self._window.strip.is_folded():
            self._height = self._window.strip.height()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Handle the size of the window; a low one opens with collapsed plots."""
        if watched is self._window and event.type() in (QEvent.Type.Resize, QEvent.Type.Move):
            # Not at the end alone: a window that does not close in order has a place too.
            self._keeps.start()
            if event.type() == QEvent.Type.Resize:
                self.fit()
        elif watched is self._window and event.type() == QEvent.Type.Show and not event.spontaneous():
            if self._window.height() < 740 and self._height is None:
                self._window.strip.set_folded(True)
                self._folded_as_low = True
            self.fit()
        return False

    # -- between sessions

    def restore(self) -> None:
        """Place the window where it stood last, or on a screen that is there; ``keep`` is then due."""
        settings, self._restored = QSettings(), True
        put_as_last(self._window)
        self._width = _number(settings.value("window/inspector"))
        self._height = _number(settings.value("window/strip"))
        if settings.value("window/folded") == "true":
            self._window.strip.set_folded(True)
        self.show_inspector(settings.value("window/inspector_shown") != "false")

    def keep(self) -> None:
        """Record where the window stands, if it was put there from memory: pictures leave no trace."""
        self._keeps.stop()
        if not self._restored:
            return
        settings, do = QSettings(), self._window.actions_
        settings.setValue("window/geometry", self._window.saveGeometry())
        folded = self._window.strip.is_folded() and not self._folded_as_low  # in a higher window it is not
        settings.setValue("window/folded", str(folded).lower())
        settings.setValue("window/inspector_shown", str(do.inspector.isChecked()).lower())
        for name, size in (("inspector", self._width), ("strip", self._height)):
            if size is None:
                settings.remove(f"window/{name}")
            else:
                settings.setValue(f"window/{name}", size)


def _number(value: object) -> int | None:
    text = str(value)
    return int(text) if text.isdecimal() and 0 < int(text) < 2000 else None
