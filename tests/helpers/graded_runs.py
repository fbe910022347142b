"""Results of runs over made bodies, without computing them: measures follow a known rule."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from app.batch.batch_design import batch_design
from app.batch.results import Results, read_results
from app.batch.store import ResultStore
from core.document.design import Design, ScanSource
from core.garment.presets import find_preset, with_preset

BANDS, CUPS = ("65", "70", "75", "80"), ("A", "B", "C", "D", "E")
UNDER, STRAP = "cut_length_under-bust_mm", "cut_length_strap left_mm"
Row = dict[str, Any]


def made_row(number: int, band: int, cup: int, noise: float = 0.0, variant: str = "one") -> Row:
    """Return a row of a body: 500 mm + 30 a band step + 8 a cup step, straps of 300 mm."""
    return {
        "scan": f"{number:03}.ply",
        "scan_sha256": f"content {number}",
        "variant": variant,
        "state": "done",
        "verdict": "good",
        "band_jp": BANDS[band],
        "cup_jp": CUPS[cup],
        "lift_left_mm": 10.0,
        "lift_right_mm": 12.0,
        "volume_error_percent": -0.5,
        "pressure_max_under-bust_kpa": 2.0,
        UNDER: 500.0 + 30.0 * band + 8.0 * cup + noise,
        STRAP: 300.0,
    }


def made_rows(count: int, noise: float = 3.0, variant: str = "one") -> list[Row]:
    """Return rows of bodies of drawn sizes."""
    rng = np.random.default_rng(count)
    draws = zip(
        rng.integers(0, 4, count), rng.integers(0, 5, count), rng.normal(0.0, noise, count), strict=True
    )
    return [made_row(at, int(b), int(c), float(off), variant) for at, (b, c, off) in enumerate(draws)]


def write_run(folder: Path, rows: Sequence[Row], variants: Sequence[str] = ("one",)) -> Path:
    """Write rows as ``busk batch`` does, and return the folder."""
    design = with_preset(Design(ScanSource("")), find_preset("soft bra"))
    designs = [batch_design(name, design, [], [], []) for name in variants]
    store = ResultStore(folder, designs)
    store.add(rows)
    store.finish([], 1.0, interrupted=False)
    store.close()
    return folder


def run_of(folder: Path, rows: Sequence[Row]) -> Results:
    """Return the results of a run with one variant."""
    (found,) = read_results(write_run(folder, rows))
    return found
