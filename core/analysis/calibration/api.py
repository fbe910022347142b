"""Prediction meets fitting: a second scan of the same person, the garment on, compared and learnt from."""

from __future__ import annotations

import numpy as np

from core.analysis.calibration.calibrate import CalibrationResult, calibrate, require_active_line
from core.analysis.calibration.fit import solve_from
from core.analysis.calibration.registration import Alignment, align
from core.analysis.calibration.residuals import (
    THICKEST,
    FittingScan,
    Residuals,
    ResidualSummary,
    aligned_fitting_scan,
    compare,
    require_not_mirrored,
)
from core.document.design import ScanSource
from core.geometry.mesh import Points
from core.pipeline.build import Stages, read_body
from core.progress import Progress, quiet

__all__ = [
    "THICKEST",
    "Alignment",
    "CalibrationResult",
    "FittingScan",
    "ResidualSummary",
    "Residuals",
    "calibrate",
    "compare",
    "predicted_points",
    "read_fitting_scan",
    "require_active_line",
]

_READ = 0.7  # what part of the time reading takes, roughly


def read_fitting_scan(stages: Stages, source: ScanSource, progress: Progress = quiet) -> FittingScan:
    """Read a scan with the garment on and lay it on the body of ``stages``.

    Raises ScanError if it cannot be read, or is not of the same person in the same posture; Cancelled.
    """
    scan, body = read_body(source, lambda what, share: progress(what, _READ * share))
    alignment = align(stages, body, lambda what, share: progress(what, _READ + (1.0 - _READ) * share))
    worn = aligned_fitting_scan(scan.name, body, alignment)
    require_not_mirrored(stages, worn)
    return worn


def predicted_points(stages: Stages) -> Points:
    """Return the control points of all regions that a design predicts, its exact answers, (n, 3) [mm].

    Raises LineError.
    """
    return np.concatenate([solve_from(region).place.points for region in stages.regions])
