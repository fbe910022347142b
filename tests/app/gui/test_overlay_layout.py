"""Panels float in the corners of a view, and none lies on another."""

from __future__ import annotations

from itertools import combinations

import pytest
from PySide6.QtCore import QPoint, QRect, QSize, Qt
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QApplication, QWidget
from pytestqt.qtbot import QtBot

from app.gui.features.lines.line_draw_card import LineDrawCard
from app.gui.theme.shadow import floating_ground
from app.gui.theme.stylesheet import Sentence, apply_theme
from app.gui.widgets.basic import FloatingPanel
from app.gui.widgets.overlay_layout import APART, GAP, OverlayLayout
from app.rendering.palette import DARK, LIGHT

pytestmark = pytest.mark.usefixtures("empty_house")


class Panel(FloatingPanel):
    def __init__(self, width: int, height: int) -> None:
        super().__init__()
        self.wanted = QSize(width, height)

    def sizeHint(self) -> QSize:  # noqa: N802
        left, top, right, bottom = self.MARGINS
        return self.wanted + QSize(left + right, top + bottom)

    def minimumSizeHint(self) -> QSize:  # noqa: N802
        return self.sizeHint()

    def seen(self) -> QRect:
        left, top, right, bottom = self.MARGINS
        return self.geometry().adjusted(left, top, -right, -bottom)


def test_panels_keep_their_corners_and_clear_each_other() -> None:
    view = QWidget()
    view.resize(1160, 760)
    floating = OverlayLayout(view)
    tools, card, legend, inset = Panel(520, 44), Panel(300, 60), Panel(104, 240), Panel(264, 302)
    for panel, corner in (
        (tools, "bottom"),
        (card, "bottom"),
        (legend, "top-right"),
        (inset, "bottom-left"),
    ):
        floating.place(panel, corner)
    view.show()

    assert tools.seen().center().x() == pytest.approx(580, abs=1)
    assert tools.seen().bottom() == inset.seen().bottom() == 759 - GAP
    assert card.seen().bottom() < tools.seen().top()
    assert (legend.seen().right(), legend.seen().top()) == (1159 - GAP, GAP)
    assert inset.seen().left() == GAP

    view.resize(763, 460)  # the smallest view: here the inset would reach under the tools
    QApplication.processEvents()
    assert inset.seen().bottom() < tools.seen().top()
    legend.wanted = QSize(140, 240)
    legend.updateGeometry()
    floating.settle()
    assert legend.seen().right() == 762 - GAP
    for one, other in combinations((tools, card, legend, inset), 2):
        assert not one.seen().intersects(other.seen())

    card.hide()
    floating.remove(inset)
    before = inset.geometry()
    view.resize(1000, 700)
    QApplication.processEvents()
    assert inset.geometry() == before
    view.close()
    view.deleteLater()


def test_headroom_leaves_room_for_what_is_piled_on_a_panel() -> None:
    view = QWidget()
    view.resize(760, 440)
    floating = OverlayLayout(view)
    bar, low, high = Panel(200, 40), Panel(220, 250), Panel(240, 120)
    for panel, corner in ((bar, "top-left"), (low, "bottom-left"), (high, "bottom-left")):
        floating.place(panel, corner)
    high.hide()
    view.show()
    floating.settle()
    alone = floating.headroom(low)
    assert alone == 439 - GAP - (GAP + 40 + APART - 1)
    high.show()
    floating.settle()
    assert floating.headroom(low) == alone - 120 - APART
    low.wanted = QSize(220, floating.headroom(low))
    low.updateGeometry()
    floating.settle()
    assert high.seen().top() >= bar.seen().bottom() + APART
    view.close()
    view.deleteLater()


def test_a_shadow_is_painted_once_and_follows_theme_and_size(qapp: QApplication) -> None:
    panel, inside, shadow = Panel(200, 40), QPoint(100, 20), QPoint(100, 3)
    panel.setAttribute(Qt.WidgetAttribute.WA_TranslucentBackground)
    for dark, tokens in ((False, LIGHT), (True, DARK)):
        apply_theme(qapp, dark)
        for size in (QSize(200, 60), QSize(260, 80)):
            panel.resize(size)
            image = panel.grab().toImage()
            fill = image.pixelColor(inside)
            assert fill.alpha() >= tokens.floating_alpha
            assert abs(fill.lightness() - QColor(tokens.floating).lightness()) < 6
            assert 0 < image.pixelColor(shadow).alpha() < 200
            assert image.pixelColor(QPoint(size.width() - 15, size.height() - 16)).alpha() > 200
            painted = floating_ground.cache_info().misses
            assert panel.grab().toImage() == image
            assert floating_ground.cache_info().misses == painted
    qapp.setStyleSheet("")


@pytest.mark.parametrize("word", ["curve ", "曲線を描きます。"])
def test_a_card_has_room_for_all_that_it_shows(qtbot: QtBot, word: str) -> None:
    card = LineDrawCard()
    qtbot.addWidget(card)
    card.show()
    for what, keys in ((20, 12), (3, 2), (30, 1)):
        card.say("Draw line", what * word, keys * word)
        card.adjustSize()
        QApplication.processEvents()
        for words in card.findChildren(Sentence):
            assert words.height() >= words.heightForWidth(words.width())
