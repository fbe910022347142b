"""Prediction meets fitting: a second scan of the same person, the garment on, compared and learnt from."""

from __future__ import annotations

from core.analysis.calibration.calibrate import CalibrationResult, calibrate, refuse_bare
from core.analysis.calibration.fit import exact_answer
from core.analysis.calibration.registration import Alignment, align
from core.analysis.calibration.residuals import (
    THICKEST,
    Difference,
    Figures,
    Worn,
    compare,
    laid_on,
    refuse_mirrored,
)
from core.document.design import ScanSource
from core.geometry.mesh import Points
from core.pipeline.build import Stages, read_body
from core.progress import Progress, quiet

__all__ = [
    "THICKEST",
    "Alignment",
    "CalibrationResult",
    "Difference",
    "Figures",
    "Worn",
    "calibrate",
    "compare",
    "predicted",
    "read_worn",
    "refuse_bare",
]

_READ = 0.7  # what part of the time reading takes, roughly


def read_worn(stages: Stages, source: ScanSource, progress: Progress = quiet) -> Worn:
    """Read a scan with the garment on and lay it on the body of ``stages``.

    Raises ScanError if it cannot be read, or is not of the same person in the same posture; Cancelled.
    """
    scan, body = read_body(source, lambda what, share: progress(what, _READ * share))
    alignment = align(stages, body, lambda what, share: progress(what, _READ + (1.0 - _READ) * share))
    worn = laid_on(scan.name, body, alignment)
    refuse_mirrored(stages, worn)
    return worn


def predicted(stages: Stages) -> Points:
    """Return the control points that a design predicts, its exact answer, (n, 3) [mm]. Raises LineError."""
    return exact_answer(stages).place.points
