"""Courses of runs made by hand, and what is judged of them turn by turn."""

import numpy as np

from core.mechanics.convergence import assess_convergence
from core.mechanics.iteration import Record


def course(errors, steps=1.0, lengths=None):
    steps = np.broadcast_to(steps, len(errors))
    lengths = np.empty((len(errors), 0)) if lengths is None else lengths
    return [
        Record(turn, float(error), 2600.0 * float(error), float(step), tuple(map(float, length)))
        for turn, (error, step, length) in enumerate(zip(errors, steps, lengths, strict=True), start=1)
    ]


def motions(errors, steps=1.0):
    """What was judged after each turn."""
    records = course(errors, steps)
    return [assess_convergence(records[:turn]).motion for turn in range(1, len(records) + 1)]


def motions_of(records):
    """The motions of a run in the order in which they were judged, each said once."""
    words = [assess_convergence(records[:turn]).motion for turn in range(1, len(records) + 1)]
    return [word for word, before in zip(words, ["", *words], strict=False) if word != before]
