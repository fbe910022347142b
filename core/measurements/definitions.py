"""Definitions of all measurements: name, unit and method.

The value of each key is yielded by ``girths.py``, ``bust.py`` or ``lower_measures.py``; window, report and
files follow. The guide shows a picture of each and is not built without it: draw a new one with
``.venv/bin/python packaging/docs_pictures.py measures``, after ``packaging/measure_marks.py`` has its curves.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from core.geometry.mesh import Points
from core.landmarks.lower_trunk.girths import BELOW_FOLD
from core.landmarks.types import SIDES
from core.messages import EMPTY, Length, Message


@dataclass(frozen=True)
class Definition:
    """What a measure is.

    ``iso`` is what ISO 8559-1 calls it, empty where that has no such measure or ours is another one; ``text``
    says how it is taken, ``group`` where it stands in a list. One that is ``sided`` is there for the left and
    for the right, with that added to its key. One of the ``lower`` trunk needs that region in the design.
    """

    key: str
    title: Message
    unit: str
    iso: str
    text: Message
    group: Message
    sided: bool = False
    lower: bool = False

    @property
    def keys(self) -> tuple[str, ...]:
        """Return the keys of its measures: its own, or one of each side."""
        return tuple(f"{self.key}_{side}" for side in SIDES) if self.sided else (self.key,)


@dataclass(frozen=True, eq=False)
class Measure:
    """What was measured: ``value`` in ``unit``, None if the scan does not show it; ``note`` then says why.

    ``curves``, each (k, 3) [mm], show it on the body. ``confidence`` (0..1) is that of what it was taken
    from; an ``estimate`` rests on something that the scan does not show, and may be off by ``plus_minus``.
    ``text`` says how one of the designer's own is taken; of all others the definition does.
    """

    key: str
    value: float | None
    unit: str
    curves: tuple[Points, ...] = ()
    confidence: float = 1.0
    estimate: bool = False
    plus_minus: float = 0.0
    note: Message = EMPTY
    text: Message = EMPTY


GIRTHS, CUPS, BUST = Message("Girths"), Message("Cups"), Message("Bust")
AREAS, BOTH = Message("Sections and volumes"), Message("Symmetry")
WAIST_HIPS, SEAT = Message("Waist and hips"), Message("Seat")

TAPE = Message("Horizontal tape around the trunk, bridging hollows, without arms.")
"""How a tape lies, said of every girth."""

_SKIN = Message("Girth along the skin at the same level, including hollows.")

_TABLE = (
    Definition(
        "bust_girth",
        Message("Bust girth"),
        "mm",
        "Bust girth",
        Message(
            "At the mean height of the bust points. {tape} In the standard, the girth is measured over a "
            "brassiere.",
            tape=TAPE,
        ),
        GIRTHS,
    ),
    Definition(
        "bust_girth_skin",
        Message("Bust outline"),
        "mm",
        "",
        Message("Defined by Busk. {text}", text=_SKIN),
        GIRTHS,
    ),
    Definition(
        "underbust_girth",
        Message("Under-bust girth"),
        "mm",
        "Under bust girth",
        Message(
            "Directly below the breasts, at the first level without breast tissue. {tape}",
            tape=TAPE,
        ),
        GIRTHS,
    ),
    Definition(
        "underbust_girth_skin",
        Message("Under-bust outline"),
        "mm",
        "",
        Message("Defined by Busk. {text}", text=_SKIN),
        GIRTHS,
    ),
    Definition(
        "high_bust_girth",
        Message("High bust girth"),
        "mm",
        "",
        Message("Defined by Busk: horizontal, just below the lower armpit. {tape}", tape=TAPE),
        GIRTHS,
    ),
    Definition(
        "high_bust_girth_skin",
        Message("High bust outline"),
        "mm",
        "",
        Message("Defined by Busk. {text}", text=_SKIN),
        GIRTHS,
    ),
    Definition(
        "waist_girth",
        Message("Waist girth (narrowest)"),
        "mm",
        "Waist girth",
        Message(
            "At the narrowest level of the trunk. {tape} The standard uses the level midway between lowest "
            "rib and hip bone, which a scan does not show.",
            tape=TAPE,
        ),
        GIRTHS,
    ),
    Definition(
        "waist_girth_skin",
        Message("Waist outline (narrowest)"),
        "mm",
        "",
        Message("Defined by Busk. {text}", text=_SKIN),
        GIRTHS,
    ),
    Definition(
        "belly_girth",
        Message("Belly girth"),
        "mm",
        "",
        Message("Defined by Busk: at the landmark of the belly. {tape}", tape=TAPE),
        GIRTHS,
        lower=True,
    ),
    Definition(
        "high_hip_girth",
        Message("High hip girth"),
        "mm",
        "Top hip girth",
        Message(
            "At the height of the line High hip, 72 % of the way from the line Waist down to the line Hip. "
            "{tape} The standard uses the level midway between waist and hip.",
            tape=TAPE,
        ),
        GIRTHS,
        lower=True,
    ),
    Definition(
        "hip_girth",
        Message("Hip girth"),
        "mm",
        "Hip girth",
        Message(
            "At the largest trunk girth below the waist. {tape} The standard uses the greatest "
            "prominence of the buttocks.",
            tape=TAPE,
        ),
        GIRTHS,
    ),
    Definition(
        "hip_girth_skin",
        Message("Hip outline"),
        "mm",
        "",
        Message("Defined by Busk. {text}", text=_SKIN),
        GIRTHS,
    ),
    Definition(
        "buttock_girth",
        Message("Buttock girth"),
        "mm",
        "Hip girth",
        Message(
            "At the mean height of the buttock points, where the seat is most prominent. {tape}", tape=TAPE
        ),
        GIRTHS,
        lower=True,
    ),
    Definition(
        "thigh_girth",
        Message("Thigh girth"),
        "mm",
        "Thigh girth",
        Message(
            "Horizontal tape around the thigh, {below} below gluteal fold or crotch, whichever is lower. "
            "The standard uses the widest level below the gluteal fold.",
            below=Length(BELOW_FOLD),
        ),
        GIRTHS,
        sided=True,
        lower=True,
    ),
    Definition(
        "bust_point_distance",
        Message("Bust point distance"),
        "mm",
        "",
        Message("Straight distance between the bust points."),
        BUST,
    ),
    Definition(
        "bust_point_to_fold",
        Message("Bust point to fold"),
        "mm",
        "",
        Message("Shortest path over the skin from the bust point to the inframammary fold below."),
        CUPS,
        True,
    ),
    Definition(
        "cup_depth",
        Message("Cup depth"),
        "mm",
        "",
        Message(
            "Defined by Busk: horizontal distance of the bust point from the straight line "
            "between the inner and outer ends of the breast root."
        ),
        CUPS,
        True,
    ),
    Definition(
        "cup_width",
        Message("Cup width"),
        "mm",
        "",
        Message(
            "Defined by Busk: straight distance between the inner and outer ends of the breast "
            "root, at bust point height."
        ),
        CUPS,
        True,
    ),
    Definition(
        "root_length",
        Message("Root length"),
        "mm",
        "",
        Message(
            "Defined by Busk: length of the breast root along the wire, from the inner end "
            "through the inframammary fold to the outer end."
        ),
        CUPS,
        True,
    ),
    Definition(
        "bust_height",
        Message("Bust height over under-bust"),
        "mm",
        "",
        Message(
            "Defined by Busk: mean height of the bust points above under-bust level. That level follows "
            "the skin and rises with the breast, so the value may decrease while the bust points rise. In "
            "the standard, the height is measured from the floor, which few scans include."
        ),
        BUST,
    ),
    Definition(
        "bust_protrusion",
        Message("Bust protrusion"),
        "mm",
        "",
        Message(
            "Defined by Busk: mean forward distance of the apexes of both breasts from the "
            "centre of the chest at under-bust level."
        ),
        BUST,
    ),
    Definition(
        "apex_lift",
        Message("Apex lift"),
        "mm",
        "",
        Message("Defined by Busk: mean rise of the apexes of both breasts from the original body."),
        BUST,
    ),
    Definition(
        "section_area_bust",
        Message("Bust area"),
        "cm2",
        "",
        Message("Defined by Busk: area enclosed by the skin at the level of the bust girth."),
        AREAS,
    ),
    Definition(
        "section_area_underbust",
        Message("Under-bust area"),
        "cm2",
        "",
        Message("Defined by Busk: area enclosed by the skin at the level of the under-bust girth."),
        AREAS,
    ),
    Definition(
        "breast_volume",
        Message("Breast volume"),
        "ml",
        "",
        Message(
            "Defined by Busk, estimate: volume between the skin within the breast root and a smooth chest "
            "wall extrapolated from the surrounding skin. This is the protruding part only, less than the "
            "whole breast. The top of the breast root is not visible and is assumed at half the root width "
            "above its ends; ± is the effect of assuming the top {lower} lower. After reshaping, the "
            "change in volume under the skin on the same side is added.",
            lower=Length(15.0),
        ),
        AREAS,
        True,
    ),
    Definition(
        "asymmetry_height",
        Message("Left bust point higher"),
        "mm",
        "",
        Message("Defined by Busk: height of the left bust point above the right one."),
        BOTH,
    ),
    Definition(
        "asymmetry_forward",
        Message("Left bust point further forward"),
        "mm",
        "",
        Message("Defined by Busk: forward distance of the left bust point from the right one."),
        BOTH,
    ),
    Definition(
        "asymmetry_volume",
        Message("Excess volume, left minus right"),
        "ml",
        "",
        Message(
            "Defined by Busk: net volume by which the left breast protrudes beyond the mirror image of the "
            "right one; negative where the right one protrudes more. The same value as under Symmetry."
        ),
        BOTH,
    ),
    Definition(
        "waist_hip_ratio",
        Message("Waist-to-hip ratio"),
        "",
        "",
        Message("Waist girth divided by hip girth."),
        WAIST_HIPS,
        lower=True,
    ),
    Definition(
        "waist_to_hip",
        Message("Waist to hip"),
        "mm",
        "",
        Message(
            "Defined by Busk: vertical distance from the level of the waist girth to that of the hip girth."
        ),
        WAIST_HIPS,
        lower=True,
    ),
    Definition(
        "crotch_length",
        Message("Crotch length"),
        "mm",
        "Total crotch length",
        Message(
            "Along the skin of the midline, from the waist in front through the crotch to the waist behind. "
            "The curve follows the cleft, which a tape may bridge."
        ),
        WAIST_HIPS,
        lower=True,
    ),
    Definition(
        "seat_protrusion",
        Message("Seat protrusion"),
        "mm",
        "",
        Message(
            "Defined by Busk: mean backward distance of the buttock points from the centre of the back at "
            "waist level."
        ),
        SEAT,
        lower=True,
    ),
    Definition(
        "gluteal_fold_height",
        Message("Gluteal fold above crotch"),
        "mm",
        "",
        Message(
            "Defined by Busk: height of the gluteal fold above the crotch, negative if the fold is lower. "
            "The crotch does not move, so the change is the lift of the fold."
        ),
        SEAT,
        sided=True,
        lower=True,
    ),
    Definition(
        "seat_volume",
        Message("Seat volume"),
        "ml",
        "",
        Message(
            "Defined by Busk: volume between the skin over the seat zone of the control mesh and the middle "
            "of that mesh. The border of the zone is ours: compare before with after."
        ),
        SEAT,
        sided=True,
        lower=True,
    ),
)

DEFINITIONS: Mapping[str, Definition] = MappingProxyType({each.key: each for each in _TABLE})
"""What every measure is, by its key without a side, in the order in which they are shown."""

KEYS = tuple(key for each in _TABLE for key in each.keys)
"""The keys of all measures, in the same order."""

LOWER_KEYS = frozenset(key for each in _TABLE if each.lower for key in each.keys)
"""The keys of the measures that need the lower trunk."""


def definition_of(key: str) -> tuple[Definition, str]:
    """Return what a measure is and its side, "left", "right" or empty. Raises KeyError for an own measure."""
    if key in DEFINITIONS:
        return DEFINITIONS[key], ""
    name, _, side = key.rpartition("_")
    return DEFINITIONS[name], side


def missing(key: str, why: Message) -> Measure:
    """Return a measure that the scan does not show, with the reason."""
    return Measure(key, None, definition_of(key)[0].unit, confidence=0.0, note=why)
