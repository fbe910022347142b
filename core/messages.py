"""Messages: sentences with parameters, which are put into a language only where they are shown."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields, is_dataclass
from pathlib import PurePath
from typing import Any, ClassVar, TypeAlias


@dataclass(frozen=True)
class Name:
    """The name of something, which may have a title in the catalogue, under ``context``."""

    text: str
    context: ClassVar[str] = ""

    def __str__(self) -> str:
        return self.text


@dataclass(frozen=True)
class LineName(Name):
    """The name of a constraining line, and the ``title`` that its design gives it, if that is known."""

    title: str = ""
    context: ClassVar[str] = "line"

    def __str__(self) -> str:
        return self.title or self.text


class LandmarkName(Name):
    """The name of a landmark."""

    context = "landmark"
    titles: ClassVar[dict[str, str]] = {
        "fold": "inframammary fold",
        "lowest": "lowest point",
        "root inner": "inner breast root",
        "root outer": "outer breast root",
    }
    """English names of keys in project files that are no plain term, before their side."""

    def __str__(self) -> str:
        stem, _, side = self.text.replace("_", " ").rpartition(" ")
        return f"{self.titles.get(stem, stem)} {side}".strip()


class SettingName(Name):
    """The name of a setting of the design."""

    context = "setting"
    titles: ClassVar[dict[str, str]] = {
        "line_contact": "skin contact",
        "line_hold": "line length",
        "member_law": "cable force",
        "firm_chest": "rib-cage support",
        "scaled_normals": "scaling of the distance to the mesh",
        "dense_volume": "conservation of the body volume",
        "volume_of": "conserved volume",
    }
    """English names of keys in project files that are no plain term."""

    def __str__(self) -> str:
        return self.titles.get(self.text, self.text.replace("_", " "))


class SideName(Name):
    """The name of a side of the body: "left" or "right"."""

    context = "side"


class ElasticName(Name):
    """The name of an elastic, built-in or of the user's own."""

    context = "elastic"


class ClothName(Name):
    """The title of a cloth, built-in or of the user's own."""

    context = "cloth"


class BlockName(Name):
    """The title of a block, built-in or of the user's own."""

    context = "block"


class PieceName(Name):
    """The name of a piece of a block, with its side if it has one: "lower cup left"."""

    context = "piece"


class SeamName(Name):
    """The name of a seam or edge of a block, with its side if it has one: "wing top left"."""

    context = "seam"


@dataclass(frozen=True)
class Length:
    """A length [mm], shown in the unit in use; ``digits`` are its decimals in millimetres."""

    mm: float
    digits: int = 0

    def __str__(self) -> str:
        return f"{self.mm:.{self.digits}f} mm"


def length_of(mm: float) -> Length:
    """Return a length [mm] with the decimals that it has, one at most."""
    return Length(mm, 0 if float(mm).is_integer() else 1)


@dataclass(frozen=True)
class LengthRange:
    """A range of lengths [mm], shown in the unit in use; ``digits`` are decimals in millimetres."""

    low: float
    high: float
    digits: int = 0

    def __str__(self) -> str:
        return f"{self.low:.{self.digits}f} to {self.high:.{self.digits}f} mm"


@dataclass(frozen=True, init=False)
class Message:
    """An English text (``msgid``) with named parameters, rendered where it is shown; ``str()`` is English.

    A parameter that is a message, a name or a length, or a tuple of these (a list), is rendered with the
    text; a text or a number stays. ``plural`` is the text for a parameter ``count`` other than one, and
    ``context`` distinguishes texts that are spelt alike. A message without ``msgid`` is empty, or consists
    of other messages, one after the other (``join``).
    """

    msgid: str
    plural: str
    context: str
    items: tuple[tuple[str, Parameter], ...]

    def __init__(
        self, msgid: str = "", plural: str = "", context: str = "", /, **parameters: Parameter
    ) -> None:
        fields = {"msgid": msgid, "plural": plural, "context": context, "items": tuple(parameters.items())}
        for name, value in fields.items():
            object.__setattr__(self, name, value)

    @property
    def parameters(self) -> dict[str, Parameter]:
        """Return the parameters by name."""
        return dict(self.items)

    @property
    def sentences(self) -> tuple[Message, ...]:
        """Return the messages that this one consists of: itself, unless it was joined or is empty."""
        return (self,) if self.msgid else tuple(each for _, each in self.items if isinstance(each, Message))

    def __bool__(self) -> bool:
        return bool(self.msgid or self.items)

    def __str__(self) -> str:
        if not self.msgid:
            return " ".join(map(str, self.sentences))
        text = self.plural if self.plural and self.parameters["count"] != 1 else self.msgid
        return text.format_map({name: _english(value) for name, value in self.items})

    def fill(self, **parameters: Parameter) -> Message:
        """Return the message with parameters that it lacks."""
        return Message(self.msgid, self.plural, self.context, **self.parameters, **parameters)


EMPTY = Message()
"""The message that states nothing."""

Parameter: TypeAlias = (
    "str | int | float | PurePath | Name | Length | LengthRange | Message | tuple[Parameter, ...]"
)
"""A value that a text can be filled with."""


def context_message(context: str, msgid: str, /, **parameters: Parameter) -> Message:
    """Return a message whose text means something else in another context."""
    return Message(msgid, "", context, **parameters)


def plural_message(one: str, many: str, /, count: int, **parameters: Parameter) -> Message:
    """Return a message whose text depends on ``count``, which fills ``{count}``."""
    return Message(one, many, count=count, **parameters)


def join(messages: Iterable[Message]) -> Message:
    """Return messages as one, one after the other; empty ones are left out."""
    parts = [part for message in messages for part in message.sentences]
    joined: dict[str, Parameter] = {str(number): part for number, part in enumerate(parts)}
    return parts[0] if len(parts) == 1 else Message(**joined)


def plain(value: Any) -> Any:
    """Return dataclasses as dictionaries, and messages and names in them in English: ready for JSON."""
    if isinstance(value, Message | Name | Length | LengthRange):
        return str(value)
    if is_dataclass(value):
        return {each.name: plain(getattr(value, each.name)) for each in fields(value)}
    if isinstance(value, Mapping):
        return {key: plain(each) for key, each in value.items()}
    return [plain(each) for each in value] if isinstance(value, list | tuple) else value


def _english(value: Parameter) -> str:
    if isinstance(value, tuple):
        texts = [_english(each) for each in value]
        return ("; " if any(", " in text for text in texts) else ", ").join(texts)
    return f"{value:,}" if isinstance(value, int) else str(value)
