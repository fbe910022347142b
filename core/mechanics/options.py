"""Mechanics: the choices that make up the model, one small immutable value.

Each is also a field of ``Design``, by the same name and default, which is what is saved.
"""

from __future__ import annotations

from dataclasses import dataclass

LAWS = ("force-density", "prestressed", "co-rotated")
LINE_FORCES = ("implicit", "explicit")
CONTACTS = ("glued", "sliding")
LINE_HOLDS = ("spring", "held")
VOLUMES = ("each", "both")
TISSUES = ("net", "solid")
POSTURES = ("standing", "leaning", "lying", "unloaded")

SAG = 20.0
"""Rise of the bust points when their weight is taken, where nothing is known of the person [mm]: assumed."""

DENSITY = 0.95
"""Density of breast tissue where nothing is known of the person, between fat and gland [kg/l]: assumed."""

DEFAULT_LINE_STIFFNESS = 16.0
"""Stiffness of a line segment in units of the cables' mean stiffness at a point [1]; ours."""


@dataclass(frozen=True)
class ModelOptions:
    """How members, lines and volume act; the paper leaves all of it open, so the choices are ours.

    ``member_law`` is that of the cables: "force-density" (a constant force for each mm of shift),
    "prestressed" (Hooke cables of natural length (1 - ``prestress``) times that at rest) or "co-rotated"
    (shapes of the neighbourhood turn freely). ``line_stiffness`` [1] in units of the cables' mean stiffness
    at a point. ``line_force`` tells whether a turn solves for the line's force together with the cables
    ("implicit") or keeps it during the turn ("explicit", the paper to the letter); both end in the same
    place. ``line_contact`` "glued" lets the whole force of a line act on the skin, "sliding" only its part
    across the skin, the garment carries the rest. ``line_hold``: a line is a "spring" (paper section 3) or
    its length is "held" exactly, under one tension. ``firm_chest`` [1] ties points to their rest, the more
    the thinner the tissue below; 0 not at all, 0.1 firm. ``volume_of`` tells what the exact answer holds:
    "each" breast, or the sum of "both". ``tissue`` is the "net" of cables (paper section 2) or a "solid"
    with weight under the skin (ours), as soft as its ``sag`` [mm] tells: the rise of the bust points when
    their weight is taken; its ``density`` [kg/l] makes the weight. ``posture``: the person stands as scanned,
    leans forward by 30 degrees, lies on the back, or has no weight.
    """

    member_law: str = "force-density"
    prestress: float = 0.5
    line_stiffness: float = DEFAULT_LINE_STIFFNESS
    line_force: str = "implicit"
    line_contact: str = "glued"
    line_hold: str = "spring"
    firm_chest: float = 0.0
    volume_of: str = "each"
    tissue: str = "net"
    sag: float = SAG
    density: float = DENSITY
    posture: str = "standing"


CHOICES = {
    "member_law": LAWS,
    "line_force": LINE_FORCES,
    "line_contact": CONTACTS,
    "line_hold": LINE_HOLDS,
    "volume_of": VOLUMES,
    "tissue": TISSUES,
    "posture": POSTURES,
}
"""The words that each choice allows."""

RANGES = {
    "prestress": (0.1, 1.0),
    "line_stiffness": (0.1, 500.0),
    "firm_chest": (0.0, 1.0),
    "sag": (1.0, 100.0),
    "density": (0.85, 1.15),
}
"""The least and the largest number that each setting allows."""
