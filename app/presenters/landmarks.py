"""A landmark as a list shows it."""

from __future__ import annotations

from dataclasses import dataclass

from app.i18n.catalog import say, tr
from app.i18n.lengths import length
from core.landmarks.types import CERTAIN


def tone_of(confidence: float) -> str:
    """Return the tone of a landmark's confidence 0..1: ok if certain, bad below 0.3, warn between them."""
    return "ok" if confidence >= CERTAIN else "warn" if confidence >= 0.3 else "bad"


@dataclass(frozen=True)
class LandmarkView:
    """What is shown of a landmark; ``confidence`` 0..1, ``group`` bust, under or further.

    ``absent``: it was not found, and can be placed. ``weak``: the control mesh hangs on it and it could
    hardly be seen, or a hand has put it ``off_mm`` from where its rule finds it. ``traced``: it was
    read from a curve on the skin. List, pins and step have ``tone`` and ``state`` from here alone.
    """

    name: str
    title: str
    confidence: float
    rule: str
    group: str = "bust"
    by_hand: bool = False
    absent: bool = False
    weak: bool = False
    traced: bool = False
    off_mm: float = 0.0

    @property
    def tone(self) -> str:
        """The token of its colour: amber and red are for what wants a look, and for nothing else."""
        if self.by_hand:
            return "warn" if self.weak else "accent"
        tone = tone_of(self.confidence)
        return "control" if self.absent or not (self.weak or tone == "ok") else tone

    @property
    def sureness(self) -> str:
        """What colour and mark say: certain, doubtful, unneeded; empty if placed by hand, or absent."""
        if self.absent or (self.by_hand and not self.weak):
            return ""
        return {"ok": "certain", "control": "unneeded"}.get(self.tone, "doubtful")

    @property
    def state(self) -> str:
        """How it came to be there, or how sure it is, in a word or two."""
        if self.absent:
            return tr("not found")
        if self.by_hand:
            off = tr("by hand, {length} off").format(length=length(self.off_mm, 0))
            return off if self.off_mm else tr("by hand")
        return f"{self.confidence * 100:.0f} %"

    def words(self) -> str:
        """Return the rule that it was found by, what it was read from, and what its colour says."""
        read = tr("The curve that it was read from is drawn on the body.")
        grey = tr("Not certain, and grey: the model does not hang on it.")
        sure = tr("Certain: from {least} % on it needs no second look.")
        doubtful = tr("Doubtful: below {least} % it wants a look.")
        said = {"certain": sure, "doubtful": "" if self.by_hand else doubtful, "unneeded": grey}
        told = said.get(self.sureness, "").format(least=f"{CERTAIN * 100:.0f}")
        return "\n".join([say(self.rule), *[read] * self.traced, *[told] * bool(told)])
