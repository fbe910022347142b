"""The garment's panel: it fits the narrowest inspector in both languages, and is told to ears."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QPushButton, QWidget
from pytestqt.qtbot import QtBot

from app.gui.features.garment.panel import GarmentPanel
from app.gui.layout import Inspector
from app.i18n.catalog import LANGUAGES, tr, use_language
from app.presenters.cut_list import CutListView, CutView
from app.presenters.pressure import PressureView

pytestmark = pytest.mark.usefixtures("light_theme")

STRAP = CutView("strap left", "Strap left", "#E2A32F", 15.0, "Strap 15 mm", "432", "+43 %", "5.0")
BAND = CutView("under-bust", "Under-bust", "#5A3F94", 18.0, "Bra band", "627", "", "2.6", (), 25.0)
BARE = CutView("mid-bust", "Mid-bust", "#E5536B", 12.0, "", tension="5.1", notes=("It lies slack.",))


def panel_of(qtbot: QtBot, *rows: CutView) -> GarmentPanel:
    panel = GarmentPanel()
    qtbot.addWidget(panel)
    panel.set_view(CutListView(rows, ("Newtons are an estimate.",), 530.0, worn=True))
    panel.resize(Inspector.LEAST, 500)
    panel.show()
    return panel


@pytest.mark.parametrize("language", LANGUAGES)
def test_all_tabs_fit_the_narrowest_inspector(qtbot: QtBot, language: str) -> None:
    use_language(language)
    inspector = Inspector()
    qtbot.addWidget(inspector)
    titles = tr("Lines"), tr("Measurements"), tr("Garment"), tr("Variants"), tr("History")
    for title in titles:
        inspector.add(title, QWidget(), title)
    inspector.resize(Inspector.LEAST, 400)
    inspector.show()
    assert inspector.width() == Inspector.LEAST
    ends = 0
    for title in titles:
        tab = inspector.tabs.button(title)
        assert tab.width() >= tab.fontMetrics().horizontalAdvance(title)
        assert tab.mapTo(inspector, tab.rect().topLeft()).x() >= ends
        ends = tab.mapTo(inspector, tab.rect().topRight()).x()
    assert ends < Inspector.LEAST


def test_figures_have_room_and_stand_under_each_other(qtbot: QtBot) -> None:
    panel = panel_of(qtbot, STRAP, BAND, BARE)
    for row in panel.rows.values():
        for figure in (row.cut, row.tension, row.stretch):
            assert figure.isHidden() or figure.width() >= figure.sizeHint().width()
    for name in ("cut", "tension", "pressure"):
        ends = {
            getattr(row, name).mapTo(panel, getattr(row, name).rect().topRight()).x()
            for row in panel.rows.values()
        }
        assert len(ends) == 1, name


def test_a_row_says_everything_to_ears(qtbot: QtBot) -> None:
    panel = panel_of(qtbot, STRAP, BAND, BARE)
    panel.set_pressures({"strap left": PressureView("2.1", "amber", "snug", "why")})
    strap, band, bare = panel.rows.values()
    assert strap.accessibleName() == "Strap left: cut 432 mm, elongation +43 %, 5.0 N"
    assert strap.elastic.accessibleName() == "Strap left: elastic, Strap 15 mm"
    assert strap.pressure.accessibleName() == "2.1 kPa snug"
    assert strap.pressure.toolTip() == "why"
    assert band.set_stretch.accessibleName() == "Under-bust: elongation in percent"
    assert bare.accessibleName() == "Mid-bust: 5.1 N, It lies slack."
    assert bare.pressure.accessibleName() == ""


def test_what_is_asked_carries_the_line(qtbot: QtBot) -> None:
    panel = panel_of(qtbot, STRAP, BAND)
    strap, band = panel.rows.values()
    with qtbot.waitSignal(panel.elastic_requested) as asked:
        strap.elastic.click()
    assert asked.args == ["strap left"]
    with qtbot.waitSignal(panel.selected) as selected:
        QTest.mouseClick(band, Qt.MouseButton.LeftButton)
    assert selected.args == ["under-bust"]
    band.set_stretch.setText("35")
    band.set_stretch.setModified(True)
    with qtbot.waitSignal(panel.stretched) as stretched:
        QTest.keyClick(band.set_stretch, Qt.Key.Key_Return)
    assert stretched.args == ["under-bust", 0.35]
    band.set_stretch.setText("180")
    band.set_stretch.setModified(True)
    QTest.keyClick(band.set_stretch, Qt.Key.Key_Return)
    assert "0 to 100" in band.set_stretch.accessibleDescription()


def test_figures_of_a_former_shape_fade_and_rows_stay_what_they_are(qtbot: QtBot) -> None:
    panel = panel_of(qtbot, STRAP, BAND)
    strap = panel.rows["strap left"]
    leaves = [each for each in panel.findChildren(QPushButton) if each.text() in ("Copy", "CSV…")]
    assert [each.isEnabled() for each in leaves] == [True, True]
    panel.set_stale()
    assert strap.cut.property("tone") == "faint"
    assert [each.isEnabled() for each in leaves] == [False, False], "nothing says on paper of when it is"
    panel.set_view(CutListView((STRAP,), worn=True))
    assert panel.rows == {"strap left": strap}, "what has the keyboard keeps it"
    assert strap.cut.property("tone") == ""
    assert [each.isEnabled() for each in leaves] == [True, True]


def test_without_a_piece_no_list_leaves(qtbot: QtBot) -> None:
    panel = panel_of(qtbot, STRAP)
    buttons = {each.text(): each for each in panel.findChildren(QPushButton)}
    panel.set_view(CutListView((BARE,)))
    assert panel.nothing.isVisible()
    assert [buttons[words].isEnabled() for words in ("Copy", "CSV…", "Elastics…")] == [False, False, True]
