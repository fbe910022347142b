"""Pattern pieces in the window: a block is chosen, seams and cloths are edited, and pieces are exported."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pdf_tools import Pdf
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtTest import QTest
from window_tools import Script, drag, run_main, run_undrawn, settled

from app.gui.features.pattern import exporting
from app.gui.main_window import MainWindow
from core.document.storage.project_file import open_project
from core.pattern.block_library import find_block, read_block

pytestmark = pytest.mark.usefixtures("empty_house")


def current(window: MainWindow) -> Callable[[], bool]:
    """The pieces are those of the present design."""
    return window.pattern_controller.is_current


def chosen(window: MainWindow, block: str) -> Script:
    yield settled(window)
    window.navigation.show_step("pattern")
    window.pattern.block_doors[block].click()
    yield current(window)


def lengths(window: MainWindow, seam: str) -> list[float]:
    """The lengths of the pieces along a seam [mm]."""
    result = window.pattern_controller.result
    assert result is not None
    return [fit.together[0] for fit in result.pattern.matched.fits if fit.seam.name == seam]


def test_a_block_is_chosen_edited_and_every_edit_is_undone_by_name(mannequin: Path) -> None:
    def script(window: MainWindow) -> Script:
        panel, view, steps = window.pattern, window.pieces, window.session.undo_stack
        yield settled(window)
        window.navigation.show_step("pattern")
        assert view.isVisible()
        assert not window.strip.isVisible(), "the pieces have its room"
        assert panel.currentIndex() == 0, "there is no block yet"
        yield from chosen(window, "one-part-cup")
        controller = window.pattern_controller
        assert [row.row.name for row in panel.list.buttons] == ["cup left", "cup right"]
        assert controller.layer.seams is not None, "the seams are drawn on the body"
        assert panel.export.isEnabled()
        panel.list.buttons[0].click()
        assert view.piece == "cup left"
        assert panel.piece_card.isVisible()
        controller.editing.choose_cloth("power net")
        yield current(window)
        cloths = {flat.panel.name: flat.panel.cloth for flat in controller.result.pattern.flats}
        assert cloths == {"cup left": "power net", "cup right": "power net"}
        assert steps.undoText() == "Cloth of Cup: Power net"
        panel.allowance.entered.emit(10.0)
        assert steps.undoText() == "Seam allowance 10.0 mm"
        controller.select_seam("neckline left")
        assert not panel.piece_card.isVisible()
        panel.seam_card.allowance_changed.emit(4.0)
        assert window.session.design.pattern.block.seam("neckline").allowance == 4.0
        steps.undo()
        steps.undo()
        steps.undo()
        assert window.session.design.pattern.allowance == 7.0
        yield current(window)
        assert {flat.panel.cloth for flat in controller.result.pattern.flats} == {"cup tricot"}
        steps.undo()
        assert panel.currentIndex() == 0, "without a block there is the choice again"
        assert controller.result is None

    run_undrawn([str(mannequin)], script)


def test_a_piece_that_does_not_fit_gets_fixes_suggested(mannequin: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield from chosen(window, "one-part-cup")
        controller, card = window.pattern_controller, window.pattern.piece_card
        assert not controller.result.pattern.fits_cloths
        controller.select_piece("cup left")
        assert card.suggest.isVisible()
        card.chart.click()
        yield lambda: card.darts.isVisible() and not window.jobs.at_work()
        assert card.darts.chart.best.within < controller.result.pattern.strains["cup left"].within
        card.suggest.click()
        yield lambda: bool(controller.fixes._found)
        controller.set_allowance(9.0)
        assert not controller.fixes._found, "they are of the former plan"
        yield current(window)
        card.suggest.click()
        yield lambda: bool(controller.fixes._found)
        best = controller.fixes._found[0]
        assert best.fits
        card.fix_chosen.emit(0)
        assert window.session.design.pattern.block == best.block
        yield current(window)
        window.session.undo_stack.undo()
        assert window.session.design.pattern.block == find_block("one-part-cup")
        assert window.session.design.pattern.allowance == 9.0

    run_undrawn([str(mannequin)], script)


def test_a_seam_is_dragged_by_its_point_on_the_body(mannequin: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield from chosen(window, "two-part-cup")
        controller, layer, steps = (
            window.pattern_controller,
            window.pattern_controller.layer,
            window.session.undo_stack,
        )
        controller.select_seam("cup seam left")
        before = lengths(window, "cup seam left")
        handles = controller.editing.handles()
        assert len(handles) == 3, "two ends and the bust point"
        spot = layer._spots(window.view.viewport.scene.carried_points(handles))[1]
        start, end = QPointF(*spot), QPointF(spot[0], spot[1] + 9.0)
        assert layer.seam_at(start) == "cup seam left"
        canvas = layer._canvas
        QTest.mousePress(canvas, Qt.MouseButton.LeftButton, pos=start.toPoint())
        QTest.mouseMove(canvas, end.toPoint())
        assert controller.editing.trial is not None, "it is tried while it is held"
        assert steps.undoText() == "Pattern: Two-part cup, bridge, cradle and wings"
        QTest.mouseRelease(canvas, Qt.MouseButton.LeftButton, pos=end.toPoint())
        yield current(window)
        assert steps.undoText() == "Cup seam moved"
        words = window.session.design.pattern.block.seam("cup seam").places
        assert words[0] == "root 285"
        assert words[1].startswith("root 1"), "below the bust point, told by the clock"
        after = lengths(window, "cup seam left")
        assert abs(after[0] - before[0]) > 0.2
        layer.moved.emit(1, handles[1])
        layer.cancelled.emit()
        assert controller.editing.trial is None
        assert window.session.design.pattern.block.seam("cup seam").places == words
        yield current(window)
        assert lengths(window, "cup seam left") == pytest.approx(after, abs=1e-6)
        window.pattern.seam_card.reset.trigger()
        assert window.session.design.pattern.block == find_block("two-part-cup")
        window.pattern.seam_card.knob.setValue(100)
        assert " | " in window.pattern.seam_card.so_far.text(), "both lengths so far"

    run_main([str(mannequin)], script)


def spot_of(window: MainWindow, place: np.ndarray) -> QPoint:
    """Where a place of the original body is seen, (3,) [mm]."""
    layer = window.pattern_controller.layer
    x, y = layer._spots(window.view.viewport.scene.carried_points(place[None]))[0]
    return QPoint(round(x), round(y))


def test_points_and_notches_are_added_to_a_seam_and_removed(mannequin: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield from chosen(window, "two-part-cup")
        controller, card, steps = (
            window.pattern_controller,
            window.pattern.seam_card,
            window.session.undo_stack,
        )
        layer, canvas = controller.layer, controller.layer._canvas
        controller.select_seam("cup seam left")
        garment = controller.result.pattern.garment
        curve = next(each.points for each in garment.curves if each.name == "cup seam left")
        QTest.mouseDClick(canvas, Qt.MouseButton.LeftButton, pos=spot_of(window, curve[len(curve) // 4]))
        yield current(window)
        assert steps.undoText() == "Point added: Cup seam"
        assert len(controller.editing.handles()) == 4
        QTest.mouseClick(
            canvas, Qt.MouseButton.LeftButton, pos=spot_of(window, controller.editing.handles()[1])
        )
        assert layer.handle == 1
        assert card.remove_point.isEnabled()
        QTest.keyClick(canvas, Qt.Key.Key_Delete)
        yield current(window)
        assert window.session.design.pattern.block == find_block("two-part-cup")
        assert steps.undoText() == "Point removed: Cup seam"
        card.knob.setValue(150)
        card.add_notch.trigger()
        yield current(window)
        assert steps.undoText() == "Notch added: Cup seam"
        pattern = controller.result.pattern
        seam = next(each for each in pattern.matched.seams if each.name == "cup seam left")
        shares = [
            pattern.notches[pattern.flats[panel].panel.name, side]
            for panel, side in zip(seam.panels, seam.sides, strict=True)
        ]
        assert shares[0] == pytest.approx((0.3, 0.62, 0.75)), "beside those that it had"
        assert shares[1] == pytest.approx((0.25, 0.38, 0.7))
        assert card.notches.text() == "Notches: 3"
        controller.editing.set_notches(None)
        assert window.session.design.pattern.block == find_block("two-part-cup")

    run_main([str(mannequin)], script)


def test_a_seam_is_drawn_on_the_body_and_removed(mannequin: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield from chosen(window, "one-part-cup")
        controller, tool, steps = (
            window.pattern_controller,
            window.pattern_controller.drawing,
            window.session.undo_stack,
        )
        breast = controller.result.drawing.places.breasts["left"]
        stops = breast.places(np.array([200.0, 200.0]), np.array([1.0, 0.5]) * breast.root_distance(200.0))
        window.pattern.draw.click()
        canvas = controller.layer._canvas
        for place in (stops[1], stops[0]):
            QTest.mouseClick(canvas, Qt.MouseButton.LeftButton, pos=spot_of(window, place))
        assert tool._sketching.card.keep.isEnabled()
        QTest.keyClick(canvas, Qt.Key.Key_Return)
        yield lambda: not tool.at_work
        yield current(window)
        assert steps.undoText() == "Cup dart drawn"
        dart = window.session.design.pattern.block.seams[-1]
        assert dart.slit
        assert dart.places[0].endswith("> wire"), "its end near the wire is on the wire"
        assert controller.layer.hand.at_work, "seams are selected again"
        controller.select_seam("cup dart left")
        window.pattern.seam_card.remove.trigger()
        assert window.session.design.pattern.block == find_block("one-part-cup")
        assert steps.undoText() == "Cup dart removed"
        yield current(window)
        tool.begin()
        QTest.mouseClick(canvas, Qt.MouseButton.LeftButton, pos=spot_of(window, stops[1]))
        QTest.keyClick(canvas, Qt.Key.Key_Escape)
        assert not tool.at_work
        assert window.session.design.pattern.block == find_block("one-part-cup")

    run_main([str(mannequin)], script)


def test_a_drag_ends_with_the_step_an_undo_and_the_scan(mannequin: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield from chosen(window, "one-part-cup")
        controller, editing = window.pattern_controller, window.pattern_controller.editing
        controller.select_seam("neckline left")
        for end in (
            lambda: window.navigation.show_step("lines"),
            lambda: controller.set_allowance(5.0),
            window.session.undo_stack.undo,
            window.progress_controller.cancel,
        ):
            controller.layer._held = 0
            controller.layer.moved.emit(0, controller.editing.handles()[0] + [0.0, 0.0, 12.0])
            assert editing.trial is not None
            assert editing.carries
            end()
            assert editing.trial is None
            assert not editing.carries
            window.navigation.show_step("pattern")
            yield current(window)
        assert window.session.design.pattern.block == find_block("one-part-cup")
        assert window.pattern.export.isEnabled()

    run_undrawn([str(mannequin)], script)


def test_pieces_of_a_shape_that_is_no_result_are_not_called_fit(mannequin: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield from chosen(window, "one-part-cup")
        controller = window.pattern_controller
        window.session.edit(
            lambda design: replace(design.with_line("mid-bust", 0.6), volume="conventional", gain=1.9), "far"
        )
        yield settled(window)
        yield current(window)
        assert "do not use this shape for production" in window.pattern.verdict.text()
        controller.files.show()
        yield lambda: controller.files.dialog.preview.count > 1
        assert "do not use this shape for production" in controller.files.dialog.doubt.text()

    run_undrawn([str(mannequin)], script)


def test_escape_is_taken_where_a_seam_is_selected_alone(mannequin: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield from chosen(window, "one-part-cup")
        controller, canvas = window.pattern_controller, window.pattern_controller.layer._canvas
        escape = QKeyEvent(QEvent.Type.KeyPress, Qt.Key.Key_Escape, Qt.KeyboardModifier.NoModifier)
        enter = QKeyEvent(QEvent.Type.KeyPress, Qt.Key.Key_Return, Qt.KeyboardModifier.NoModifier)
        hand = controller.layer.hand
        assert not hand.eventFilter(canvas, escape), "Esc means what it means elsewhere"
        controller.select_seam("neckline left")
        assert not hand.eventFilter(canvas, enter)
        assert hand.eventFilter(canvas, escape)
        assert controller.seam == ""

    run_undrawn([str(mannequin)], script)


def test_a_cancelled_computation_does_not_keep_back_the_next(mannequin: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.navigation.show_step("pattern")
        window.pattern.block_doors["two-part-cup"].click()
        controller, jobs = window.pattern_controller, window.jobs
        assert controller.worker.at_work
        jobs.leave(controller.worker._job)
        assert not controller.worker.at_work
        assert controller.result is None
        assert window.pattern.verdict.text() == "The computation of the pieces was cancelled."
        window.pattern.compute.click()
        yield current(window)
        controller.choose_block(find_block("one-part-cup"))
        yield current(window)
        assert controller.result.pattern.garment.block.name == "one-part-cup"

    run_undrawn([str(mannequin)], script)


def test_the_pieces_follow_a_line_and_are_not_exported_meanwhile(mannequin: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield from chosen(window, "one-part-cup")
        controller, panel = window.pattern_controller, window.pattern
        former = controller.result
        panel.lines_door.click()
        assert window.inspector.panel() is window.lines_page
        assert window.pieces.isVisible(), "the pieces stay beside the body"
        drag(window, "mid-bust", -12)
        assert not controller.is_current()
        assert not panel.export.isEnabled()
        yield settled(window)
        yield current(window)
        assert controller.result is not former
        moved = np.abs(controller.result.pattern.places[0] - former.pattern.places[0]).max()
        assert moved > 0.5, "the panel rides on the skin"
        assert panel.export.isEnabled()

    run_undrawn([str(mannequin)], script)


def test_pieces_are_exported_with_a_preview_and_kept_in_the_project(
    mannequin: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    target: list[Path] = []
    monkeypatch.setattr(exporting, "ask_save", lambda *_: str(target[-1]))
    monkeypatch.setattr(exporting, "ask_file", lambda *_: str(target[-1]))

    def script(window: MainWindow) -> Script:
        yield from chosen(window, "one-part-cup")
        controller = window.pattern_controller
        for kind, name in (("pdf", "a.pdf"), ("dxf-aama", "a.dxf"), ("json", "a.json"), ("obj", "a.obj")):
            window.pattern.export.click()
            dialog = controller.files.dialog
            assert dialog is not None
            assert not dialog.save.isEnabled(), "the pages are laid out in the background"
            yield lambda dialog=dialog: dialog.preview.count > 1  # an overview, and tiles
            dialog.kinds[kind].click()
            target.append(tmp_path / name)
            dialog.save.click()
            assert target[-1].stat().st_size > 500
        assert len(Pdf(tmp_path / "a.pdf").sizes) > 1
        told = json.loads((tmp_path / "a.json").read_text())
        assert [piece["name"] for piece in told["pieces"]] == ["cup", "cup"]
        target.append(tmp_path / "mine.json")
        controller.files.save_block()
        assert read_block(target[-1]).seams == find_block("one-part-cup").seams
        controller.files.open_block()
        assert window.session.design.pattern.block.name == "mine"
        target.append(tmp_path / "broken.json")
        target[-1].write_text("{}")
        controller.files.open_block()
        assert window.session.design.pattern.block.name == "mine", "what cannot be used changes nothing"
        notice = window.notices.notice()
        assert notice is not None
        assert "broken" in str(notice.sentence)
        window.session.save(str(tmp_path / "kept.busk"), None)
        assert window.session.finish_saving()
        assert open_project(str(tmp_path / "kept.busk")).design.pattern == window.session.design.pattern

    run_undrawn([str(mannequin)], script)


def test_a_block_that_the_scan_has_no_room_for_says_why(mannequin: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        controller = window.pattern_controller
        window.navigation.show_step("pattern")
        before = window.session.frame
        window.pattern.block_doors["brief"].click()
        yield lambda: bool(controller._failure) or window.notices.notice() is not None
        assert controller.result is None
        assert not window.pattern.export.isEnabled()
        assert window.session.frame.stages.body is before.stages.body, "the body stays"

    run_undrawn([str(mannequin)], script)
