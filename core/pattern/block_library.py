"""The blocks that come with Busk, and blocks of one's own as files."""

from __future__ import annotations

import json
from dataclasses import fields
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

from core.document.block import Block
from core.document.json_values import parsed, value_of
from core.errors import PatternError, UserError, reason_of
from core.files.atomic_write import write_text
from core.files.regular_file import read_text
from core.messages import Message

LARGEST_BLOCK = 200_000
"""Bytes of a block's file."""


@cache
def built_in_blocks() -> tuple[Block, ...]:
    """Return the blocks that come with Busk, by name."""
    folder = resources.files("resources") / "blocks"
    files = {each.name: each for each in folder.iterdir() if each.name.endswith(".json")}
    texts = {name: files[name].read_text(encoding="utf-8") for name in sorted(files)}
    return tuple(block_of(name.removesuffix(".json"), text) for name, text in texts.items())


def find_block(name: str) -> Block:
    """Return a block by its name. Raises PatternError with the names that there are."""
    blocks = {block.name: block for block in built_in_blocks()}
    if name not in blocks:
        raise PatternError(
            Message("There is no block '{name}'.", name=name),
            Message("Choose one of: {choices}.", choices=", ".join(blocks)),
        )
    return blocks[name]


def block_of(name: str, text: str) -> Block:
    """Return the block that a JSON text describes. Raises PatternError, which says what is wrong in it."""
    try:
        values = parsed(text)
        return value_of(Block, {**values, "name": name} if isinstance(values, dict) else values, "block")
    except PatternError:
        raise
    except UserError as error:
        raise PatternError(
            Message("The block {name} cannot be used. {why}", name=name, why=error.message),
            Message("Correct the file or choose another block."),
        ) from error
    except (TypeError, ValueError) as error:
        raise _refusal(name, str(error)) from error


def block_text(block: Block) -> str:
    """Return a block as JSON text, without what is as usual."""
    values = _plain(block)
    values.pop("name")
    return json.dumps(values, indent=1, ensure_ascii=False) + "\n"


def _plain(value: Any) -> Any:
    """Return a dataclass as values of JSON, without fields that have their defaults."""
    kept = {
        field.name: getattr(value, field.name)
        for field in fields(value)
        if getattr(value, field.name) != field.default
    }
    return {
        key: [_plain(one) for one in each] if key in ("levels", "seams", "panels") else each
        for key, each in kept.items()
    }


def read_block(path: Path) -> Block:
    """Read a block, named after its file. Raises PatternError where it cannot be read or used."""
    try:
        return block_of(path.stem, read_text(path, LARGEST_BLOCK))
    except UnicodeDecodeError as error:
        raise _refusal(path.stem, "not text") from error
    except OSError as problem:
        raise PatternError(
            Message("The block {name} cannot be read: {why}.", name=path.name, why=reason_of(problem)),
            Message("Check the name and folder of the file."),
        ) from problem


def write_block(path: Path, block: Block) -> None:
    """Write a block."""
    write_text(path, block_text(block))


def _refusal(name: str, why: Message | str) -> PatternError:
    return PatternError(
        Message("The block {name} cannot be used: {why}.", name=name, why=why),
        Message("Correct the file or choose another block."),
    )
