"""The catalogue of texts: English in the code, other languages as gettext files in ``resources/locale``."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from functools import cache
from gettext import GNUTranslations, NullTranslations, c2py
from importlib import resources
from typing import Any

from app.i18n.numerals import number as number  # noqa: PLC0414 - imported with the texts almost everywhere
from core.messages import Message

LANGUAGES = {"en": "English", "ja": "日本語"}
"""The languages that can be chosen, by code, each under its own name."""

_code = "en"
_JOINER = "\N{WORD JOINER}"
_END = re.compile(r"[\u3001-\u30ff\u4e00-\u9fff\uff09]{2,4}$", re.MULTILINE)  # kana, kanji, their marks
_FIELD = re.compile(r'^(msgctxt|msgid|msgid_plural|msgstr(?:\[\d+\])?) (".*"(?:\n".*")*)', re.MULTILINE)
_PLURAL = re.compile(r"plural=([^;]+);")


class Catalogue(GNUTranslations):
    """Translations read from a PO file as it is: without a compiled copy that could be out of date."""

    texts: dict[tuple[str, str], list[str]]
    """Translations by context, empty for none, and English text; several where there are plural forms."""

    def _parse(self, fp: Any) -> None:  # to be overridden for another format, says gettext
        entry: dict[str, str] = {}
        entries = [entry]
        for name, quoted in _FIELD.findall(fp.read().decode("utf-8")):
            if name == "msgctxt" or (name == "msgid" and "msgid" in entry):
                entries.append(entry := {})
            entry[name] = "".join(map(_unquoted, quoted.split("\n")))
        self.texts = {}
        self._catalog: dict[str | tuple[str, int], str] = {}
        for entry in entries:
            forms = [text for name, text in entry.items() if name.startswith("msgstr")]
            self._add(entry.get("msgctxt", ""), entry["msgid"], forms, "msgid_plural" in entry)

    def _add(self, context: str, english: str, forms: list[str], plural: bool) -> None:
        key = self.CONTEXT % (context, english) if context else english
        if not english:
            self.plural = c2py(_PLURAL.findall(forms[0])[0])
        elif any(forms):
            self.texts[context, english] = forms
            self._catalog.update(
                {(key, k): form for k, form in enumerate(forms)} if plural else {key: forms[0]}
            )


def _unquoted(text: str) -> str:
    # The escapes of both formats are the same; without any, nothing has to be parsed.
    return str(json.loads(text)) if "\\" in text else text[1:-1]


@cache
def catalogue(code: str) -> NullTranslations:
    """Return the translations into a language; English has none."""
    if code == "en":
        return NullTranslations()
    file = resources.files("resources") / "locale" / code / "LC_MESSAGES" / "busk.po"
    with file.open("rb") as stream:
        return Catalogue(stream)


def use_language(code: str) -> None:
    """Set the language of all texts from now on; an unknown one leaves English.

    Call it once, before the first widget is built: a widget keeps the texts it was built with.
    """
    global _code  # noqa: PLW0603 - one language at a time
    _code = code if code in LANGUAGES else "en"


@contextmanager
def using_language(code: str) -> Iterator[None]:
    """Use another language meanwhile, as for a report that is not in the language of the window."""
    before = _code
    use_language(code)
    try:
        yield
    finally:
        use_language(before)


def language() -> str:
    """Return the code of the language in use."""
    return _code


def tr(english: str) -> str:
    """Return a text in the language in use, or in English where no translation is known."""
    return catalogue(_code).gettext(english)


def tr_context(context: str, english: str) -> str:
    """Return a text that means something else in another context."""
    return catalogue(_code).pgettext(context, english)


def tr_plural(one: str, many: str, count: int) -> str:
    """Return the text for a number of things, with ``{count}`` still to be filled."""
    return catalogue(_code).ngettext(one, many, count)


def template(message: Message) -> str:
    """Return the text of a message in the language in use, with its parameters still to be filled."""
    if not message.plural:
        return tr_context(message.context, message.msgid) if message.context else tr(message.msgid)
    count = message.parameters["count"]
    return tr_plural(message.msgid, message.plural, count if isinstance(count, int) else 0)


def translations(code: str) -> dict[tuple[str, str], list[str]]:
    """Return all translations into a language by context and English text; see ``Catalogue``."""
    found = catalogue(code)
    return found.texts if isinstance(found, Catalogue) else {}


def in_all_languages(shown: str) -> list[str]:
    """Return a text of the window in the language in use and in every other language."""
    known = (key[1] for key, forms in translations(_code).items() if forms[0] == shown)
    english = next(known, shown)
    others = (translations(code).get(("", english)) for code in LANGUAGES if code != "en")
    return [shown, english, *(other[0] for other in others if other)]


def listed(names: Iterable[str]) -> str:
    """Return names one after the other, as the language in use separates them."""
    return ("、" if _code == "ja" else ", ").join(names)


def colon() -> str:
    """Return a colon as the language in use writes it, with the space after it."""
    return "：" if _code == "ja" else ": "


def joined(sentences: Iterable[str]) -> str:
    """Return sentences one after the other, those that are empty left out."""
    return ("" if _code == "ja" else " ").join(filter(None, sentences))


def add_word_joiners(text: str) -> str:
    """Return text whose paragraphs never end in a line of a letter or two, where any two letters may part."""
    return _END.sub(lambda end: _JOINER.join(end[0]), text)


def strip_word_joiners(text: str) -> str:
    """Return text without the joiners of ``add_word_joiners``."""
    return text.replace(_JOINER, "")
