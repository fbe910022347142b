"""Which numbers a second scan can tell, and what the others cannot be told from (ours)."""

from __future__ import annotations

import numpy as np

from core.mesh import Floats
from core.worn_scan.least_squares import Normal
from core.worn_scan.numbers import Number

NOISE = 1.0
"""Of a good scan, to judge beforehand what can be told [mm]."""

_ALIKE = 0.7  # correlation from which on two numbers count as not told apart


def tellable(slopes: Floats, numbers: tuple[Number, ...]) -> tuple[tuple[Number, ...], dict[str, str]]:
    """Return those of ``numbers`` that a good scan tells, whose gaps have ``slopes`` (k, p) [mm].

    Beside them, for each of the others, what it cannot be told from; empty if it does nothing.
    """
    confused: dict[str, str] = {}
    columns = list(range(len(numbers)))
    while columns:
        chosen = slopes[:, columns] - slopes[:, columns].mean(axis=0)
        matrix = chosen.T @ chosen
        good = Normal(matrix, np.zeros(len(columns)), NOISE**2 * matrix)
        now = tuple(numbers[column] for column in columns)
        worst = least_sure(good, now)
        if worst is None:
            break
        confused[now[worst].name] = confused_with(good, now, worst)
        del columns[worst]
    return tuple(numbers[column] for column in columns), confused


def unsure_of(equations: Normal) -> Floats:
    """Return the standard deviations of numbers as they are sought, (p,); infinite where nothing tells."""
    blind = np.diag(equations.matrix) <= 1e-12
    return np.where(blind, np.inf, np.sqrt(np.maximum(np.diag(equations.covariance), 0.0)))


def least_sure(equations: Normal, numbers: tuple[Number, ...]) -> int | None:
    """Return which number is least sure, if it is less sure than what counts as told."""
    share = unsure_of(equations) / np.array([number.doubt for number in numbers])
    return int(share.argmax()) if share.max(initial=0.0) > 1.0 else None


def confused_with(equations: Normal, numbers: tuple[Number, ...], at: int) -> str:
    """Return the name of the number that one cannot be told from, empty if it does nothing by itself."""
    size = np.sqrt(np.maximum(np.diag(equations.covariance), 1e-300))
    alike = np.abs(equations.covariance[at]) / (size * size[at])
    alike[at] = 0.0
    other = int(alike.argmax())
    return numbers[other].name if alike[other] > 0.7 else ""
