"""The words of the window: complete in every language, and made of letters that the shipped type has."""

from __future__ import annotations

import ast
import json
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtGui import QRawFont, QTextLayout
from PySide6.QtWidgets import QApplication, QLabel

from app.gui.widgets.basic import sentence
from app.i18n.catalog import (
    LANGUAGES,
    colon,
    held_together,
    joined,
    listed,
    number,
    read_words,
    say,
    speaking,
    tr,
    use_language,
)
from app.i18n.lengths import use_unit

ROOT = Path(__file__).parents[3]
TRANSLATIONS = [code for code in LANGUAGES if code != "en"]


def asked_words() -> set[str]:
    """Return every literal that the program asks a translation for."""
    calls = (
        node
        for path in (ROOT / "app").rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "tr"
    )
    return {
        each.value
        for call in calls
        for each in ast.walk(call.args[0])
        if isinstance(each, ast.Constant) and isinstance(each.value, str)
    }


def written_words() -> set[str]:
    """Return every literal of the program and of its resources, as it stands in a sentence and alone."""
    trees = [
        ast.parse(path.read_text("utf-8")) for part in ("app", "core") for path in (ROOT / part).rglob("*.py")
    ]
    texts = {each.value for tree in trees for each in ast.walk(tree) if isinstance(each, ast.Constant)}
    files = [path for path in (ROOT / "resources").rglob("*.json") if path.parent.name != "words"]
    for path in files:
        texts |= set(map(json.loads, re.findall(r'"(?:[^"\\]|\\.)*"', path.read_text("utf-8"))))
    words = {each for each in texts if isinstance(each, str)}
    return words | {each[:1].upper() + each[1:] for each in words}


def places(text: str) -> list[str]:
    return sorted(re.findall(r"\{(\w*)", text))


@pytest.mark.parametrize("code", TRANSLATIONS)
def test_every_word_is_translated(code: str) -> None:
    asked = asked_words()
    assert len(asked) > 50
    assert sorted(asked - read_words(code).keys()) == []


@pytest.mark.parametrize("code", TRANSLATIONS)
def test_no_word_is_translated_that_nobody_reads(code: str) -> None:
    assert sorted(read_words(code).keys() - written_words()) == []


@pytest.mark.parametrize("code", TRANSLATIONS)
def test_a_translation_has_the_same_places_to_fill(code: str) -> None:
    for english_text, translated in (read_words(code) | read_words(f"{code}_messages")).items():
        assert places(english_text) == places(translated), english_text
        assert translated.strip()


def core_sentences() -> set[str]:
    """Return all that the core may say to a user, with a 7 where a name or a number is filled in."""
    trees = (ast.parse(path.read_text("utf-8")) for path in (ROOT / "core").rglob("*.py"))
    texts = (text.strip() for tree in trees for text in _texts(tree))
    return {text for text in texts if re.fullmatch(r"(?s)[A-Z{'7].*[a-z] [a-z].*\.", text)}


def _texts(node: ast.AST) -> Iterator[str]:
    if isinstance(node, ast.JoinedStr):
        yield "".join(part.value if isinstance(part, ast.Constant) else "7" for part in node.values)
    elif isinstance(node, ast.Constant) and isinstance(node.value, str):
        yield node.value.replace("{}", "7")
    elif not (isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)):
        for child in ast.iter_child_nodes(node):
            yield from _texts(child)


@pytest.mark.parametrize("code", TRANSLATIONS)
def test_every_sentence_of_the_core_is_translated(code: str) -> None:
    sentences = core_sentences()
    assert len(sentences) > 80
    use_language(code)
    assert sorted(each for each in sentences if say(each) == each) == []


@pytest.mark.parametrize("code", LANGUAGES)
def test_every_length_that_the_core_tells_is_in_the_unit_in_use(code: str) -> None:
    in_mm = re.compile(r"7 ?mm(?!\w)", re.ASCII)
    sentences = [each for each in core_sentences() if in_mm.search(each)]
    assert len(sentences) > 20
    use_language(code)
    use_unit("in")
    assert [each for each in sentences if in_mm.search(say(each))] == []


def test_words_of_the_window_name_millimetres_only_where_they_are_meant() -> None:
    """Everywhere else the unit is filled in: it can be chosen."""
    in_files = {"Allowance mm", "Cut mm", "Front on the body mm", "Whole on the body mm", "Width mm"}
    in_files |= {"bust points up [mm]", "foremost place up [mm]", "largest move [mm]", "{line} [mm]"}
    in_files |= {each for each in asked_words() if each.startswith(("A table of the control", "For CAD"))}
    chosen = {"Millimetres", "{line}: length in millimetres"}
    typed = {each for each in asked_words() if each.startswith("Type 94, −6%, −20mm")}
    in_the_model = {each for each in asked_words() if "the same force for every millimetre" in each}
    named = {each for each in asked_words() if re.search(r"(?<![A-Za-z{])mm(?![A-Za-z])|[Mm]illimetre", each)}
    assert sorted(named - in_files - chosen - typed - in_the_model) == []


def test_a_message_is_translated_with_what_is_filled_in() -> None:
    use_language("ja")
    assert say("scan.ply has no sound triangles.") == "scan.ply に正しい三角形がありません。"
    assert say("mid-bust cannot be held at 80.0 % of its rest length.").startswith("バスト下部を")
    assert say("Dropped 1,204 vertices outside any face.") == "面に属さない頂点 1,204 個を除きました。"
    assert say("It is odd. Choose another scan.") == "It is odd.別のスキャンを選んでください。"
    unit = "Read in mm, the trunk is 889 mm round, which is the size of a body."
    axes = "That +z is up and -y is front was told."
    translated = "mm で読むと胴まわり（およその値）は 889 mm で、上半身の大きさです。"
    assert say(f"{unit} {axes}") == translated + "上 +z、前 -y は指定によります。"
    assert say("a cloud of {curly} words") == "a cloud of {curly} words"
    use_language("en")
    assert say("scan.ply has no sound triangles.") == "scan.ply has no sound triangles."


@pytest.mark.parametrize("code", TRANSLATIONS)
def test_the_shipped_type_has_every_letter(qapp: QApplication, code: str) -> None:
    folder = ROOT / "resources" / "fonts"
    fonts = [QRawFont(str(path), 13.0) for path in folder.iterdir() if "Regular" in path.stem]
    assert len(fonts) == 2
    texts = [*read_words(code).values(), *read_words(f"{code}_messages").values()]
    letters = {letter for text in texts for letter in text if not letter.isspace()}
    assert sorted(x for x in letters if not any(each.supportsCharacter(ord(x)) for each in fonts)) == []


def test_language_is_chosen_once_and_unknown_words_stay() -> None:
    assert tr("Scan") == "Scan"
    use_language("ja")
    assert tr("Scan") == "スキャン"
    assert tr("no such sentence") == "no such sentence"
    use_language("xx")
    assert tr("Scan") == "Scan"


def test_another_language_is_spoken_for_a_while() -> None:
    use_language("ja")
    with speaking("en"):
        assert (tr("Scan"), say("Choose another scan.")) == ("Scan", "Choose another scan.")
    assert (tr("Scan"), say("Choose another scan.")) == ("スキャン", "別のスキャンを選んでください。")


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
    said = "着用時の長さは前と同じに設定しました。"
    place = sentence(said)
    assert place.text() == said, "what is read is what was said"
    shown = QLabel.text(place)
    for width in range(60, 300, 3):
        layout = QTextLayout(shown, place.font())
        layout.beginLayout()
        while (line := layout.createLine()).isValid():
            line.setLineWidth(width)
            last = shown[line.textStart() :]
        layout.endLayout()
        assert len(last.replace("\N{WORD JOINER}", "")) >= 4
    assert held_together("Set it longer.") == "Set it longer."


@pytest.mark.parametrize(
    ("code", "told"), [("en", "C70, A80: So it is. So not."), ("ja", "C70、A80：So it is.So not.")]
)
def test_what_is_joined_is_parted_as_the_language_parts_it(code: str, told: str) -> None:
    with speaking(code):
        assert listed(["C70", "A80"]) + colon() + joined(["So it is.", "", "So not."]) == told
