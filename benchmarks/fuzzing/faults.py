"""Faults on purpose: each must be noticed by the worker's limits."""

from __future__ import annotations

import os
from typing import Any


def run(recipe: Any) -> str:
    """Fail in the way of the recipe's name."""
    if recipe == "traceback":
        raise KeyError(recipe)
    if recipe == "crash":
        os._exit(3)
    held = []
    while recipe in ("hang", "memory"):
        if recipe == "memory":
            held.append(bytearray(b"x" * 20_000_000))
    return "fine"
