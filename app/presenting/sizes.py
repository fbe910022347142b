"""What is said of band and cup: the size in every system, the rule, what lies near it, the doubts."""

from __future__ import annotations

from collections.abc import Iterator

from app.panels.size_card import SizeView
from app.wording.words import language, number, say, tr
from core.measures import Measures
from core.sizes import Neighbour, SizeAnswer, sizes

NEEDED = ("underbust_girth", "bust_girth")
"""The measures that a size is made of."""


def size_views(measured: Measures, allowance_mm: float) -> tuple[list[SizeView], str]:
    """Return the sizes of a body in every system, or none and why."""
    underbust, bust = (measured[key] for key in NEEDED)
    if underbust.value is None or bust.value is None:
        return [], say(underbust.note or bust.note)
    answers = sizes(underbust.value, bust.value, allowance_mm)
    return [_view(key, answer) for key, answer in answers.items()], ""


def _view(key: str, answer: SizeAnswer) -> SizeView:
    doubts = [f"• {each.told(language())}" for each in answer.doubts]
    return SizeView(
        key,
        key.upper() if len(key) == 2 else answer.table.system,
        answer.label or "\N{EN DASH}",
        " ".join(say(each) for each in answer.rule),
        tuple(_near(answer)),
        "\n".join([answer.table.title.told(language()), *doubts]),
    )


def _near(answer: SizeAnswer) -> Iterator[str]:
    for each in answer.neighbours:
        missing = number(each.missing_mm, 1)
        yield _words(each).format(size=each.label or each.name, mm=missing)
    if answer.sisters:
        labels = ", ".join(each.label for each in answer.sisters)
        yield tr("Sister sizes: {sizes}").format(sizes=labels)


def _words(neighbour: Neighbour) -> str:
    if neighbour.part == "band":
        more, less = tr("{size}: under-bust {mm} mm more"), tr("{size}: under-bust {mm} mm less")
    else:
        more, less = tr("{size}: bust {mm} mm more"), tr("{size}: bust {mm} mm less")
    return more if neighbour.up else less
