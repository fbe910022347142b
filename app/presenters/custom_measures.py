"""What is said of a measure of one's own: while it is made, and in the table."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace

from app.i18n.catalog import number, say, tr
from app.i18n.lengths import length, length_number
from app.presenters.scan import landmark_title
from core.document.custom_measures import LONGEST_NAME, OwnMeasure
from core.errors import UserError
from core.landmarks.types import CERTAIN
from core.measurements.definitions import Measure


def own_words(own: OwnMeasure) -> str:
    """Return how a measure of the designer's own is taken."""
    places = [landmark_title(name) for name in own.marks]
    if own.kind != "girth":
        ways = {
            "straight": tr("Yours: straight from {start} to {end}."),
            "skin": tr("Yours: the shortest way over the skin from {start} to {end}."),
        }
        return ways[own.kind].format(start=places[0], end=places[1])
    if not places:
        return tr("Yours: a tape, level, {length} above the lowest point of the scan.").format(
            length=length(own.level, 0)
        )
    at, above, below = (
        tr("Yours: a tape, level, at {place}."),
        tr("Yours: a tape, level, {length} above {place}."),
        tr("Yours: a tape, level, {length} below {place}."),
    )
    words = above if own.level > 0.0 else below if own.level < 0.0 else at
    return words.format(place=places[0], length=length(abs(own.level), 0))


def draft_of(own: OwnMeasure) -> Draft:
    """Return a measure as the form shows it."""
    if own.kind != "girth":
        return Draft(own.name, own.kind, (own.marks[0], own.marks[1]))
    at = own.marks[0] if own.marks else ""
    return Draft(own.name, own.kind, at=at, level=own.level)


def measure_of(draft: Draft, suggested: str, taken: Collection[str]) -> OwnMeasure | None:
    """Return the measure of a draft, None while a place is missing.

    Without a name it gets the ``suggested`` one. Raises UserError if its name is ``taken``.
    """
    if draft.kind != "girth" and not all(draft.ends):
        return None
    if draft.kind == "girth" and not draft.at and not draft.level:
        return None
    name = draft.name or _free(suggested, taken)
    if name in taken:
        raise UserError(f"There is a measure {name} already.", "Give it a name of its own.")
    return OwnMeasure(name, draft.kind, draft.marks, draft.level if draft.kind == "girth" else 0.0)


def suggested_name(draft: Draft, titles: Mapping[str, str]) -> str:
    """Return what a measure may be called if no name is typed, as far as it is known where it is taken."""
    if draft.kind != "girth":
        ends = [titles.get(mark, "") for mark in draft.ends]
        return f"{ends[0]} → {ends[1]}"[:LONGEST_NAME] if all(ends) else ""
    level = length(draft.level, 0, signed=bool(draft.at))
    if not draft.at:
        return tr("Girth at {height}").format(height=level) if draft.level else ""
    place = titles.get(draft.at, draft.at)
    if draft.level:
        place = f"{place} {level}"
    return tr("Girth, {place}").format(place=place)[:LONGEST_NAME]


def said_of(before: Measure, after: Measure) -> tuple[str, str, str]:
    """Return what a measure is now, what is said of it, and what is doubtful in it or why it is missing."""
    if before.value is None or after.value is None:
        return "", "", say(before.note or after.note)
    values = f"{length_number(before.value)} → {length(after.value)}"
    said = tr("before → after, {change}").format(
        change=length(round(after.value, 1) - round(before.value, 1), signed=True)
    )
    sure = min(before.confidence, after.confidence)
    unsure = tr("What it is taken from is sure to {percent} %").format(percent=number(100 * sure, 0))
    doubts = (unsure if sure < CERTAIN else "", say(after.note))
    return values, said, "\n".join(each for each in doubts if each)


def _free(name: str, taken: Collection[str]) -> str:
    """Return a name that is not taken, with a number if need be."""
    numbered = (f"{name[: LONGEST_NAME - 4]} {count}" for count in range(2, 1000))
    return name if name not in taken else next(each for each in numbered if each not in taken)


@dataclass(frozen=True)
class Draft:
    """A measure that is being made: as long as no place is chosen for an end, that is empty.

    A girth lies ``level`` [mm] above the landmark ``at``, or above the lowest point of the scan if that is
    empty. An empty ``name`` leaves it to Busk.
    """

    name: str = ""
    kind: str = "straight"
    ends: tuple[str, str] = ("", "")
    at: str = ""
    level: float = 0.0

    def picked(self, mark: str) -> Draft:
        """Return it with a landmark that was clicked: the next end, or given up if it was one already."""
        if self.kind == "girth":
            return replace(self, at=mark, level=self.level if self.at else 0.0)
        start, end = self.ends
        if mark in self.ends:
            return replace(self, ends=("" if start == mark else start, "" if end == mark else end))
        return replace(self, ends=(mark, end) if not start else (start, mark))

    def stepped_back(self) -> Draft:
        """Return it without the landmark that was chosen last."""
        if self.kind == "girth":
            return replace(self, at="", level=0.0)
        start, end = self.ends
        return replace(self, ends=(start, "") if end else ("", ""))

    @property
    def marks(self) -> tuple[str, ...]:
        """The landmarks it is taken at so far."""
        return tuple(mark for mark in ((self.at,) if self.kind == "girth" else self.ends) if mark)
