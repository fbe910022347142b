"""Variants of the design through the real main(): looked at, flipped, their figures beside each other."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtTest import QTest
from window_tools import Script, run_bodiless, run_undrawn, settled

import app.gui.features.variants.controller
import app.gui.file_export
from app.gui.main_window import MainWindow
from app.gui.viewport import compare_key as flip_key
from core.document.design import Design
from core.errors import LineError
from core.garment.cut_list import cut_list
from core.garment.elastic_library import find_elastic
from core.messages import Message
from core.pipeline.live_solver import Frame

pytestmark = pytest.mark.usefixtures("empty_house")
SPACE = Qt.Key.Key_Space


def test_the_space_bar_goes_back_to_the_way_it_was_flipped_from(monkeypatch: pytest.MonkeyPatch) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        view = window.view
        window.activateWindow()
        yield window.isActiveWindow
        window.variants_controller.choose("B")
        yield settled(window)
        for way in ("variants", "side", "wipe"):
            show(window, way)
            yield lambda way=way: view.beside.way == way
            monkeypatch.setattr(flip_key, "HOLD", 60_000)
            QTest.keyClick(window, SPACE)
            assert view.beside.way == "before"
            QTest.keyClick(window, SPACE)
            assert view.beside.way == way
            monkeypatch.setattr(flip_key, "HOLD", 0)  # now every press is a long one
            QTest.keyPress(window, SPACE)
            assert view.beside.way == "before"
            QTest.keyRelease(window, SPACE)
            assert view.beside.way == way
        window.navigation.show_step("scan")
        assert view.beside.way == "before"
        QTest.keyPress(window, SPACE)
        assert view.beside.way == "after", "the wipe was left for good"
        QTest.keyRelease(window, SPACE)
        assert view.beside.way == "before"

    run_undrawn([], script)


def test_the_figures_of_all_variants_stand_beside_each_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "variants.csv"

    def script(window: MainWindow) -> Script:
        panel, desk = window.variants, window.variant_table_controller
        yield settled(window)
        window.navigation.show_panel("variants")
        assert panel.view is None, "one variant has nothing to be compared with"
        first = window.session.frame
        window.variants_controller.choose("B")
        window.lines_controller.commit_length("mid-bust", 0.92)
        yield settled(window)
        yield lambda: panel.view is not None and not {"", "pending"} & set(panel.view.levels)
        assert (panel.view.names, panel.view.shown) == (("A", "B"), 1)
        mid = next(row for row in panel.view.rows if row.label == "Mid-bust")
        percent, length = mid.figures
        assert percent.values == (95.0, 92.0)
        assert percent.apart(1) == -3.0
        rest = next(line.rest_length for line in first.stages.model.lines if line.name == "mid-bust")
        assert length.values == pytest.approx((0.95 * rest, 0.92 * rest))
        lift = next(row for row in panel.view.rows if row.label == "Bust point lift").figures[0]
        assert lift.values[1] == pytest.approx(lift_of(window.session.frame))
        assert lift.values[0] == pytest.approx(lift_of(first), abs=0.2), "solved anew, from rest"
        monkeypatch.setattr(app.gui.file_export, "ask_save", lambda *_: str(path))
        desk.export()
        table = list(csv.reader(path.read_text("utf-8-sig").splitlines()))
        assert table[0] == ["Quantity", "Unit", "A", "B", "B - A"]
        assert ["Mid-bust", "%", "95.0", "92.0", "-3.0"] in table
        desk.copy()
        assert "Mid-bust\t%\t95.0\t92.0\t-3.0\n" in QGuiApplication.clipboard().text()
        yield from what_cannot_be_solved_is_told_once(window, monkeypatch)
        window.session.remove_variant("B")
        yield lambda: panel.view is None

    run_bodiless([], script)


def test_variants_that_differ_in_elastics_alone_are_told_apart() -> None:
    def script(window: MainWindow) -> Script:
        panel = window.variants
        yield settled(window)
        window.navigation.show_panel("variants")
        window.variants_controller.choose("B")
        band = find_elastic("plush back 18")

        def made(design: Design) -> Design:
            design = design.with_line("mid-bust", 0.6).with_elastic("mid-bust", find_elastic("strap 15"))
            return design.with_line("under-bust", 1.0 / 1.2).with_elastic("under-bust", band)

        window.session.edit(made, "Elastics")
        yield settled(window)

        def known() -> bool:
            rows = {row.label: row for row in panel.view.rows} if panel.view is not None else {}
            piece = rows.get("Mid-bust: cut length, elastic, contact pressure")
            return piece is not None and piece.figures[2].values[1] is not None

        yield known
        rows = {row.label: row.figures for row in panel.view.rows}
        frame = window.session.frame
        cuts = {row.line: row for row in cut_list(frame.stages, frame.control_points).rows}
        assert "Mid-bust" not in rows, "the length of an elastic unstretched is compared with nothing"
        assert rows["Mid-bust, on body"][1].values[1] == pytest.approx(cuts["mid-bust"].reached_front_mm)
        cut, made_of, kpa = rows["Under-bust: cut length, elastic, contact pressure"]
        assert cut.values == (None, pytest.approx(cuts["under-bust"].cut_mm))
        assert made_of.values == ("", band.name)
        assert kpa.values[1] == pytest.approx(window.pressure_controller.of(frame).rows[0].max_kpa)
        window.variant_table_controller.copy()
        told = QGuiApplication.clipboard().text().splitlines()
        assert any(line.split("\t")[1:] == ["", "", band.name, ""] for line in told)

    run_bodiless([], script)


def what_cannot_be_solved_is_told_once(window: MainWindow, monkeypatch: pytest.MonkeyPatch) -> Script:
    asked: list[int] = []

    def refuse(*_: object) -> None:
        asked.append(1)
        raise LineError(Message("No balance holds this."), Message("Set it longer."))

    monkeypatch.setattr(app.gui.features.variants.controller, "converged_frame", refuse)
    window.variants_controller.choose("A")
    yield lambda: bool(asked)
    yield settled(window)
    window.lines_controller.commit_length("full-bust", 0.99)
    yield settled(window)
    assert window.variants.view.levels[1] == "", "it is said that this one is not solved"
    assert len(asked) == 1


def lift_of(frame: Frame) -> float:
    now, rest = frame.marks, frame.stages.rest_marks
    return (
        now.bust_point_left_z + now.bust_point_right_z - rest.bust_point_left_z - rest.bust_point_right_z
    ) / 2


def show(window: MainWindow, way: str) -> None:
    if way == "variants":
        window.variants_controller.show_side_by_side()
    else:
        window.view.compare_by(way)
