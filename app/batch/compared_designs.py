"""Two designs compared body by body: the bodies that both have, matched by the content of their scans."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from app.batch.results import Results
from core.analysis.comparison.paired import PairedDifference, Tradeoff, paired_difference, tradeoff
from core.errors import UserError
from core.geometry.mesh import Floats, Indices
from core.messages import Message

LIFT, PRESSURE, VOLUME = "lift_mm", "pressure_max_kpa", "volume_error_percent"
UNITS = {LIFT: "mm", PRESSURE: "kPa", VOLUME: "%"}
RESOLUTIONS = {LIFT: 0.1, PRESSURE: 0.01, VOLUME: 0.01}
"""Differences up to these count as none: results are shown with these digits."""

CUT_LENGTH = "cut_length_"
VERDICTS = ("good", "caution", "bad")


@dataclass(frozen=True)
class Unmatched:
    """Bodies that are not compared: without results of the ``first`` or ``second`` design, or of ``both``."""

    first: tuple[str, ...]
    second: tuple[str, ...]
    both: tuple[str, ...]


@dataclass(frozen=True)
class DesignComparison:
    """The values of two designs on n bodies by quantity, each (n,), NaN where unknown.

    ``scans`` are the files of the bodies; ``names`` are those of the designs; ``verdicts`` those of both on
    each body.
    """

    names: tuple[str, str]
    scans: tuple[str, ...]
    values: dict[str, tuple[Floats, Floats]]
    units: dict[str, str]
    verdicts: tuple[tuple[str, str], ...]
    unmatched: Unmatched

    def change(self, quantity: str) -> Floats:
        """Return second - first of a quantity, shape (n,)."""
        first, second = self.values[quantity]
        return second - first

    @cached_property
    def differences(self) -> dict[str, PairedDifference]:
        """Return the differences of all quantities that some body has on both designs."""
        found = {
            name: paired_difference(*pair, RESOLUTIONS.get(name, RESOLUTIONS[LIFT]))
            for name, pair in self.values.items()
        }
        return {name: each for name, each in found.items() if each is not None}

    @cached_property
    def tradeoff(self) -> Tradeoff:
        """Return how lift and the largest pressure change together."""
        limits = RESOLUTIONS[LIFT], RESOLUTIONS[PRESSURE]
        return tradeoff(self.change(LIFT), self.change(PRESSURE), limits)

    @cached_property
    def verdict_counts(self) -> np.ndarray:
        """Return numbers of bodies by verdict of the first (rows) and of the second design (columns)."""
        counts = np.zeros((len(VERDICTS), len(VERDICTS)), dtype=np.int64)
        for pair in self.verdicts:
            if all(each in VERDICTS for each in pair):
                counts[VERDICTS.index(pair[0]), VERDICTS.index(pair[1])] += 1
        return counts


def compared_designs(first: Results, second: Results) -> DesignComparison:
    """Compare two designs on the bodies that both have. Raises UserError if there is none."""
    rows, unmatched = _matched(first, second)
    if not len(rows):
        raise UserError(
            Message("No body has results of both designs."),
            Message("Compute both on the same scans; scans are matched by their content."),
        )
    quantities = {
        LIFT: (_lift(first), _lift(second)),
        PRESSURE: (_pressure(first), _pressure(second)),
        VOLUME: (np.abs(first.numbers(VOLUME)), np.abs(second.numbers(VOLUME))),
    }
    lengths = [name for name in first.units if name.startswith(CUT_LENGTH) and name in second.units]
    quantities |= {name: (first.numbers(name), second.numbers(name)) for name in lengths}
    values = {name: (one[rows[:, 0]], other[rows[:, 1]]) for name, (one, other) in quantities.items()}
    values = {
        name: pair
        for name, pair in values.items()
        if name in UNITS or (np.isfinite(pair[0]) & np.isfinite(pair[1])).any()
    }
    scans, verdicts = first.texts("scan"), (first.texts("verdict"), second.texts("verdict"))
    return DesignComparison(
        _names(first, second),
        tuple(scans[at] for at in rows[:, 0]),
        values,
        {name: UNITS.get(name, "mm") for name in values},
        tuple((verdicts[0][one], verdicts[1][other]) for one, other in rows),
        unmatched,
    )


def _names(first: Results, second: Results) -> tuple[str, str]:
    if first.variant != second.variant:
        return first.variant, second.variant
    folders = [each.folder.name for each in (first, second)]
    if folders[0] == folders[1]:
        folders = [str(each.folder) for each in (first, second)]
    return f"{first.variant} ({folders[0]})", f"{second.variant} ({folders[1]})"


def _matched(first: Results, second: Results) -> tuple[Indices, Unmatched]:
    """Return the rows of both designs (n, 2) of the bodies that both have, in the order of the first."""
    one, other = _by_content(first, first.done), _by_content(second, second.done)
    pairs = [(at, other[digest]) for digest, at in one.items() if digest in other]
    names = dict[str, str]()
    for each in (second, first):
        scans = each.texts("scan")
        names |= {digest: scans[at] for digest, at in _by_content(each, range(len(scans))).items()}
    lacking = {digest: (digest not in one, digest not in other) for digest in names}
    listed = [
        tuple(sorted(names[digest] for digest, each in lacking.items() if each == wanted))
        for wanted in ((True, False), (False, True), (True, True))
    ]
    return np.array(pairs, dtype=np.int64).reshape(-1, 2), Unmatched(*listed)


def _by_content(results: Results, places: Sequence[int] | range | Indices) -> dict[str, int]:
    """Return rows by the content of their scans, the first of equal ones; a scan without is left out."""
    digests, found = results.texts("scan_sha256"), dict[str, int]()
    for at in places:
        if digests[at]:
            found.setdefault(digests[at], int(at))
    return found


def _lift(results: Results) -> Floats:
    """Return the mean lift of both sides [mm]."""
    return 0.5 * (results.numbers("lift_left_mm") + results.numbers("lift_right_mm"))


def _pressure(results: Results) -> Floats:
    """Return the largest contact pressure of all lines and cups [kPa], NaN without any."""
    names = [name for name in results.units if name.startswith("pressure_max_")]
    columns = np.array([results.numbers(name) for name in names]).reshape(len(names), -1)
    if not len(columns):
        return np.full(len(results.texts("scan")), np.nan)
    known = np.isfinite(columns)
    highest = np.where(known, columns, -np.inf).max(axis=0)
    return np.asarray(np.where(known.any(axis=0), highest, np.nan))
