"""Parts of a self-test about type: the letters of both scripts are there, and are drawn."""

from __future__ import annotations

from importlib import resources

from app.cli.self_test.checks import check
from app.cli.self_test.fixture import Bench

_NO_LETTER = "\U0010fffd"
_LATIN = "AaGgQq059%°±−×·…"
_JAPANESE = "特徴点ライン"


def latin(bench: Bench) -> str:
    """Look for the Latin letters in the type that is shipped."""
    return _letters(set(_LATIN) | {chr(code) for code in range(33, 127)}, "Inter", _LATIN, bench)


def japanese(bench: Bench) -> str:
    """Look for every letter of the Japanese words in the type that is shipped."""
    from app.i18n.catalog import read_words  # noqa: PLC0415

    texts = [text for name in ("ja", "ja_messages") for text in read_words(name).values()]
    letters = {letter for text in texts for letter in text if not letter.isspace()}
    return _letters(letters, "Noto Sans JP", _JAPANESE, bench)


def _letters(letters: set[str], family: str, drawn: str, bench: Bench) -> str:
    from PySide6.QtGui import QRawFont  # noqa: PLC0415 (brings Qt along)

    from app.gui.theme.stylesheet import load_fonts  # noqa: PLC0415

    check(family in load_fonts(), f"{family} is not among the bundled fonts: {load_fonts()}")
    folder = resources.files("resources") / "fonts"
    files = [each for each in folder.iterdir() if "Regular" in each.name]
    fonts = []
    for each in files:
        font = QRawFont()
        font.loadFromData(each.read_bytes(), 13.0, font.hintingPreference())
        fonts.append(font)
    missing = sorted(x for x in letters if not any(font.supportsCharacter(ord(x)) for font in fonts))
    check(not missing, f"{len(missing)} glyphs are missing: {''.join(missing[:20])}")
    pictures = {_drawn(letter) for letter in drawn}
    check(_drawn(_NO_LETTER) not in pictures, f"placeholder boxes are rendered: {drawn}")
    check(len(pictures) == len(drawn), f"different letters have the same rendering: {drawn}")
    return f"{family}, {len(letters)} glyphs rendered"


def _drawn(letter: str) -> bytes:
    """Return the pixels of a letter."""
    from PySide6.QtCore import Qt  # noqa: PLC0415
    from PySide6.QtGui import QImage, QPainter  # noqa: PLC0415

    from app.gui.theme.stylesheet import font  # noqa: PLC0415

    image = QImage(40, 40, QImage.Format.Format_Grayscale8)
    image.fill(Qt.GlobalColor.white)
    painter = QPainter(image)
    painter.setFont(font("hero"))
    painter.drawText(image.rect(), Qt.AlignmentFlag.AlignCenter, letter)
    painter.end()
    return bytes(image.constBits())
