"""What ``busk doctor`` does: tell what is wrong with a design, what fights in it, and what ends it."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from app.cli.options import dressed, made_of
from app.presenters.assessment import assessment_lines, assessment_view
from core import __version__
from core.analysis.diagnosis.candidate_changes import Change
from core.analysis.diagnosis.diagnose import Diagnosis, diagnose
from core.analysis.diagnosis.fix import Cure
from core.analysis.diagnosis.opposing_constraints import Clash, Fight, Pull
from core.document.design import Design
from core.document.document import Document
from core.document.storage.backups import backed_up
from core.document.storage.project_file import SUFFIX, is_project, open_project, save_project
from core.errors import UserError
from core.garment.assessment import Assessment, assessed
from core.pipeline.build import build

MEANING = {
    "strained": "an edge of the control mesh is outside 80 to 120 % of its original length",
    "settling": "the solver has not converged in the given iterations",
    "overstrained": "an edge of the control mesh is outside 70 to 130 % of its original length",
    "folded": "a triangle of the control mesh has rotated by more than 78 degrees",
    "vibrating": "the solver oscillates and does not converge",
    "diverging": "the solver diverges",
    "unreachable": "no equilibrium exists for these line lengths",
}
"""What each complaint means."""

CHOICES = {
    ("volume", "adaptive"): "use adaptive volume control",
    ("volume", "exact"): "use the exact solution",
    ("line_force", "implicit"): "use implicit line forces",
    ("line_hold", "spring"): "make lines elastic",
}
"""What other choices of the model do."""


TROUBLES = {
    "vibrating": "the oscillation",
    "diverging": "the divergence",
    "settling": "the slow convergence",
    "folded": "the fold",
    "overstrained": "the strain",
    "strained": "the strain",
    "unreachable": "the missing equilibrium",
}
"""Each complaint as a thing that a part of a change can end."""

PARTS = {
    "gain": "the gain",
    "volume": "the volume control",
    "line_force": "the implicit line force",
    "line_hold": "the elastic line",
}
"""Other choices of the model as parts of a change."""


@dataclass(frozen=True, eq=False)
class Examined:
    """A diagnosis; ``out`` is where the cured design was saved, or empty."""

    diagnosis: Diagnosis
    out: str

    @property
    def assessment(self) -> Assessment:
        """The overall verdict on the design."""
        return assessed(self.diagnosis.standing)

    @property
    def helped(self) -> bool:
        """Whether its run is well, or something was found that makes it so."""
        return not self.diagnosis.complaint or self.diagnosis.cure is not None


def run_doctor(
    source: str, design: Design, lengths: Sequence[str], elastics: Sequence[str], out: str
) -> Examined:
    """Examine a design with ``lengths``, NAME=LENGTH, and ``elastics``, LINE=ELASTIC.

    ``source`` is the file it came from; ``out`` the project that a cured design is saved as, or empty.
    """
    if out and not is_project(out):
        raise UserError(
            f"{out} is not a project file name.", f"Specify a project file: --out design{SUFFIX}."
        )
    stages = build(design)
    stages = build(made_of(dressed(design, stages.model.lines, lengths), elastics), stages)
    found = diagnose(stages)
    if out and found.cure is not None:
        document = open_project(source) if is_project(source) else Document.of(found.cure.change.design)
        with backed_up(Path(out)):
            save_project(out, document.with_design(found.cure.change.design), stages.scan, None)
        return Examined(found, out)
    return Examined(found, "")


def examined_text(examined: Examined, as_json: bool) -> str:
    """Return what is to be printed: sentences for people, or the same figures as JSON."""
    return json.dumps(_figures(examined), indent=1) if as_json else "\n".join(_plain(examined))


def _plain(examined: Examined) -> Iterator[str]:
    found = examined.diagnosis
    yield from assessment_lines(examined.assessment, found.stages.design)
    if not found.complaint:
        yield f"The solver converged in {found.verdict.turns} iterations."
        yield from _table(found)
        if found.findings:
            yield from _remedy(examined)
        return
    yield f"{found.complaint}: {MEANING[found.complaint]}"
    verdict = found.verdict
    if verdict.period:
        yield (
            f"oscillates with a period of {verdict.period:.1f} iterations, amplitude "
            f"{100.0 * verdict.amplitude:.2f} % of the volume, {_growth(verdict.growth)}"
        )
    if found.onset is not None and 1.0 < found.onset < float("inf"):
        yield (
            f"a small oscillation about the equilibrium grows by {100.0 * (found.onset - 1.0):.1f} % "
            "per iteration"
        )
    if found.bears is not None:
        gain = found.stages.gain
        share = f"{100.0 * gain / found.bears:.0f} %"
        yield (
            f"the conventional gain is {gain:.2f}, {share} of the {found.bears:.2f} stability limit "
            "of this shape"
        )
    yield _fight(found.fight.worst)
    yield from _table(found)
    yield from _remedy(examined)


def _growth(growth: float) -> str:
    percent = 100.0 * (growth - 1.0)
    if abs(percent) < 0.05:
        return "with constant amplitude"
    return f"and {'grows' if percent > 0.0 else 'fades'} by {abs(percent):.1f} % a turn"


def _fight(worst: Clash | None) -> str:
    if worst is None:
        return "no pair of constraints conflicts clearly"
    sizes = f"{worst.one.newtons:.1f} N against {worst.other.newtons:.1f} N"
    return f"{_name(worst.one)} and {_name(worst.other)} conflict: {worst.angle:.0f} degrees apart, {sizes}"


def _name(pull: Pull) -> str:
    return " and ".join(pull.lines) or "the volume"


def _table(found: Diagnosis) -> Iterator[str]:
    fight = found.fight
    if not fight.pulls:
        return
    if fight.share < 1.0:
        yield (
            f"the last equilibrium is at {100.0 * fight.share:.0f} % of the change from the original "
            "to these lengths; forces there:"
        )
    yield f"  {'':24}{'force':>10}   to the volume"
    for pull in fight.pulls:
        sides = f"   left {pull.sides[0]:.1f} N, right {pull.sides[1]:.1f} N" if pull.sides else ""
        yield f"  {_name(pull):24}{pull.newtons:8.1f} N{pull.to_volume:8.0f} degrees{sides}"
    yield f"  {'skin':24}{fight.skin:8.1f} N"
    yield "  (sum over all points; for tension along a line see busk cut)"


def _remedy(examined: Examined) -> Iterator[str]:
    found = examined.diagnosis
    if found.fixes:
        yield "Fixes, verified from the original body and from the current state, best first:"
        for place, cure in enumerate(found.fixes, start=1):
            yield f"  {place}. {change_words(found, cure.change)}: {_remains(found, cure)}"
            if cure.choice_ends:
                yield f"     {_parts(cure)}"
        if examined.out:
            yield f"written to {examined.out}"
        return
    yield "No fix found among changes of one line, of the gain or of the model."
    if found.nearest is not None:
        yield f"Closest: {change_words(found, found.nearest.change)}; status then: {found.nearest.left}."
    if found.locked:
        yield f"Locked and not changed: {', '.join(found.locked)}."


def _remains(found: Diagnosis, cure: Cure) -> str:
    """Return what is left to be checked with a change."""
    left = Assessment(cure.remains)
    view = assessment_view(left, cure.change.design)
    return " ".join((f"{view.headline}.", *(message for message, _ in view.reasons)))


def _parts(cure: Cure) -> str:
    """Return which part of a double change ends what."""
    one, other = TROUBLES[cure.choice_ends], TROUBLES[cure.lengths_end]
    if one == other:
        return f"Neither part is sufficient alone; status: {cure.choice_ends}."
    lengths = "the lengths" if cure.change.kind == "together" else "the length"
    return f"{PARTS[cure.change.setting[0]].capitalize()} removes {one}, {lengths} {other}."


def change_words(found: Diagnosis, change: Change) -> str:
    """Return what a change does, as part of a sentence."""
    parts = []
    if change.setting in CHOICES:
        parts.append(CHOICES[change.setting])
    if "gain" in (change.kind, change.setting[0]):
        parts.append(f"lower the gain from {found.stages.gain:.2f} to {change.design.gain:.2f}")
    if change.kind == "length":
        longer = found.longer_mm(change)
        percent = 100.0 * change.design.ratio(change.lines[0])
        names = " and ".join(change.lines)
        verb = "lengthen" if longer > 0.0 else "shorten"
        parts.append(f"{verb} {names} by {abs(longer):.1f} mm, to {percent:.1f} %")
    if change.kind == "together":
        lengths = (f"{name} to {100.0 * change.design.ratio(name):.1f} %" for name in change.lines)
        nearer = f"move all lines up to {found.moves_mm(change):.0f} mm closer to their original lengths"
        parts.append(f"{nearer}: {', '.join(lengths)}")
    if change.kind == "width":
        width = change.design.traits_of(change.lines[0]).width
        parts.append(f"widen {' and '.join(change.lines)} to {width:g} mm")
    if change.kind == "off":
        parts.append(f"deactivate {' and '.join(change.lines)}")
    return ", and ".join(parts)


def _figures(examined: Examined) -> dict[str, Any]:
    found, verdict = examined.diagnosis, examined.diagnosis.verdict
    return {
        "assessment": examined.assessment.as_data(),
        "complaint": found.complaint or None,
        "state": verdict.told,
        "turns": verdict.turns,
        "period_turns": verdict.period or None,
        "amplitude_percent": 100.0 * verdict.amplitude if verdict.period else None,
        "growth_per_turn": verdict.growth if verdict.period else None,
        "growth_at_first": found.onset if found.onset and found.onset < float("inf") else None,
        "gain": found.stages.gain,
        "gain_borne": found.bears,
        **_forces(found.fight),
        **_treatment(found),
        "locked": list(found.locked),
        "written_to": examined.out or None,
        "definition": (
            "forces on the free points at convergence, or at the last equilibrium before it, "
            "magnitudes summed over all points; angles between their effects on the skin; newtons "
            "depend on the assumed tissue stiffness; size_percent: of the original length, or of the "
            "gain"
        ),
        "versions": {"busk": __version__},
    }


def _forces(fight: Fight) -> dict[str, Any]:
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
        for pull in fight.pulls
    ]
    return {"fight": named, "balance_share": fight.share, "forces": forces, "skin_newtons": fight.skin}


def _treatment(found: Diagnosis) -> dict[str, Any]:
    cure, nearest = found.cure, found.nearest
    return {
        "cure": None if cure is None else _change(found, cure.change),
        "state_with_cure": None if cure is None else cure.standing.verdict.told,
        "ended_by_choice": (cure and cure.choice_ends) or None,
        "ended_by_lengths": (cure and cure.lengths_end) or None,
        "fixes": [{**_change(found, each.change), **_left(each)} for each in found.fixes],
        "nearest": None if nearest is None else _change(found, nearest.change),
        "state_with_nearest": None if nearest is None else nearest.left,
    }


def _left(cure: Cure) -> dict[str, Any]:
    return {"state": cure.standing.verdict.told, "remains": Assessment(cure.remains).as_data()}


def _change(found: Diagnosis, change: Change) -> dict[str, Any]:
    key, value = change.setting
    return {
        "kind": change.kind,
        "words": change_words(found, change),
        "lengths_percent": {line.name: 100.0 * line.ratio for line in change.design.lines},
        "gain": change.design.gain,
        "setting": {key: value} if key else None,
        "size_percent": change.size,
    }
