"""Format cups: their settings, and what they do to the breasts."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from app.i18n.catalog import colon, number, tr, tr_context
from app.i18n.lengths import length, length_unit, shown_digits, shown_value
from app.presenters.bust_shift import bust_shift, step_text
from app.presenters.messages import render_all
from app.presenters.model_options import Amount, Choice
from app.presenters.pressure import TONES, kpa_text, rating_text
from app.presenters.status import invalid_reason
from core.document.cup import CUP_RANGES, Cup
from core.document.design import Design
from core.garment.cup_fit import CupFit, CupSide, WornCups
from core.garment.pressure import pressure_limits
from core.garment.wires import nearest_wires
from core.pipeline.live_solver import Frame

NO_CUPS = ""
"""The kind of a design without cups."""

AMOUNTS = {"moulded": ("lift", "forward", "gather"), "sewn": ("across", "upright")}
"""The numbers that the shape of each kind of cup has."""

_STARTS: dict[str, dict[str, Any]] = {
    "moulded": {"lift": 20.0, "forward": 5.0},
    "sewn": {"across": 0.97, "upright": 0.95},
}  # with which cups that were not set before show what they do


def kind_choice() -> Choice:
    """Return the choice of cups, or of none."""
    tip = tr(
        "Choose the cups. Moulded: keep their own shape, raised and shifted from the breast. Sewn: cloth cut "
        "smaller than the skin that it covers."
    )
    options = ((NO_CUPS, tr("None")), ("moulded", tr("Moulded")), ("sewn", tr("Sewn")))
    return Choice("kind", tr("Cups"), tip, options)


def kind_titles() -> dict[str, str]:
    """Return what the kinds of cups are called in the menu."""
    return {NO_CUPS: tr("No cups"), "moulded": tr("Moulded cups"), "sewn": tr("Sewn cups")}


def coverage_choice() -> Choice:
    """Return the choice of how far up cups go."""
    tip = tr("Choose the upper edge of the cups: at the bust points, above, or near the upper chest.")
    options = (
        ("half", tr_context("coverage", "Half")),
        ("three-quarter", tr_context("coverage", "Three-quarter")),
        ("full", tr_context("coverage", "Full")),
    )
    return Choice("coverage", tr("Coverage"), tip, options)


def amounts() -> dict[str, Amount]:
    """Return the numbers of cups, by the field of ``Cup``."""
    length = length_unit(), shown_value(1.0), shown_digits(0)
    share = "%", 100.0, 0
    words = {
        "lift": (tr("Lift"), tr("Set how far the cup apex is above that of the breast."), length),
        "forward": (
            tr("Forward"),
            tr("Set how far the cup apex is in front of that of the breast; negative values flatten it."),
            length,
        ),
        "gather": (
            tr("Gather"),
            tr("Set how far each cup apex is nearer to the centre front than that of the breast."),
            length,
        ),
        "across": (tr("Across"), tr("Set the width of the cloth in % of the skin that it covers."), share),
        "upright": (tr("Upright"), tr("Set the height of the cloth in % of the skin that it covers."), share),
        "wire_width": (
            tr("Wire width"),
            tr("Set the width of the underwire in % of the breast root."),
            share,
        ),
    }
    return {key: Amount(key, title, tip, *form, CUP_RANGES[key]) for key, (title, tip, form) in words.items()}


def wire_texts() -> tuple[str, str]:
    """Return the title and the tip of the underwire."""
    return tr("Underwire"), tr("Hold the breast root in the form of a rigid wire")


def with_kind(design: Design, kind: str) -> Design:
    """Return a design with cups of a kind, or with none.

    Cups are computed on solid tissue, with bonded lines: the design is changed to these.
    """
    if kind == NO_CUPS:
        return replace(design, cup=None)
    cup = replace(design.cup or Cup(), kind=kind)
    if all(getattr(cup, key) == getattr(Cup(), key) for key in AMOUNTS[kind]):
        cup = replace(cup, **_STARTS[kind])
    return replace(design, cup=cup, tissue="solid", line_contact="glued")


def kind_text(kind: str) -> str:
    """Return the name of an edit that chooses cups of a kind, or removes them."""
    if kind == NO_CUPS:
        return tr("Cups removed")
    return f"{tr('Cups')}{colon()}{kind_choice().words(kind)}"


def change_text(key: str, value: Any) -> str:
    """Return the name of an edit of one setting of cups."""
    if key == "wire":
        return tr("Underwire added") if value else tr("Underwire removed")
    setting = coverage_choice() if key == "coverage" else amounts()[key]
    return tr("Cups: {setting} {value}").format(setting=setting.title, value=setting.words(value))


def cup_notes(design: Design) -> str:
    """Return what has to be known of cups in a design."""
    if design.cup is not None:
        moulded = tr("Estimate on solid tissue: the cup is rigid, fixed in space and without friction.")
        sewn = tr("Estimate on solid tissue: the cloth is bonded to the skin, its edge is free.")
        return moulded if design.cup.kind == "moulded" else sewn
    if design.tissue == "net":
        return tr("Cups need solid tissue: choosing them changes the tissue from net to solid.")
    return ""


def fit_view(frame: Frame) -> CupFitView | None:
    """Return what the cups of a frame do; None without cups."""
    if frame.stages.design.cup is None:
        return None
    doubt = invalid_reason(frame)
    if doubt:
        return CupFitView("", (), (doubt,))
    fit = WornCups(frame.stages).fit(frame.control_points)
    lift = tr("Bust points: {shift}").format(shift=step_text(bust_shift(frame).mean))
    rows = tuple(_rows(fit, frame.stages.design.cup.wire))
    return CupFitView(lift, rows, tuple(render_all(fit.warnings)), *_light(fit))


def _light(fit: CupFit) -> tuple[str, str]:
    light = pressure_limits().rating(fit.highest.max_kpa)
    return rating_text(light), TONES[light]


def _rows(fit: CupFit, wire: bool) -> list[FitRow]:
    sides = fit.sides
    rows = []
    if all(side.more_ml is not None for side in sides):
        rows = [
            FitRow(
                tr("Cup − breast volume"),
                "ml",
                _figures(sides, "more_ml", 0, signed=True),
                tr("Volume of the cup less that of the breast: below zero the cup compresses the breast."),
            ),
            FitRow(
                tr("Support"),
                "N",
                _figures(sides, "up_n", 1),
                tr("Vertical force of the cup on the breast: straps and band have to carry it."),
            ),
        ]
    if wire:
        rows.append(_wire_sizes(sides))
        tip = tr("Sum of the forces of the underwire on the skin, whatever their direction.")
        rows.append(FitRow(tr("Wire force"), "N", _figures(sides, "wire_n", 1), tip))
    tip = tr("Share of the area of the cup that presses on the skin.")
    contact = tuple(number(100.0 * side.contact, 0) for side in sides)
    rows.append(FitRow(tr("Contact"), "%", contact, tip))
    tip = tr("Maximum contact pressure of the cup: {values}.").format(
        values=" / ".join(kpa_text(side.max_kpa) for side in sides)
    )
    tones = tuple(TONES[pressure_limits().rating(side.max_kpa)] for side in sides)
    return [*rows, FitRow(tr("Max. pressure"), "kPa", _figures(sides, "max_kpa", 1), tip, tones)]


def _wire_sizes(sides: tuple[CupSide, ...]) -> FitRow:
    """Return the wires that are as long as the roots; other shapes of wire in the tooltip."""
    nearest = [nearest_wires(side.root_mm) for side in sides]
    names = {"Regular": tr("regular"), "Short": tr("short")}
    others = "; ".join(f"{names[each.kind]} {each.size} ({length(each.length_mm, 0)})" for each in nearest[0])
    tip = tr(
        "Size of the regular wire that is as long as the root. Left root {length}: {wires}. Lengths are "
        "those of printed size sheets."
    ).format(length=length(sides[0].root_mm, 0), wires=others)
    return FitRow(tr("Wire size"), "", tuple(each[0].size for each in nearest), tip)


def _figures(sides: tuple[CupSide, ...], field: str, digits: int, *, signed: bool = False) -> tuple[str, ...]:
    return tuple(number(getattr(side, field), digits, signed) for side in sides)


@dataclass(frozen=True)
class FitRow:
    """A value of both cups: title, unit, the left and the right one as written, what it is, their tones."""

    title: str
    unit: str
    values: tuple[str, ...]
    tip: str
    tones: tuple[str, ...] = ("", "")


@dataclass(frozen=True)
class CupFitView:
    """What cups do: ``lift`` of the bust points in words, ``rows`` of values for both, ``warnings``.

    ``word`` is what the larger pressure means, in its ``tone``; without rows there is no result.
    """

    lift: str
    rows: tuple[FitRow, ...]
    warnings: tuple[str, ...] = ()
    word: str = ""
    tone: str = ""
