"""Blocks: garments as seams and panels whose places are told by landmarks, so that they fit any body."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from importlib import resources
from types import MappingProxyType
from typing import Any

from core.errors import PatternError
from core.landmarks.types import SIDES
from core.messages import Message

WAY, RING, ROOT = "way", "ring", "root"
"""How a seam runs: from place to place over the skin, at a level, or along the root of a breast."""

REFERENCES = ("under", "bust", "waist", "belly", "hip", "crotch", "low")
"""What levels are told from: the under-bust, the bust points, those of the lower trunk, the scan's edge."""


@dataclass(frozen=True)
class Seam:
    """A seam or edge of a block, ``each`` on both sides of the body or once.

    ``kind`` is one of WAY, RING and ROOT. A way goes through ``places`` (see ``places``); a ring lies at
    ``level`` from one share of the half round to another, ``span``, 0 being the front centre and 1 the back
    centre; a root goes from one clock position to another [degrees], ``below`` the bust point or above it.
    A ``slit`` is cut into a panel and divides none: a dart. Panels beside an ``edge`` are not sewn together,
    as where a band is hooked.
    """

    name: str
    kind: str
    each: bool = False
    places: tuple[str, ...] = ()
    level: str = ""
    span: tuple[float, float] = (0.0, 1.0)
    below: bool = False
    slit: bool = False
    edge: bool = False

    def named(self) -> tuple[tuple[str, str], ...]:
        """Return name and side of each curve that it is: "" for one over the middle."""
        return tuple((f"{self.name} {side}", side) for side in SIDES) if self.each else ((self.name, ""),)


@dataclass(frozen=True)
class PanelPlan:
    """A panel of a block: the skin round the place ``seed`` up to the seams, and what it is cut from."""

    name: str
    seed: str
    cloth: str
    each: bool = False


@dataclass(frozen=True)
class Block:
    """A garment: its ``seams`` in the order in which they are drawn, and its ``panels``.

    ``levels`` are heights by name: one of REFERENCES and how far above it [mm].
    """

    name: str
    title: str
    levels: Mapping[str, tuple[str, float]]
    seams: tuple[Seam, ...]
    panels: tuple[PanelPlan, ...]

    @property
    def needs_lower_trunk(self) -> bool:
        """Return whether any of its places is told from the lower trunk."""
        words = [
            *(place for seam in self.seams for place in seam.places),
            *(each.seed for each in self.panels),
        ]
        levels = {reference for reference, _ in self.levels.values()}
        return bool(levels & {"waist", "belly", "hip", "crotch"}) or any("below" in word for word in words)


@cache
def built_in_blocks() -> tuple[Block, ...]:
    """Return the blocks that come with Busk, by name."""
    folder = resources.files("resources") / "blocks"
    files = {each.name: each for each in folder.iterdir() if each.name.endswith(".json")}
    texts = {name: files[name].read_text(encoding="utf-8") for name in sorted(files)}
    return tuple(block_of(name.removesuffix(".json"), text) for name, text in texts.items())


def find_block(name: str) -> Block:
    """Return a block by its name. Raises PatternError with the names that there are."""
    blocks = {block.name: block for block in built_in_blocks()}
    if name not in blocks:
        raise PatternError(
            Message("There is no block '{name}'.", name=name),
            Message("Choose one of: {choices}.", choices=", ".join(blocks)),
        )
    return blocks[name]


def block_of(name: str, text: str) -> Block:
    """Return the block that a JSON text describes. Raises PatternError, which says what is wrong in it."""
    try:
        data = json.loads(text)
        levels = {str(level): (str(told[0]), float(told[1])) for level, told in data["levels"].items()}
        seams = tuple(_seam(entry) for entry in data["seams"])
        panels = tuple(
            PanelPlan(str(each["name"]), str(each["seed"]), str(each["cloth"]), bool(each.get("each", False)))
            for each in data["panels"]
        )
        block = Block(name, str(data["title"]), MappingProxyType(levels), seams, panels)
    except (KeyError, TypeError, ValueError, AttributeError, IndexError) as error:
        raise _refusal(name, f"{type(error).__name__}, {error}") from error
    _check(block)
    return block


def _seam(entry: Mapping[str, Any]) -> Seam:
    kind = next(kind for kind in (WAY, RING, ROOT) if kind in entry)
    each, slit, edge = (bool(entry.get(key, False)) for key in ("each", "slit", "edge"))
    seam = Seam(str(entry["name"]), kind, each, slit=slit, edge=edge)
    if kind == WAY:
        return replace(seam, places=tuple(str(place) for place in entry[WAY]))
    if kind == RING:
        return replace(seam, level=str(entry[RING]), span=_pair(entry.get("span", (0.0, 1.0))))
    return replace(seam, span=_pair(entry[ROOT]), below=bool(entry.get("below", False)))


def _pair(values: Sequence[Any]) -> tuple[float, float]:
    first, second = values
    return float(first), float(second)


def _check(block: Block) -> None:
    names = [seam.name for seam in block.seams]
    panels = [panel.name for panel in block.panels]
    for each in (names, panels):
        if len(set(each)) < len(each):
            raise _refusal(block.name, "two seams or panels have one name")
    for level, (reference, _) in block.levels.items():
        if reference not in REFERENCES:
            raise _refusal(block.name, f"the level {level} is told from '{reference}'")
    for seam in block.seams:
        if seam.kind == RING and seam.level not in block.levels:
            raise _refusal(block.name, f"the seam {seam.name} is at the level '{seam.level}'")
        if seam.kind == WAY and len(seam.places) < 2:
            raise _refusal(block.name, f"the seam {seam.name} has fewer than two places")
    if not block.panels:
        raise _refusal(block.name, "it has no panel")


def _refusal(name: str, why: str) -> PatternError:
    return PatternError(
        Message("The block {name} cannot be used: {why}.", name=name, why=why),
        Message("Correct the file or choose another block."),
    )
