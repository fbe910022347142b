"""Messages are rendered in the language and the unit in use, with the titles that lines have."""

from __future__ import annotations

import pytest

from app.i18n.catalog import use_language
from app.i18n.lengths import use_unit, using_unit
from app.presenters.messages import elastic_kind, elastic_title, line_title, preset_title, render
from core.document.design import Design
from core.document.lines import LineSettings
from core.garment.elastic_library import built_in as elastics
from core.garment.presets import Preset, PresetLine
from core.garment.presets import built_in as presets
from core.landmarks.types import NAMES, SIDES
from core.messages import (
    ElasticName,
    LandmarkName,
    Length,
    LengthRange,
    LineName,
    Message,
    Name,
    SideName,
    join,
    plural_message,
)
from core.scan.source import ScanSource

CLOSED = Message(
    "Filled {count} up to {size} across.",
    count=plural_message("{count} hole", "{count} holes", 7),
    size=Length(12.0),
)
LIMITS = Message(
    "Enter {low} to {high} % ({range} front length).",
    low="50",
    high="130",
    range=LengthRange(300.0, 1691.0),
)


@pytest.mark.parametrize(
    ("language", "unit", "message", "text"),
    [
        ("en", "mm", CLOSED, "Filled 7 holes up to 12 mm across."),
        ("en", "in", CLOSED, "Filled 7 holes up to 1/2 in across."),
        ("ja", "cm", CLOSED, "1.2 cm までの穴 7 個をふさぎました。"),
        ("en", "cm", LIMITS, "Enter 50 to 130 % (30.0 to 169.1 cm front length)."),
        ("en", "in", Message("In mm, it is 8 mm."), "In mm, it is 8 mm."),
        ("ja", "mm", join((Message("Choose another scan."), CLOSED)), "別のスキャンを選んでください。"),
    ],
)
def test_a_message_has_its_lengths_in_the_unit_in_use(
    language: str, unit: str, message: Message, text: str
) -> None:
    use_language(language)
    use_unit(unit)
    assert render(message).replace("\N{NO-BREAK SPACE}", " ").startswith(text)
    with using_unit("mm"):
        assert "12 mm" in render(CLOSED), "files keep millimetres"


def test_a_line_is_named_by_the_title_that_it_was_given() -> None:
    design = Design(ScanSource("x")).with_line_settings(LineSettings("strap left", title="lift tape"))
    strap, template_line = LineName("strap left"), LineName("full-bust")
    assert render(Message("{line} is slack (no tension).", line=strap), design) == (
        "Lift tape, left is slack (no tension)."
    )
    locked = Message("The line {name} is locked.", name=strap)
    assert render(locked, design) == "The line lift tape, left is locked."
    assert render(locked) == "The line strap left is locked."
    locked = Message("The line {name} is locked.", name=LineName("strap left", "lift tape"))
    assert render(locked) == "The line lift tape, left is locked."
    slack = Message("{line} is slack (no tension).", line=template_line)
    assert render(slack, design) == render(slack) == "Full bust is slack (no tension)."
    use_language("ja")
    assert render(slack, design).startswith(line_title("full-bust"))


def test_names_have_titles_in_another_language() -> None:
    use_language("ja")
    names: tuple[Name, ...] = (*map(LandmarkName, NAMES), *map(SideName, SIDES))
    for name in names:
        assert str(name) not in render(Message("{name}", name=name))
    mine = "My band 12 mm"
    titles = [render(Message("{name}", name=ElasticName(each.name))) for each in elastics()]
    assert not [title for each, title in zip(elastics(), titles, strict=True) if each.name == title]
    assert render(Message("{name}", name=ElasticName(mine))) == mine
    assert preset_title(Preset(mine, (PresetLine("mid-bust"),))) == mine
    assert not [each for each in presets() if preset_title(each) == each.title]


def test_the_width_of_an_elastic_is_in_the_unit_in_use() -> None:
    use_unit("cm")
    assert elastic_title(elastics()[0].name) == f"{elastic_kind(elastics()[0].name)} 1.0 cm"


def test_a_text_stays() -> None:
    use_language("ja")
    assert render("{curly} words") == "{curly} words"
    assert render(Message("{file} is empty.", file="{curly}")).startswith("{curly}")
