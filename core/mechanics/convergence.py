"""Convergence state of a run, a pure function of its records and its mesh quality.

Paper section 5 names the cases; the rules and figures are ours.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from core.geometry.mesh import Floats, Indices
from core.mechanics.iteration import Record
from core.mechanics.mesh_quality import MeshQuality, worst_of

MOTIONS = ("settled", "settling", "vibrating", "diverging")
"""What a run can do, from the best to the worst."""

STATES = (*MOTIONS, "folded", "overstrained")
"""What can be said of a run in one word."""

SOUND = ("settled", "strained", "settling")
"""What is told of runs whose figures can be worked with, or will be once all has settled."""

CONVERGED_STEP = 0.002
"""A run has settled when no control point moved further than this in each of the last turns [mm]."""

_QUIET_TURNS = 5
_DIVERGED = 0.5
_FADING = 0.99

_RIPPLE = 1e-4
_LEAST = 26  # turns without which no swing is judged
_LOOK_BACK = 120  # turns: room for a swing of 40 turns to show twice
_LAGS = (1, 2, 4, 8, 16)  # together they see periods from 2 to 40
_WINDOW = 12  # turns over which a quick swing is measured
_SPANS = (24, 48)  # over which its growth is: the longer for swings that come and go


@dataclass(frozen=True)
class Convergence:
    """How a run stands: ``motion`` is one of MOTIONS, ``condition`` that of the control mesh, if known.

    ``error`` [1] is the mean volume error of the last turns. ``period`` [turns], ``amplitude`` [1] (half the
    swing of the volume error, 0 if only the shape swings) and ``growth`` per turn [1] describe a vibration;
    without one they are 0, 0 and 1.
    """

    motion: str
    iterations: int
    error: float
    period: float = 0.0
    amplitude: float = 0.0
    growth: float = 1.0
    condition: MeshQuality | None = None

    @property
    def state(self) -> str:
        """Return the state to show, one of STATES.

        A run that vibrates or diverges has no shape to speak of; else a fold weighs more than strain, and
        both more than whether it has come to rest.
        """
        if self.condition is None or self.motion in ("vibrating", "diverging"):
            return self.motion
        if self.condition.folded:
            return "folded"
        return "overstrained" if self.condition.overstrained else self.motion

    @property
    def display_state(self) -> str:
        """Return the state as designers are told it: "strained" where skin strains though all has settled."""
        strained = self.condition is not None and self.condition.strained
        return "strained" if self.state == "settled" and strained else self.state

    @property
    def strain(self) -> tuple[float, float] | None:
        """Return how far a "strained" skin is pressed together and stretched at most [%], else None."""
        condition = self.condition
        if condition is None or self.display_state != "strained":
            return None
        return 100.0 * (condition.shortest - 1.0), 100.0 * (condition.longest - 1.0)

    @property
    def is_valid(self) -> bool:
        """Return whether figures can be worked with, or will be once all has settled."""
        return self.display_state in SOUND

    @property
    def words(self) -> str:
        """Return the state, after the motion if that is another: "settled but folded"."""
        return self.motion if self.state == self.motion else f"{self.motion} but {self.state}"


def combined(verdicts: Sequence[Convergence]) -> Convergence:
    """Return one verdict on runs side by side: the worst motion, and the worst condition of all."""
    worst = max(verdicts, key=lambda each: MOTIONS.index(each.motion))
    known = [each.condition for each in verdicts if each.condition is not None]
    count = max(each.iterations for each in verdicts)
    return replace(worst, iterations=count, condition=worst_of(known) if known else None)


def assess_convergence(records: Sequence[Record], condition: MeshQuality | None = None) -> Convergence:
    """Assess a run by its records so far, and by its mesh quality if known."""
    if not records:
        return Convergence("settling", 0, 0.0, condition=condition)
    last, recent = records[-1], records[-_LOOK_BACK:]
    errors = np.array([record.error for record in recent])
    zones = np.array([record.zones for record in recent]).T
    if not np.isfinite(errors).all():
        return Convergence("diverging", last.iteration, last.error, condition=condition)
    if len(recent) >= _QUIET_TURNS and max(record.step for record in recent[-_QUIET_TURNS:]) < CONVERGED_STEP:
        return Convergence("settled", last.iteration, last.error, condition=condition)
    if max(map(abs, (last.error, *last.zones))) > _DIVERGED:
        return Convergence("diverging", last.iteration, last.error, condition=condition)
    # Zones of a trunk may swing against each other, so that their sum does not.
    swings = [swing for course in (errors, *zones) if (swing := _strongest_swing(course))]
    swing = max(swings, key=lambda each: each.amplitude, default=None) or _shape_swing(recent)
    if swing is None:
        return Convergence("settling", last.iteration, float(errors[-2:].mean()), condition=condition)
    mean = float(errors[-swing.window :].mean())
    return Convergence(
        "vibrating", last.iteration, mean, swing.period, swing.amplitude, swing.growth, condition
    )


@dataclass(frozen=True)
class _Swing:
    """How a course swings: period [turns], half the swing, growth per turn, turns it was measured over."""

    period: float
    amplitude: float
    growth: float
    window: int


def _strongest_swing(course: Floats) -> _Swing | None:
    """Return the largest swing of a course (n,) [1] that neither fades nor is too small to see, or None."""
    ups = course[1:] > course[:-1]
    turned = int(np.count_nonzero(ups[1:] != ups[:-1]))
    if len(course) < _LEAST or turned < 3:
        return None
    late = course[-3 * _WINDOW :]
    room = 0.25 * float(late.max() - late.min())
    strongest = None
    for lag in _LAGS:
        swing = _swing(course, lag)
        if swing and (strongest is None or swing.amplitude > strongest.amplitude):
            strongest = swing
            if swing.amplitude > room:  # no other can be much larger
                break
    return strongest if strongest and strongest.amplitude >= _RIPPLE else None


def _swing(course: Floats, lag: int) -> _Swing | None:
    """Return the swing of about 2 x ``lag`` turns in a course, if there is one that does not fade.

    Second differences over half a period show a swing in full and a straight drift not at all; a smooth
    approach leaves little, and that of one sign.
    """
    bend = course[: -2 * lag] + course[2 * lag :] - 2.0 * course[lag:-lag]
    turns = _sign_changes(bend)
    if len(turns) < 4:  # a single pulse bends three times
        return None
    periods = min((len(turns) - 1) // 2, _WINDOW)
    turns = turns[-1 - 2 * periods :]
    period = float(turns[-1] - turns[0]) / periods
    longest = max(int((turns[1:] - turns[:-1]).max()), len(bend) - int(turns[-1]))
    whole = int(len(bend) / 2.0 / period)
    if not 1.4 * lag <= period <= 4.0 * lag or whole < 1 or longest > period + 1.0:
        return None
    window, *spans = (round(period * min(whole, math.ceil(n / period))) for n in (_WINDOW, *_SPANS))
    growth = next((each for span in spans if (each := _growth(bend, period, span)) >= _FADING), None)
    if growth is None:
        return None
    gain = 4.0 * math.sin(math.pi * lag / period) ** 2
    return _Swing(period, _size(bend[-window:], period) / gain, growth, window)


def _growth(bend: Floats, period: float, span: int) -> float:
    """Return by how much the last ``span`` turns swing more than those before them, per turn."""
    earlier = max(_size(bend[-2 * span : -span], period), 0.01 * _RIPPLE)
    return math.pow(_size(bend[-span:], period) / earlier, 1.0 / span)


def _sign_changes(bend: Floats) -> Indices:
    """Return where ``bend`` takes the other sign, but for what is too small to matter."""
    large = (np.abs(bend) > _RIPPLE).nonzero()[0]
    up = bend[large] > 0.0
    return np.asarray(large[1:][up[1:] != up[:-1]])


def _size(bend: Floats, period: float) -> float:
    """Return half the swing about its mean: a flip-flop is always at its crest, else that of the best sine.

    A window that cuts a period would make the root mean square larger or smaller, and be seen as growth.
    """
    if period < 2.05:
        return float(np.abs(bend - bend.sum() / len(bend)).sum()) / len(bend)
    angle = 2.0 * math.pi / period * np.arange(len(bend))
    waves = np.column_stack((np.cos(angle), np.sin(angle), np.ones(len(bend))))
    fit = np.linalg.lstsq(waves, bend)[0]
    return math.hypot(fit[0], fit[1])


def _shape_swing(records: Sequence[Record]) -> _Swing | None:
    """Return the swing of the line that moves most, in parts of its length, unless the moves fade."""
    if len(records) < _LEAST or not records[-1].lengths:
        return None
    earlier, later = (max(r.step for r in part) for part in (records[-24:-12], records[-12:]))
    if later < _FADING**12 * earlier:
        return None
    lengths = np.array([record.lengths for record in records])
    course = lengths[:, int(np.ptp(lengths[-24:], axis=0).argmax())]
    swing = _strongest_swing(course / course.mean())
    return swing and _Swing(swing.period, 0.0, swing.growth, swing.window)
