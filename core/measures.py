"""Measures: what a body measures, at rest and reshaped, for a pattern cutter."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType

import numpy as np
from scipy.spatial import cKDTree

from core.body import Body
from core.design_measures import OwnMeasure
from core.landmark import Landmarks
from core.measuring.cups import NO_ROOT, cup_measures, foremost_places
from core.measuring.definitions import KEYS, Measure, missing
from core.measuring.girths import girth_measures
from core.measuring.own import own_measures
from core.measuring.subject import Subject, subject_of
from core.mesh import Mesh, Points
from core.pipeline import Stages
from core.tffd import deform

Measures = Mapping[str, Measure]
"""Measures by their keys, in the order of the table of definitions; own ones come last, as "own:NAME"."""


def measures(mesh: Mesh, landmarks: Landmarks, own: Iterable[OwnMeasure] = ()) -> Measures:
    """Return what a body measures; of a scan take the calm skin, ``body.calm``.

    One that the scan does not show is there with the value None and the reason.
    """
    return _measured(subject_of(mesh, landmarks), own)


def before_after(stages: Stages, control_points: Points) -> tuple[Measures, Measures]:
    """Return what a body measures at rest, and reshaped by ``control_points``, shape (n, 3) [mm].

    The landmarks ride on the skin and the levels follow them; the lift of the apex is told after alone.
    """
    rest = subject_of(stages.body.calm, stages.landmarks)
    moves = deform(stages.binding, control_points) - stages.body.mesh.vertices
    after = rest.moved(rest.mesh.vertices + calm_moves(stages.body, moves))
    own = stages.design.own_measures
    return _measured(rest, own), _measured(after, own, rest)


def calm_moves(body: Body, moves: Points) -> Points:
    """Return how the vertices of the calm skin move where those of the scan make ``moves``, (n, 3) [mm].

    The calm skin has the vertices of the scan, or, of a giant scan, fewer: these go as the nearest do.
    """
    if len(body.calm.vertices) == len(moves):
        return moves
    nearest = cKDTree(body.mesh.vertices).query(body.calm.vertices)[1]
    return np.asarray(moves[nearest])


def _measured(subject: Subject, own: Iterable[OwnMeasure], rest: Subject | None = None) -> Measures:
    found = {each.key: each for each in (*girth_measures(subject), *cup_measures(subject))}
    if rest is not None:
        found["apex_lift"] = _lift(subject, rest)
    ordered = {key: found[key] for key in KEYS if key in found}
    ordered |= {each.key: each for each in own_measures(subject, own)}
    return MappingProxyType(ordered)


def _lift(subject: Subject, rest: Subject) -> Measure:
    now, before = foremost_places(subject), foremost_places(rest)
    if now is None or before is None:
        return missing("apex_lift", NO_ROOT)
    sure = min(root.confidence for root in subject.roots.values())
    return Measure("apex_lift", float((now - before)[:, 1].mean()), "mm", (), sure)
