"""Pieces and the chart of darts as widgets: what is under the pointer, what is chosen by hand and key."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from app.gui.features.pattern.dart_view import DartChartView
from app.gui.features.pattern.pieces_view import PiecesView
from app.presenters.pattern_layout import PieceShape
from core.pattern.dart_chart import Dart, DartChart


def square(name: str, x: float, strain: float) -> PieceShape:
    points = np.array([[x, 0.0], [x + 60.0, 0.0], [x + 60.0, 60.0], [x, 60.0]])
    seams = ("hem", "side", "top", "front")
    sides = tuple((seam, np.array([k, (k + 1) % 4]), True) for k, seam in enumerate(seams))
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    return PieceShape(
        name,
        points,
        faces,
        np.array([strain, strain]),
        0.1,
        sides,
        abs(strain) < 0.1,
        (x, 0.0),
        np.array([[0.12, 0.03]] * 2),
    )


@pytest.fixture
def view(qtbot: QtBot) -> PiecesView:
    shown = PiecesView()
    qtbot.addWidget(shown)
    shown.resize(400, 240)
    shown.show()
    shown.show_pieces((square("back", 0.0, 0.05), square("front", 200.0, -0.2)), {}, {})
    return shown


def middle(view: PiecesView, number: int) -> QPointF:
    shape = view._shapes[number]
    return QPointF(*view._spots((shape.points.mean(axis=0) + view._moves[number])[None])[0])


def test_pieces_and_seams_are_found_under_the_pointer(view: PiecesView) -> None:
    assert view.piece_at(middle(view, 0)) == "back"
    assert view.piece_at(QPointF(1.0, 1.0)) == ""
    tip = view.tip_at(middle(view, 1).toPoint())
    assert all(part in tip for part in ("compressed by 20.0 %", "12.0 % across", "3.0 % down"))
    edge = view._shapes[0].points[[1, 2]].mean(axis=0) + view._moves[0]
    assert view.seam_at(QPointF(*view._spots(edge[None])[0])) == "side"
    assert view.seam_at(middle(view, 0)) == ""


def test_a_click_chooses_and_arrows_go_on(view: PiecesView, qtbot: QtBot) -> None:
    chosen: list[str] = []
    view.piece_chosen.connect(chosen.append)
    view.piece_chosen.connect(lambda name: view.select(name, ""))
    QTest.mouseClick(view, Qt.MouseButton.LeftButton, pos=middle(view, 1).toPoint())
    QTest.keyClick(view, Qt.Key.Key_Right)
    QTest.keyClick(view, Qt.Key.Key_Left)
    assert chosen == ["front", "back", "front"]
    QTest.mouseClick(view, Qt.MouseButton.LeftButton, pos=QPoint(2, 2))
    assert chosen[-1] == "", "beside the pieces nothing is chosen"


def test_a_drag_moves_the_pieces_and_a_double_click_shows_all(view: PiecesView) -> None:
    before = middle(view, 0)
    QTest.mousePress(view, Qt.MouseButton.LeftButton, pos=before.toPoint())
    QTest.mouseMove(view, before.toPoint() + QPoint(30, 0))
    QTest.mouseRelease(view, Qt.MouseButton.LeftButton, pos=before.toPoint() + QPoint(30, 0))
    assert middle(view, 0).x() == pytest.approx(before.x() + 30.0, abs=1.0)
    assert view.piece == "", "a drag is no click"
    QTest.mouseDClick(view, Qt.MouseButton.LeftButton, pos=QPoint(200, 120))
    assert middle(view, 0).x() == pytest.approx(before.x(), abs=1e-6)


def test_a_colour_tells_what_is_stretched(view: PiecesView) -> None:
    picture = view.grab().toImage()
    stretched, compressed = (
        picture.pixelColor((middle(view, k) + QPointF(-20, 20)).toPoint()) for k in (0, 1)
    )
    assert stretched.red() > stretched.blue() + 20
    assert compressed.blue() > compressed.red() + 20


def chart(side: str) -> DartChart:
    place = np.zeros(3)
    darts = tuple(
        Dart("wire", 0.0, clock, place, place, 0.1, within)
        for clock, within in ((0.0, 0.12), (90.0, 0.09), (180.0, 0.06), (270.0, 0.1))
    )
    return DartChart(f"cup {side}", 0.17, 88.0, darts)


@pytest.mark.parametrize(("side", "right_hand"), [("left", 90.0), ("right", 270.0)])
def test_the_chart_of_darts_runs_as_the_body_is_seen(qtbot: QtBot, side: str, right_hand: float) -> None:
    """Clock positions run outward: on the left breast that is to the right of who looks at her."""
    view = DartChartView()
    qtbot.addWidget(view)
    view.resize(280, 190)
    view.show()
    view.show_chart(chart(side), 0.08)
    assert view.dart.clock == 180.0, "the least strain"
    assert "strain 6.0 %" in view.words()
    chosen: list[Dart] = []
    view.chosen.connect(chosen.append)
    QTest.mouseClick(view, Qt.MouseButton.LeftButton, pos=QPoint(250, 95))
    assert chosen[0].clock == right_hand
    QTest.keyClick(view, Qt.Key.Key_Right)
    assert len(chosen) == 2
