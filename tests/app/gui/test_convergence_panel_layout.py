"""The strip's words keep off its buttons, at the height it opens with in the smallest window."""

from __future__ import annotations

import pytest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.gui.layout import LOW, NARROW, TALLER
from app.gui.plots.convergence_panel import ConvergencePanel
from app.gui.step_navigation import StepNavigation
from app.gui.theme.stylesheet import apply_theme, load_fonts
from app.i18n.catalog import using_language
from app.presenters.status import ConvergenceView

NUMBERS = {
    "en": [
        ("Bust point", "0.2 mm up, 1.2 mm back"),
        ("Bust girth", "895.4 mm"),
        ("Max. pressure", "12.8 kPa"),
    ],
    "ja": [("BP", "上へ 0.2 mm、後ろへ 1.2 mm"), ("バスト囲", "895.4 mm"), ("最大接触圧", "12.8 kPa")],
}
HINTS = {
    "en": "Mid-bust: contact pressure 12.8 kPa (96 mmHg). "
    "Not wearable: make the line much longer, wider or softer.",
    "ja": "バスト下部の接触圧は 12.8 kPa（96 mmHg）です。着用できません。"
    "大幅に長く、広く、または柔らかくしてください。",
}


@pytest.mark.parametrize("code", ["en", "ja"])
def test_a_hint_of_three_lines_keeps_off_the_controls(qtbot: QtBot, qapp: QApplication, code: str) -> None:
    load_fonts()
    apply_theme(qapp, dark=False)
    with using_language(code):
        strip = ConvergencePanel()
    qtbot.addWidget(strip)
    strip.resize(1180 - NARROW - StepNavigation().width(), LOW + TALLER.get(code, 0))
    strip.show()
    numbers, hint = NUMBERS[code], strip.hint
    strip.set_verdict(
        ConvergenceView("bad", "Do not use", "settled", numbers, HINTS[code], "0.2 s", "", False)
    )
    strip._show_emptiness(False)
    QApplication.processEvents()
    assert hint.heightForWidth(hint.width()) >= 3 * hint.fontMetrics().height()
    body = strip._body.layout()
    assert body is not None
    assert body.heightForWidth(strip.width()) <= strip.height()
    assert strip._segment.y() >= hint.geometry().bottom() + 4
