"""Numbers in lines of text, read many lines at a time."""

from __future__ import annotations

import re
from array import array
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from core.errors import ScanError
from core.geometry.mesh import Flags, Floats, Indices
from core.messages import Message
from core.progress import Progress
from core.scan.readers.raw_scan import AGAIN, check_size, too_much

BLOCK = 1 << 20
"""How much text is read at a time [bytes], so that what is made of it stays small; a line is not longer."""

MOST_LINES = 40_000_000
"""The finest scan as text has fewer lines; a small packed file may hold many more."""

NUMBERS_A_POINT = 8
"""How many numbers a point may come with before so many are too many."""

Text = npt.NDArray[np.uint8]

_BLANKS = bytes.maketrans(b"\t\n\v\f\r", b"     ")


def blocks(name: str, data: bytes, progress: Progress) -> Iterator[bytes]:
    """Cut text at line ends into blocks that fit into memory.

    Raises ScanError on too many lines or an endless one.
    """
    if max(data.count(b"\n"), data.count(b"\r")) > MOST_LINES:
        raise too_much(name)
    start = 0
    while start < len(data):
        progress("reading", start / len(data))
        end = len(data)
        if end - start > BLOCK:
            end = 1 + max(data.rfind(mark, start, start + BLOCK) for mark in (b"\n", b"\r"))
        if end <= start:
            raise ScanError(
                Message(
                    "{file} contains a line of text longer than {count} MB. The file is not a scan, or it "
                    "is damaged.",
                    file=name,
                    count=BLOCK // 1_000_000,
                ),
                AGAIN,
            )
        yield data[start:end]
        start = end


@dataclass(frozen=True, eq=False)
class Lines:
    """The lines of a block that hold anything: where they begin and end, and where the first word does."""

    text: Text
    starts: Indices
    ends: Indices
    first: Indices

    def marked(self, *words: bytes) -> Flags:
        """Return which lines begin with one of the words, in any case, and a blank."""
        found = np.zeros(len(self.first), dtype=bool)
        for word in words:
            same = np.ones(len(self.first), dtype=bool)
            for k, letter in enumerate(word.lower()):
                same &= (self.text[np.minimum(self.first + k, len(self.text) - 1)] | 0x20) == letter
            after = self.text[np.minimum(self.first + len(word), len(self.text) - 1)]
            found |= same & (after <= 32)
        return found

    def picked(self, lines: Flags, skip: int = 0) -> bytes:
        """Return the text of some lines without the first ``skip`` letters of each."""
        text = self.text.copy()
        text[(self.first[lines, None] + np.arange(skip)).ravel()] = 32
        edges = np.stack([self.starts, self.ends], axis=1).ravel()
        bounds = np.concatenate([[0], edges, [len(text)]])
        keep = np.zeros(len(bounds) - 1, dtype=bool)
        keep[1::2] = lines
        return bytes(text[np.repeat(keep, np.diff(bounds))])


def lines_of(block: bytes) -> Lines:
    """Find the lines in a block of text; what follows a ``#`` is left out."""
    if b"#" in block:
        block = re.sub(rb"(?<!\S)#[^\n\r]*", b"", block)
    text = np.frombuffer(block.replace(b"\r", b"\n") + b"\n", dtype=np.uint8)
    ends = np.flatnonzero(text == 10) + 1
    starts = np.concatenate([[0], ends[:-1]])
    words = np.flatnonzero(text > 32)
    after = np.searchsorted(words, starts)
    filled = after < np.searchsorted(words, ends)
    return Lines(text, starts[filled], ends[filled], words[after[filled]])


@dataclass(frozen=True, eq=False)
class Table:
    """All numbers of some lines one after the other, and how many of them each line holds."""

    numbers: Floats
    counts: Indices

    @property
    def starts(self) -> Indices:
        """Return where the numbers of each line begin."""
        return np.cumsum(self.counts) - self.counts

    def rows(self, first: int, last: int) -> Table:
        """Return some of the lines."""
        edges = np.concatenate([[0], np.cumsum(self.counts)])
        return Table(self.numbers[edges[first] : edges[last]], self.counts[first:last])

    def columns(self, first: int, last: int) -> Floats:
        """Return some numbers of each line, shape (lines, last - first). ValueError if one is short."""
        if len(self.counts) and self.counts.min() < last:
            raise ValueError("a line too short")
        if len(self.counts) and np.ptp(self.counts) == 0:
            return self.numbers.reshape(len(self.counts), -1)[:, first:last].copy()
        return np.asarray(self.numbers[self.starts[:, None] + np.arange(first, last)])


class Growing:
    """An array that grows at its end, without a copy of all of it when it is whole."""

    def __init__(self, kind: Literal["d", "q", "B"]) -> None:
        self._held = array(kind)

    def __len__(self) -> int:
        return len(self._held)

    def add(self, values: npt.NDArray[np.generic]) -> None:
        """Append values, converted to the kind of the array."""
        self._held.frombytes(np.ascontiguousarray(values, self._held.typecode).tobytes())

    def array(self) -> npt.NDArray[Any]:
        """Return all values, shape (n,)."""
        return np.frombuffer(self._held, self._held.typecode)


def table(text: bytes) -> Table:
    """Read lines that hold nothing but numbers. Raises ValueError."""
    letters = np.frombuffer(text, dtype=np.uint8)
    words = _words(letters)
    ends = np.flatnonzero(letters == 10) + 1
    counts = np.diff(np.searchsorted(words, np.concatenate([[0], ends])))
    return Table(numbers(text, len(words)), counts)


def whole_table(name: str, data: bytes, progress: Progress) -> Table:
    """Read a text that holds nothing but numbers; empty lines are left out. Raises ScanError, ValueError."""
    held, counts = Growing("d"), Growing("q")
    for block in blocks(name, data, progress):
        lines = lines_of(block)
        part = table(lines.picked(np.ones(len(lines.first), dtype=bool)))
        held.add(part.numbers)
        counts.add(part.counts)
        check_size(name, len(held) // NUMBERS_A_POINT)
    return Table(held.array(), counts.array())


def all_numbers(text: bytes, progress: Progress) -> Floats:
    """Read numbers that blanks or line ends keep apart, whatever the lines. Raises ValueError, Cancelled."""
    text, held, start = text.translate(_BLANKS), Growing("d"), 0
    while start < len(text):
        progress("reading", start / len(text))
        end = len(text) if len(text) - start <= BLOCK else 1 + text.rfind(b" ", start, start + BLOCK)
        if end <= start:
            raise ValueError("a number without an end")
        block = text[start:end]
        held.add(numbers(block, len(_words(np.frombuffer(block, dtype=np.uint8)))))
        start = end
    return held.array()


def _words(letters: Text) -> Indices:
    """Return where the words of a text begin."""
    filled = letters > 32
    return np.flatnonzero(filled & ~np.concatenate([[False], filled[:-1]]))


def numbers(text: bytes, count: int) -> Floats:
    """Read ``count`` numbers that blanks keep apart; a comma in one is its decimal mark.

    Raises ValueError if there are not as many.
    """
    if b"," in text:
        text = text.replace(b",", b".")
    if b"(" in text or b"#" in text:  # nan(ind), 1.#QNAN: how some programs write that there is no number
        text = re.sub(rb"-?(nan|ind)\([a-z]*\)|-?1\.#[A-Z]+\w*", b"nan", text)
    read = np.fromstring(text, sep=" ") if count else np.empty(0)
    if len(read) != count:
        raise ValueError("a word that is not a number")
    return np.asarray(read, dtype=np.float64)


def whole(values: Floats) -> Indices:
    """Return numbers that must be whole ones as such. Raises ValueError."""
    if len(values) and not (values.min() > -(2.0**53) and values.max() < 2.0**53):  # or not a number
        raise ValueError("a number that is too large")
    result = values.astype(np.int64)
    if (result != values).any():
        raise ValueError("a number that is not an integer")
    return result
