"""Bring the catalogues up to date with the texts of the code: ``make words``.

New texts are added without a translation, those that nothing shows any more are removed.
"""

from __future__ import annotations

import ast
import json
import sys
from collections.abc import Iterable, Iterator
from itertools import chain
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT))

from app.i18n.catalog import LANGUAGES, translations  # noqa: E402
from app.presenters.samples import SAMPLES  # noqa: E402
from core.garment.elastic_library import built_in as elastics  # noqa: E402
from core.garment.presets import built_in as presets  # noqa: E402
from core.landmarks.types import ALL_NAMES, SIDES  # noqa: E402
from core.mechanics.options import CHOICES, RANGES  # noqa: E402
from core.messages import LandmarkName, SettingName, SideName  # noqa: E402
from core.pattern.block_library import built_in_blocks  # noqa: E402
from core.pattern.cloth_library import built_in as cloths  # noqa: E402
from core.scan.orientation.unit_detection import MILLIMETRES  # noqa: E402

ENGLISH_ONLY = ("app/cli", "app/research")
"""Parts of the program that are shown in no other language."""

Text = tuple[str, str, str]
"""A context, an English text, and its plural; context and plural may be empty."""

_CALLS = {
    "tr": lambda one: ("", one, ""),
    "Message": lambda one: ("", one, ""),
    "tr_context": lambda context, one: (context, one, ""),
    "context_message": lambda context, one: (context, one, ""),
    "tr_plural": lambda one, many: ("", one, many),
    "plural_message": lambda one, many: ("", one, many),
    "SettingName": lambda one: (SettingName.context, str(SettingName(one)), ""),
}


def texts() -> set[Text]:
    """Return all texts that are shown in the language in use."""
    return {*texts_of_code(), *texts_of_data()}


def texts_of_code() -> Iterator[Text]:
    """Yield the texts in calls of ``tr``, ``Message`` and the like."""
    for path in sorted(chain(ROOT.glob("core/**/*.py"), ROOT.glob("app/**/*.py"))):
        if not path.relative_to(ROOT).as_posix().startswith(ENGLISH_ONLY):
            yield from (text for call, text in calls_of(path) if text[1])


def calls_of(path: Path) -> Iterator[tuple[ast.Call, Text]]:
    """Yield the calls in a module that hold a text, with it."""
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in _CALLS:
            words = [each.value for each in node.args if isinstance(each, ast.Constant)]
            text_of = _CALLS[node.func.id]
            if len(words) >= text_of.__code__.co_argcount:
                yield node, text_of(*words[: text_of.__code__.co_argcount])


def texts_of_data() -> Iterator[Text]:
    """Yield the names and texts of what comes with the program."""
    for elastic in elastics():
        kind = elastic.name.removesuffix(f" {elastic.width_mm:g} mm")
        yield from (("elastic", kind, ""), ("elastic", elastic.source, ""))
    for cloth in cloths():
        yield from (("cloth", cloth.title, ""), ("cloth", cloth.source, ""))
    for block in built_in_blocks():
        yield ("block", block.title, "")
        yield from (("piece", panel.name, "") for panel in block.panels)
        yield from (("seam", seam.name, "") for seam in block.seams)
    for preset in presets():
        yield from (("preset", each, "") for each in (preset.title, preset.leaves_out) if each)
    named = (*map(LandmarkName, ALL_NAMES), *map(SideName, SIDES))
    settings = map(SettingName, (*CHOICES, *RANGES, "scaled_normals", "dense_volume"))
    yield from ((name.context, str(name), "") for name in (*named, *settings))
    yield from (("sample", title, "") for title in SAMPLES.values())
    yield from (("unit", unit, "") for unit in MILLIMETRES)


def catalogue_text(found: Iterable[Text], known: dict[tuple[str, str], list[str]], language: str) -> str:
    """Return the catalogue of a language with all texts that were ``found``, sorted."""
    entries = [_HEADER.format(language=language)]
    for context, english, plural in sorted(found, key=lambda text: (text[1], text[0])):
        forms = known.get((context, english)) or [""]
        lines = [f"msgctxt {_quoted(context)}"] if context else []
        lines.append(f"msgid {_quoted(english)}")
        if plural:
            lines.append(f"msgid_plural {_quoted(plural)}")
            lines += [f"msgstr[{k}] {_quoted(form)}" for k, form in enumerate(forms)]
        else:
            lines.append(f"msgstr {_quoted(forms[0])}")
        entries.append("\n".join(lines))
    return "\n\n".join(entries) + "\n"


_HEADER = """\
msgid ""
msgstr ""
"Project-Id-Version: Busk\\n"
"Language: {language}\\n"
"MIME-Version: 1.0\\n"
"Content-Type: text/plain; charset=UTF-8\\n"
"Content-Transfer-Encoding: 8bit\\n"
"Plural-Forms: nplurals=1; plural=0;\\n\""""


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


def main() -> None:
    """Write the catalogues of all languages, and print what has no translation."""
    found = texts()
    for code in LANGUAGES:
        if code == "en":
            continue
        known = translations(code)
        path = ROOT / "resources" / "locale" / code / "LC_MESSAGES" / "busk.po"
        path.write_text(catalogue_text(found, known, code), encoding="utf-8")
        for context, english, _ in sorted(found):
            if (context, english) not in known:
                print(f"{code}: {context}{': ' * bool(context)}{english}")


if __name__ == "__main__":
    main()
