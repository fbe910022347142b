"""Pieces and seams of a pattern as rows: titles, lengths, strain, and what keeps a piece from being sewn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from app.presenters.messages import own_title, render, sided_title
from core.document.block import Block
from core.messages import BlockName, ClothName, Message, PieceName, SeamName

if TYPE_CHECKING:
    from core.pattern.garment import Pattern


@dataclass(frozen=True)
class PieceRow:
    """A piece: ``name`` is its key ("lower cup left"), ``title`` and ``cloth`` are in the language in use.

    ``strain_percent`` is that of the worn piece before ease on 95 % of its area, at most ``limit_percent``
    where its cloth takes it up. ``reason`` says why it cannot be sewn as it is, empty if it ``fits``;
    it ``is_overstrained`` where that is its strain. ``note`` is a remark on it, ``stretch_percent`` its
    mean stretch when worn, with its ease, across and down.
    """

    name: str
    title: str
    cloth: str
    area_cm2: float
    strain_percent: float
    limit_percent: float
    fits: bool
    reason: str
    note: str
    stretch_percent: tuple[float, float]
    is_overstrained: bool


@dataclass(frozen=True)
class SeamRow:
    """A seam between two ``pieces``, by their keys; lengths of both sides are in their order.

    ``lengths_mm`` are those of the pieces as they are cut, ``alone_mm`` those that they would have if each
    was flattened by itself. ``note`` says what keeps it from being sewn, or what has to be eased in.
    """

    name: str
    title: str
    pieces: tuple[str, str]
    on_body_mm: float
    lengths_mm: tuple[float, float]
    alone_mm: tuple[float, float]
    note: str


def piece_rows(pattern: Pattern) -> tuple[PieceRow, ...]:
    """Return the pieces of a pattern in the order of its block, left and right one by one."""
    rows = []
    for flat in pattern.flats:
        name, cloth, problem = flat.panel.name, pattern.cloths[flat.panel.cloth], pattern.problem(flat)
        across, down = pattern.worn_stretch(flat)
        rows.append(
            PieceRow(
                name,
                piece_title(name),
                own_title(ClothName(cloth.title)),
                float(flat.areas.sum()) / 100.0,
                100.0 * pattern.strains[name].within,
                100.0 * cloth.limit,
                problem is None,
                _said(problem),
                _said(pattern.note(flat)),
                (100.0 * across, 100.0 * down),
                problem is not None and problem == pattern.strain_problem(flat),
            )
        )
    return tuple(rows)


def seam_rows(pattern: Pattern) -> tuple[SeamRow, ...]:
    """Return the seams of a pattern in the order of its pieces."""
    panels = pattern.garment.panels
    rows = []
    for fit in pattern.matched.fits:
        first, second = (panels[number].name for number in fit.seam.panels)
        name = fit.seam.name
        rows.append(
            SeamRow(
                name,
                seam_title(name),
                (first, second),
                pattern.seam_length(fit),
                fit.together,
                fit.alone,
                _said(pattern.seam_problem(fit.seam) or pattern.seam_note(fit)),
            )
        )
    return tuple(rows)


def block_title(block: Block) -> str:
    """Return what a block is called; one of the user's own keeps its title."""
    return own_title(BlockName(block.title))


def block_about(block: Block) -> str:
    """Return the pieces of a block in a line."""
    return ", ".join(piece_title(panel.name) for panel in block.panels)


def piece_title(name: str) -> str:
    """Return what a piece is called by its key, with or without a side."""
    return sided_title(PieceName(name))


def seam_title(name: str) -> str:
    """Return what a seam is called by its name, with or without a side."""
    return sided_title(SeamName(name))


def _said(message: Message | None) -> str:
    return "" if message is None else render(message)
