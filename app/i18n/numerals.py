"""Numbers as the window writes them."""

from __future__ import annotations


def number(value: float, digits: int = 1, signed: bool = False) -> str:
    """Return ``value`` with thousands commas and a real minus sign; ``signed`` writes the plus too."""
    text = f"{value:{'+' if signed else ''},.{digits}f}"
    if not text.strip("+-0.,"):
        text = text.lstrip("+-")
    return text.replace("-", "\N{MINUS SIGN}")
