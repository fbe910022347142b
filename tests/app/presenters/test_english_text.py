"""English sentences from files are shown as the messages that they were."""

from __future__ import annotations

import pytest

from app.i18n.catalog import translations, using_language
from app.i18n.lengths import using_unit
from app.presenters.english_text import shown_text
from app.presenters.messages import render
from core.messages import Length, LineName, Message, join

SPACING = Message(
    "The scan is coarse (point spacing about {apart}). Landmarks and girths are less accurate.",
    apart=Length(10.0),
)
PRESSURE = Message(
    "{line}: contact pressure {pressure}.", line=LineName("strap left"), pressure="10.4 kPa (78 mmHg)"
)


@pytest.mark.parametrize("code", ["en", "ja"])
@pytest.mark.parametrize("unit", ["mm", "cm"])
def test_a_sentence_is_that_of_its_message(code: str, unit: str) -> None:
    with using_language(code), using_unit(unit):
        assert shown_text(str(SPACING)) == render(SPACING)
        both = join((SPACING, Message("Choose another folder.")))
        assert shown_text(str(both)) == render(both)


def test_names_of_lines_are_translated() -> None:
    assert shown_text(str(PRESSURE)) == "strap left: contact pressure 10.4 kPa (78 mmHg)."
    with using_language("ja"):
        assert shown_text(str(PRESSURE)) == "ストラップ左：接触圧 10.4 kPa（78 mmHg）。"


def test_what_is_in_no_catalogue_stays() -> None:
    with using_language("ja"):
        assert shown_text("Nobody wrote this. Not this either.") == "Nobody wrote this. Not this either."
        assert shown_text("") == ""


def test_nearly_all_sentences_are_found_again() -> None:
    """Two texts can differ in a parameter alone; then another one of them may be found."""
    wrong, count = [], 0
    with using_language("ja"):
        for (context, english), forms in translations("ja").items():
            if context or len(forms) > 1 or not english.endswith(".") or "{" not in english:
                continue
            names = Message(english)
            fields = {part.split("}")[0]: "7" for part in english.split("{")[1:]}
            message = Message(names.msgid, **fields)
            count += 1
            if shown_text(str(message)) != render(message):
                wrong.append(english)
    assert count > 300
    assert len(wrong) < 0.05 * count, wrong


def test_a_file_name_before_a_colon_stays() -> None:
    refused = "customer 022.obj has too few points for a surface: 0. Scan again."
    assert shown_text(refused) == refused
