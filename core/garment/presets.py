"""Presets: named garments as data files, ours and those that a designer saves: lines, elastics and cups."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

import platformdirs

from core.control_mesh.template import Template, read_template
from core.document.cup import Cup
from core.document.design import Design, ScanSource
from core.document.json_values import value_of
from core.document.line_notation import format_path, parse_line, ready_made_lines, template_of
from core.document.lines import BUST, LONGEST_TITLE, LOWER, CustomLine, LineSettings
from core.document.lower_trunk import LowerTrunk, lower_lines_of
from core.document.printable_name import is_blank, is_printable
from core.document.storage.project_file import safe_name
from core.errors import LineError, UserError, reason_of
from core.files.atomic_write import private_folder, write_text
from core.files.regular_file import read_text
from core.garment.elastic_library import find_elastic, library
from core.messages import ElasticName, LineName, Message, join

FORMAT = 3
"""The newest format of a preset that is read: 2 has tissue, cups and elastics, 3 lines of the lower trunk.

Each preset is written in the oldest format that can hold it.
"""

_LARGEST = 1_000_000  # bytes of a preset's file
_REMEDY = Message("Correct the file or remove it.")
_LONGEST = 1000  # letters of what it leaves out


@dataclass(frozen=True)
class PresetLine:
    """A line of a preset: one of the template, a ready-made pair ("straps"), or one through ``places``.

    ``places`` are written as for ``parse_line``. ``length`` [1] is where it starts, None leaves it off;
    ``width`` [mm], ``stiffness`` [1], ``title``, ``colour`` and ``linked`` as in ``LineSettings``;
    ``elastic`` names one of the library.
    """

    line: str
    places: str = ""
    length: float | None = None
    width: float | None = None
    title: str = ""
    colour: str = ""
    stiffness: float | None = None
    linked: bool = True
    elastic: str = ""

    @property
    def is_below(self) -> bool:
        """Return whether it is a line of the lower trunk."""
        if self.places:
            return LOWER in (word.strip().lower() for word in self.places.split(","))
        return bool(lower_lines_of(self.line))


@dataclass(frozen=True)
class Preset:
    """A garment by its ``title``: lines, and the ``cup`` of both breasts; ``leaves_out`` says what it lacks.

    ``template`` is that of the places, empty if it names none: then it goes with every template. ``tissue``
    is what it is worn on, empty for that of the design. Raises LineError for a title that cannot be shown.
    """

    title: str
    lines: tuple[PresetLine, ...]
    leaves_out: str = ""
    template: str = ""
    tissue: str = ""
    cup: Cup | None = None

    def __post_init__(self) -> None:
        if not is_printable(self.title, LONGEST_TITLE) or not is_printable(self.leaves_out, _LONGEST):
            raise LineError(
                Message("The title of the preset is too long or contains unprintable characters."),
                Message("Use at most {count} characters.", count=LONGEST_TITLE),
            )

    @property
    def is_for_bust(self) -> bool:
        """Return whether it says what is worn on the bust."""
        of_bust = any(not each.is_below for each in self.lines)
        return of_bust or self.cup is not None

    @property
    def is_for_lower_trunk(self) -> bool:
        """Return whether it says what is worn on the lower trunk."""
        return any(each.is_below for each in self.lines)

    def lines_on_template(self, template: Template) -> Iterator[tuple[PresetLine, tuple[CustomLine, ...]]]:
        """Yield each line with the own lines that it is, none for one of the template. Raises LineError."""
        pairs = ready_made_lines(template)
        for line in self.lines:
            if line.places:
                yield line, (parse_line(f"{line.line}={line.places}", template),)
            elif line.line in pairs:
                yield line, pairs[line.line]
            elif line.line in template.lines or lower_lines_of(line.line):
                yield line, ()
            else:
                known = tuple(LineName(each) for each in (*template.lines, *pairs))
                raise LineError(
                    Message("There is no line '{line}'.", line=LineName(line.line)),
                    Message("Available lines: {lines}.", lines=known),
                )


def read_preset(path: Path) -> Preset:
    """Read a preset's file. Raises LineError, which says what is wrong in it."""
    try:
        return preset_of(read_text(path, _LARGEST))
    except UserError as problem:
        unreadable = Message("The preset {name} cannot be read.", name=path.name)
        raise LineError(join((unreadable, problem.message)), _REMEDY) from problem
    except (OSError, ValueError) as problem:
        unreadable = Message(
            "The preset {name} cannot be read: {why}.", name=path.name, why=reason_of(problem)
        )
        raise LineError(unreadable, _REMEDY) from problem


def preset_of(text: str) -> Preset:
    """Return the preset that a file's text describes. Raises ValueError or LineError if it is none."""
    try:
        values = dict(json.loads(text))
        if values.pop("format") not in (1, 2, FORMAT):
            raise ValueError(f"it is not of format {FORMAT}")
        lines = tuple(_line(each) for each in values.pop("lines"))
        told = values.pop("cup", None)
        cup = None if told is None else value_of(Cup, told, "cup")
        texts = {key: str(text) for key, text in values.items()}
        preset = Preset(texts.pop("title"), lines, cup=cup, **texts)
    except (KeyError, TypeError, AttributeError, RecursionError) as problem:
        raise ValueError(f"{type(problem).__name__} {problem}") from problem
    if is_blank(preset.title) or not preset.lines:
        raise ValueError("it needs a title and lines")
    # Laid once on a template, so that a fault is told now and not when it is wanted.
    design = Design(ScanSource(""), template=preset.template or "168")
    with_preset(design, preset)
    return preset


def _line(values: Mapping[str, Any]) -> PresetLine:
    line = PresetLine(**values)
    texts = (line.line, line.places, line.title, line.colour, line.elastic)
    numbers = (line.length, line.width, line.stiffness)
    fit = all(isinstance(text, str) for text in texts) and isinstance(line.linked, bool)
    if not fit or not all(each is None or type(each) in (int, float) for each in numbers):
        raise TypeError(f"in line {line.line}")
    return line


@cache
def built_in() -> tuple[Preset, ...]:
    """Return the presets that come with Busk."""
    folder = resources.files("resources") / "presets"
    files = sorted((each for each in folder.iterdir() if each.name.endswith(".json")), key=lambda f: f.name)
    return tuple(preset_of(each.read_text(encoding="utf-8")) for each in files)


def user_folder() -> Path:
    """Return where a designer's own presets lie."""
    return Path(platformdirs.user_data_path("Busk", appauthor=False)) / "presets"


def user_file(title: str) -> Path:
    """Return where an own preset of that title lies, or would lie."""
    return user_folder() / f"{safe_name(title)}.json"


def user_presets() -> tuple[list[Preset], list[LineError]]:
    """Return the designer's own presets, and why some of them cannot be read."""
    presets, problems = [], []
    for path in sorted(user_folder().glob("*.json")):
        try:
            presets.append(read_preset(path))
        except LineError as problem:
            problems.append(problem)
    return presets, problems


def find_preset(text: str) -> Preset:
    """Find the preset of this title, of all these words, or in this file. Raises LineError."""
    if text.lower().endswith(".json"):
        return read_preset(Path(text))
    presets = (*built_in(), *user_presets()[0])
    words, titles = _words(text), [_words(each.title) for each in presets]
    exact = [preset for preset, title in zip(presets, titles, strict=True) if title == words]
    alike = [preset for preset, title in zip(presets, titles, strict=True) if set(words) <= set(title)]
    found = exact or (alike if words else [])
    if len(found) != 1:
        raise LineError(
            Message("Several presets match '{text}'.", text=text)
            if found
            else Message("No preset matches '{text}'.", text=text),
            Message("Choose one of: {choices}.", choices="; ".join(each.title for each in found or presets)),
        )
    return found[0]


def _words(text: str) -> list[str]:
    return text.casefold().replace("-", " ").replace(",", "").split()


def save_preset(preset: Preset) -> Path:
    """Write a preset into the designer's own folder, over one of the same name. Raises ProjectError."""
    path = user_file(preset.title)
    private_folder(path.parent)
    text = json.dumps(_as_values(preset), indent=1, ensure_ascii=False)
    write_text(path, text, private=True)
    return path


def _as_values(preset: Preset) -> dict[str, Any]:
    """Return a preset as values of JSON: one that an older Busk can hold is one that it reads."""
    values = asdict(preset)
    newer = preset.tissue, preset.cup, *(line.elastic for line in preset.lines)
    if any(newer) or preset.is_for_lower_trunk:
        return {"format": FORMAT if preset.is_for_lower_trunk else 2, **values}
    del values["tissue"], values["cup"]
    for line in values["lines"]:
        del line["elastic"]
    return {"format": 1, **values}


def preset_from(design: Design, title: str) -> Preset:
    """Return the lines of a design as a preset: those that are worn, and all own ones."""
    own = {line.name: line for line in design.own_lines}
    known = library()
    if strange := [each for each in design.active_elastics().values() if known.get(each.name) != each]:
        raise LineError(
            Message("The elastic {name} is not in the library.", name=ElasticName(strange[0].name)),
            Message("Save it in the library first, or choose another elastic."),
        )
    below = () if design.lower is None else sorted(design.lower_design.active_lines() - own.keys())
    names = [*sorted(design.active_lines() - own.keys()), *own, *below]
    lines = tuple(_as_preset(name, design, own.get(name)) for name in names)
    if not lines:
        raise LineError(
            Message("The design has no lines to save as a preset."),
            Message("Shorten or add a line first."),
        )
    # Lengths of elastics, and cups, mean something on the tissue that they were chosen on.
    tissue = design.tissue if design.active_elastics() or design.cup else ""
    return Preset(
        title, lines, template=design.template if design.lines_of(BUST) else "", tissue=tissue, cup=design.cup
    )


def _as_preset(name: str, design: Design, line: CustomLine | None) -> PresetLine:
    traits = design.line_settings(name)
    places = "" if line is None else format_path(line, template_of(line.region, design.template))
    worn = name in design.all_active_lines()
    length = design.ratio(name) if worn else None
    elastic = traits.elastic if worn else ""
    dress = (traits.width, traits.title, traits.colour, traits.stiffness, traits.linked, elastic)
    return PresetLine(name, places, length, *dress)


def with_preset(design: Design, preset: Preset) -> Design:
    """Return the design in a preset; other lines of its regions stay, taken off unless locked, as are cups.

    A region that the preset has no lines for stays as it is.
    Ready-made lines that are there stay as they were led; those through places are led through these. Lines
    have the elastics of the preset, else none. Raises LineError if the preset's places are those of another
    template, an elastic of it is not in the library, or a line of it is locked.
    """
    if preset.template not in ("", design.template):
        raise LineError(
            Message(
                "The preset {name} belongs to the {count}-polygon control mesh.",
                name=preset.title,
                count=preset.template,
            ),
            Message("Choose that control mesh first."),
        )
    after = design
    if preset.is_for_bust:
        after = replace(design.with_bust_lines_reset(), cup=preset.cup, tissue=preset.tissue or design.tissue)
    if preset.is_for_lower_trunk:
        after = replace(after, lower=after.lower or LowerTrunk()).with_lower_lines_reset()
    for line, own in preset.lines_on_template(read_template(design.template)):
        names = _names(line, own)
        present = {each.name: each for each in after.own_lines}
        for each in own:
            if each.name not in present or (line.places and each != present[each.name]):
                after = after.with_custom_line(each)
        for name in names:
            if after.line_settings(name).locked:
                continue
            usual = after.line_settings(name)
            after = after.with_line(name, line.length).with_line_settings(_dressed(usual, line))
            if line.elastic:
                after = after.with_elastic(name, find_elastic(line.elastic))
    return after


def is_active(design: Design, preset: Preset) -> bool:
    """Return whether a design wears the lines of a preset and no others, whatever their lengths are now."""
    courses = {line.name: line for line in design.own_lines}
    wanted: set[str] = set()
    for line, own in preset.lines_on_template(read_template(design.template)):
        there = [courses.get(each.name) for each in own]
        # Ready-made lines may have been led elsewhere: they are the same lines.
        if None in there or (line.places and there != list(own)):
            return False
        if line.length is not None:
            wanted.update(_names(line, own))
    of_preset: set[str] = set()
    if preset.is_for_lower_trunk and design.lower is not None:
        of_preset |= design.lower_design.active_lines()
    if preset.is_for_bust:
        of_preset |= design.active_lines()
        if not _has_cups_and_elastics(design, preset):
            return False
    return bool(wanted) and of_preset == wanted


def _names(line: PresetLine, own: Sequence[CustomLine]) -> list[str]:
    """Return the lines that a line of a preset is: own ones, both sides below the bust, or itself."""
    return [each.name for each in own] or list(lower_lines_of(line.line)) or [line.line]


def _has_cups_and_elastics(design: Design, preset: Preset) -> bool:
    """Return whether cups are of the same kind, cut and wire, and lines of the elastics that are named."""
    told, worn = (
        None if cup is None else (cup.kind, cup.coverage, cup.wire) for cup in (preset.cup, design.cup)
    )
    named = {find_elastic(line.elastic).name for line in preset.lines if line.elastic}
    made = {elastic.name for elastic in design.active_elastics().values()}
    return told == worn and (not named or made == named)


def _dressed(traits: LineSettings, line: PresetLine) -> LineSettings:
    usual = replace(traits, elastic="", width=None) if traits.elastic else traits
    return replace(
        usual,
        title=line.title or traits.title,
        colour=line.colour or traits.colour,
        width=line.width if line.width is not None else usual.width,
        stiffness=line.stiffness if line.stiffness is not None else traits.stiffness,
        linked=line.linked,
    )
