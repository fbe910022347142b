"""Strict reading of JSON: each value is of the type that a field has, or a sentence names the field."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import MISSING, fields, is_dataclass
from functools import cache
from types import NoneType, UnionType
from typing import Any, TypeVar, get_args, get_origin, get_type_hints

from core.errors import ProjectError
from core.messages import Message

T = TypeVar("T")

_LARGEST = 2**128
"""No whole number in a file is larger."""


def parsed(text: str) -> Any:
    """Return what a JSON text holds. Raises ValueError if it is none."""
    try:
        return json.loads(text)
    except RecursionError as problem:
        raise ValueError("it is nested too deeply") from problem


def value_of(kind: type[T], value: Any, place: str) -> T:
    """Return a JSON ``value`` as a frozen dataclass, told in a message as the one at ``place``.

    Fields that are left out take their defaults, others than those of ``kind`` are not read. Raises
    ProjectError, which names the first field that is missing or of another type, and what ``kind`` raises.
    """
    read: T = _object(kind, value, place)
    return read


def field_of(kind: type, key: str, value: Any) -> Any:
    """Return a JSON ``value`` as the field ``key`` of a dataclass, see ``value_of``."""
    return _read(_types(kind)[key], value, key)


def whole_number(value: Any, place: str) -> int:
    """Return a JSON ``value`` as a whole number. Raises ProjectError."""
    if type(value) is not int or abs(value) > _LARGEST:
        raise _wrong(place, Message("a whole number"))
    return value


@cache
def _types(kind: type) -> dict[str, Any]:
    return get_type_hints(kind)


def _object(kind: Any, value: Any, place: str) -> Any:
    if not isinstance(value, dict):
        raise _wrong(place, Message("an object"))
    read = {}
    for field in fields(kind):
        where = f"{place}.{field.name}"
        if field.name in value:
            read[field.name] = _read(_types(kind)[field.name], value[field.name], where)
        elif field.default is MISSING and field.default_factory is MISSING:
            raise ProjectError(Message("'{place}' is missing in this file.", place=where), _HINT)
    return kind(**read)


def _read(kind: Any, value: Any, place: str) -> Any:
    if get_origin(kind) is UnionType:
        (kind,) = (each for each in get_args(kind) if each is not NoneType)
        return None if value is None else _read(kind, value, place)
    if get_origin(kind) is tuple:
        return _tuple(get_args(kind), value, place)
    if is_dataclass(kind):
        return _object(kind, value, place)
    return _PLAIN[kind](value, place)


def _tuple(kinds: tuple[Any, ...], value: Any, place: str) -> tuple[Any, ...]:
    given = _list(value, place)
    if kinds[-1] is not Ellipsis and len(given) != len(kinds):
        raise _wrong(place, Message("a list of {count} values", count=len(kinds)))
    of_each = [kinds[0]] * len(given) if kinds[-1] is Ellipsis else kinds
    return tuple(
        _read(kind, each, f"{place}[{k}]") for k, (kind, each) in enumerate(zip(of_each, given, strict=True))
    )


def _list(value: Any, place: str) -> list[Any]:
    if not isinstance(value, list):
        raise _wrong(place, Message("a list"))
    return value


def _text(value: Any, place: str) -> str:
    if not isinstance(value, str):
        raise _wrong(place, Message("text"))
    return value


def _flag(value: Any, place: str) -> bool:
    if not isinstance(value, bool):
        raise _wrong(place, Message("true or false"))
    return value


def _number(value: Any, place: str) -> float:
    if type(value) is int and abs(value) <= _LARGEST:
        return float(value)
    if type(value) is not float or not math.isfinite(value):
        raise _wrong(place, Message("a number"))
    return value


_PLAIN: dict[Any, Callable[[Any, str], Any]] = {str: _text, bool: _flag, int: whole_number, float: _number}
_HINT = Message("Open a backup or start from the scan.")


def _wrong(place: str, what: Message) -> ProjectError:
    return ProjectError(Message("'{place}' in this file is not {kind}.", place=place, kind=what), _HINT)
