"""Which numbers a second scan can tell, and what the others cannot be told from (ours)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.special import chdtri

from core.design import Design
from core.mesh import Floats
from core.worn_scan.least_squares import Normal
from core.worn_scan.numbers import OWN_DOUBT, STIFFNESS, Number

NOISE = 1.0
"""Of a good scan, to judge beforehand what can be told [mm]."""

_ALIKE = 0.7  # correlation from which on two numbers count as not told apart
_CHANCE = 0.05  # that lines of one stiffness are taken for unlike


def tellable(slopes: Floats, numbers: tuple[Number, ...]) -> tuple[tuple[Number, ...], dict[str, str]]:
    """Return those of ``numbers`` that a good scan tells, whose gaps have ``slopes`` (k, p) [mm].

    Beside them, for each of the others, what it cannot be told from; empty if it does nothing.
    """
    confused: dict[str, str] = {}
    columns = list(range(len(numbers)))
    while columns:
        chosen = slopes[:, columns] - slopes[:, columns].mean(axis=0)
        matrix = chosen.T @ chosen
        white = NOISE**2 * np.linalg.pinv(matrix, rcond=1e-14, hermitian=True)
        good = Normal(matrix, np.zeros(len(columns)), white)
        now = tuple(numbers[column] for column in columns)
        worst = least_sure(good, [number.blind for number in now])
        if worst is None:
            break
        confused[now[worst].name] = confused_with(good, now, worst)
        del columns[worst]
    return tuple(numbers[column] for column in columns), confused


def unsure_of(equations: Normal) -> Floats:
    """Return the standard deviations of numbers as they are sought, (p,); infinite where nothing tells."""
    blind = np.diag(equations.matrix) <= 1e-12
    return np.where(blind, np.inf, np.sqrt(np.maximum(np.diag(equations.covariance), 0.0)))


def least_sure(equations: Normal, doubts: Sequence[float]) -> int | None:
    """Return which number is least sure, if it is less sure than ``doubts`` (p,) say, as it is sought."""
    share = unsure_of(equations) / np.array(doubts)
    return int(share.argmax()) if share.max(initial=0.0) > 1.0 else None


def one_will_do(equations: Normal, numbers: tuple[Number, ...], design: Design) -> bool:
    """Tell whether one stiffness for all lines says as much as those of its own that each was given.

    So it is where one of them is unsure by itself, and nothing tells it from the others (95 %, after Wald).
    """
    own = [at for at, number in enumerate(numbers) if number.kind == STIFFNESS]
    unsure = unsure_of(equations)[own]
    if len(own) < 2 or unsure.max() <= OWN_DOUBT or not np.isfinite(unsure).all():
        return False
    logs = np.array([numbers[at].sought(design) for at in own])
    apart = np.eye(len(own))[1:] - np.eye(len(own))[0]
    between = apart @ equations.covariance[np.ix_(own, own)] @ apart.T
    far = float(apart @ logs @ np.linalg.pinv(between, hermitian=True) @ (apart @ logs))
    return bool(chdtri(len(own) - 1, _CHANCE) > far)


def confused_with(equations: Normal, numbers: tuple[Number, ...], at: int) -> str:
    """Return the name of the number that one cannot be told from, empty if it does nothing by itself."""
    size = np.sqrt(np.maximum(np.diag(equations.covariance), 1e-300))
    alike = np.abs(equations.covariance[at]) / (size * size[at])
    alike[at] = 0.0
    other = int(alike.argmax())
    return numbers[other].name if alike[other] > _ALIKE else ""
