"""Format the status of the solver: state, values of the convergence panel, faults."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from app.i18n.catalog import number, tr
from app.i18n.lengths import length, length_number, length_unit
from app.presenters.assessment import AssessmentView
from app.presenters.bust_shift import bust_shift, mean_lifts, sides_text, step_text
from core.garment.pressure_list import PressureList
from core.mechanics.mesh_quality import MeshQuality
from core.pipeline.live_solver import Frame
from core.pipeline.warnings import controlled_volume

TONES = {
    "settled": ("ok", "check-circle"),
    "strained": ("warn", "overstrained"),
    "settling": ("info", "arc"),
    "vibrating": ("warn", "wave"),
    "diverging": ("bad", "arrow-up-right"),
    "folded": ("bad", "folded"),
    "overstrained": ("bad", "overstrained"),
    "stale": ("plain", "clock-counter-clockwise"),
    "paused": ("plain", "pause"),
    "good": ("ok", "check-circle"),
    "pending": ("info", "arc"),
    "caution": ("warn", "warning"),
    "bad": ("bad", "warning-octagon"),
    "idle": ("plain", "lines"),
}
"""Tone and drawing of each state of a run, and of each level of an overall verdict."""


TROUBLED = ("caution", "bad", "strained", "overstrained", "folded", "vibrating", "diverging")
"""States that there is more to say of: a click asks for it."""


def state_title(state: str) -> str:
    """Return the word for a state of a run in ``TONES``."""
    return {
        "settled": tr("Converged"),
        "strained": tr("Converged, strained"),
        "settling": tr("Converging"),
        "vibrating": tr("Oscillating"),
        "diverging": tr("Diverged"),
        "folded": tr("Folded"),
        "overstrained": tr("Overstrained"),
        "stale": tr("Not computed"),
        "paused": tr("Paused"),
    }[state]


def facts(frame: Frame, current: bool = True) -> list[str]:
    """Return the plain facts of the status bar; a frame that is not ``current`` is of a former design."""
    return [
        length_unit(),
        tr("{count} triangles").format(count=number(len(frame.stages.body.mesh.faces), 0)),
        *([] if current else [state_title("stale")]),
    ]


_WATCHED = 24  # turns over which a swing is measured
_STEADY = 5e-4  # a swing that changes by less a turn stays as large as it is [1]


@dataclass(frozen=True)
class ConvergenceView:
    """What the strip shows: ``level`` and ``headline`` of the overall verdict, and the ``state`` of the run.

    ``effort`` says what the ``pace`` took.
    """

    level: str
    headline: str
    state: str
    numbers: list[tuple[str, str]]
    hint: str
    pace: str
    effort: str
    settling: bool


def display_state(frame: Frame) -> str:
    """Return the state of a frame: that of its verdict, or strained skin."""
    return frame.verdict.display_state


def is_result(frame: Frame) -> bool:
    """Return whether the figures of a frame can be worked with, or will be when it has settled."""
    return frame.verdict.is_valid


def convergence_view(
    frame: Frame,
    overall: AssessmentView,
    girths: Mapping[str, tuple[float, float]] | None = None,
    pressed: PressureList | None = None,
) -> ConvergenceView:
    """Return how a frame stands under its ``overall`` verdict, with the values that matter then.

    ``girths`` before and after by name [mm], see ``figure_girths``, and contact pressures, as far as known.
    """
    state, seconds = display_state(frame), tr("{seconds} s").format(seconds=number(frame.seconds))
    return ConvergenceView(
        overall.level,
        overall.headline,
        state,
        _figures(frame, girths, pressed),
        overall.first,
        tr("{state} · {seconds}").format(state=state_title(state), seconds=seconds),
        _effort(frame),
        frame.verdict.motion == "settling",
    )


def invalid_reason(frame: Frame) -> str:
    """Return why the figures of a frame are no result, or nothing."""
    if is_result(frame):
        return ""
    state = state_title(display_state(frame))
    return tr("{state}: do not use these values for production.").format(state=state)


def oscillation_mm(frame: Frame) -> tuple[float, float]:
    """Return the middle of the height that the bust points swing about, and half of how far [mm]."""
    rows = frame.tracks.get(frame.stages.design.volume, ())[-_WATCHED:]
    marks = [row.marks for row in rows if row.marks is not None]
    heights = np.array([(each.bust_point_left_z, each.bust_point_right_z) for each in marks]).reshape(-1, 2)
    up = mean_lifts(frame.stages.rest_marks, *heights.T)
    if not len(up):
        return 0.0, 0.0
    return 0.5 * float(up.max() + up.min()), 0.5 * float(np.ptp(up))


def explanation(frame: Frame) -> str:
    """Return what it means that a run swings or runs away, or that a shape is no body; else nothing."""
    if _swings_below(frame):
        return tr("The solver does not converge: waist and hips oscillate.")
    return {
        "vibrating": tr("The solver does not converge: the bust point oscillates by ±{swing}."),
        "diverging": tr("The solver diverged. The last valid shape is shown."),
        "folded": tr("The skin overlaps itself: this is not a valid shape."),
        "overstrained": tr(
            "Skin is compressed or stretched by over 30 %: do not use this shape for production."
        ),
    }.get(frame.verdict.state, "").format(swing=length(oscillation_mm(frame)[1]))


def _swings_below(frame: Frame) -> bool:
    """Return whether the lower trunk alone swings."""
    return frame.verdict.motion == "vibrating" and frame.bust_verdict.motion != "vibrating"


def _effort(frame: Frame) -> str:
    """Return how many rounds it took, or steps to the exact answer."""
    exact, turns = frame.stages.design.volume == "exact", frame.verdict.iterations
    if exact and turns == 1:
        return tr("Solved in one Newton iteration")
    if exact:
        text = tr("Solved in {count} Newton iterations")
    elif frame.verdict.motion == "settled":
        text = tr("Converged in {count} iterations")
    else:
        text = tr("Not converged after {count} iterations")
    return text.format(count=number(turns, 0))


def _figures(
    frame: Frame, girths: Mapping[str, tuple[float, float]] | None, pressed: PressureList | None
) -> list[tuple[str, str]]:
    verdict, state = frame.verdict, display_state(frame)
    if state == "diverging":
        return []  # the figures would be those of the body shown, as it was before
    if state == "vibrating":
        return _swing_figures(frame)
    error, ml = controlled_volume(frame)
    kept = (tr("Volume error"), f"{number(error, 2, signed=True)} % · {number(ml, 1, signed=True)} ml")
    if verdict.condition and state == "folded":
        return [kept, (tr("Skin rotation"), f"{number(verdict.condition.largest_rotation, 0)}°")]
    if verdict.condition and state == "overstrained":
        return [kept, (tr("Skin strain"), _strain(verdict.condition))]
    move = bust_shift(frame)
    told = [(tr("Bust point"), step_text(move.mean))]
    told += _girths(girths or {})
    hardest = None if pressed is None else pressed.highest
    if hardest is not None and hardest.max_kpa is not None:
        told.append((tr("Max. pressure"), f"{number(hardest.max_kpa)} kPa"))
    elif move.differs:
        told.append((tr("Left · right"), " · ".join(sides_text(move))))
    return [*told, kept]


def _girths(girths: Mapping[str, tuple[float, float]]) -> list[tuple[str, str]]:
    """Return the girth of the bust before and after, or how those of bust, waist and hip change."""
    if len(girths) == 1:
        return [(tr("Bust girth"), f"{length_number(was)} → {length(now)}") for was, now in girths.values()]
    titles = {"bust": tr("Bust"), "waist": tr("Waist"), "hip": tr("Hip")}
    *others, last = [now - was for was, now in girths.values()] or [0.0]
    changes = [*(length_number(each, signed=True) for each in others), length(last, signed=True)]
    names = " · ".join(titles[name] for name in girths)
    return [(tr("{parts}, girth").format(parts=names), " · ".join(changes))] if girths else []


def _swing_figures(frame: Frame) -> list[tuple[str, str]]:
    verdict, (middle, swing) = frame.verdict, oscillation_mm(frame)
    growth = verdict.growth - 1.0
    grows = (
        tr("increasing") if growth > _STEADY else tr("decreasing") if growth < -_STEADY else tr("constant")
    )
    percent = f"{number(100.0 * verdict.error, 2)} ± {number(100.0 * verdict.amplitude, 2)} %"
    if _swings_below(frame):
        return [(tr("Waist and hips"), percent), (tr("Amplitude"), grows)]
    return [
        (tr("Volume error"), percent),
        (tr("Bust point"), f"{length_number(middle, signed=True)} ± {length(swing)}"),
        (tr("Amplitude"), grows),
    ]


def _strain(condition: MeshQuality) -> str:
    """Return how far the skin is pressed together and stretched at the worst places."""
    return _percents(100.0 * (condition.shortest - 1.0), 100.0 * (condition.longest - 1.0))


def _percents(pressed: float, stretched: float) -> str:
    return tr("{pressed} to {stretched} %").format(
        pressed=number(pressed, 0, signed=True), stretched=number(stretched, 0, signed=True)
    )


def solver_error_text(error: Exception) -> tuple[str, str]:
    """Return what failed while a shape was computed, and what to do."""
    if isinstance(error, MemoryError):
        return (
            tr("There is not enough memory to compute the shape."),
            tr("Your design is safe and can be saved. Close other programs, then try again."),
        )
    return (
        tr("An internal error stopped the computation of the shape."),
        tr("Your design is safe and can be saved. The view shows the last computed shape."),
    )


def error_text(error: Exception) -> tuple[str, str]:
    """Return what failed in any other work, and what to do."""
    if isinstance(error, MemoryError):
        return tr("There is not enough memory for this task."), tr("Close other programs, then try again.")
    return tr("An internal error occurred in Busk."), tr("Your design is safe. See the log for details.")


def not_computed() -> str:
    """Return that there are no results of the present design, because its shape was not computed."""
    return tr("Not computed: the view shows the last computed shape.")


def out_of_date(verdict: ConvergenceView) -> ConvergenceView:
    """Return the verdict on a frame that is not that of the present design, marked as such."""
    title = state_title("stale")
    return replace(verdict, level="stale", headline=title, state="stale", hint=not_computed(), settling=False)
