"""The legend of a map: it goes where it covers no band, label or flag."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QRect, QRectF
from window_tools import Script, run_main, settled, undrawn

from app.main_window import MainWindow

pytestmark = pytest.mark.usefixtures("empty_house")


def covers(window: MainWindow, room: QRect) -> int:
    """Return over how many labels and places of bands the legend would lie."""
    place, field = window.map_desk._place, QRectF(room)
    words = sum(field.intersects(each) for each in place._words())
    return words + sum(field.contains(x, y) for x, y in place._places().tolist())


def test_the_legend_goes_from_where_it_covers_what_it_explains() -> None:
    def script(window: MainWindow) -> Script:
        undrawn(window)
        yield settled(window)
        maps, floating, legend = window.map_desk, window.view.floating, window.map_desk.legend
        maps.choose("pull")
        maps._place.choose()
        assert not covers(window, floating.seen(legend))
        window.variant_desk.choose("B")
        yield settled(window)
        window.variant_desk.show_side_by_side()
        yield lambda: len(window.view.beside.bodies) == 2
        window.desk.select_line("full-bust")
        legend.set_small(False)
        floating.move(legend, "top-right")
        assert covers(window, floating.seen(legend)), "where it always was"
        before = covers(window, floating.seen(legend))
        window.view.viewport.set_view("front")
        yield lambda: floating.corner_of(legend) != "top-right"
        assert covers(window, floating.seen(legend)) < before

    run_main([], script)
