"""Cloths: what pieces are cut from, how far each gives across and down, and how far it is worn stretched."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

from core.document.printable_name import is_blank, is_printable
from core.errors import PatternError
from core.files.table_text import best_names
from core.messages import ClothName, Length, Message

FORMAT = 1
"""The format of the files in ``resources/cloths``."""

Pair = tuple[float, float]
"""Across (the direction of greatest stretch) and down."""

LONGEST_NAME, LONGEST_SOURCE = 80, 500
"""Letters of a name or title, and of where the values of a cloth come from."""

TEST_LENGTH = 100.0
"""The length on which stretch is read by hand [mm]."""

MOST_STRETCH = 3.0
"""Cloths do not stretch further by hand [1]."""

STIFFNESS_LIMITS = (0.01, 100.0)
"""The softest and the stiffest cloth [1]."""


@dataclass(frozen=True)
class Cloth:
    """A cloth that pieces are cut from.

    ``stiffness`` across, down and in shear is relative to a stable cup tricot across [1]. Worn lengths are
    1 + ``ease`` times the lengths of the piece (negative ease in the trade: the piece is cut smaller); on top
    of that a piece may be stretched or compressed by ``limit`` [1]. ``stretch`` is what the cloth gives by
    hand, None if it was not tested. ``source`` says where the values come from, ``estimate`` that they were
    not measured. Raises PatternError for what no cloth can be.
    """

    name: str
    title: str
    stiffness: tuple[float, float, float]
    poisson: float
    ease: Pair
    limit: float
    stretch: Pair | None = None
    source: str = ""
    estimate: bool = True

    def __post_init__(self) -> None:
        if any(is_blank(each) or not is_printable(each, LONGEST_NAME) for each in (self.name, self.title)):
            raise PatternError(
                Message("A cloth requires a name."),
                Message("Use at most {count} characters.", count=LONGEST_NAME),
            )
        if not is_printable(self.source, LONGEST_SOURCE):
            raise PatternError(
                Message(
                    "The source of the cloth {name} is too long or contains unprintable characters.",
                    name=ClothName(self.title),
                ),
                Message("Use at most {count} characters.", count=LONGEST_SOURCE),
            )
        stretches = [(each, (0.0, MOST_STRETCH)) for each in self.stretch or ()]
        for what, values in (
            (Message("stiffness"), [(each, STIFFNESS_LIMITS) for each in self.stiffness]),
            (Message("Poisson's ratio"), [(self.poisson, (0.0, 0.9))]),
            (Message("ease"), [(each, (-0.3, 1.0)) for each in self.ease]),
            (Message("limit"), [(self.limit, (0.001, 2.0))]),
            (Message("stretch"), stretches),
        ):
            for value, (low, high) in values:
                if not (math.isfinite(value) and low <= value <= high):
                    raise self._range_error(what, value, low, high)

    def _range_error(self, what: Message, value: float, low: float, high: float) -> PatternError:
        return PatternError(
            Message(
                "The {what} {value} of the cloth {name} is out of range.",
                what=what,
                value=f"{value:g}",
                name=ClothName(self.title),
            ),
            Message("Enter a value from {low} to {high}.", low=f"{low:g}", high=f"{high:g}"),
        )


def stretch_test(across_mm: float, down_mm: float, length_mm: float = TEST_LENGTH) -> Pair:
    """Return the stretch [1] of a cloth of which ``length_mm`` gives to these lengths by hand [mm].

    The hand pulls until the cloth resists, and the cloth must come back. Raises PatternError for lengths that
    are shorter, or longer than a cloth stretches.
    """
    longest = (1.0 + MOST_STRETCH) * length_mm
    for each in (across_mm, down_mm):
        if not length_mm <= each <= longest:
            raise PatternError(
                Message(
                    "{length} of cloth cannot stretch to {stretched}.",
                    length=Length(length_mm),
                    stretched=Length(each, 1),
                ),
                Message(
                    "Mark {length} on the cloth and enter its length when stretched.",
                    length=Length(length_mm),
                ),
            )
    return round(across_mm / length_mm - 1.0, 6), round(down_mm / length_mm - 1.0, 6)


def cloth_of_stretch(name: str, stretch: Pair, source: str = "", ease: Pair | None = None) -> Cloth:
    """Return a cloth of which only the ``stretch`` by hand is known [1]; the other values are estimates.

    A stable cloth (less than 20 % both ways) is cut without ease, another one at three eighths of its stretch
    across, as the cloths that come with Busk. Half of the stretch is the limit. Source: ours.
    """
    across, down = (max(each, 0.015) for each in stretch)
    stiff = (round(0.15 / across, 4), round(0.15 / down, 4), round(0.06 / max(across, down), 4))
    usual = 0.0 if max(stretch) < 0.2 else round(0.375 * stretch[0], 4)
    return Cloth(
        name,
        name,
        stiff,
        0.3,
        ease or (usual, 0.0),
        round(0.5 * max(across, down), 4),
        stretch,
        source,
        estimate=True,
    )


@cache
def built_in() -> tuple[Cloth, ...]:
    """Return the cloths that come with Busk."""
    folder = resources.files("resources") / "cloths"
    files = sorted((each for each in folder.iterdir() if each.name.endswith(".json")), key=lambda f: f.name)
    return tuple(_cloth_of(json.loads(each.read_text("utf-8"))) for each in files)


def find_cloth(text: str, cloths: tuple[Cloth, ...] = ()) -> Cloth:
    """Find the cloth of this name or title, or the only one with all these words in its title.

    ``cloths`` of one's own come before those of the program. Raises PatternError if there is none, or more
    than one.
    """
    known = {each.name: each for each in (*built_in(), *cloths)}
    titles = {each.title: each for each in known.values()}
    found = [known[each] for each in best_names(text, known)] or [
        titles[each] for each in best_names(text, titles)
    ]
    if len(found) == 1:
        return found[0]
    shown = found or known.values()
    raise PatternError(
        Message("Several cloths match '{text}'.", text=text)
        if found
        else Message("No cloth matches '{text}'.", text=text),
        Message("Choose one of: {choices}.", choices=tuple(ClothName(each.title) for each in shown)),
    )


def _cloth_of(values: dict[str, Any]) -> Cloth:
    assert values["format"] == FORMAT
    pairs = {key: (values[key]["across"], values[key]["down"]) for key in ("ease", "stretch")}
    stiff = values["stiffness"]
    return Cloth(
        values["name"],
        values["title"],
        (stiff["across"], stiff["down"], stiff["shear"]),
        values["poisson"],
        pairs["ease"],
        values["limit"],
        pairs["stretch"],
        values["source"],
        values["estimate"],
    )
