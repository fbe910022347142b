"""Whether a run settles, vibrates or diverges: a small pure function of its records.

Paper section 5 names the cases; the figures are ours.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.mesh import Floats
from core.solver import Record

SETTLED_STEP = 0.002
"""A run has settled when no control point moved further than this in each of the last turns [mm]."""

_QUIET_TURNS = 5
_WINDOW = 12
_RIPPLE = 1e-4
_DIVERGED = 0.5
_FADING = 0.99


@dataclass(frozen=True)
class Verdict:
    """How a run stands: ``state`` is settled, settling, vibrating or diverged.

    ``period`` [turns], ``amplitude`` [1] (half the swing of the volume error) and ``growth`` per turn [1]
    describe the flip-flop if there is one, else they are 0, 0 and 1; ``error`` [1] is the mean volume error
    of the last turns.
    """

    state: str
    turns: int
    error: float
    period: float = 0.0
    amplitude: float = 0.0
    growth: float = 1.0


def judge(records: Sequence[Record]) -> Verdict:
    """Judge a run by its records so far."""
    if not records:
        return Verdict("settling", 0, 0.0)
    last = records[-1]
    errors = np.array([record.error for record in records[-2 * _WINDOW - 2 :]])
    if not np.isfinite(errors).all() or abs(last.error) > _DIVERGED:
        return Verdict("diverged", last.turn, last.error)
    if len(records) >= _QUIET_TURNS and max(r.step for r in records[-_QUIET_TURNS:]) < SETTLED_STEP:
        return Verdict("settled", last.turn, last.error)
    return _judge_ripple(errors, last.turn)


def _judge_ripple(errors: Floats, turns: int) -> Verdict:
    mean = float(errors[-2:].mean())
    # A flip-flop shows as a second difference of alternating sign; a smooth approach has almost none.
    swing = (errors[:-2] - 2.0 * errors[1:-1] + errors[2:]) / 4.0
    if len(swing) < 2 * _WINDOW:
        return Verdict("settling", turns, mean)
    recent, earlier = swing[-_WINDOW:], swing[:_WINDOW]
    amplitude = float(np.abs(recent).mean())
    flips = int(np.count_nonzero(recent[1:] * recent[:-1] < 0.0))
    growth = float((amplitude / max(float(np.abs(earlier).mean()), 1e-300)) ** (1.0 / _WINDOW))
    if amplitude < _RIPPLE or flips < _WINDOW // 2 or growth < _FADING:
        return Verdict("settling", turns, mean)
    return Verdict("vibrating", turns, mean, 2.0 * (_WINDOW - 1) / flips, amplitude, growth)
