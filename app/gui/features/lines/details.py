"""Details of an opened line row: set, reached, gap, limits, stiffness and actions."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QCheckBox, QGridLayout, QHBoxLayout, QLabel, QVBoxLayout, QWidget

from app.gui.features.lines.limits_legend import LimitsLegend
from app.gui.theme.stylesheet import font, label, set_tag
from app.gui.widgets.basic import ToolButton, hairline, sentence
from app.gui.widgets.line_widgets import ElasticButton, PaletteMenu, StiffnessField
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import number, tr
from app.i18n.lengths import length, length_number, length_unit
from app.presenters.length_limits import tone_at
from app.presenters.lines import LineView, SideView

_OFF = 5e-6  # a set length nearer to the rest length than this means that the line is not worn


class LineDetails(QWidget):
    """The lower part of an opened row; a linked pair has one line of figures for each side.

    ``decided`` carries what was decided and its value: colour, linked, stiffness, over_shoulder;
    ``requested`` one of: reset, rename, path, remove. ``elastic_requested``: an elastic is to be chosen.
    """

    decided = Signal(str, object)
    requested = Signal(str)
    elastic_requested = Signal()

    def __init__(self) -> None:
        super().__init__()
        outside = QVBoxLayout(self)
        outside.setContentsMargins(0, 0, 4, 4)
        outside.setSpacing(0)
        self._set = QWidget()
        column = QVBoxLayout(self._set)
        column.setContentsMargins(0, 6, 0, 0)
        column.setSpacing(3)
        column.addLayout(self._make_figures())
        column.addSpacing(5)
        column.addWidget(hairline())
        column.addSpacing(4)
        self._key = LimitsLegend()
        column.addWidget(self._key)
        self._part, self._whole = sentence("", "caption"), sentence("", "caption")
        column.addWidget(self._part)
        column.addWidget(self._whole)
        self.over = QCheckBox(tr("Extend over shoulder"))
        self.over.setFont(font("body"))
        set_tip(self.over, tr("Extend the line over the shoulder and down the back to the under-bust band"))
        self.over.clicked.connect(lambda over: self.decided.emit("over_shoulder", over))
        column.addWidget(self.over)
        outside.addWidget(self._set)
        self._elastic = ElasticButton()
        self._elastic.clicked.connect(self.elastic_requested)
        made = QHBoxLayout()
        made.setContentsMargins(0, 3, 0, 0)
        made.addWidget(label(tr("Elastic"), "caption"))
        made.addWidget(self._elastic, 1)
        outside.addLayout(made)
        outside.addWidget(self._make_pressed())
        outside.addLayout(self._foot())

    def _make_figures(self) -> QGridLayout:
        self._grid = QGridLayout()
        self._grid.setHorizontalSpacing(8)
        self._grid.setVerticalSpacing(1)
        self._heads = [label("", "caption") for _ in range(3)]
        for place, head in enumerate(self._heads, start=1):
            self._grid.addWidget(head, 0, place)
            self._grid.setColumnStretch(place, 1)
        self._figures = [self._row(1), self._row(2)]
        return self._grid

    def show_lengths(self, view: LineView, ratio: float) -> None:
        """Show a set length, as a share of the rest length, and what ``view`` reached."""
        worn = abs(ratio - 1.0) > _OFF
        sides = view.sides or (SideView("", view.rest_mm, view.reached_mm),)
        for row, figures in enumerate(self._figures):
            for each in figures:
                each.setVisible(row < len(sides) and (each is not figures[0] or len(sides) > 1))
        unit = length_unit() if len(sides) == 1 else ""  # two sides leave no room for it in each figure
        tone = tone_at(view.leeway, ratio) if worn and not view.stale else ""
        for side, figures in zip(sides, self._figures, strict=False):
            _show_side(side, ratio, "" if view.elastic else tone, unit, figures, bool(view.elastic))
        if view.parted and not worn:
            self._figures[0][3].setText("–")  # what pulls there is told by the rows of its halves
        made = tr("Unstretched"), tr("Reached"), tr("Elongation")
        for head, title in zip(self._heads, made if view.elastic else _titles(), strict=True):
            head.setText(title)
        part = _part_words(view).format(percent=number(ratio * 100))
        off = tr("At 100 % the line is inactive: measured only, no tension.")
        if view.parted:
            off = tr("Inactive: replaced by its left and right halves.")
        self._part.setText(part if worn else off)
        self._show_whole(view, ratio)

    def show_view(self, view: LineView) -> None:
        """Show limits and stiffness, and what can be done; a line that is only measured has none."""
        for each in (self._set, self._tools["reset"]):
            each.setVisible(view.constrained)
        self._key.setVisible(view.leeway is not None)
        if view.leeway is not None:
            pressed = "" if view.elastic else view.pressed  # that has a place of its own
            self._key.show_leeway(view.leeway, view.ratio, view.stale, pressed, view.tone)
        self._pull.setVisible(view.constrained and not view.elastic)  # an elastic has its own
        self._presses.setVisible(bool(view.elastic))
        self._pressed.setText(view.pressed or "\N{EN DASH}")
        set_tag(self._pressed, "tone", view.tone)
        self.over.setVisible(view.over_shoulder is not None)
        self.over.setChecked(bool(view.over_shoulder))
        self.over.setEnabled(not view.locked)
        self._elastic.show_elastic(view.title, view.elastic)
        self._stiffness.show_stiffness(view.stiffness, view.usual_stiffness)
        self._show_link(view)
        self._stiffness.name_line(view.title)
        for tool in self._tools.values():
            tool.setAccessibleName(f"{view.title}: {tool.toolTip()}")
        for name in ("path", "remove"):
            self._tools[name].setVisible(view.own)
        for name in ("path", "remove", "reset"):
            self._tools[name].setEnabled(not view.locked)
        self._tools["reset"].setEnabled(view.settable and abs(view.ratio - 1.0) > _OFF)

    def _show_link(self, view: LineView) -> None:
        """Show what left and right can become of it: linked, set apart, or split off each other."""
        link, self._linked = self._tools["link"], bool(view.sides) or view.splits
        link.setVisible(bool(view.partner) or view.splits)
        link.show_icon("columns" if view.splits else "unlink" if view.sides else "link")
        if view.splits:
            set_tip(link, tr("Split at the front centre into a left and a right line (L)"))
        else:
            apart, linked = tr("Unlink left and right (L)"), tr("Link with the other side (L)")
            set_tip(link, apart if view.sides else linked)

    def _row(self, row: int) -> list[QLabel]:
        figures = [label("", "caption"), *(label("", "heading", tabular=True) for _ in range(3))]
        for column, each in enumerate(figures):
            each.setTextFormat(Qt.TextFormat.RichText)
            self._grid.addWidget(each, row, column)
        return figures

    def _foot(self) -> QHBoxLayout:
        foot = QHBoxLayout()
        foot.setContentsMargins(0, 5, 0, 2)
        foot.setSpacing(0)
        self._stiffness = StiffnessField()
        self._stiffness.entered.connect(lambda value: self.decided.emit("stiffness", value))
        self._pull = QWidget()
        left = QVBoxLayout(self._pull)
        left.setContentsMargins(0, 0, 0, 0)
        left.setSpacing(1)
        left.addWidget(label(tr("Stiffness"), "caption"))
        left.addWidget(self._stiffness)
        foot.addWidget(self._pull)
        foot.addStretch(1)
        self._palette = PaletteMenu(self)
        self._palette.chosen.connect(lambda colour: self.decided.emit("colour", colour))
        self._linked = False
        self._tools: dict[str, ToolButton] = {}
        for name, drawing, tip in _tools():
            tool = self._tools[name] = ToolButton(drawing, tip, size=16, room=26)
            foot.addWidget(tool, alignment=Qt.AlignmentFlag.AlignBottom)
            tool.clicked.connect(lambda _=False, name=name: self._press(name))
        return foot

    def _make_pressed(self) -> QWidget:
        self._presses = QWidget()
        row = QHBoxLayout(self._presses)
        row.setContentsMargins(0, 3, 0, 0)
        self._pressed = label("", "body", tabular=True)
        row.addWidget(label(tr("Maximum contact pressure, estimated"), "caption"))
        row.addWidget(self._pressed, 1)
        return self._presses

    def _press(self, name: str) -> None:
        if name == "colour":
            tool = self._tools[name]
            self._palette.popup(tool.mapToGlobal(tool.rect().bottomLeft()))
        elif name == "link":
            self.decided.emit("linked", not self._linked)
        else:
            self.requested.emit(name)

    def _show_whole(self, view: LineView, ratio: float) -> None:
        whole_mm = view.whole_mm - view.rest_mm + ratio * view.rest_mm
        # Of an elastic the back is stretched as the front: what is cut stands in the cut list.
        self._whole.setVisible(bool(view.strap) or (view.whole_mm > view.rest_mm and not view.elastic))
        if view.strap:
            self._whole.setText(view.strap)
            return
        whole = tr("Full length: {set} of {rest} ({percent} %)")
        percent = number(whole_mm / view.whole_mm * 100)
        self._whole.setText(
            whole.format(set=length_number(whole_mm), rest=length(view.whole_mm), percent=percent)
        )


def _tools() -> Sequence[tuple[str, str, str]]:
    return (
        ("rename", "rename", tr("Rename the line (F2)")),
        ("colour", "palette", tr("Choose the colour of this line")),
        ("link", "link", tr("Link with the other side (L)")),
        ("path", "edit-path", tr("Edit the line path")),
        ("reset", "arrow-counter-clockwise", tr("Reset this line to its original length (Backspace)")),
        ("remove", "trash", tr("Remove this line (Del)")),
    )


def _titles() -> tuple[str, str, str]:
    return tr("Set"), tr("Reached"), tr("Gap")


def _part_words(view: LineView) -> str:
    """Return what the set length is a share of."""
    if view.elastic:
        return tr("Unstretched: {percent} % of the original length")
    if view.group != "bust" and view.whole_band:
        return tr("{percent} % of the whole band")
    if view.own or view.group != "bust":
        return tr("{percent} % of its original length")
    return tr("{percent} % of the front length, side to side")


def _show_side(
    side: SideView, ratio: float, tone: str, unit: str, figures: list[QLabel], stretch: bool
) -> None:
    """Write what is set and reached of a line, and the gap between them in the tone of the groove there.

    The gap of an elastic is how far it is stretched.
    """
    set_mm = ratio * side.rest_mm
    reached, gap = "–", "–"
    if side.reached_mm is not None:
        off = side.reached_mm - set_mm
        share = abs(off) / set_mm
        reached = _figure(length_number(side.reached_mm), unit)
        gap = _figure(length_number(off, signed=True), f"{length_unit()}&nbsp; {number(share * 100)} %")
        if stretch:
            gap = _figure(number(100.0 * off / set_mm, signed=True), "%")
    texts = (side.title, _figure(length_number(set_mm), unit), reached, gap)
    for each, text in zip(figures, texts, strict=True):
        each.setText(text)
    set_tag(figures[3], "tone", tone)


def _figure(value: str, unit: str) -> str:
    """Return a number with its unit behind it in small type, as rich text."""
    return f'{value} <span style="font-size:11px; font-weight:400">{unit}</span>'
