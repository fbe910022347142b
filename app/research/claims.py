"""Compare the statements of the paper with this model: every number is measured here."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from app.research.cases import (
    BODIES,
    EXCESSIVE,
    MODEST,
    PAPER_CONTROLS,
    TEMPLATE,
    TURNS,
    Study,
    bust_heights,
    curve,
    line_share,
    moved,
    reached_length,
    signed,
)
from app.research.sphere import sphere_model
from core.geometry.mesh import Floats
from core.mechanics.exact_solution import solve_exact

AGREES, PARTLY, DIFFERS = "agrees", "partly", "does not"
LENGTHS = (MODEST, 0.9, 0.8, 0.7, 0.6, EXCESSIVE)


@dataclass(frozen=True)
class Claim:
    """A statement of the paper, where it stands, what was found here and whether that agrees."""

    where: str
    statement: str
    found: str
    verdict: str


def claims(study: Study) -> list[Claim]:
    """Return all statements of the paper that a number can be set against, in its order."""
    return [claim(study) for claim in STATEMENTS]


def agreement(*holds: bool) -> str:
    """Return the verdict on a statement of which each part ``holds`` or not."""
    return AGREES if all(holds) else PARTLY if any(holds) else DIFFERS


def _each(say: Callable[[str], str]) -> str:
    return "; ".join(f"{body}: {say(body)}" for body in BODIES.values())


def _meshes(study: Study) -> Claim:
    sizes = {body: len(study.stages(body).body.mesh.faces) for body in BODIES.values()}
    number = {body: len(study.stages(body).control.mesh.faces) for body in BODIES.values()}
    return Claim(
        "2, 4",
        "scans of about 62,000 and 65,000 polygons, control meshes of 120 and 168",
        _each(lambda body: f"{sizes[body]:,} polygons under a control mesh of {number[body]}"),
        agreement(number == {"mannequin": 120, "person": 168}),
    )


def _balance(study: Study) -> Claim:
    runs = {body: study.solved(body, 1.0, "adaptive", 20).records for body in BODIES.values()}
    drift = {body: max(record.step for record in run) for body, run in runs.items()}
    return Claim(
        "3",
        "without external forces the model is in equilibrium and keeps its shape",
        _each(lambda body: f"a control point moves at most {drift[body]:.0e} mm per iteration"),
        agreement(max(drift.values()) < 1e-9),
    )


def _sphere(_: Study) -> Claim:
    sizes = {}
    for ratio in (0.8, 1.15):
        ball = sphere_model(("horizontal",))
        points = ball.centred(solve_exact(ball.model, (ratio, 1.0)).state.moved)
        sizes[ratio] = np.ptp(points, axis=0)
    short, long = sizes[0.8], sizes[1.15]
    return Claim(
        "3, Fig. 2",
        "a shorter line narrows a sphere, a longer one widens it",
        f"a horizontal line at 80 %: {short[0]:.0f} mm wide and {short[2]:.0f} mm high; at 115 %: "
        f"{long[0]:.0f} and {long[2]:.0f} mm; at rest 200 and 200 mm",
        agreement(bool(short[0] < 200.0 < short[2]), bool(long[2] < 200.0 < long[0])),
    )


def _both_meshes(study: Study) -> Claim:
    found, near = [], []
    for body in BODIES.values():
        for control in ("none", "adaptive"):
            solution = study.solved(body, study.ratio_for(body, 0.97), control)
            dense = solution.body_change
            found.append(f"{body}, {control}: {signed(solution.last.error_ml)} and {signed(dense)} ml")
            near.append(
                abs(dense - solution.last.error_ml) * 1e3 < 1e-3 * solution.stages.model.volume.rest_volume
            )
    return Claim(
        "4",
        "the volume of the body changes almost as that of the control mesh",
        "line 3 % shorter, change of the control mesh and of the body, " + "; ".join(found),
        agreement(all(near)),
    )


def _three_percent(study: Study) -> Claim:
    runs = {
        (body, control): study.solved(body, study.ratio_for(body, 0.97), control)
        for body in BODIES.values()
        for control in (*PAPER_CONTROLS.values(), "exact")
    }
    error = {key: abs(100.0 * run.last.error) for key, run in runs.items()}
    texts = {
        body: ", ".join(
            f"{control} {error[body, control]:.2g} %" for control in (*PAPER_CONTROLS.values(), "exact")
        )
        for body in BODIES.values()
    }
    lengths = ", ".join(f"{100 * line_share(runs[body, 'adaptive']):.2f} %" for body in BODIES.values())
    return Claim(
        "4, Figs. 3, 4",
        "line about 3 % shorter, volume error below 0.1 %",
        f"line at {lengths}; " + "; ".join(f"{body}: {words}" for body, words in texts.items()),
        agreement(*(error[body, "adaptive"] < 0.1 for body in BODIES.values())),
    )


def _upward(study: Study) -> Claim:
    ways = {
        body: moved(study.solved(body, study.ratio_for(body, 0.97), "adaptive")) for body in BODIES.values()
    }
    slid = {}
    for body in BODIES.values():
        ratio = study.ratio_for(body, 0.97, line_contact="sliding")
        slid[body] = moved(study.solved(body, ratio, "adaptive", line_contact="sliding"))
    return Claim(
        "4, Fig. 4a",
        "the bust moves upward",
        _each(lambda body: f"apex {ways[body][1]:+.1f} mm, bust points {ways[body][0]:+.2f} mm")
        + "; with a sliding line, "
        + _each(lambda body: f"apex {slid[body][1]:+.1f} mm, bust points {slid[body][0]:+.2f} mm"),
        agreement(*(m[1] > 0.5 for m in ways.values()), *(m[0] > 0.5 for m in ways.values())),
    )


def _suppressed(study: Study) -> Claim:
    ratio = {body: study.ratio_for(body, 0.97) for body in BODIES.values()}
    free, held = (
        {body: moved(study.solved(body, ratio[body], control))[2] for body in BODIES.values()}
        for control in ("none", "adaptive")
    )
    return Claim(
        "4, Fig. 4b",
        "without the volume constraint the line suppresses the bust",
        _each(lambda body: f"apex {free[body]:+.1f} mm forward, with it {held[body]:+.1f} mm"),
        agreement(*(free[body] < held[body] - 0.1 for body in BODIES.values())),
    )


def _states(study: Study, control: str) -> dict[str, dict[float, str]]:
    return {
        body: {ratio: study.solved(body, ratio, control, 200).verdict.motion for ratio in LENGTHS}
        for body in BODIES.values()
    }


def _vibrates(study: Study) -> Claim:
    texts, holds = [], []
    for body, states in _states(study, "conventional").items():
        bad = [ratio for ratio, state in states.items() if state in ("vibrating", "diverging")]
        calm = [ratio for ratio in LENGTHS if ratio not in bad]
        stages = study.stages(body)
        shortest = 100 * reached_length(stages, min(calm, default=1.0))
        words = f"vibrates at {percents(bad)}, not at {percents(calm)} (which reaches {shortest:.0f} %)"
        texts.append(f"{body}, gain {stages.gain:.2f}: {words}")
        holds.append(bool(bad) and MODEST in calm)
    return Claim(
        "5",
        "it vibrates or diverges when the line is too short, not when it is a little shorter",
        "with the default gain, " + "; ".join(texts),
        agreement(*holds),
    )


def percents(ratios: Sequence[float]) -> str:
    """Return length ratios [1] as a list of percentages."""
    return ", ".join(f"{100 * ratio:.0f}" for ratio in ratios) + " %" if ratios else "no length"


def _never_without(study: Study) -> Claim:
    states = _states(study, "none")
    calm = {body: sum(s in ("settled", "settling") for s in each.values()) for body, each in states.items()}
    return Claim(
        "5",
        "no vibration if the volume constraint is not applied",
        _each(lambda body: f"stable at {calm[body]} of {len(LENGTHS)} lengths ({percents(LENGTHS)})"),
        agreement(*(number == len(LENGTHS) for number in calm.values())),
    )


def _errors(study: Study, body: str, ratio: float, control: str, turns: int = TURNS) -> Floats:
    """Return the volume errors of a run, shape (turns,) [%]."""
    return 100.0 * np.array([r.error for r in study.solved(body, ratio, control, turns).records])


def _calm(study: Study) -> Claim:
    swing = {
        body: max(float(np.ptp(_errors(study, body, ratio, "adaptive", 200)[-20:])) for ratio in LENGTHS)
        for body in BODIES.values()
    }
    return Claim(
        "6, Fig. 7",
        "the adaptive force makes no vibration",
        f"maximum amplitude in the last 20 of 200 iterations at {percents(LENGTHS)}, "
        + _each(lambda body: f"{swing[body]:.1g} %"),
        agreement(*(each < 0.001 for each in swing.values())),
    )


def _higher(study: Study) -> Claim:
    found, holds = [], []
    for ratio in (MODEST, EXCESSIVE):
        for body in BODIES.values():
            ends = []
            for control in PAPER_CONTROLS.values():
                records = curve(study.solved(body, ratio, control, TURNS))
                out = np.array([r.marks.apex_protrusion for r in records if r.marks])
                ends.append([*bust_heights(records)[-20:].mean(axis=0), out[-20:].mean()])
            bust, apex, forward = np.subtract(ends[1], ends[0]).tolist()
            holds.append(bust > 0.0)
            found.append(
                f"{body} at {100 * ratio:.0f} %: bust points {bust:+.2f}, apex {apex:+.2f}, forward "
                f"{forward:+.2f} mm"
            )
    return Claim(
        "6, Fig. 6",
        "the height of the nipples converges, and ends bigger than with the conventional force",
        "adaptive less conventional, " + "; ".join(found),
        agreement(*holds),
    )


def _smaller(study: Study) -> Claim:
    error = {
        (body, control): abs(float(_errors(study, body, MODEST, control)[-20:].mean()))
        for body in BODIES.values()
        for control in PAPER_CONTROLS.values()
    }
    return Claim(
        "6, Fig. 7",
        "the adaptive error is significantly smaller",
        f"line at {100 * MODEST:.0f} %, "
        + _each(lambda b: f"{error[b, 'adaptive']:.1g} % against {error[b, 'conventional']:.2g} %"),
        agreement(*(10 * error[b, "adaptive"] < error[b, "conventional"] for b in BODIES.values())),
    )


def _first_error(study: Study) -> Claim:
    found, holds = [], []
    for ratio in (MODEST, EXCESSIVE):
        peak = {b: float(np.abs(_errors(study, b, ratio, "adaptive")[:10]).max()) for b in BODIES.values()}
        holds.append(peak["person"] > peak["mannequin"])
        found.append(f"at {100 * ratio:.0f} % " + " and ".join(f"{b} {p:.3f} %" for b, p in peak.items()))
    same = study.solved("mannequin", MODEST, "adaptive", TURNS, template=TEMPLATE["person"])
    first = 100 * max(abs(record.error) for record in same.records[:10])
    found.append(
        f"the mannequin on {TEMPLATE['person']} triangles too, at {100 * MODEST:.0f} % {first:.3f} %"
    )
    return Claim(
        "6, Fig. 7",
        "the real body gives a bigger error in the initial stage",
        "maximum error of the first 10 iterations, " + "; ".join(found),
        agreement(*holds),
    )


def _speed(study: Study) -> Claim:
    turns = {
        (body, control): study.solved(body, MODEST, control).last.iteration
        for body in BODIES.values()
        for control in PAPER_CONTROLS.values()
    }
    return Claim(
        "5",
        "the damping does not harm the speed of convergence",
        f"line at {100 * MODEST:.0f} %, iterations to convergence: "
        + _each(lambda b: f"{turns[b, 'adaptive']}, conventional {turns[b, 'conventional']}"),
        agreement(*(turns[b, "adaptive"] <= turns[b, "conventional"] for b in BODIES.values())),
    )


STATEMENTS: tuple[Callable[[Study], Claim], ...] = (
    *(_meshes, _balance, _sphere, _both_meshes, _three_percent, _upward, _suppressed),
    *(_vibrates, _never_without, _calm, _higher, _smaller, _first_error, _speed),
)
