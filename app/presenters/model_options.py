"""Describe the model options: titles, effects, and which are those of the paper."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from app.i18n.catalog import number, tr
from app.i18n.lengths import length_unit, shown_digits, shown_value
from core.document.design import Design, ScanSource, new_design
from core.document.lower_trunk import LOWER_RANGES, LOWER_SETTINGS
from core.mechanics.options import RANGES

SOFT_LINE = 0.2
"""Line stiffness that goes with forces one turn late: stiffer lines would not come to rest [1]."""


@dataclass(frozen=True)
class Choice:
    """A field ``key`` of the design that is one of a few values, each with its words."""

    key: str
    title: str
    tip: str
    options: tuple[tuple[Any, str], ...]

    def words(self, value: Any) -> str:
        """Return the words for a value; one that is none of the options reads as the last."""
        return next((words for each, words in self.options if each == value), self.options[-1][1])


@dataclass(frozen=True)
class Amount:
    """A field ``key`` of the design that is a number, shown ``scale`` times as large with its ``unit``.

    ``limits`` are the least and the largest number; without them any can be typed. An ``optional`` one may
    be left empty.
    """

    key: str
    title: str
    tip: str
    unit: str
    scale: float
    digits: int
    limits: tuple[float, float] = (-math.inf, math.inf)
    optional: bool = False

    def words(self, value: float | None) -> str:
        """Return a value as it is written."""
        if value is None:
            return tr("automatic")
        return f"{number(self.scale * value, self.digits)} {self.unit}".strip()


def length_amount(
    key: str, title: str, tip: str, limits: tuple[float, float], *, optional: bool = False
) -> Amount:
    """Return an amount of tenths of a millimetre, shown in the unit in use; ``limits`` [mm]."""
    return Amount(key, title, tip, length_unit(), shown_value(1.0), shown_digits(1), limits, optional)


@dataclass(frozen=True)
class ControlText:
    """What a volume control is called: as an option, in the menu, and beside its curve in the plots.

    ``button`` and ``tip`` are those under the verdict; a control without them is not offered there.
    """

    option: str
    menu: str
    curve: str
    button: str = ""
    tip: str = ""


Setting = Choice | Amount
Group = tuple[str, tuple[Setting, ...]]


def groups() -> tuple[Group, ...]:
    """Return all settings of the model, by what they are about."""
    return (
        (tr("Lines"), (_contact(), _hold(), _stiffness(), _height(), _force())),
        (tr("Tissue"), (_tissue(), _sag(), _density(), _posture())),
        (tr("Body"), (_chest(), _law(), _prestress(), _weights(), _normals())),
        (tr("Volume"), (_control(), _volume_of(), _dense(), _gain())),
        (
            tr("Waist, hips and seat"),
            (_belly_height(), _waist_kept(), _lower_firmness(), _lower_stiffness()),
        ),
    )


def defaults() -> dict[str, Any]:
    """Return what every setting of the model is in a new design."""
    usual = new_design(ScanSource(""))
    return {setting.key: usual.setting(setting.key) for _, settings in groups() for setting in settings}


def present_values(design: Design) -> dict[str, Any]:
    """Return every setting that a design has: those of the lower trunk only if it wears that."""
    keys = [key for key in defaults() if design.lower is not None or key not in LOWER_SETTINGS]
    return {key: design.setting(key) for key in keys}


def without_effect(present: Mapping[str, Any]) -> frozenset[str]:
    """Return the settings that change nothing beside the others: those of the other tissue, prestress.

    The lower trunk is on a net whatever the bust is on.
    """
    solid, below = present["tissue"] == "solid", LOWER_SETTINGS.keys() <= present.keys()
    if solid and not below:
        return frozenset({"firm_chest", "member_law", "prestress", "line_contact"})
    idle = {"firm_chest"} if solid else {"sag", "density", "posture"}
    return frozenset(idle if present["member_law"] == "prestressed" else {*idle, "prestress"})


def consequences(key: str, value: Any, present: Mapping[str, Any]) -> dict[str, Any]:
    """Return the fields that change when a setting is chosen: forces one turn late need a soft line."""
    changes = {key: value}
    stiffness = float(present["line_stiffness"])
    if key == "line_force" and value == "explicit" and stiffness > SOFT_LINE:
        changes["line_stiffness"] = SOFT_LINE
    if key == "line_force" and value == "implicit" and stiffness == SOFT_LINE:
        changes["line_stiffness"] = defaults()["line_stiffness"]
    return changes


def summary(present: Mapping[str, Any]) -> str:
    """Return in a line what is chosen: tissue and lines always, else what is not as in a new design.

    Of the numbers only those of the lower trunk are told, with their titles.
    """
    usual, idle = defaults(), without_effect(present)
    texts = []
    for setting in (each for _, settings in groups() for each in settings if each.key in present):
        changed, words = present[setting.key] != usual[setting.key], setting.words(present[setting.key])
        if setting.key in LOWER_SETTINGS:
            texts += [f"{setting.title} {words}"] if changed else []
        elif setting.key in ("line_contact", "line_hold", "tissue") or (
            isinstance(setting, Choice) and changed
        ):
            texts += [words] if setting.key not in idle else []
    return " · ".join(texts)


def _contact() -> Choice:
    tip = tr(
        "Choose how line tension acts on the skin. Bonded: in full, as in the paper. "
        "Frictionless sliding: only normal to the skin; this lifts the bust."
    )
    options = (("glued", tr("Bonded")), ("sliding", tr("Frictionless sliding")))
    return Choice("line_contact", tr("Skin contact"), tip, options)


def _hold() -> Choice:
    tip = tr(
        "Choose how the line length behaves. Elastic length: as a spring, as in the paper. Fixed "
        "length: exactly as set, at any tension."
    )
    options = (("spring", tr("Elastic length")), ("held", tr("Fixed length")))
    return Choice("line_hold", tr("Length"), tip, options)


def _stiffness() -> Amount:
    low, high = RANGES["line_stiffness"]
    tip = tr("Set the stiffness of lines relative to the body, {low} to {high}; not given in the paper.")
    return Amount(
        "line_stiffness", tr("Stiffness"), tip.format(low=low, high=number(high, 0)), "×", 1.0, 1, (low, high)
    )


def _height() -> Amount:
    tip = tr(
        "Set the position of the mid-bust line between inframammary fold (0 %) and bust point "
        "(100 %), from 25 to 75 %."
    )
    return Amount("line_height", tr("Mid-bust line height"), tip, "%", 100.0, 0, (0.25, 0.75))


def _force() -> Choice:
    tip = tr(
        "Choose the iteration scheme for line forces. Implicit: cables and lines are solved in the same "
        "iteration. Explicit: line forces lag by one iteration, as in the paper; the solver converges only "
        "with very soft lines, so the line stiffness is reduced too."
    )
    options = (("implicit", tr("Implicit")), ("explicit", tr("Explicit")))
    return Choice("line_force", tr("Line force"), tip, options)


def _tissue() -> Choice:
    tip = tr(
        "Choose the tissue under the skin. Net: cables along the control mesh, as in the paper. Solid: soft "
        "tissue with weight between skin and chest wall; its forces are in newtons."
    )
    return Choice(
        "tissue", tr("Tissue"), tip, (("net", tr("Net (paper)")), ("solid", tr("Solid with weight")))
    )


def _sag() -> Amount:
    tip = tr(
        "Set how far the bust points rise when the weight of the breasts is taken, as by a hand or lying "
        "down: the softness of solid tissue. The default is an assumption; half or twice as much is "
        "plausible."
    )
    unit, digits = length_unit(), shown_digits(0)
    return Amount("sag", tr("Sag"), tip, unit, shown_value(1.0), digits, RANGES["sag"])


def _density() -> Amount:
    tip = tr("Set the density of solid tissue: fat has 0.92 kg/l. Forces are proportional to it.")
    return Amount("density", tr("Density"), tip, "kg/l", 1.0, 2, RANGES["density"])


def _posture() -> Choice:
    tip = tr(
        "Choose the posture to compute with solid tissue: standing as scanned, leaning forward by 30 "
        "degrees, lying on the back, or without weight."
    )
    options = (
        ("standing", tr("Standing")),
        ("leaning", tr("Leaning forward")),
        ("lying", tr("Lying on the back")),
        ("unloaded", tr("Without weight")),
    )
    return Choice("posture", tr("Posture"), tip, options)


def _chest() -> Choice:
    tip = tr(
        "Choose the support of the chest. None: points are held by their neighbours only, as in "
        "the paper. Rib-cage support: thin tissue over the ribs holds the skin near its original "
        "position."
    )
    return Choice("firm_chest", tr("Chest"), tip, ((0.0, tr("None")), (0.1, tr("Rib-cage support"))))


def _law() -> Choice:
    tip = tr(
        "Choose the force law of the control mesh cables: constant force per millimetre of length, "
        "prestressed springs, or co-rotational. Not given in the paper."
    )
    options = (
        ("force-density", tr("Force density")),
        ("prestressed", tr("Prestressed springs")),
        ("co-rotated", tr("Co-rotational")),
    )
    return Choice("member_law", tr("Cables"), tip, options)


def _prestress() -> Amount:
    tip = tr("Set the initial elongation of prestressed springs, 10 to 100 % (no value in the paper).")
    return Amount("prestress", tr("Spring prestress"), tip, "%", 100.0, 0, RANGES["prestress"])


def _weights() -> Choice:
    tip = tr(
        "Choose the interpolation of skin between control points. Smooth: by the distance to "
        "each triangle. Paper: by the distance to the triangle centre; the skin may crease."
    )
    options = (("smooth", tr("Smooth")), ("paper", tr("Paper")))
    return Choice("weights", tr("Skin interpolation"), tip, options)


def _normals() -> Choice:
    tip = tr(
        "Keep the distance between skin and control mesh constant (paper), or scale it with the triangle "
        "size."
    )
    options = ((False, tr("Constant")), (True, tr("Scaled")))
    return Choice("scaled_normals", tr("Distance to mesh"), tip, options)


def control_text(control: str) -> str:
    """Return the name of an edit that chooses a volume control."""
    return tr("Volume control: {control}").format(control=_control().words(control))


def control_texts() -> dict[str, ControlText]:
    """Return the texts of every volume control in the order of lists; ``accumulating`` is called integral."""
    return {
        "adaptive": ControlText(
            tr("Adaptive"),
            tr("Adaptive volume control"),
            tr("Adaptive"),
            tr("Adaptive"),
            tr("Adaptive: adjusts the volume force at every iteration"),
        ),
        "conventional": ControlText(
            tr("Conventional"),
            tr("Conventional volume control"),
            tr("Conventional"),
            tr("Conventional"),
            tr("Conventional: volume force proportional to the volume error; may oscillate"),
        ),
        "accumulating": ControlText(tr("Integral"), tr("Integral volume control"), tr("Integral")),
        "none": ControlText(
            tr("None"),
            tr("No volume control"),
            tr("No volume control"),
            tr("Off"),
            tr("Volume is not conserved"),
        ),
        "exact": ControlText(
            tr("Exact"),
            tr("Exact solution"),
            tr("Exact"),
            tr("Exact"),
            tr("Exact: conserves the volume in one direct solution"),
        ),
    }


def _control() -> Choice:
    tip = tr(
        "Choose the volume control: the paper's conventional and adaptive forces (adaptive formula by "
        "Busk), integral control that accumulates half of each error, the exact solution, or none."
    )
    options = tuple((control, text.option) for control, text in control_texts().items())
    return Choice("volume", tr("Volume control"), tip, options)


def _volume_of() -> Choice:
    tip = tr(
        "Conserve the volume of each breast, or of both combined. For the exact solution only; "
        "iterations conserve the combined volume (paper)."
    )
    options = (("each", tr("Per breast")), ("both", tr("Combined")))
    return Choice("volume_of", tr("Conserve volume"), tip, options)


def _dense() -> Choice:
    tip = tr(
        "Choose the volume that the exact solution conserves: that of the control mesh, as in "
        "the paper, or of the scanned body."
    )
    return Choice("dense_volume", tr("Volume of"), tip, ((False, tr("Control mesh")), (True, tr("Body"))))


def _gain() -> Amount:
    tip = tr(
        "Set the volume force per volume error of conventional control, from 0 to 10. Leave empty for 97 % "
        "of the gain at which oscillation starts."
    )
    return Amount("gain", tr("Conventional gain"), tip, "", 1.0, 2, (0.0, 10.0), optional=True)


def _belly_height() -> Amount:
    tip = tr("Set the position of the belly line between waist (0 %) and hip (100 %), from 35 to 55 %.")
    limits = LOWER_RANGES["belly_height"]
    return Amount("belly_line_height", tr("Belly line height"), tip, "%", 100.0, 0, limits)


def _waist_kept() -> Amount:
    tip = tr(
        "Set how much of the volume that lines displace at the waist stays under the skin there. The rest "
        "is assumed to move inward under the ribs. The default is an assumption."
    )
    return Amount("waist_kept", tr("Volume kept at waist"), tip, "%", 100.0, 0, LOWER_RANGES["waist_kept"])


def _lower_firmness() -> Amount:
    tip = tr(
        "Set how firmly thin tissue holds the skin of waist, hips and seat near its original position, "
        "0 (not at all) to 1."
    )
    return Amount("lower_firmness", tr("Firmness"), tip, "", 1.0, 2, LOWER_RANGES["firmness"])


def _lower_stiffness() -> Amount:
    tip = tr(
        "Set the tissue stiffness of waist, hips and seat, 10 to 5000 N/m. All forces and pressures there "
        "are proportional to it; the shape does not change, except with elastics."
    )
    return Amount("lower_stiffness", tr("Tissue stiffness"), tip, "N/m", 1.0, 0, LOWER_RANGES["stiffness"])
