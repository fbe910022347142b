"""The cloths that come with Busk, finding one by its name, and the 10 cm stretch test."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from importlib import resources
from typing import Any

from core.document.cloth import MOST_STRETCH, Cloth, Pair
from core.document.garment_pattern import GarmentPattern
from core.errors import PatternError
from core.files.table_text import best_names
from core.messages import ClothName, Length, Message, PieceName

FORMAT = 1
"""The format of the files in ``resources/cloths``."""

TEST_LENGTH = 100.0
"""The length on which stretch is read by hand [mm]."""


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


def cloths_of(plan: GarmentPattern) -> Mapping[str, Cloth]:
    """Return all cloths of a pattern by name: its own take the place of those of the program.

    Raises PatternError where a piece of its block is of none of them.
    """
    cloths = {each.name: each for each in (*built_in(), *plan.cloths)}
    for panel in plan.block.panels:
        if panel.cloth not in cloths:
            raise PatternError(
                Message(
                    "The cloth '{cloth}' of {piece} is not known.",
                    cloth=panel.cloth,
                    piece=PieceName(panel.name),
                ),
                Message(
                    "Choose one of: {choices}.",
                    choices=tuple(ClothName(each.title) for each in cloths.values()),
                ),
            )
    return cloths


ALL_PIECES = "all"
"""In place of the name of a piece: each of them."""


def with_cloth(plan: GarmentPattern, piece: str, cloth: Cloth) -> GarmentPattern:
    """Return a pattern with a ``piece``, named without its side, or ``ALL_PIECES``, of another cloth.

    One of the user's own does not replace a cloth of the program that has the same name: its name gets "own".
    Raises PatternError for a piece that the block does not have.
    """
    names = [panel.name for panel in plan.block.panels]
    if piece not in (ALL_PIECES, *names):
        raise PatternError(
            Message("There is no piece '{piece}'.", piece=piece),
            Message("Choose one of: {choices}.", choices=(ALL_PIECES, *map(PieceName, names))),
        )
    if cloth not in built_in() and cloth.name.casefold() in {each.name for each in built_in()}:
        cloth = replace(cloth, name=f"{cloth.name} own", title=f"{cloth.title} (own)")
    panels = tuple(
        replace(panel, cloth=cloth.name) if piece in (ALL_PIECES, panel.name) else panel
        for panel in plan.block.panels
    )
    own = {each.name: each for each in plan.cloths} | ({} if cloth in built_in() else {cloth.name: cloth})
    return replace(plan, block=replace(plan.block, panels=panels), cloths=tuple(own.values()))


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
