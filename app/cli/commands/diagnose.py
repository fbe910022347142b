"""Diagnose a design: conflicting lines, and the smallest changes that fix it."""

from __future__ import annotations

import json
from argparse import ArgumentParser, Namespace
from collections.abc import Iterator
from typing import Any

from app.cli.design import check_project_name, save_design, stages_of
from app.cli.options import add_forms, add_lines, add_project_output, add_scan, add_volume
from app.cli.output import finish
from app.presenters.assessment import assessment_lines
from app.presenters.diagnosis import change_text, details, hint, sentence
from core import __version__
from core.analysis.diagnosis.candidate_changes import Change, Fix
from core.analysis.diagnosis.diagnose import Diagnosis, diagnose
from core.analysis.diagnosis.opposing_constraints import ConstraintForces
from core.garment.assessment import Assessment, assess


def add_options(parser: ArgumentParser) -> None:
    """Add the options of ``busk diagnose``."""
    add_scan(parser)
    add_lines(parser)
    add_project_output(parser, "the corrected design")
    add_volume(parser)
    add_forms(parser)


def run(options: Namespace) -> int:
    """Print the diagnosis, and save the design with the best fix."""
    check_project_name(options.out)
    stages = stages_of(options)
    found = diagnose(stages)
    out = options.out if found.best_fix is not None else ""
    if found.best_fix is not None:
        save_design(options.input, out, found.best_fix.change.design, stages)
    data = diagnosis_data(found, out)
    text = json.dumps(data, indent=1) if options.json else "\n".join(_text(found, out))
    return finish(text, not found.problem or found.best_fix is not None)


def _text(found: Diagnosis, out: str) -> Iterator[str]:
    yield from assessment_lines(assess(found.trial), found.stages.design)
    if found.problem:
        yield sentence(found, 0.0)
        if not found.fixes:
            yield hint(found)
    else:
        yield f"The solver converged in {found.verdict.iterations} iterations."
    yield from details(found).splitlines()
    if out:
        yield f"written to {out}"


def diagnosis_data(found: Diagnosis, out: str) -> dict[str, Any]:
    """Return a diagnosis as plain values, ready for JSON."""
    verdict = found.verdict
    return {
        "assessment": assess(found.trial).as_data(),
        "complaint": found.problem or None,
        "state": verdict.display_state,
        "turns": verdict.iterations,
        "period_turns": verdict.period or None,
        "amplitude_percent": 100.0 * verdict.amplitude if verdict.period else None,
        "growth_per_turn": verdict.growth if verdict.period else None,
        "growth_at_first": found.onset if found.onset and found.onset < float("inf") else None,
        "gain": found.gain,
        "gain_borne": found.gain_limit,
        **_forces(found.forces),
        **_treatment(found),
        "locked": list(found.locked),
        "written_to": out or None,
        "definition": (
            "forces on the free points at convergence, or at the last equilibrium before it, "
            "magnitudes summed over all points; angles between their effects on the skin; newtons "
            "depend on the assumed tissue stiffness; size_percent: of the original length, or of the "
            "gain"
        ),
        "versions": {"busk": __version__},
    }


def _forces(fight: ConstraintForces) -> dict[str, Any]:
    worst = fight.worst
    named = worst and {
        "between": [list(worst.one.lines) or "volume", list(worst.other.lines) or "volume"],
        "angle_degrees": worst.angle,
        "newtons": [worst.one.newtons, worst.other.newtons],
    }
    forces = [
        {
            "of": list(pull.lines) or "volume",
            "newtons": pull.newtons,
            "to_volume_degrees": pull.to_volume,
            "left_right_newtons": list(pull.sides) if pull.sides else None,
        }
        for pull in fight.forces
    ]
    return {"fight": named, "balance_share": fight.share, "forces": forces, "skin_newtons": fight.skin}


def _treatment(found: Diagnosis) -> dict[str, Any]:
    cure, nearest = found.best_fix, found.nearest
    return {
        "cure": None if cure is None else _change(found, cure.change),
        "state_with_cure": None if cure is None else cure.trial.verdict.display_state,
        "ended_by_choice": (cure and cure.option_result) or None,
        "ended_by_lengths": (cure and cure.lengths_result) or None,
        "fixes": [{**_change(found, each.change), **_left(each)} for each in found.fixes],
        "nearest": None if nearest is None else _change(found, nearest.change),
        "state_with_nearest": None if nearest is None else nearest.remaining_problem,
    }


def _left(cure: Fix) -> dict[str, Any]:
    return {"state": cure.trial.verdict.display_state, "remains": Assessment(cure.remains).as_data()}


def _change(found: Diagnosis, change: Change) -> dict[str, Any]:
    key, value = change.setting
    return {
        "kind": change.kind,
        "words": change_text(found, change),
        "lengths_percent": {
            line.name: 100.0 * line.ratio for region in change.design.regions for line in region.lines
        },
        "gain": change.design.gain,
        "setting": {key: value} if key else None,
        "size_percent": change.size,
    }
