"""The theme keeps its promises: all can be read, colours stay apart, both themes reach all widgets."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QFontInfo
from PySide6.QtWidgets import QApplication, QCheckBox, QWidget
from scipy.ndimage import gaussian_filter

from app.gui.theme.icons import SCALES, icon, pixmap
from app.gui.theme.stylesheet import ROLES, apply_theme, font, label, load_fonts, tokens_of
from app.gui.widgets.basic import ToolButton, sentence
from app.presenters.export import exports
from app.rendering.palette import DARK, LIGHT, LINE_COLORS, Tokens
from core.geometry.mesh import Floats

ICONS = Path(__file__).parents[3] / "resources" / "icons"

READ = [  # what is read on what
    *(
        (text, ground)
        for text in ("text", "text_quiet")
        for ground in ("panel", "raised", "hover", "pressed")
    ),
    *(("text_caption", ground) for ground in ("panel", "raised", "hover")),
    ("text", "selected"),
    ("accent", "panel"),
    ("accent", "selected"),
    ("on_ink", "ink"),
    ("on_accent", "accent"),
    *((tone, f"{tone}_fill") for tone in ("ok", "info", "warn", "bad")),
    *((tone, ground) for tone in ("warn", "bad") for ground in ("panel", "raised")),
    *((text, f"{tone}_fill") for text in ("text", "text_quiet") for tone in ("ok", "info", "warn", "bad")),
]
SEEN = [(mark, "panel") for mark in ("control", "warn_mark", "ok", "bad", "less", "more", "exact_curve")]


@pytest.fixture
def themed(qapp: QApplication) -> Iterator[QApplication]:
    yield qapp
    qapp.setStyleSheet("")


def linear(color: str) -> np.ndarray:
    """Return ``"#rrggbb"`` as linear light, shape (3,)."""
    share = np.array([int(color[i : i + 2], 16) for i in (1, 3, 5)]) / 255
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


def contrast(one: str, other: str) -> float:
    """Return the WCAG 2 contrast of two colours, 1..21."""
    light = sorted(float(linear(each) @ (0.2126, 0.7152, 0.0722)) for each in (one, other))
    return (light[1] + 0.05) / (light[0] + 0.05)


def test_contrast_by_hand() -> None:
    assert contrast("#000000", "#FFFFFF") == pytest.approx(21.0)
    assert contrast("#777777", "#FFFFFF") == pytest.approx(4.48, abs=0.005)


@pytest.mark.parametrize("tokens", [LIGHT, DARK], ids=["light", "dark"])
@pytest.mark.parametrize(("ink", "ground"), READ)
def test_text_can_be_read(tokens: Tokens, ink: str, ground: str) -> None:
    assert contrast(getattr(tokens, ink), getattr(tokens, ground)) >= 4.5


@pytest.mark.parametrize("tokens", [LIGHT, DARK], ids=["light", "dark"])
@pytest.mark.parametrize(("mark", "ground"), SEEN)
def test_marks_can_be_seen(tokens: Tokens, mark: str, ground: str) -> None:
    assert contrast(getattr(tokens, mark), getattr(tokens, ground)) >= 3.0


def test_every_token_is_a_colour() -> None:
    for tokens in (LIGHT, DARK):
        for field in fields(Tokens):
            if field.type == "str":
                assert linear(getattr(tokens, field.name)).shape == (3,)
                assert len(getattr(tokens, field.name)) == 7


# Machado, Oliveira and Fernandes 2009, full severity, on linear light.
SIGHT = {
    "normal": np.eye(3),
    "protan": [
        [0.152286, 1.052583, -0.204868],
        [0.114503, 0.786281, 0.099216],
        [-0.003882, -0.048116, 1.051998],
    ],
    "deutan": [
        [0.367322, 0.860646, -0.227968],
        [0.280085, 0.672501, 0.047413],
        [-0.01182, 0.04294, 0.968881],
    ],
    "tritan": [
        [1.255528, -0.076749, -0.178779],
        [-0.078411, 0.930809, 0.147602],
        [0.004733, 0.691367, 0.3039],
    ],
}


def lab(light: np.ndarray) -> np.ndarray:
    """Return CIE L*a*b* (D65) of linear sRGB light, shape (3,)."""
    to_xyz = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
    xyz = to_xyz @ np.clip(light, 0.0, 1.0) / (0.9505, 1.0, 1.089)
    x, y, z = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16 / 116)
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


@pytest.mark.parametrize("sight", SIGHT)
def test_line_colours_stay_apart_for_every_eye(sight: str) -> None:
    seen = [lab(np.asarray(SIGHT[sight]) @ linear(color)) for color in LINE_COLORS[:7]]
    assert min(np.linalg.norm(a - b) for a, b in combinations(seen, 2)) > 20.0


@pytest.mark.parametrize(("dark", "tokens"), [(False, LIGHT), (True, DARK)])
def test_every_widget_knows_its_theme(themed: QApplication, dark: bool, tokens: Tokens) -> None:
    apply_theme(themed, dark)
    for widget in (QWidget(), label("x", "caption"), ToolButton("eye", "Eye")):
        widget.ensurePolished()
        assert tokens_of(widget) is tokens


@pytest.mark.parametrize(("dark", "tokens"), [(False, LIGHT), (True, DARK)])
def test_an_empty_check_box_can_be_seen(themed: QApplication, dark: bool, tokens: Tokens) -> None:
    apply_theme(themed, dark)
    image = QCheckBox("Word").grab().toImage()
    middle = image.height() // 2
    edge = [image.pixelColor(x, middle).name() for x in range(8)]
    assert max(contrast(color, tokens.panel) for color in edge) >= 3.0


def test_icons_follow_a_change_of_theme(themed: QApplication) -> None:
    apply_theme(themed, dark=False)
    tool = ToolButton("eye", "Eye", size=24)
    tool.ensurePolished()
    before = tool.icon().pixmap(24).toImage()
    apply_theme(themed, dark=True)
    themed.processEvents()
    after = tool.icon().pixmap(24).toImage()
    assert after == pixmap("eye", DARK.text_quiet, 24).toImage()
    assert before != after


def test_shipped_type_is_used(themed: QApplication) -> None:
    assert {"Inter", "Noto Sans JP"} <= set(load_fonts())
    for role, (size, _, _) in ROLES.items():
        found = QFontInfo(font(role))
        assert (found.family(), found.pixelSize()) == ("Inter", size)


def test_words_are_shown_letter_by_letter(themed: QApplication) -> None:
    assert label("<b>Roll</b> 7").sizeHint().width() > 1.5 * label("Roll 7").sizeHint().width()
    assert sentence("<b>Roll</b> 7").textFormat() == Qt.TextFormat.PlainText


def test_a_changed_type_changes_no_other(themed: QApplication) -> None:
    font("name").setPixelSize(40)
    assert font("name").pixelSize() == 13


@pytest.mark.parametrize("path", sorted(ICONS.glob("*.svg")), ids=lambda path: path.stem)
def test_every_icon_takes_its_colour(qapp: QApplication, path: Path) -> None:
    image = pixmap(path.stem, "#FF0000", 24, 2.0).toImage()
    colors = [image.pixelColor(x, y) for x in range(48) for y in range(48)]
    drawn = [color for color in colors if color.alpha() > 200]
    assert len(drawn) > 40
    assert all((color.red(), color.green(), color.blue()) == (255, 0, 0) for color in drawn)


def test_an_icon_is_sharp_at_every_scale(qapp: QApplication) -> None:
    drawn = icon("eye", "#000000", 20)
    for scale in SCALES:
        assert drawn.pixmap(drawn.availableSizes()[0], scale).devicePixelRatio() == pytest.approx(scale)


def test_what_can_be_exported_has_drawings_that_differ(themed: QApplication) -> None:
    """Two torsos with two lines each have a correlation of 0.92, the others at most 0.75."""

    def ink(name: str) -> Floats:
        image = pixmap(name, "#000000", 20, 1.0).toImage()
        rows = [[image.pixelColor(x, y).alphaF() for x in range(20)] for y in range(20)]
        return gaussian_filter(np.array(rows), 1.0).ravel()

    drawings = {export.title: ink(export.drawing) for export in exports()}
    for (one, first), (other, second) in combinations(drawings.items(), 2):
        assert np.corrcoef(first, second)[0, 1] < 0.85, (one, other)
