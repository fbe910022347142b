"""Round numbers for axes."""

from __future__ import annotations

import math


def round_ticks(low: float, high: float, count: int = 4) -> list[float]:
    """Return about ``count`` round numbers from ``low`` to ``high``."""
    span = high - low
    if not (math.isfinite(span) and span > 0.0):
        return [low]
    rough = span / count
    unit = 10.0 ** math.floor(math.log10(rough))
    step = min((m * unit for m in (1, 2, 2.5, 5, 10)), key=lambda s: abs(span / s - count))
    first = math.ceil(low / step - 1e-9)
    return [i * step for i in range(first, math.floor(high / step + 1e-9) + 1)]


def digits_of(levels: list[float]) -> int:
    """Return with how many digits these levels are told apart."""
    return next((d for d in (0, 1, 2) if all(abs(v - round(v, d)) < 1e-9 for v in levels)), 3)
