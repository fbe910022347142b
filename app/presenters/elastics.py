"""What the window says of elastics: where they come from, and forces at round elongations."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from app.i18n.catalog import number, say, tr
from app.i18n.lengths import width, width_number
from core.document.elastic import Elastic


def elastic_views(
    own: Iterable[Elastic], built_in: Iterable[Elastic], kept: Iterable[Elastic]
) -> list[ElasticView]:
    """Return the designer's own first, those that a project brings along, then ours.

    One of the designer's own stands in the place of one of ours of the same name.
    """
    own, built_in = list(own), list(built_in)
    names = {each.name for each in own}
    brought = [each for each in kept if each not in own and each not in built_in]
    return [
        *(_view(each, tr("your own"), True) for each in own),
        *(_view(each, tr("this project"), False) for each in brought if each.name not in names),
        *(_view(each, "Busk", False) for each in built_in if each.name not in names),
    ]


def _view(elastic: Elastic, where: str, own: bool) -> ElasticView:
    forces = tuple(number(elastic.force(e), 1) if e <= elastic.reach + 1e-9 else "" for e in TOLD_AT)
    return ElasticView(
        elastic.name,
        elastic.name if own else say(elastic.name),
        tr("{where}, estimate").format(where=where) if elastic.estimate else where,
        width_number(elastic.width_mm),
        forces,
        width_number(elastic.allowance_mm),
        say(elastic.source),
        elastic.estimate,
        own,
        elastic.curve,
    )


def kind_title(elastic: Elastic) -> str:
    """Return what an elastic that comes with Busk is called without its width."""
    return say(elastic.name).removesuffix(width(elastic.width_mm)).strip()


TOLD_AT = (0.2, 0.4, 0.6, 0.8)
"""Elongations that the table has forces at [1]."""


@dataclass(frozen=True)
class ElasticView:
    """One elastic: its ``name`` as it is kept and ``title`` as it is shown, ``where`` it comes from.

    ``curve`` are points (elongation [1], force [N]); ``forces`` those at TOLD_AT as they are read, empty
    beyond the end of the curve. ``own`` ones can be taken away.
    """

    name: str
    title: str
    where: str
    width: str
    forces: tuple[str, ...]
    allowance: str
    source: str
    estimate: bool
    own: bool
    curve: tuple[tuple[float, float], ...]
