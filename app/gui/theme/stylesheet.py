"""The look of all widgets: palette, style sheet and type, made from the colour tokens."""

from __future__ import annotations

from functools import cache
from importlib import resources
from string import Template

from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QFont, QFontDatabase, QPalette
from PySide6.QtWidgets import QApplication, QLabel, QWidget

from app.i18n.catalog import add_word_joiners, strip_word_joiners
from app.rendering.palette import DARK, LIGHT, Tokens

FAMILIES = ("Inter", "Inter Variable", "Noto Sans JP")
"""Type in the order in which a letter is looked for."""

ROLES = {
    "axis": (10, 400, "text_caption"),
    "caption": (11, 400, "text_caption"),
    "secondary": (12, 400, "text_quiet"),
    "title": (12, 600, "text"),
    "body": (13, 400, "text"),
    "button": (13, 500, "text"),
    "name": (13, 600, "text"),
    "heading": (15, 600, "text"),
    "wordmark": (15, 700, "text"),
    "page": (20, 600, "text"),
    "hero": (22, 650, "text"),
}
"""Size [px], weight and colour token of each kind of text."""


_OUTLINE = QPalette.ColorRole.Mid


@cache
def load_fonts() -> tuple[str, ...]:
    """Make the shipped fonts known to Qt and return their families; empty when none is shipped."""
    folder = resources.files("resources") / "fonts"
    files = [file for file in folder.iterdir() if file.name.endswith((".ttf", ".otf"))]
    ids = [QFontDatabase.addApplicationFontFromData(file.read_bytes()) for file in files]
    return tuple(family for i in ids if i >= 0 for family in QFontDatabase.applicationFontFamilies(i))


def font(role: str, tabular: bool = False) -> QFont:
    """Return the type of one role of ``ROLES``; ``tabular`` gives figures of equal width, for numbers."""
    return QFont(_type(role, tabular))  # its holder may change it


@cache
def _type(role: str, tabular: bool) -> QFont:
    size, weight, _ = ROLES[role]
    result = QFont(list(FAMILIES))
    result.setPixelSize(size)
    result.setWeight(QFont.Weight(weight))
    result.setHintingPreference(QFont.HintingPreference.PreferNoHinting)
    if tabular:
        result.setFeature(QFont.Tag("tnum"), 1)
    return result


class Sentence(QLabel):
    """Text of which no line of one letter is left at the end."""

    def setText(self, text: str) -> None:  # noqa: N802 - Qt names it
        """Show a text."""
        super().setText(add_word_joiners(text))

    def text(self) -> str:
        """Return it as it was said."""
        return strip_word_joiners(super().text())


def label(text: str = "", role: str = "body", tabular: bool = False, kind: type[QLabel] = QLabel) -> QLabel:
    """Return a line of text in one role of ``ROLES``; its colour follows the theme.

    It is shown letter by letter: names of files and elastics are others' and may look like marks of a page.
    """
    result = kind()
    result.setTextFormat(Qt.TextFormat.PlainText)
    result.setText(text)
    result.setFont(font(role, tabular))
    result.setProperty("role", role)
    return result


def set_tag(widget: QWidget, name: str, value: object) -> None:
    """Set a property that the style sheet looks at, and have the widget styled again if it changed."""
    if widget.property(name) != value:
        widget.setProperty(name, value)
        widget.style().unpolish(widget)
        widget.style().polish(widget)


def tokens_of(widget: QWidget) -> Tokens:
    """Return the colours of the theme that ``widget`` is shown in; ask again on a palette change."""
    # A style sheet rewrites the colours of window, button and text in a widget's palette, but never this one.
    return DARK if widget.palette().color(_OUTLINE).lightness() < 128 else LIGHT


def apply_theme(app: QApplication, dark: bool) -> None:
    """Apply the light or the dark theme to the whole program, also while windows are open."""
    load_fonts()
    tokens = DARK if dark else LIGHT
    app.setStyle("Fusion")
    app.setFont(font("body"))
    app.setPalette(palette(tokens))
    for kind in ("QCheckBox", "QRadioButton"):
        app.setPalette(_box_palette(tokens), kind)  # type: ignore[arg-type]  # the stub wants bytes
    app.setStyleSheet(style_sheet(tokens))


def palette(t: Tokens) -> QPalette:
    """Return the Qt palette of one theme."""
    role = QPalette.ColorRole
    colors = {
        role.Window: t.panel,
        role.WindowText: t.text,
        role.Base: t.raised,
        role.AlternateBase: t.hover,
        role.Text: t.text,
        role.Button: t.raised,
        role.ButtonText: t.text,
        role.PlaceholderText: t.text_caption,
        role.Highlight: t.accent,
        role.HighlightedText: t.on_accent,
        role.ToolTipBase: t.ink,
        role.ToolTipText: t.on_ink,
        _OUTLINE: t.outline,
        role.Dark: t.control,
        role.Light: t.raised,
        role.Midlight: t.line,
        role.Link: t.accent,
        role.Accent: t.accent,
    }
    result = QPalette()
    for each, color in colors.items():
        result.setColor(each, QColor(color))
    for each in (role.WindowText, role.Text, role.ButtonText):
        result.setColor(QPalette.ColorGroup.Disabled, each, faded(t.text_caption, t.panel, 0.55))
    return result


def _box_palette(t: Tokens) -> QPalette:
    """Return the palette of check boxes, whose outline must be seen on a dark panel too."""
    result = palette(t)
    # Fusion draws that outline in the colour of the window, made darker by 1.4 and lighter by 1.1.
    result.setColor(QPalette.ColorRole.Window, QColor(t.control).lighter(127))
    return result


def faded(color: str, ground: str, share: float) -> QColor:
    """Return ``share`` of ``color`` laid over ``ground``."""
    top, under = QColor(color), QColor(ground)

    def mix(a: float, b: float) -> float:
        return share * a + (1 - share) * b

    return QColor.fromRgbF(
        mix(top.redF(), under.redF()),
        mix(top.greenF(), under.greenF()),
        mix(top.blueF(), under.blueF()),
    )


def style_sheet(t: Tokens) -> str:
    """Return the style sheet of one theme: what the palette cannot say."""
    roles = (
        f'QLabel[role="{role}"] {{ color: {getattr(t, token)}; }}' for role, (*_, token) in ROLES.items()
    )
    tones = (
        f'QLabel[tone="{tone}"], QLineEdit[tone="{tone}"] {{ color: {getattr(t, tone)}; }}'
        f'QWidget[fill="{tone}"] {{ background: {getattr(t, tone + "_fill")}; }}'
        for tone in ("ok", "info", "warn", "bad")
    )
    made = {
        "disabled": faded(t.text_caption, t.panel, 0.6).name(),
        "disabled_segment": faded(t.text_caption, t.panel, 0.4).name(),
        "ink_hover": faded(t.ink, t.panel, 0.88).name(),
        "segment_ground": t.app if t.dark else t.pressed,
        "segment_on": t.pressed if t.dark else t.raised,
    }
    sheet = (resources.files("resources") / "style.qss").read_text(encoding="utf-8")
    return "\n".join((*roles, *tones, Template(sheet).substitute(vars(t) | made)))
