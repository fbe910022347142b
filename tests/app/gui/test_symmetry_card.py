"""The card of left and right where it is narrow: names and units are there whole, and take no focus."""

from __future__ import annotations

from dataclasses import replace

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication, QScrollArea

from app.gui.features.measurements.panel import MeasurementsPanel
from app.gui.features.symmetry.card import ElidedTitle, SymmetryCard
from app.gui.theme.stylesheet import load_fonts
from app.i18n.catalog import using_language
from app.presenters.samples import sample_design
from app.presenters.symmetry import symmetry_view
from core.analysis.symmetry.compare import BeforeAfter, SideDifference
from core.measurements.mirrored_surface import SkinGap
from core.pipeline.build import build

NARROWEST = 296
"""What a card has in a window that is 1180 px wide [px]."""

SKIN = SkinGap(3.6, 11.6, "left", 0, 54.0, 40.0, 1.0)


@pytest.mark.parametrize("words", ["en", "ja"])
def test_titles_and_units_are_whole_beside_what_figures_may_be_off(words: str, qapp: QApplication) -> None:
    load_fonts()
    stages = build(sample_design("person").with_line("mid-bust", 0.97))
    now = SideDifference(-11.8, -10.3, -0.1, SKIN)
    with using_language(words):
        summary = symmetry_view(BeforeAfter(now, now, ()), stages)
        card = SymmetryCard()
        views = tuple(replace(view, off="± 5.8") for view in summary.views)
        card.fold.setChecked(True)
        card.show_summary(replace(summary, views=views), faint=False)
        card.resize(NARROWEST, 600)
        card.show()
        QApplication.processEvents()
        titles = [title for title in card.findChildren(ElidedTitle) if title.isVisible()]
        assert len(titles) == 8
        assert [title.shown() for title in titles] == [title.text() for title in titles]
        titles[0].setFixedWidth(60)
        titles[0].setText("Further out than anything [mm]")
        assert titles[0].shown().endswith("… [mm]"), "a unit is never cut"
        card.close()
        card.deleteLater()


def test_a_click_beside_figures_puts_no_frame_round_all_of_them(qapp: QApplication) -> None:
    panel = MeasurementsPanel()
    areas = [area for area in panel.findChildren(QScrollArea) if area.accessibleName() == "Measurements"]
    assert [area.focusPolicy() for area in areas] == [Qt.FocusPolicy.TabFocus]
    panel.deleteLater()
