"""The legend of a map: it goes where it covers no band, label or flag."""

from __future__ import annotations

from itertools import combinations, product

import pytest
from PySide6.QtCore import QRect, QRectF, Qt
from PySide6.QtWidgets import QApplication, QWidget
from window_tools import Script, run_main, settled, undrawn

from app.gui.main_window import MainWindow

pytestmark = pytest.mark.usefixtures("empty_house")


@pytest.fixture(autouse=True)
def no_button_is_down(monkeypatch: pytest.MonkeyPatch) -> None:
    """A double click that a test before this one made leaves Qt with a button that never comes up."""
    monkeypatch.setattr(QApplication, "mouseButtons", lambda: Qt.MouseButton.NoButton)


class Wall(QWidget):
    """A panel of a size."""

    def __init__(self, width: int, height: int) -> None:
        super().__init__()
        self.setFixedSize(width, height)


def covers(window: MainWindow, room: QRect) -> int:
    """Return over how many labels and places of bands the legend would lie."""
    place, field = window.maps_controller._place, QRectF(room)
    words = sum(field.intersects(each) for each in place._words())
    return words + sum(field.contains(x, y) for x, y in place._places().tolist())


def test_the_legend_goes_from_where_it_covers_what_it_explains() -> None:
    def script(window: MainWindow) -> Script:
        undrawn(window)
        yield settled(window)
        maps, floating, legend = window.maps_controller, window.view.floating, window.maps_controller.legend
        maps.choose("pull")
        maps._place.choose()
        assert not covers(window, floating.seen(legend))
        window.variants_controller.choose("B")
        yield settled(window)
        window.variants_controller.show_side_by_side()
        yield lambda: len(window.view.beside.bodies) == 2
        window.selection.select_line("full-bust")
        legend.set_size("full")
        floating.move(legend, "top-right")
        assert covers(window, floating.seen(legend)), "where it always was"
        before = covers(window, floating.seen(legend))
        window.view.viewport.set_view("front")
        yield lambda: covers(window, floating.seen(legend)) < before

    run_main([], script)


def test_the_legend_lies_on_no_other_panel_and_in_the_view() -> None:
    def script(window: MainWindow) -> Script:
        undrawn(window)
        yield settled(window)
        for size in ((1280, 800), (1180, 700)):
            window.resize(*size)
            yield from in_view(window)

    def in_view(window: MainWindow) -> Script:
        maps, section, view = window.maps_controller, window.sections_controller, window.view
        others = [section.panel, view.compare, view.tools]

        def clear() -> None:
            shown = [panel for panel in (maps.legend, *others) if not panel.isHidden()]
            for panel in shown:
                assert view.rect().contains(view.floating.seen(panel)), type(panel).__name__
            for one, other in combinations(shown, 2):
                room = view.floating.seen(one)
                assert not room.intersects(view.floating.seen(other)), (type(one), type(other))

        def asked(on: bool) -> None:
            window.target_shape_controller.begin() if on else window.target_shape_controller.leave()

        opened = (lambda on: maps.choose("sides" if on else "")), section.set_on, asked
        for one, other, third in ((0, 1, 2), (1, 0, 2), (2, 0, 1), (2, 1, 0)):
            for each in (one, other, third):
                opened[each](True)
                yield lambda: not maps._place._clock.isActive()
                clear()
            for turned in ("left", "front", "three-quarter"):
                view.viewport.set_view(turned)
                maps._place.choose()
                clear()
            for each in opened:
                each(False)
        assert maps.legend.isHidden()

    run_main([], script)


def test_a_legend_that_finds_no_room_folds_and_comes_back() -> None:
    def script(window: MainWindow) -> Script:
        undrawn(window)
        yield settled(window)
        maps, view = window.maps_controller, window.view
        maps.choose("displacement")
        walls = [Wall(view.width() // 2 - 40, view.height() // 2 - 90) for _ in range(4)]
        for wall, (edge, side) in zip(walls, product(("top", "bottom"), ("left", "right")), strict=True):
            view.place(wall, f"{edge}-{side}")
            wall.show()
        yield maps.legend.bar.isHidden
        assert "outward (+)" in maps.legend.title.toolTip()
        assert view.floating.clashes(maps.legend) == 0
        for wall in walls:
            wall.hide()
        yield lambda: not maps.legend.bar.isHidden()

    run_main([], script)


def test_a_legend_that_covers_nothing_stays_where_it_is() -> None:
    def script(window: MainWindow) -> Script:
        undrawn(window)
        yield settled(window)
        maps, view = window.maps_controller, window.view
        legend, floating = maps.legend, view.floating

        def at() -> tuple[str, str]:
            return legend.size_taken(), floating.corner_of(legend)

        assert window.session.frame is not None
        for line in window.session.frame.stages.model.lines:
            view.set_line_visible(line.name, False)
        maps.choose("displacement")
        legend.set_size("full")
        floating.move(legend, "bottom-right")
        full = floating.seen(legend)
        legend.set_size("small")
        wall = Wall(150, full.top() + (floating.seen(legend).top() - full.top()) // 2)
        view.place(wall, "top-right")
        wall.show()
        maps._place.choose()
        assert at() == ("small", "bottom-right"), "a larger one elsewhere is no reason to go"
        told: list[bool] = []
        floating.rearranged.connect(lambda: told.append(True))
        maps._place.choose()
        assert not told, "its own moves are no reason to look again"
        wall.hide()
        yield lambda: at() == ("full", "bottom-right")

    run_main([], script)
