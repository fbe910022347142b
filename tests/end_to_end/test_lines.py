"""The list of lines in the real window: each decision is one undo step with a good name."""

from __future__ import annotations

from dataclasses import replace

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from window_tools import Script, drag, run_undrawn, settled

from app.gui.main_window import MainWindow
from app.gui.session.document_editor import DocumentEditor
from app.gui.widgets.notification_bar import Notification
from core.analysis.length_limits.zones import LengthLimits, Reason, Zone
from core.document.design import Design, ScanSource
from core.document.document import Document
from core.document.lines import CustomLine, LineSettings
from core.garment.presets import built_in, find_preset, preset_from

FOLDS_BELOW_93 = LengthLimits(
    "mid-bust", (Zone("red", 0.5, 0.93, (Reason("folded", 0.5, 0.93),)), Zone("green", 0.93, 1.3))
)

pytestmark = pytest.mark.usefixtures("empty_house")


def last(window: MainWindow) -> str:
    return window.session.undo_stack.undoText()


def test_lines_are_linked_locked_named_coloured_softened_and_dressed_by_a_preset() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.activateWindow()
        yield window.isActiveWindow
        window.actions_.add_lines["straps"].trigger()
        yield lambda: "strap left" in window.lines.rows and window.is_settled()
        yield from linked(window)
        yield from over_the_shoulder(window)
        yield from treated(window)
        yield from locked(window)
        yield from preset(window)
        while window.session.undo_stack.canUndo():
            window.actions_.undo.trigger()
        yield settled(window)
        assert list(window.lines.rows) == ["full-bust", "mid-bust", "under-bust"]

    run_undrawn([], script)


def over_the_shoulder(window: MainWindow) -> Script:
    """Straps run over the shoulder or end on the chest, as one choice for both sides."""
    session, row = window.session, window.lines.rows["strap left"]
    window.lines.select("strap left")
    box = row.details.over
    assert box.isVisibleTo(window)
    assert box.isChecked()
    steps, whole = session.undo_stack.index(), row.view.whole_mm
    for over, text in ((False, "ends at upper chest"), (True, "extended over shoulder")):
        box.click()
        yield settled(window)
        assert [line.over_shoulder for line in session.design.own_lines] == [over, over]
        assert last(window).endswith(text)
        assert (row.view.whole_mm < 0.8 * whole) != over
        assert box.isVisibleTo(window)
    assert session.undo_stack.index() == steps + 2
    window.lines.select("mid-bust")
    assert window.lines.rows["mid-bust"].details.over.isHidden(), "it is no line that could"
    window.lines.select("strap left")


def linked(window: MainWindow) -> Script:
    """One row and one undo step for both sides; set apart each has its own, linked again they are alike."""
    rows, session = window.lines.rows, window.session
    assert last(window) == "Straps added"
    assert "strap right" not in rows
    count = session.undo_stack.count()
    drag(window, "strap left", -40)
    yield settled(window)
    assert session.undo_stack.count() == count + 1
    assert last(window).startswith("Straps 9")
    ratio = session.design.ratio("strap left")
    assert 0.9 < ratio < 0.99
    assert session.design.ratio("strap right") == ratio
    assert len(rows["strap left"].view.sides) == 2
    window.view.viewport.band_clicked.emit("strap right")
    assert rows["strap left"]._open, "the row of the pair stands for both"
    QTest.keyClick(window.lines, Qt.Key.Key_L)
    yield lambda: "strap right" in window.lines.rows
    assert last(window) == "Straps: left and right unlinked"
    window.lines.length_committed.emit("strap right", 0.98)
    assert session.design.ratio("strap left") == ratio
    left, right = rows["strap left"], window.lines.rows["strap right"]
    assert [row.view.apart for row in (left, right)] == ["left", "right"]
    assert list(window.lines.rows)[-2:] == ["strap left", "strap right"], "one under the other, in a bracket"
    assert [row._side.accessibleName() for row in (left, right)] == ["left", "right"]
    window.lines.select("strap right")
    right.slider.setFocus()
    QTest.keyClick(right.slider, Qt.Key.Key_Delete)
    assert last(window) == "Strap right removed"
    assert [each.name for each in session.design.own_lines] == ["strap left"], "of a side set apart only it"
    window.actions_.undo.trigger()
    yield lambda: "strap right" in window.lines.rows and window.is_settled()
    yield from linked_again(window, ratio)


def linked_again(window: MainWindow, ratio: float) -> Script:
    """Both sides take the length of the left one, and go together."""
    session, left = window.session, window.lines.rows["strap left"]
    window.lines.select("mid-bust")
    assert left._link.isVisible()
    assert not window.lines.rows["mid-bust"]._link.isVisible()
    left._link.click()
    yield lambda: "strap right" not in window.lines.rows
    assert (last(window), session.design.ratio("strap right")) == ("Straps linked", ratio)
    rows = window.lines.rows
    assert not rows["strap left"].view.apart
    window.lines.select("strap left")
    rows["strap left"].percent.setFocus()
    QTest.keyClick(rows["strap left"].percent, Qt.Key.Key_Delete)
    assert last(window) == "Straps linked", "in a field the key takes letters away"
    rows["strap left"].slider.setFocus()
    QTest.keyClick(rows["strap left"].slider, Qt.Key.Key_Delete)
    assert last(window) == "Straps removed"
    assert session.design.own_lines == (), "both sides of a pair, as one step"
    window.actions_.undo.trigger()
    window.selection.select_line("strap left")
    yield settled(window)


def treated(window: MainWindow) -> Script:
    """Name, colour and stiffness."""
    session, bands = window.session, window.view.viewport.scene.bands
    row = window.lines.rows["strap left"]
    QTest.mouseDClick(row.title, Qt.MouseButton.LeftButton, pos=QPoint(10, 8))
    QTest.keyClicks(row.title._editor, "Lift tape")
    QTest.keyClick(row.title._editor, Qt.Key.Key_Return)
    yield lambda: row.title.text() == "Lift tape"
    assert last(window) == "Straps renamed"
    assert session.design.line_settings("strap right").title == "Lift tape"
    window.selection.select_line("strap right")
    assert window.view.viewport._labels.band[1].startswith("Lift tape, right 9")
    row.details._palette.chosen.emit("#C2571A")
    yield lambda: bands.colour("strap right") == "#C2571A"
    assert last(window) == "Lift tape: colour changed"
    yield settled(window)
    stiff = session.frame.lengths["strap left"]
    field = row.details._stiffness
    field.setFocus()
    QTest.keyClicks(field, "4")
    QTest.keyClick(field, Qt.Key.Key_Return)
    yield settled(window)
    assert last(window) == "Lift tape: stiffness 4.0"
    assert session.frame.lengths["strap left"] > stiff + 0.5, "a softer line pulls less"


def locked(window: MainWindow) -> Script:
    """A locked line keeps its length: no slider, no field, and the reset of all leaves it."""
    session, row = window.session, window.lines.rows["strap left"]
    window.lines.length_committed.emit("mid-bust", 0.97)
    window.lines.select("strap left")
    QTest.keyClick(window.lines, Qt.Key.Key_L, Qt.KeyboardModifier.ShiftModifier)
    yield lambda: row.view.locked
    assert last(window) == "Lift tape locked"
    for part in (row.slider, row.percent, row.millimetres, row.details._tools["remove"]):
        assert not part.isEnabled()
    assert "locked" in row.slider.toolTip()
    ratio = session.design.ratio("strap left")
    drag(window, "strap left", 40)
    window.actions_.reset.trigger()
    QTest.keyClick(window.lines, Qt.Key.Key_Delete)
    assert session.design.active_lines() == {"strap left", "strap right"}
    assert session.design.ratio("strap left") == ratio
    assert window.lines.isVisible()
    QTest.keyClick(window.lines, Qt.Key.Key_H)
    assert window.view.hidden_lines == {"strap left", "strap right"}
    QTest.keyClick(window.lines, Qt.Key.Key_H)
    QTest.keyClick(window.lines, Qt.Key.Key_L, Qt.KeyboardModifier.ShiftModifier)
    assert last(window) == "Lift tape unlocked"
    yield settled(window)


def preset(window: MainWindow) -> Script:
    """A preset from the menu is one undo step."""
    before, count = window.session.design, window.session.undo_stack.count()
    window.presets_controller._menu.aboutToShow.emit()
    titles = [action.text() for action in window.presets_controller._menu.actions()]
    shipped = [each.title for each in built_in()]
    assert titles[: len(shipped)] == shipped
    window.presets_controller._menu.actions()[titles.index("Bra")].trigger()
    assert window.session.undo_stack.count() == count + 1
    assert last(window) == "Preset Bra"
    assert window.session.design.active_lines() == {"mid-bust", "strap left", "strap right"}
    yield settled(window)
    a_preset_that_leads_lines_otherwise_says_so_and_can_be_taken_back(window)
    row = window.lines.rows["mid-bust"]
    lines = window.lines_controller
    lines.sources = replace(lines.sources, limits=lambda _: {"mid-bust": (FOLDS_BELOW_93, False)})
    window.lines_controller.show_rows()
    wall = row.slider.x_of(0.93)
    drag(window, "mid-bust", round(wall - 10 - row.slider.x_of(0.97)), release=False)
    assert row.slider.ratio() == pytest.approx(0.93, abs=1e-9 + 0.001), "the red resists"
    QTest.keyClick(row.slider, Qt.Key.Key_Escape)
    window.actions_.undo.trigger()
    assert window.session.design == before


def a_preset_that_leads_lines_otherwise_says_so_and_can_be_taken_back(window: MainWindow) -> None:
    session = window.session
    ours = preset_from(session.design, "Ours")
    left = next(line for line in session.design.own_lines if line.name == "strap left")
    by_hand = CustomLine(left.name, left.points[1:])
    session.edit(lambda design: design.with_custom_line(by_hand).with_line("full-bust", 0.98), "led by hand")
    led = session.design
    window.notices.clear()
    window.presets_controller.wear(find_preset("Bra"))
    assert window.notices.notice() is None, "nothing was led anew"
    assert window.lines.head.presets.text() == "Bra"
    assert session.design.own_lines == led.own_lines, "ready-made lines stay as they were led"
    worn = session.design
    window.notices.clear()
    window.presets_controller.wear(ours)
    assert left in session.design.own_lines
    assert _notice(window).sentence == "Line paths from preset Ours: Lift tape"
    (word, undo), *_ = _notice(window).actions
    undo()
    assert (word, session.design) == ("Undo", worn)
    for _ in range(2):
        session.undo_stack.undo()


def _notice(window: MainWindow) -> Notification:
    notice = window.notices.notice()
    assert notice is not None
    return notice


class _Editing(DocumentEditor):
    """Editing that solves nothing."""

    def __init__(self, design: Design) -> None:
        super().__init__()
        self.document = Document.single(design)

    def _submit(self, design: Design, fresh: bool = False) -> None:
        pass

    def _try(self, design: Design, fresh: bool) -> bool:
        return True


def test_a_locked_line_is_not_dragged_and_says_so_when_it_is_let_go(qapp: QApplication) -> None:
    editing = _Editing(Design(ScanSource("x")).with_line_settings(LineSettings("mid-bust", locked=True)))
    said: list[str] = []
    editing.failed.connect(lambda problem: said.append(str(problem.message)))
    editing.preview_line("mid-bust", 0.9)
    assert (editing._preview, said) == (None, [])
    editing.commit_line("mid-bust", "Mid-bust", 0.9)
    assert said == ["The line mid-bust is locked."]
    assert not editing.undo_stack.canUndo()
