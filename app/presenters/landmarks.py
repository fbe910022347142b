"""Format landmarks: titles, groups, and the rows of the list."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass

from app.i18n.catalog import tr
from app.i18n.lengths import length
from app.presenters.messages import render
from core.landmarks.types import ALL_NAMES, CERTAIN, LOWER_NAMES, NAMES, POOR, Landmark
from core.landmarks.warnings import ESSENTIAL

GROUPS = {
    "bust_point": "bust",
    "lowest": "bust",
    "fold": "under",
    "root_inner": "under",
    "root_outer": "under",
    **dict.fromkeys(("crotch", "waist", "belly", "hip", "buttock", "gluteal_fold"), "lower"),
    **dict.fromkeys(("iliac_crest", "side_seam", "leg_opening"), "lower"),
}
"""The group of each kind of landmark in the list; all others are further ones."""

PINNED = ("bust_point", "lowest", "fold")
"""The kinds of landmarks that always have a pin at the Landmarks step."""


Spot = tuple[str, tuple[float, ...]]
"""A landmark's name and where it lies, to a tenth of a millimetre."""


def spot_of(mark: Landmark) -> Spot:
    """Return by what a landmark is known again once all of them have been found anew."""
    return mark.name, tuple(mark.position.round(1).tolist())


def kind_of(name: str) -> str:
    """Return a landmark's name without its side."""
    return name.removesuffix("_left").removesuffix("_right")


def landmark_title(name: str) -> str:
    """Return a landmark's name in the window's language."""
    titles = {
        "bust_point": tr("Bust point"),
        "fold": tr("Inframammary fold"),
        "lowest": tr("Lowest point"),
        "root_inner": tr("Inner breast root"),
        "root_outer": tr("Outer breast root"),
        "front_centre": tr("Centre front, bust"),
        "front_centre_underbust": tr("Centre front, under-bust"),
        "back_centre": tr("Centre back, bust"),
        "back_centre_underbust": tr("Centre back, under-bust"),
        "side": tr("Side"),
        "armpit": tr("Armpit"),
        "waist_front": tr("Waist, front"),
        "hip_front": tr("Hip, front"),
        "neck_front": tr("Neck, front"),
        "neck_back": tr("Neck, back"),
        "crotch": tr("Crotch"),
        "waist": tr("Waist"),
        "belly": tr("Belly"),
        "hip": tr("Hip"),
        "buttock": tr("Buttock point"),
        "gluteal_fold": tr("Gluteal fold"),
        "iliac_crest": tr("Iliac crest"),
        "side_seam": tr("Side seam"),
        "leg_opening": tr("Leg opening"),
    }
    kind = kind_of(name)
    sides = {"_left": tr("{name} left"), "_right": tr("{name} right")}
    return sides.get(name[len(kind) :], "{name}").format(name=titles.get(kind, kind.replace("_", " ")))


def other_side(name: str) -> str:
    """Return the same landmark of the other side, or an empty text if it has no side."""
    for side, other in (("_left", "_right"), ("_right", "_left")):
        if name.endswith(side):
            return name.removesuffix(side) + other
    return ""


def landmark_views(points: Mapping[str, Landmark], accepted: Collection[Spot] = ()) -> list[LandmarkView]:
    """Return the rows of the list of landmarks, those of the bust first; the absent ones are among them.

    Those of the lower trunk are there if any was found. What is ``accepted`` need not be looked at again.
    """
    order = list(GROUPS)
    names = ALL_NAMES if any(name in points for name in LOWER_NAMES) else NAMES
    known = sorted(
        names, key=lambda name: order.index(kind_of(name)) if kind_of(name) in order else len(order)
    )
    return [landmark_view(name, points.get(name), accepted) for name in known]


def landmark_view(name: str, mark: Landmark | None, accepted: Collection[Spot] = ()) -> LandmarkView:
    """Return what is shown of a landmark, ``mark`` if it was found: in the list and on its pin alike."""
    title, group = landmark_title(name), GROUPS.get(kind_of(name), "further")
    if mark is None:
        return LandmarkView(name, title, 0.0, tr("Not detected on the scan."), group, absent=True)
    unsure = kind_of(name) in ESSENTIAL and not mark.by_hand and mark.confidence < CERTAIN
    weak = unsure or (mark.off > 0.0 and spot_of(mark) not in accepted)
    traced, off = len(mark.evidence) > 0, mark.off
    return LandmarkView(
        name,
        title,
        mark.confidence,
        render(mark.rule),
        group,
        mark.by_hand,
        weak=weak,
        traced=traced,
        off_mm=off,
    )


def tone_of(confidence: float) -> str:
    """Return the tone of a landmark's confidence 0..1: ok if certain, bad if poor, warn between them."""
    return "ok" if confidence >= CERTAIN else "warn" if confidence >= POOR else "bad"


@dataclass(frozen=True)
class LandmarkView:
    """What is shown of a landmark; ``confidence`` 0..1, ``group`` bust, under, lower or further.

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
        """Return the token of its colour: amber and red are for what wants a look, and for nothing else."""
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
        """Return how it came to be there, or how sure it is, in a word or two."""
        if self.absent:
            return tr("not detected")
        if self.by_hand:
            off = tr("manual, moved {length}").format(length=length(self.off_mm, 0))
            return off if self.off_mm else tr("manual")
        return f"{self.confidence * 100:.0f} %"

    def words(self) -> str:
        """Return the rule of its detection, its evidence, and the meaning of its colour."""
        read = tr("The curve used for detection is shown on the body.")
        grey = tr("Low confidence; not used by the model.")
        sure = tr("High confidence: {least} % or more needs no review.")
        doubtful = tr("Low confidence: below {least} % the landmark needs review.")
        texts = {"certain": sure, "doubtful": "" if self.by_hand else doubtful, "unneeded": grey}
        told = texts.get(self.sureness, "").format(least=f"{CERTAIN * 100:.0f}")
        return "\n".join([self.rule, *[read] * self.traced, *[told] * bool(told)])
