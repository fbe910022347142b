"""Blocks: what no garment can have is refused as the file is read, before anything is drawn."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import pytest

from core.document.block import LONGEST_PLACE, MOST_TURN
from core.errors import PatternError
from core.pattern.block_library import block_of, block_text, built_in_blocks, find_block

Values = dict[str, Any]


def changed(change: Callable[[Values], object]) -> str:
    values = json.loads(block_text(find_block("two-part-cup")))
    change(values)
    return json.dumps(values)


def seam(values: Values, name: str) -> Values:
    return next(each for each in values["seams"] if each["name"] == name)


def panel(values: Values, name: str) -> Values:
    return next(each for each in values["panels"] if each["name"] == name)


@pytest.mark.parametrize(
    "change",
    [
        lambda block: block.update(panels=[]),
        lambda block: panel(block, "bridge").update(name="cradle left"),
        lambda block: seam(block, "bridge top").update(name="wire right"),
        lambda block: seam(block, "wire").update(span=[-1e9, 1e9]),
        lambda block: seam(block, "wire").update(each=False),
        lambda block: seam(block, "band edge").update(span=[-1e300, 1e300]),
        lambda block: seam(block, "band edge").update(span=[0.5, 0.5]),
        lambda block: seam(block, "band edge").update(line="\x07"),
        lambda block: seam(block, "cup seam")["places"].__setitem__(0, f"root {'9' * LONGEST_PLACE}"),
        lambda block: seam(block, "cup seam").update(right=["apex", "root\x00 72"]),
        lambda block: panel(block, "wing").update(seed="ring " + "a " * LONGEST_PLACE),
        lambda block: panel(block, "wing").update(cloth="z" * 1000),
        lambda block: panel(block, "wing").update(cloth="power\u202enet"),
        lambda block: panel(block, "wing").update(turn=MOST_TURN + 1.0),
    ],
)
def test_a_block_beyond_its_limits_is_refused(change: Callable[[Values], object]) -> None:
    with pytest.raises(PatternError):
        block_of("mine", changed(change))


def test_what_is_refused_is_a_sentence() -> None:
    texts = ["", "[]", "3", "{}", changed(lambda block: block["seams"][0].update(each="yes"))]
    for text in texts:
        with pytest.raises(PatternError) as refused:
            block_of("mine", text)
        assert str(refused.value.message).endswith(".")
        assert ".." not in str(refused.value.text)


def test_a_block_is_read_back_as_it_was_written() -> None:
    for block in built_in_blocks():
        assert block_of(block.name, block_text(block)) == block
