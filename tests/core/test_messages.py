"""Messages are values: English where nothing renders them, equal where their parts are."""

from __future__ import annotations

import json
from dataclasses import FrozenInstanceError, dataclass

import pytest

from core.errors import LineError, UserError, reason_of
from core.messages import (
    EMPTY,
    LandmarkName,
    Length,
    LengthRange,
    LineName,
    Message,
    SideName,
    context_message,
    join,
    plain,
    plural_message,
)


@pytest.mark.parametrize(
    ("message", "text"),
    [
        (Message("{file} is empty.", file="a{b}.ply"), "a{b}.ply is empty."),
        (Message("{line} is slack.", line=LineName("strap left", "Lift")), "Lift is slack."),
        (Message("{line} is slack.", line=LineName("strap left")), "strap left is slack."),
        (Message("At {place}.", place=LandmarkName("bust_point_left")), "At bust point left."),
        (Message("On the {side}.", side=SideName("left")), "On the left."),
        (Message("{mm} off.", mm=Length(12.34, 1)), "12.3 mm off."),
        (Message("Within {range}.", range=LengthRange(300, 1691.4)), "Within 300 to 1691 mm."),
        (Message("One of {names}.", names=("a", "b")), "One of a, b."),
        (Message("Of {names}.", names=("lace, 3 mm", "net")), "Of lace, 3 mm; net."),
        (Message("Because {why}.", why=Message("of {what}", what=7)), "Because of 7."),
        (Message("{count} {what}.", count=1204, what="points"), "1,204 points."),
        (plural_message("{count} hole", "{count} holes", 1), "1 hole"),
        (plural_message("{count} hole", "{count} holes", 1204), "1,204 holes"),
        (Message("Of {a}.").fill(a=1), "Of 1."),
        (context_message("on the body", "front"), "front"),
        (join((Message("One."), EMPTY, join((Message("Two."), Message("Three."))))), "One. Two. Three."),
        (EMPTY, ""),
    ],
)
def test_a_message_in_english(message: Message, text: str) -> None:
    assert str(message) == text
    assert bool(message) is bool(text)


def test_messages_are_equal_if_their_parts_are() -> None:
    held = Message("{line} is held at {mm}.", line=LineName("a"), mm=Length(2.0))
    assert held == Message("{line} is held at {mm}.", line=LineName("a"), mm=Length(2.0))
    assert len({held, Message("{line} is held at {mm}.", line=LineName("a"), mm=Length(2.0))}) == 1
    assert held != Message("{line} is held at {mm}.", line=LineName("b"), mm=Length(2.0))
    assert context_message("on the body", "front") != Message("front")
    assert held.parameters == {"line": LineName("a"), "mm": Length(2.0)}
    assert join((held,)) == held
    with pytest.raises(FrozenInstanceError):
        held.msgid = "other"  # type: ignore[misc]


def test_an_error_is_its_message_and_its_hint() -> None:
    error = LineError(Message("No."), Message("Yes."))
    assert (str(error), error.text.sentences) == ("No. Yes.", (Message("No."), Message("Yes.")))
    assert str(UserError(Message("No."))) == "No."


def test_the_reason_of_an_exception_is_what_it_states() -> None:
    assert reason_of(OSError(2, "No such file")) == "No such file"
    assert reason_of(ValueError(Message("it is nothing"))) == Message("it is nothing")
    assert reason_of(UserError(Message("No."), Message("Yes."))) == Message("No.")
    assert reason_of(ValueError("odd")) == "odd"


@dataclass(frozen=True)
class _Row:
    line: LineName
    notes: tuple[Message, ...]


def test_plain_values_hold_english_texts() -> None:
    row = _Row(LineName("a"), (Message("{mm} off.", mm=Length(2.0)),))
    values = plain({"rows": (row,), "count": 2})
    assert json.loads(json.dumps(values)) == {"rows": [{"line": "a", "notes": ["2 mm off."]}], "count": 2}
