"""Scan files with any damage: flipped bits, cuts, other numbers, heads of other files, wrong names."""

from __future__ import annotations

import gzip
import random
import re
from collections.abc import Callable

Damage = Callable[[bytes, int, random.Random], bytes]

NUMBERS = b"0 1 -1 7 255 65535 65536 2147483647 -2147483648 4294967295 18446744073709551615 1e9 1e39 1e308"
NUMBERS = [*NUMBERS.split(), b"1e999", b"nan", b"-inf", b"x", b"", b"9" * 400]


def _flip(data: bytes, at: int, chance: random.Random) -> bytes:
    broken = bytearray(data)
    for place in [at, *(chance.randrange(len(data)) for _ in range(chance.randrange(4)))]:
        broken[place] ^= 1 << chance.randrange(8)
    return bytes(broken)


def _number(data: bytes, at: int, chance: random.Random) -> bytes:
    found = list(re.finditer(rb"\d+", data))
    if not found:
        return data[:at]
    match = chance.choice(found[: chance.choice((5, 40, len(found)))])
    return data[: match.start()] + chance.choice(NUMBERS) + data[match.end() :]


def _word(data: bytes, at: int, chance: random.Random) -> bytes:
    size = chance.choice((1, 2, 4, 8))
    word = chance.choice((b"\xff" * 8, b"\0" * 8, b"\xff\xff\xff\x7f" * 2, chance.randbytes(8)))[:size]
    return data[:at] + word + data[at + size :]


DAMAGES: list[Damage] = [
    _flip,
    _number,
    _number,
    _word,
    lambda data, at, chance: data[:at],
    lambda data, at, chance: data[:at] + data[at + chance.randrange(1, 40) :],
    lambda data, at, chance: data[: at + 20] * chance.choice((1, 1, 50)) + data[at:],
]


def damaged_file(chance: random.Random, files: dict[str, bytes]) -> tuple[str, bytes]:
    """Return a file's name and content after up to three damages; a packed one is damaged in or outside."""
    name = chance.choice(list(files))
    data = files[name]
    packed = name.endswith(".gz") and chance.random() < 0.5
    data = gzip.decompress(data) if packed else data
    for _ in range(chance.randrange(1, 4)):
        if data:
            data = chance.choice(DAMAGES)(data, chance.randrange(len(data)), chance)
    if chance.random() < 0.1:  # the head of another file
        other = files[chance.choice(list(files))]
        data = other[: chance.randrange(len(other))] + data[chance.randrange(len(data) + 1) :]
    if chance.random() < 0.1:
        name = f"scan.{chance.choice(list(files)).rpartition('.')[2]}"
    return name, gzip.compress(data, 1, mtime=0) if packed else data
