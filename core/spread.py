"""How far the figures of a solved design may be off: a standard deviation for each, and a band for its skin.

What is not known exactly is a number in ``resources/spread.json``; it is propagated to all figures by
derivatives (``core.advice.propagated``), or sampled by solving designs anew (``core.advice.sampled``).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from types import MappingProxyType

import numpy as np
from threadpoolctl import threadpool_limits

from core.advice.assumed import Assumed, assumed
from core.advice.knobs import Turned, knobs
from core.advice.propagated import Effect, Propagation, effects
from core.advice.trials import Trials
from core.errors import UserError
from core.measuring.plus_minus import AFTER, BEFORE, LANDMARKS, ROOT, SCAN, SOURCES, Doubt, Spread
from core.mechanics import CONTACTS
from core.pipeline import Stages
from core.progress import Progress, quiet


def spread_of(
    stages: Stages,
    sizes: Assumed | None = None,
    progress: Progress = quiet,
    former: Trials | None = None,
) -> Spread:
    """Return how far the figures of a design may be off; see ``spreads``."""
    *_, last = spreads(Trials(stages, former), sizes or assumed(), progress)
    return last


def spreads(trials: Trials, sizes: Assumed, progress: Progress = quiet) -> Iterator[Spread]:
    """Yield how far the figures of a design may be off, first without landmarks, which are slow, then whole.

    Raises NoAnswerError where the design has no exact answer, and Cancelled.
    """
    # Two BLAS threads make these small products many times slower.
    with threadpool_limits(1):
        propagation = Propagation(trials)
        turning = knobs(trials.base, sizes)
        quick = [knob for knob in turning if knob.source != LANDMARKS]
        slow = [knob for knob in turning if knob.source == LANDMARKS]
        found: list[Effect] = []
        failed = 0
        for at, effect in enumerate(effects(propagation, [*quick, *slow])):
            if at == len(quick) and at:
                yield _spread(propagation, found, sizes, failed)
            progress("propagating", at / (len(turning) + 2.0))
            failed += effect is None
            found += [effect] if effect else []
        progress("the other contact", (len(turning) + 1.0) / (len(turning) + 2.0))
        contact, figures = _other_contact(trials)
        whole = _spread(propagation, found, sizes, failed)
        yield replace(whole, sources=SOURCES, other=figures, contact=contact)


def _other_contact(trials: Trials) -> tuple[str, Mapping[str, float]]:
    """Return the skin contact that a design has not, and its figures with that; none without an answer."""
    design = trials.base.design
    other = next(each for each in CONTACTS if each != design.line_contact)
    try:
        tried = trials(Turned(replace(design, line_contact=other)))
    except UserError:
        return other, MappingProxyType({})
    return other, MappingProxyType(tried.figures)


def _spread(propagation: Propagation, found: list[Effect], sizes: Assumed, failed: int) -> Spread:
    doubts: dict[str, dict[str, float]] = {}
    for effect in found:
        for key, step in effect.figures.items():
            of_figure = doubts.setdefault(key, {})
            of_figure[effect.knob.source] = np.hypot(of_figure.get(effect.knob.source, 0.0), step)
    for key, sd in _of_roots(propagation, sizes).items():
        doubts.setdefault(key, {})[ROOT] = sd
    skin = sum((effect.skin**2 for effect in found), np.zeros(len(propagation.places)))
    sources = tuple(dict.fromkeys(effect.knob.source for effect in found if effect.knob.source != LANDMARKS))
    told = {key: Doubt({name: float(sd) for name, sd in parts.items()}) for key, parts in doubts.items()}
    rest = next((effect.knob.sd for effect in found if effect.knob.source == SCAN), 0.0)
    return Spread(
        MappingProxyType(told), np.sqrt(skin), rest, sizes.sds, sources, MappingProxyType({}), "", failed
    )


def _of_roots(propagation: Propagation, sizes: Assumed) -> dict[str, float]:
    """Return what the top of the root, which no skin shows, makes of volumes, the same before and after."""
    before = propagation.trials.rest.before
    return {
        f"{kind}:{key}": measure.plus_minus / 2.0
        for kind in (BEFORE, AFTER)
        for key, measure in before.items()
        if measure.plus_minus and measure.value is not None
    }
