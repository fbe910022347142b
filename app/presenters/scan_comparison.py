"""Format the comparison with a fitting scan: registration, residuals, fitted parameters."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from app.i18n.catalog import joined, listed, number, tr
from app.i18n.lengths import length, length_number
from app.presenters.lines import told_title
from core.analysis.calibration.api import CalibrationResult, FittingScan, Residuals, ResidualSummary
from core.analysis.calibration.parameters import (
    FIRM_CHEST,
    LENGTH,
    LINE_STIFFNESS,
    LOWER_FIRMNESS,
    LOWER_TISSUE,
    PRESTRESS,
    SAG,
    STIFFNESS,
    TISSUE,
)
from core.analysis.calibration.registration import MET
from core.document.calibration_record import WELL, Calibration, FittedParameter
from core.document.design import Design
from core.geometry.mesh import Floats


def aligned_text(worn: FittingScan) -> str:
    """Return how well a worn scan lies on the first, in a sentence or two."""
    laid = worn.alignment
    met = tr(
        "Registration: {share} % of the skin outside the reshaped region matches within {near}, RMS {length}."
    ).format(near=length(MET, 0), share=number(100.0 * laid.met, 0), length=length(laid.rms))
    sure = tr("Registration accuracy ±{angle}° and ±{length}.").format(
        angle=number(2.0 * float(laid.rotation_deviations.max()), 2),
        length=length(2.0 * float(laid.translation_deviations.max())),
    )
    return joined([met, sure])


def residual_rows(difference: Residuals) -> tuple[ResidualRow, ...]:
    """Return predicted less real in rows: all, her left, her right."""
    named = {"left": tr("Left"), "right": tr("Right")}
    rows = [(tr("Reshaped region"), difference.total)]
    rows += [(named[side], figures) for side, figures in difference.sides.items()]
    return tuple(ResidualRow(title, *_figures(figures)) for title, figures in rows)


def _figures(figures: ResidualSummary) -> tuple[str, str, str]:
    if not np.isfinite(figures.rms):
        return "–", "–", "–"
    return length_number(figures.mean, 1, True), length_number(figures.rms), length_number(figures.most)


def map_values(difference: Residuals | None, count: int) -> Floats:
    """Return predicted less real at ``count`` vertices, (count,) [mm]: no number where it is not known."""
    values = np.full(count, np.nan)
    if difference is not None:
        values[: len(difference.values)] = difference.values
    return values


def bust_text(difference: Residuals) -> str:
    """Return how far the predicted bust points lie from the real ones, in a sentence."""
    if not difference.bust_points:
        return tr("The bust points are unclear on the fitting scan.")
    named = {
        "left": tr("Bust point left: predicted {shift}, {forward}."),
        "right": tr("Bust point right: predicted {shift}, {forward}."),
    }
    texts = [
        named[side].format(
            shift=_way(
                float(way[2]),
                tr("{length} higher (±{uncertainty})"),
                tr("{length} lower (±{uncertainty})"),
                difference.bust_unsure[side],
            ),
            forward=_way(-float(way[1]), tr("{length} further forward"), tr("{length} further back")),
        )
        for side, way in difference.bust_points.items()
    ]
    return joined([*texts, tr("± is the uncertainty of the bust points on both scans.")])


def _way(mm: float, more: str, less: str, sure: float = 0.0) -> str:
    return (less if round(mm, 1) < 0.0 else more).format(length=length(abs(mm)), uncertainty=length(sure))


def summary_text(difference: Residuals) -> str:
    """Return the text below the residuals: the bust points, and the compared share of the skin."""
    return joined([bust_text(difference), shown_text(difference)])


def shown_text(difference: Residuals) -> str:
    """Return how much of the moving skin the worn scan shows, where that is not nearly all."""
    share = difference.total.seen
    text = tr("The fitting scan covers {share} % of the reshaped region.").format(
        share=number(100.0 * share, 0)
    )
    return "" if share > 0.9 else text


def parameter_rows(found: CalibrationResult, design: Design) -> tuple[ParameterRow, ...]:
    """Return the numbers that were found, in rows."""
    return tuple(
        ParameterRow(
            parameter_title(each.name, design),
            formatted_value(each, each.before),
            formatted_value(each, each.after),
            f"±{formatted_value(each, each.plus_minus)}",
            each.is_well_determined,
        )
        for each in found.calibration.numbers
        if not each.kept
    )


def determination_text(found: CalibrationResult, design: Design) -> str:
    """Return which fitted parameters are well determined, and which are not."""
    sought = [each for each in found.calibration.numbers if not each.kept]
    well, weak = (
        listed([parameter_title(each.name, design) for each in sought if each.is_well_determined is told])
        for told in (True, False)
    )
    percent = number(100.0 * WELL, 0)
    if not weak:
        return (
            tr("All parameters are determined to within {percent} %.").format(percent=percent) if well else ""
        )
    first = (
        tr("Determined to within {percent} %: {numbers}.").format(percent=percent, numbers=well)
        if well
        else ""
    )
    return joined([first, tr("Poorly determined (see ±): {numbers}.").format(numbers=weak)])


def fixed_parameters_text(found: CalibrationResult, design: Design) -> str:
    """Return which numbers stay as they are, since the scans do not tell them."""
    names = [parameter_title(each.name, design) for each in found.calibration.numbers if each.kept]
    return tr("Not determined by these scans, kept unchanged: {numbers}.").format(
        numbers=listed(names)
    ) if names else ""  # fmt: skip


def parameter_title(name: str, design: Design) -> str:
    """Return what a number is called."""
    kind, _, line = name.partition(" of ")
    if kind == STIFFNESS and line:
        return tr("Stiffness of {line}").format(line=told_title(line, design))
    if kind == LENGTH and line:
        return tr("Length of {line}").format(line=told_title(line, design))
    return {
        LINE_STIFFNESS: tr("Line stiffness"),
        FIRM_CHEST: tr("Rib-cage support"),
        PRESTRESS: tr("Spring prestress"),
        TISSUE: tr("Tissue stiffness"),
        LOWER_TISSUE: tr("Tissue stiffness, waist and hips"),
        LOWER_FIRMNESS: tr("Firmness of the tissue, waist and hips"),
        SAG: tr("Sag"),
    }.get(name, name)


def formatted_value(of: FittedParameter, value: float) -> str:
    """Return one value of a number, with its unit where it has one."""
    if of.name in (TISSUE, LOWER_TISSUE):
        return f"{number(value, 0)} N/m"
    if of.name == SAG:
        return f"{number(value, 1)} mm"
    if of.name.startswith(LENGTH) or of.name == PRESTRESS:
        return f"{number(100.0 * value, 1)} %"
    return number(value, 3 if of.name in (FIRM_CHEST, LOWER_FIRMNESS) else 1)


def improvement_text(found: CalibrationResult, design: Design) -> str:
    """Return by how much the prediction comes nearer to the worn scan, or why that counts for nothing."""
    if found.at_end:
        names = listed([parameter_title(name, design) for name in found.at_end])
        return tr(
            "Calibration failed: {numbers} reached their limits. Check that this is the fitting "
            "scan and that the lines match the garment."
        ).format(numbers=names)
    before, after = (length(each.total.rms) for each in (found.before, found.after))
    if not found.is_improved:
        return tr("No parameter changed by more than its ±. The residual stays at {before}.").format(
            before=before
        )
    nearer = tr("Residual: {before} → {after}.").format(before=before, after=after)
    left = tr("Most of the residual remains. Posture, breathing or fabric thickness may affect the values.")
    weak = tr("No parameter is well determined. Treat the values as indicative.")
    return joined(
        [nearer, left if found.has_large_residual else "", weak if found.is_poorly_determined else ""]
    )


def record_text(record: Calibration | None) -> str:
    """Return what a design keeps of a calibration, in a line; nothing if there was none."""
    if record is None:
        return ""
    return tr("Calibration with {file}: {before} → {after}.").format(
        file=record.worn, before=length(record.rms_before), after=length(record.rms_after)
    )


def navigation_text(record: Calibration | None, worn: FittingScan | None) -> str:
    """Return what stands on the door: what was calibrated, what is compared, or what is behind it."""
    if worn is not None:
        return worn.name
    return record_text(record) or tr("Residuals from a scan of the worn garment")


def notes_of(worn: FittingScan | None, pending: bool) -> Iterator[str]:
    """Yield notes of the legend of the map, in place of its own line."""
    if worn is None:
        yield tr("Compare with a fitting scan first (File menu).")
    elif pending:
        yield tr("Compared again when the solver has converged.")


@dataclass(frozen=True)
class ResidualRow:
    """Predicted less real of some skin, as it is written: mean, root of the mean square, 95 % [mm]."""

    title: str
    mean: str
    rms: str
    most: str


@dataclass(frozen=True)
class ParameterRow:
    """A fitted parameter as text: before, after, its ±; and whether it is well determined."""

    title: str
    before: str
    after: str
    plus_minus: str
    told: bool = True
