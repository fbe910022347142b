"""Messages of the core, and names in them, as texts in the language and the unit in use."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache

from app.i18n.catalog import joined, listed, template, tr, tr_context
from app.i18n.lengths import length, length_number, width
from core.document.design import Design
from core.garment.elastic_library import built_in
from core.garment.presets import Preset
from core.messages import (
    ElasticName,
    Length,
    LengthRange,
    LineName,
    Message,
    Name,
    Parameter,
    PieceName,
    SeamName,
)

Text = Message | str
"""A message, or a text that is in the language in use."""


def render(message: Text, design: Design | None = None) -> str:
    """Return a message in the language and the unit in use; a text stays.

    Lines have the titles that the ``design`` gives them, or that their names bring with them.
    """
    if isinstance(message, str):
        return message
    if not message.msgid:
        return joined(render(each, design) for each in message.sentences)
    text = template(message)
    texts = {name: _text(value, design) for name, value in message.items}
    first = re.match(r"\{(\w+)\}", text)
    if first is not None and isinstance(line := message.parameters[first[1]], LineName):
        title = _line(line, design, within=False)
        texts[first[1]] = title[:1].upper() + title[1:]
    return text.format_map(texts)


def render_all(messages: tuple[Message, ...] | list[Message], design: Design | None = None) -> list[str]:
    """Return messages in the language and the unit in use, see ``render``."""
    return [render(each, design) for each in messages]


def sentence_text(english: str, values: Mapping[str, str]) -> str:
    """Return an English sentence of the catalogue, of another process, filled in the language in use."""
    return render(Message(english, **values))


def _text(value: Parameter, design: Design | None) -> str:
    match value:
        case tuple():
            texts = [_text(each, design) for each in value]
            text = "; ".join(texts) if any(", " in each for each in texts) else listed(texts)
        case Message():
            text = render(value, design)
        case Length(mm, digits):
            text = length(mm, digits)
        case LengthRange(low, high, digits):
            text = tr("{low} to {high}").format(low=length_number(low, digits), high=length(high, digits))
        case LineName():
            text = _line(value, design)
        case ElasticName(name):
            text = elastic_title(name)
        case PieceName() | SeamName():
            text = _sided(value, value.text)
        case Name():
            text = tr_context(value.context, str(value))
        case int():
            text = f"{value:,}"
        case _:
            text = str(value)
    return text


def _line(name: LineName, design: Design | None, within: bool = True) -> str:
    """Return the title of a line; ``within`` a sentence one of the program's own begins small."""
    if name.title and name.title != name.text:
        return _with_side(name.title, name.text)
    title = line_title(name.text, design)
    known = title.lower().replace("-", " ") == name.text.lower().replace("-", " ")
    return name.text if within and known else title


def line_title(name: str, design: Design | None = None) -> str:
    """Return a line's name in the window's language, or the title that ``design`` gives it."""
    own = design.line_settings(name).title if design else ""
    if own:
        return _with_side(own, name)
    if design is not None and (upper := design.band_of(name)[0]) != name:
        return tr("{line}, below the bust").format(line=line_title(upper, design))
    titles = {
        "full-bust": tr("Full bust"),
        "mid-bust": tr("Mid-bust"),
        "under-bust": tr("Under-bust"),
        "strap left": tr("Strap left"),
        "strap right": tr("Strap right"),
        "sling left": tr("Sling left"),
        "sling right": tr("Sling right"),
        "oblique left": tr("Oblique left"),
        "oblique right": tr("Oblique right"),
        "ring left": tr("Ring left"),
        "ring right": tr("Ring right"),
        "cup left": tr("Cup left"),
        "cup right": tr("Cup right"),
        **_lower_titles(),
    }
    kind = kind_of(name)
    usual = _with_side(titles.get(kind) or _generated(kind), name)
    return titles.get(name, usual[:1].upper() + usual[1:])


def _lower_titles() -> dict[str, str]:
    """Return the names of the lines of the lower trunk, by kind."""
    return {
        "under-bust-whole": tr("Under-bust, all round"),
        "above-waist": tr("Above waist"),
        "waist": tr("Waist"),
        "below-waist": tr("Below waist"),
        "belly": tr("Belly"),
        "high-hip": tr("High hip"),
        "hip": tr("Hip"),
        "under-hip": tr("Under hip"),
        "belly-panel": tr("Belly panel"),
        "low-belly-panel": tr("Low belly panel"),
        "belly-cross": tr("Belly cross"),
        "sling": tr("Seat sling"),
        "high-sling": tr("High seat sling"),
        "buttock-lift": tr("Buttock lift"),
        "leg-opening": tr("Leg opening"),
        "high-leg": tr("High leg opening"),
        "princess-front": tr("Princess seam, front"),
        "princess-back": tr("Princess seam, back"),
        "side": tr("Side seam"),
    }


def kind_of(name: str) -> str:
    """Return the name of a line without its side."""
    return re.sub(r"[ -](left|right)$", "", name)


def side_of(name: str) -> str:
    """Return the side of a line in words; empty for one that is not one of a pair."""
    return {"left": tr("left"), "right": tr("right")}.get(name[len(kind_of(name)) + 1 :], "")


def sided_title(name: PieceName | SeamName) -> str:
    """Return the title of a piece or seam of a block, with its side; one of the user's own keeps its name."""
    title = _sided(name)
    return title[:1].upper() + title[1:]


def _sided(name: PieceName | SeamName, untranslated: str = "") -> str:
    """Return what a piece or seam is called here, or a text in place of the English name, if there is one."""
    kind, side = kind_of(name.text), side_of(name.text)
    title = tr_context(name.context, kind)
    if title == kind and untranslated:
        return untranslated
    return tr("{name}, {side}").format(name=title, side=side) if side else title


def _with_side(title: str, name: str) -> str:
    side = side_of(name)
    return listed((title, side)) if side else title


def _generated(name: str) -> str:
    """Return a name as the program gives it to a drawn line, such as "line 1", in the window's language."""
    word, _, number = name.partition(" ")
    return tr("line {number}").format(number=number) if word == "line" and number.isdecimal() else name


def own_title(name: Name) -> str:
    """Return a title that comes with the program in the window's language, one of the user's own as it is."""
    return tr_context(name.context, name.text)


def elastic_title(name: str) -> str:
    """Return what an elastic is called; one of the user's own keeps its name."""
    mm = _built_in_widths().get(name)
    return name if mm is None else f"{elastic_kind(name)} {width(mm)}"


def elastic_kind(name: str) -> str:
    """Return what an elastic that comes with Busk is called without its width."""
    return tr_context("elastic", re.sub(r" [\d.]+ mm$", "", name))


def preset_title(preset: Preset) -> str:
    """Return what a preset is called; one of the user's own keeps its title."""
    return tr_context("preset", preset.title)


def preset_note(preset: Preset) -> str:
    """Return what a preset leaves out of the garment, or nothing."""
    return tr_context("preset", preset.leaves_out) if preset.leaves_out else ""


@cache
def _built_in_widths() -> dict[str, float]:
    return {each.name: each.width_mm for each in built_in()}
