"""Format a diagnosis: one sentence, the words of the buttons, and all values."""

from __future__ import annotations

from collections.abc import Iterator

from app.i18n.catalog import joined, listed, number, tr
from app.i18n.lengths import length
from app.presenters.assessment import assessment_view
from app.presenters.lines import row_title
from app.presenters.messages import line_title
from app.presenters.status import state_title
from core.analysis.diagnosis.candidate_changes import Change, Fix
from core.analysis.diagnosis.diagnose import Diagnosis
from core.analysis.diagnosis.opposing_constraints import ConstraintForce
from core.garment.assessment import BAD, Assessment, Finding
from core.garment.pressure import pressure_limits

BUTTONS = 2
"""Fixes that have a button at most."""

_ROOM = 56  # letters on the buttons of a notice in the narrowest window
_SEEN = 0.05  # mm that a bust point swings by at least where its swing is worth a word
_STEADY = 5e-4  # a swing that changes by less a turn stays as large as it is [1]


def sentence(found: Diagnosis, swing: float) -> str:
    """Return what is wrong in one sentence, with what fights if any pair stands out.

    ``swing`` [mm] is how far the bust point swings to either side.
    """
    worst = found.forces.worst
    if worst is None:
        return _plain(found, swing)
    words = {
        "vibrating": tr(
            "{one} and {other} conflict: the bust point oscillates by ±{swing} (period {period} iterations)."
        ),
        "volume": tr(
            "{one} and {other} conflict: the volume oscillates by ±{percent} % (period {period} iterations)."
        ),
        "diverging": tr("{one} and {other} conflict: the solver diverged."),
        "folded": tr("{one} and {other} conflict: the mesh is folded."),
        "overstrained": tr("{one} and {other} conflict: skin is compressed or stretched by over 30 %."),
        "strained": tr("{one} and {other} conflict: skin is compressed or stretched by over 20 %."),
        "settling": tr("{one} and {other} conflict: the solver does not converge."),
        "unreachable": tr("{one} and {other} conflict: no equilibrium found."),
    }
    one, other = (_name(found, pull) for pull in (worst.one, worst.other))
    what = "volume" if found.problem == "vibrating" and swing < _SEEN else found.problem
    percent = number(100.0 * found.verdict.amplitude, 2)
    values = {"swing": length(swing), "percent": percent, "period": _period(found)}
    return words[what].format(one=one, other=other, **values)


def _plain(found: Diagnosis, swing: float) -> str:
    words = {
        "vibrating": tr("The solver does not converge: the bust point oscillates by ±{swing}."),
        "diverging": tr("The solver diverged. The last valid shape is shown."),
        "folded": tr("The skin overlaps itself: this is not a valid shape."),
        "overstrained": tr(
            "Skin is compressed or stretched by over 30 %: do not use this shape for production."
        ),
        "strained": tr("Skin is compressed or stretched by over 20 %."),
        "settling": tr("The solver has not converged."),
        "unreachable": tr("No equilibrium found for these line lengths."),
    }
    unseen = found.problem == "vibrating" and swing < _SEEN  # in the volume alone
    return words["settling" if unseen else found.problem].format(swing=length(swing))


def hint(found: Diagnosis) -> str:
    """Return what leads to the buttons, or what there is to do where there are none."""
    if found.fixes:
        return _leading(found)
    texts = [tr("No fix found by changing one line, the gain or the model.")]
    if found.locked:
        titles = listed(line_title(name, found.stages.design) for name in found.locked)
        texts.append(tr("Locked lines were not changed: {lines}.").format(lines=titles))
    return joined(texts)


def _leading(found: Diagnosis) -> str:
    """Return what the changes on the buttons leave: only what leaves nothing bad is called a verified fix."""
    shown = shown_fixes(found)
    first, *others = (_left(cure) for cure in shown)
    if not any(cure.remains for cure in shown):
        return tr("Verified fixes:") if others else tr("Verified fix:")
    partial = all(cure.level == BAD for cure in shown)
    if others:
        words = (
            tr("Partial fixes. Remaining with the first: {one}; with the second: {other}.")
            if partial
            else tr("Fixes. Remaining with the first: {one}; with the second: {other}.")
        )
        return words.format(one=first, other=others[0])
    words = tr("Partial fix. Remaining: {what}.") if partial else tr("Verified fix. Remaining: {what}.")
    return words.format(what=first)


def shown_fixes(found: Diagnosis) -> tuple[Fix, ...]:
    """Return the fixes that have a button: the best, and the next if a narrow window has room."""
    best = found.fixes[:BUTTONS]
    return best if sum(_wide(change_text(found, cure.change)) for cure in best) <= _ROOM else best[:1]


def _wide(words: str) -> int:
    """Return about how wide words are, in Latin letters."""
    return sum(2 if letter > "\u2e80" else 1 for letter in words)


def _left(cure: Fix) -> str:
    """Return what remains with a fix: the worst finding of each topic."""
    worst = {each.topic: each for each in reversed(cure.remains)}
    order = dict.fromkeys(each.topic for each in cure.remains)
    return listed(_amount(cure, worst[topic]) for topic in order) or tr("no problems")


def _amount(cure: Fix, finding: Finding) -> str:
    """Return what remains with a fix in a few words, and how much."""
    if finding.topic == "pressure" and finding.level == BAD:
        words, limit = tr("contact pressure {kpa} kPa (limit {most} kPa)"), pressure_limits().red_kpa
        return words.format(kpa=number(finding.value), most=number(limit))
    if finding.topic == "pressure":
        return tr("snug contact pressure {kpa} kPa").format(kpa=number(finding.value))
    condition = cure.trial.verdict.condition
    if finding.topic == "shape" and condition is not None:
        low, high = (100.0 * (each - 1.0) for each in (condition.shortest, condition.longest))
        words = tr("skin strain {low} to {high} %")
        return words.format(low=number(low, 0, signed=True), high=number(high, 0, signed=True))
    return tr("slack or overstretched band")


def change_text(found: Diagnosis, change: Change) -> str:
    """Return what a change does, as an undo step is called."""
    choice = {
        ("volume", "adaptive"): tr("Use adaptive"),
        ("volume", "exact"): tr("Use exact"),
        ("line_force", "implicit"): tr("Use implicit line force"),
        ("line_hold", "spring"): tr("Use elastic lines"),
    }.get(change.setting, "")
    design, what = found.stages.design, ""
    if "gain" in (change.kind, change.setting[0]) and change.design.gain is not None:
        choice = tr("Reduce gain to {gain}").format(gain=number(change.design.gain, 2))
    if change.kind == "length":
        ratio = change.design.ratio(change.lines[0])
        values = {
            "line": row_title(change.lines[0], design),
            "length": length(abs(found.longer_mm(change))),
            "percent": number(100.0 * ratio),
        }
        longer = ratio > design.ratio(change.lines[0])
        what = tr("Lengthen {line} by {length}") if longer else tr("Shorten {line} by {length}")
        if found.problem == "unreachable":  # that length is nowhere to be seen
            what = tr("Set {line} to {percent} %")
        what = what.format(**values)
    elif change.kind == "together":
        what = tr("All lines up to {length} closer to 100 %")
        what = what.format(length=length(found.moves_mm(change), 0))
    elif change.kind == "width":
        what = tr("Widen elastic of {line} to {length}")
        width = change.design.line_settings(change.lines[0]).width
        what = what.format(line=row_title(change.lines[0], design), length=length(width or 0.0, 0))
    elif change.kind == "off":
        what = tr("Deactivate {line}").format(line=row_title(change.lines[0], design))
    return listed((choice, what[:1].lower() + what[1:])) if choice and what else choice or what


def details(found: Diagnosis) -> str:
    """Return all figures, a line each: what fights and what ends it stand first."""
    pair = [_pair(found)] if found.problem else []
    return "\n".join([*pair, *_changes(found), *_run(found), *_forces(found)])


def _pair(found: Diagnosis) -> str:
    worst = found.forces.worst
    if worst is None:
        return tr("No conflicting pair found.")
    words = tr("{one} and {other}: forces on the skin {angle}° apart")
    one, other = (_name(found, pull) for pull in (worst.one, worst.other))
    return words.format(one=one, other=other, angle=number(worst.angle, 0))


def _run(found: Diagnosis) -> Iterator[str]:
    verdict = found.verdict
    if verdict.period:
        words = tr("Oscillation: period {period} iterations, volume ±{percent} %; {grows}")
        percent = number(100.0 * verdict.amplitude, 2)
        yield words.format(period=_period(found), percent=percent, grows=_growth(verdict.growth))
    if found.onset is not None and 1.0 + _STEADY < found.onset < float("inf"):
        words = tr("Small oscillations increase by {percent} % per iteration")
        yield words.format(percent=number(100.0 * (found.onset - 1.0)))
    if found.gain_limit is not None:
        words = tr("Gain {gain}: {percent} % of the limit {most} for this shape")
        share = number(100.0 * found.gain / found.gain_limit, 0)
        yield words.format(gain=number(found.gain, 2), percent=share, most=number(found.gain_limit, 2))


def _growth(growth: float) -> str:
    percent = number(100.0 * abs(growth - 1.0))
    if growth - 1.0 > _STEADY:
        return tr("increasing by {percent} % per iteration").format(percent=percent)
    if growth - 1.0 < -_STEADY:
        return tr("decreasing by {percent} % per iteration").format(percent=percent)
    return tr("constant")


def _forces(found: Diagnosis) -> Iterator[str]:
    fight = found.forces
    if fight.share < 1.0:
        words = tr("Forces in the last equilibrium, {percent} % of the way from original to set lengths:")
        yield words.format(percent=number(100.0 * fight.share, 0))
    elif fight.forces:
        yield tr("Forces in equilibrium at these lengths (tissue stiffness assumed):")
    for pull in fight.forces:
        yield "  " + _force(found, pull)
    if fight.forces:
        yield "  " + tr("Skin: {newtons} N").format(newtons=number(fight.skin))
        yield "  " + tr("Sum of the forces at all points. For tension along a line, see the Garment tab.")


def _force(found: Diagnosis, pull: ConstraintForce) -> str:
    name, newtons = _name(found, pull), number(pull.newtons)
    if pull.lines:
        words = tr("{name}: {newtons} N, {angle}° to the volume force")
        return words.format(name=name, newtons=newtons, angle=number(pull.to_volume, 0))
    name = name[:1].upper() + name[1:]
    if pull.sides is None:
        return tr("{name}: {newtons} N").format(name=name, newtons=newtons)
    left, right = (number(side) for side in pull.sides)
    words = tr("{name}: {newtons} N (left {left}, right {right})")
    return words.format(name=name, newtons=newtons, left=left, right=right)


def _changes(found: Diagnosis) -> Iterator[str]:
    if found.fixes:
        yield tr("Fixes, best first; each was verified from the original and the current shape:")
    for place, cure in enumerate(found.fixes, start=1):
        view = assessment_view(Assessment(cure.remains), cure.change.design)
        text = joined((tr("{headline}.").format(headline=view.headline), *(each for each, _ in view.reasons)))
        change = change_text(found, cure.change)
        yield "  " + tr("{place}. {change}: {what}").format(place=place, change=change, what=text)
        if cure.option_result:
            yield "     " + _parts(cure)
        if cure.change.kind == "together":
            after = cure.change.design
            lengths = (
                tr("{line} {percent} %").format(
                    line=line_title(name, after), percent=number(100.0 * after.ratio(name))
                )
                for name in cure.change.lines
            )
            yield "     " + listed(lengths)
    if found.nearest is not None:
        words = tr("Best change tried: {change}; status “{state}”")
        text = change_text(found, found.nearest.change)
        yield words.format(change=text, state=state_title(found.nearest.remaining_problem))


def _parts(cure: Fix) -> str:
    """Return which part of a double change ends what; ``cure`` knows how each did alone."""
    if _trouble(cure.option_result) == _trouble(cure.lengths_result):
        words = tr("One change alone is not enough: status “{state}”")
        return words.format(state=state_title(cure.option_result))
    choice = {
        "gain": tr("The gain"),
        "volume": tr("The volume control"),
        "line_force": tr("Implicit line force"),
        "line_hold": tr("Elastic lines"),
    }[cure.change.setting[0]]
    length = tr("the lengths") if cure.change.kind == "together" else tr("the length")
    words = tr("{choice} resolved {one}; {length} resolved {other}")
    troubles = {"one": _trouble(cure.option_result), "other": _trouble(cure.lengths_result)}
    return words.format(choice=choice, length=length, **troubles)


def _trouble(complaint: str) -> str:
    """Return what is wrong as a thing that something can end."""
    words = {
        "vibrating": tr("the oscillation"),
        "diverging": tr("the divergence"),
        "settling": tr("the slow convergence"),
        "folded": tr("the folding"),
        "unreachable": tr("the missing equilibrium"),
    }
    return words.get(complaint, tr("the strain"))


def _name(found: Diagnosis, pull: ConstraintForce) -> str:
    if not pull.lines:
        return tr("the volume")
    title = row_title if len(pull.lines) > 1 else line_title
    return title(pull.lines[0], found.stages.design)


def _period(found: Diagnosis) -> str:
    period = found.verdict.period
    return number(period, 0 if abs(period - round(period)) < 0.05 else 1)
