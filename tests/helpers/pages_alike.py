"""Whether a page of the documentation says what is printed: the same words, the numbers to a last digit."""

import re

import pytest

NUMBER = r"[+-]?\d+(?:\.\d+)?"


def alike(page: str, printed: str) -> bool:
    """Tell whether two texts differ in the last digits of numbers only, as those of two machines may."""
    if [_words(line) for line in page.splitlines()] != [_words(line) for line in printed.splitlines()]:
        return False
    numbers = [[float(each) for each in re.findall(NUMBER, text)] for text in (page, printed)]
    return numbers[0] == pytest.approx(numbers[1], abs=0.15)


def _words(line: str) -> list[str]:
    return re.sub(NUMBER, "#", line).split()
