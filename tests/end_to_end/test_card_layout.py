"""Cards are laid out before they are painted: the next picture of the body may be a second away."""

from collections.abc import Callable

import pytest
from PySide6.QtCore import QCoreApplication, QEvent, QRect
from PySide6.QtWidgets import QWidget
from window_tools import Script, run_undrawn, settled

from app.gui.main_window import MainWindow

pytestmark = pytest.mark.usefixtures("empty_house")


def places(card: QWidget) -> list[QRect]:
    """Where a card and all that is seen in it are."""
    return [each.geometry() for each in (card, *card.findChildren(QWidget)) if each.isVisible()]


def test_a_card_is_whole_when_it_is_first_painted() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        cards: tuple[tuple[Callable[[], object], QWidget], ...] = (
            (window.ask_door.click, window.target_shape_controller.card),
            (window.draw_tool.begin, window.draw_tool._sketching.card),
        )
        for show, card in cards:
            show()
            QCoreApplication.sendEvent(window, QEvent(QEvent.Type.UpdateRequest))  # Qt paints first
            painted = places(card)
            assert len(painted) > 5
            for _ in range(9):
                QCoreApplication.sendPostedEvents(None, QEvent.Type.LayoutRequest.value)
            assert places(card) == painted
            window.layout_.give_up()

    run_undrawn([], script)
