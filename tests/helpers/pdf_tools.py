"""Reading a PDF back with PDFium, which Busk itself does not know: words with their places, type, pixels."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pypdfium2 as pdfium
from pypdfium2 import raw

POINT = 25.4 / 72.0


@dataclass(frozen=True)
class Piece:
    """A text as it was written, with its box from the top left of the page [mm]."""

    text: str
    left: float
    top: float
    right: float
    bottom: float

    def overlaps(self, other: Piece) -> bool:
        """Whether the letters of both lie over each other by more than a hair."""
        across = min(self.right, other.right) - max(self.left, other.left)
        down = min(self.bottom, other.bottom) - max(self.top, other.top)
        return across > 0.15 and down > 0.15

    def goes_on_with(self, other: Piece) -> bool:
        """Whether another text follows on the same line, a space away at most."""
        gap, level = other.left - self.right, min(self.bottom, other.bottom) - max(self.top, other.top)
        dot = other.text[0] in ".,-…·ー" or self.text[-1] in ".,-…·ー"
        return -0.12 <= gap < 1.3 and (level > 0.0 or dot)

    def joined(self, other: Piece) -> Piece:
        """Both as one."""
        top, bottom = min(self.top, other.top), max(self.bottom, other.bottom)
        return Piece(self.text + other.text, self.left, top, other.right, bottom)


class Pdf:
    def __init__(self, path: Path) -> None:
        self.document = pdfium.PdfDocument(str(path))

    @property
    def sizes(self) -> list[tuple[float, float]]:
        """Width and height of each page [mm]."""
        return [(round(w * POINT), round(h * POINT)) for w, h in (p.get_size() for p in self.document)]

    def text(self) -> str:
        """All text, in the order in which it was written, spaces and lines as one space."""
        pages = (page.get_textpage().get_text_range() for page in self.document)
        return " ".join(" ".join(pages).replace("\x02", "").split())

    def fonts(self) -> dict[str, bool]:
        """The fonts by name, and whether they are within the file."""
        found = {}
        for page in self.document:
            for each in _texts(page):
                font, name = raw.FPDFTextObj_GetFont(each.raw), ctypes.create_string_buffer(200)
                raw.FPDFFont_GetBaseFontName(font, name, 200)
                found[name.value.decode()] = bool(raw.FPDFFont_GetIsEmbedded(font))
        return found

    def pieces(self, page: int) -> list[Piece]:
        """The texts of a page with their boxes: letters that follow one another closely on a line are one."""
        found: list[Piece] = []
        for letter in self._letters(page):
            if found and found[-1].goes_on_with(letter):
                found[-1] = found[-1].joined(letter)
            else:
                found.append(letter)
        return [replace(piece, text=piece.text.strip()) for piece in found if piece.text.strip()]

    def _letters(self, page: int) -> list[Piece]:
        at = self.document[page]
        height, words = at.get_size()[1], at.get_textpage()
        found = []
        for left, bottom, right, top in (words.get_rect(k) for k in range(words.count_rects())):
            text = words.get_text_bounded(left, bottom, right, top)
            box = left, height - top, right, height - bottom
            found.append(Piece(text, *(each * POINT for each in box)))
        return found

    def pixels(self, page: int, dots: float = 60.0) -> np.ndarray:
        """A page as pixels, (h, w, 3)."""
        return np.asarray(self.document[page].render(scale=dots / 72.0).to_numpy())


def _texts(page: pdfium.PdfPage) -> Iterator[pdfium.PdfObject]:
    return (each for each in page.get_objects() if each.type == raw.FPDF_PAGEOBJ_TEXT)
