"""The catalogues: complete in every language, and made of letters that the shipped type has."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest
from PySide6.QtGui import QRawFont, QTextLayout
from PySide6.QtWidgets import QApplication, QLabel

from app.gui.widgets.basic import sentence
from app.i18n.catalog import (
    LANGUAGES,
    Catalogue,
    add_word_joiners,
    catalogue,
    colon,
    joined,
    listed,
    number,
    tr,
    tr_context,
    tr_plural,
    translations,
    use_language,
    using_language,
)
from benchmarks.catalogue import ENGLISH_ONLY, calls_of, catalogue_text, texts

ROOT = Path(__file__).parents[3]
TRANSLATIONS = [code for code in LANGUAGES if code != "en"]


def places(text: str) -> list[str]:
    return sorted(re.findall(r"(?<!\{)\{(\w+)", text))


@pytest.mark.parametrize("code", TRANSLATIONS)
def test_every_text_is_translated_and_no_other(code: str) -> None:
    shown = {(context, english_text) for context, english_text, _ in texts()}
    assert len(shown) > 2000
    missing = sorted(shown - translations(code).keys())
    assert missing == [], (
        "not in the catalogue, or without a translation: run `make words`, then translate the empty entries"
    )
    assert sorted(translations(code).keys() - shown) == [], "no longer in the code: run `make words`"


@pytest.mark.parametrize("code", TRANSLATIONS)
def test_a_translation_has_the_same_places_to_fill(code: str) -> None:
    for (_, english_text), forms in translations(code).items():
        for form in forms:
            assert places(english_text) == places(form), english_text
            assert form.strip()


@pytest.mark.parametrize("code", TRANSLATIONS)
def test_a_catalogue_is_written_as_it_is_read(code: str) -> None:
    path = ROOT / "resources" / "locale" / code / "LC_MESSAGES" / "busk.po"
    assert path.read_text("utf-8") == catalogue_text(texts(), translations(code), code), "run `make words`"


def test_a_message_is_given_what_its_text_names() -> None:
    """Parameters that only ``fill`` adds, and those that are unpacked, cannot be seen here."""
    for path in (each for part in ("core", "app") for each in (ROOT / part).rglob("*.py")):
        for call, (_, english_text, plural) in calls_of(path):
            given = sorted(each.arg for each in call.keywords if each.arg)
            called = call.func.id if isinstance(call.func, ast.Name) else ""
            if not called.endswith(("Message", "message")) or not given:
                continue
            given += ["count"] * (called == "plural_message")
            assert sorted(given) == sorted(set(places(english_text))), f"{path}: {english_text}"
            assert not plural or places(plural) == places(english_text), path


def test_no_text_is_put_together_before_it_is_looked_up() -> None:
    """A text that ``tr`` or a message gets as anything but a literal would not be in the catalogues."""
    looked_up = {"tr", "tr_context", "tr_plural", "Message", "context_message", "plural_message"}
    allowed = {"app/i18n/catalog.py", "core/messages.py", "app/presenters/messages.py"}
    allowed |= {"app/presenters/elastics.py", "app/gui/actions.py"}  # names of what comes with the program
    allowed |= {"app/gui/features/project/start_page.py", "app/gui/features/scan/panel.py"}
    for path in (each for part in ("core", "app") for each in (ROOT / part).rglob("*.py")):
        name = path.relative_to(ROOT).as_posix()
        if name in allowed or name.startswith(ENGLISH_ONLY):
            continue
        found = {(call.lineno, call.col_offset) for call, _ in calls_of(path)}
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in looked_up:
                assert (node.lineno, node.col_offset) in found or not node.args, f"{name}:{node.lineno}"


TYPED = (
    "Enter NAME=12mm",
    "Enter 94, −6%",
    "Enter a length such as",
    "Enter the value in mm",
    "Enter millimetres",
    "Enter x, y and z",
)


def test_words_of_the_window_name_millimetres_only_where_they_are_meant() -> None:
    """Everywhere else the unit is filled in: it can be chosen."""
    shown = {english_text for context, english_text, _ in texts() if context not in ("unit", "elastic")}
    in_files = {"Allowance mm", "Cut mm", "Front on body mm", "Full length on body mm", "Width mm"}
    in_files |= {"bust points up [mm]", "foremost place up [mm]", "largest move [mm]", "{line} [mm]"}
    in_files |= {each for each in shown if each.startswith(("Table of control", "For CAD"))}
    in_files |= {each for each in shown if "width_mm" in each or "height_mm" in each or "{number} mm" in each}
    chosen = {"Millimetres", "{line}: length in millimetres"}
    typed = {each for each in shown if each.startswith(TYPED)}
    typed |= {each for each in shown if re.search(r"a height in mm|0 mm or more|\}mm gives", each)}
    in_the_model = {each for each in shown if "constant force per millimetre" in each}
    in_the_model |= {each for each in shown if each.startswith("Use heights on the body as shown in Busk")}
    named = {each for each in shown if re.search(r"(?<![A-Za-z{])mm(?![A-Za-z])|[Mm]illimetre", each)}
    assert sorted(named - in_files - chosen - typed - in_the_model) == []


@pytest.mark.parametrize("code", TRANSLATIONS)
def test_the_shipped_type_has_every_letter(qapp: QApplication, code: str) -> None:
    folder = ROOT / "resources" / "fonts"
    fonts = [QRawFont(str(path), 13.0) for path in folder.iterdir() if "Regular" in path.stem]
    assert len(fonts) == 2
    letters = {x for forms in translations(code).values() for text in forms for x in text if not x.isspace()}
    assert sorted(x for x in letters if not any(each.supportsCharacter(ord(x)) for each in fonts)) == []


def test_a_catalogue_has_contexts_plural_forms_and_broken_lines(tmp_path: Path) -> None:
    (tmp_path / "busk.po").write_text(
        'msgid ""\nmsgstr ""\n"Language: xx\\n"\n"Plural-Forms: nplurals=2; plural=(n > 1);\\n"\n\n'
        '# a note\n#: place.py\nmsgid "Open"\nmsgstr "A"\n\n'
        'msgctxt "state"\nmsgid "Open"\nmsgstr "B"\n\n'
        'msgid "{count} hole"\nmsgid_plural "{count} holes"\nmsgstr[0] "C"\nmsgstr[1] "D"\n\n'
        'msgid ""\n"two "\n"lines\\n"\nmsgstr ""\n"E \\"e\\""\n\n'
        'msgid "empty"\nmsgstr ""\n\n#~ msgid "gone"\n#~ msgstr "F"\n',
        encoding="utf-8",
    )
    with (tmp_path / "busk.po").open("rb") as stream:
        found = Catalogue(stream)
    assert (found.gettext("Open"), found.pgettext("state", "Open")) == ("A", "B")
    holes = [found.ngettext("{count} hole", "{count} holes", count) for count in (0, 1, 2)]
    assert holes == ["C", "C", "D"]
    assert found.gettext("two lines\n") == 'E "e"'
    assert (found.gettext("empty"), found.gettext("gone")) == ("empty", "gone")


def test_language_is_chosen_once_and_unknown_texts_stay() -> None:
    assert tr("Scan") == "Scan"
    use_language("ja")
    assert tr("Scan") == "スキャン"
    assert tr("no such sentence") == tr_context("side", "no such sentence") == "no such sentence"
    assert tr_plural("{count} such", "{count} such ones", 2) == "{count} such ones"
    use_language("xx")
    assert tr("Scan") == "Scan"
    assert isinstance(catalogue("ja"), Catalogue)


def test_another_language_is_used_for_a_while() -> None:
    use_language("ja")
    with using_language("en"):
        assert tr("Scan") == "Scan"
    assert tr("Scan") == "スキャン"


@pytest.mark.parametrize(
    ("value", "digits", "signed", "text"),
    [
        (1234.56, 1, False, "1,234.6"),
        (-0.02, 2, True, "−0.02"),
        (-0.004, 2, True, "0.00"),
        (-0.004, 2, False, "0.00"),
        (18.6, 1, True, "+18.6"),
        (0.0, 0, True, "0"),
    ],
)
def test_numbers_are_written_with_a_real_minus(value: float, digits: int, signed: bool, text: str) -> None:
    assert number(value, digits, signed) == text


def test_no_letter_stands_alone_on_the_last_line(qapp: QApplication) -> None:
    text = "着用時の長さは前と同じに設定しました。"
    place = sentence(text)
    assert place.text() == text, "the joiners are not read aloud"
    shown = QLabel.text(place)
    for width in range(60, 300, 3):
        layout = QTextLayout(shown, place.font())
        layout.beginLayout()
        while (line := layout.createLine()).isValid():
            line.setLineWidth(width)
            last = shown[line.textStart() :]
        layout.endLayout()
        assert len(last.replace("\N{WORD JOINER}", "")) >= 4
    assert add_word_joiners("Set it longer.") == "Set it longer."


@pytest.mark.parametrize(
    ("code", "text"), [("en", "C70, A80: So it is. So not."), ("ja", "C70、A80：So it is.So not.")]
)
def test_what_is_joined_is_separated_as_the_language_does(code: str, text: str) -> None:
    with using_language(code):
        assert listed(["C70", "A80"]) + colon() + joined(["So it is.", "", "So not."]) == text
