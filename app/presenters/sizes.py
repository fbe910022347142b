"""Format band and cup sizes: the size in every system, its rule, neighbouring sizes, caveats."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from html import escape

from app.i18n.catalog import colon, joined, language, listed, tr
from app.i18n.lengths import length
from app.presenters.messages import render
from core.measurements.girdle_sizes import GIRTHS_OF_GIRDLES, girdle_tables
from core.measurements.sizes import GIRTHS_OF_SIZES, Neighbour, SizeAnswer, letter_sizes, neighbours_of, sizes
from core.measurements.table import Measures
from core.measurements.uncertain_value import BEFORE, OutputUncertainties


def size_views(
    measured: Measures, allowance_mm: float, spread: OutputUncertainties | None = None
) -> tuple[list[SizeView], str]:
    """Return the sizes of a body in every system, or none and why; ``spread`` adds others within the ±."""
    underbust, bust = (measured[key] for key in GIRTHS_OF_SIZES)
    if underbust.value is None or bust.value is None:
        return [], render(underbust.note or bust.note)
    answers = sizes(underbust.value, bust.value, allowance_mm)
    letters, girdles = {"jp": tuple(_letters(measured))}, tuple(_girdles(measured))
    return [
        _view(key, answer, letters.get(key, ()), within_text(answer, spread), girdles)
        for key, answer in answers.items()
    ], ""


def within_text(answer: SizeAnswer, spread: OutputUncertainties | None) -> str:
    """Return which other sizes lie within what both girths may be off, once all of that is known."""
    offs = [spread.plus_minus(f"{BEFORE}:{key}") for key in GIRTHS_OF_SIZES] if spread else [None]
    known = [off for off in offs if off is not None]
    if len(known) < len(GIRTHS_OF_SIZES) or not answer.inside:
        return ""
    others = neighbours_of(answer, *known)
    if not others:
        return tr("No other size within ±.")
    return tr("Also within ±: {sizes}").format(sizes=listed(others))


def _letters(measured: Measures) -> Iterator[str]:
    """Yield the sizes in letters of Japan that go by a girth which the scan shows."""
    for table in letter_sizes().tables:
        girth = measured[table.girth].value
        found = table.sizes(girth) if girth is not None else ()
        if found:
            yield f"{table.title.told(language())}{colon()}{' / '.join(found)}"


def _girdles(measured: Measures) -> Iterator[str]:
    """Yield the girdle size in each table of the user's own, and why a table cannot be read."""
    tables, problems = girdle_tables()
    waist, hip = (measured[key].value for key in GIRTHS_OF_GIRDLES)
    if waist is not None and hip is not None:
        for table in tables:
            found = " / ".join(table.sizes(waist, hip)) or tr("no size fits waist and hip")
            yield tr("Girdle, {table}: {size}").format(table=table.title, size=found)
    yield from (render(problem.message) for problem in problems)


def _view(
    key: str, answer: SizeAnswer, letters: tuple[str, ...], within: str, girdles: tuple[str, ...]
) -> SizeView:
    texts = (*answer.doubts, *(letter_sizes().doubts if letters else ()))
    doubts, caution = _unlike([each.told(language()) for each in texts]), answer.table.caution
    return SizeView(
        key,
        key.upper() if len(key) == 2 else answer.table.system,
        answer.label or "\N{EN DASH}",
        joined(render(each) for each in answer.rule),
        (*_near(answer), *letters, *girdles),
        answer.table.title.told(language()),
        doubts,
        caution.told(language()) if caution else "",
        doubts[0] if caution and doubts else "",
        within,
    )


def _unlike(sentences: list[str]) -> tuple[str, ...]:
    """Return sentences without those that are contained in another one."""
    return tuple(one for one in sentences if not any(one != each and one in each for each in sentences))


def _near(answer: SizeAnswer) -> Iterator[str]:
    """Yield a line on the next bands, one on the next cups and one on the sister sizes."""
    lines = {
        "band": tr("Under-bust girth {sizes}"),
        "cup": tr("Bust girth {sizes}"),
    }
    for part, words in lines.items():
        near = [_away(each) for each in answer.neighbours if each.part == part]
        if near:
            yield words.format(sizes=" · ".join(near))
    if answer.sisters:
        labels = listed(each.label for each in answer.sisters)
        yield tr("Sister sizes: {sizes}").format(sizes=labels)


def _away(neighbour: Neighbour) -> str:
    """Return how far a size beside this one is, and which it is."""
    missing = neighbour.missing_mm if neighbour.up else -neighbour.missing_mm
    return f"{length(missing, signed=True)}{colon()}{neighbour.label or neighbour.name}"


@dataclass(frozen=True)
class SizeView:
    """The size in one system: how it is written, the rule that found it, and what lies ``near`` it.

    ``short`` is the system in a few letters, ``system`` its name; ``doubts`` are what is uncertain in it.
    Where others may find quite another size, ``caution`` says so in a few words and ``doubt`` in a sentence.
    ``within`` says which other sizes lie within what the girths may be off.
    """

    key: str
    short: str
    size: str
    rule: str
    near: tuple[str, ...]
    system: str
    doubts: tuple[str, ...]
    caution: str = ""
    doubt: str = ""
    within: str = ""

    @property
    def title(self) -> str:
        """Return the name of the system with the size."""
        return f"{self.short} {self.size}"

    @property
    def tip(self) -> str:
        """Return the tooltip, as rich text."""
        return "".join(f"<p>{escape(each)}</p>" for each in (self.system, *self.doubts))
