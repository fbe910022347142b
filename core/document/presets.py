"""Presets: named sets of lines as data files, ours and those that a designer saves."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

import platformdirs

from core.control_mesh.template import Template, read_template
from core.document.design import Design, ScanSource
from core.document.line_notation import format_path, parse_line, ready_made_lines
from core.document.lines import LONGEST_TITLE, CustomLine, LineSettings
from core.document.printable_name import is_blank, is_printable
from core.document.storage.project_file import safe_name
from core.errors import LineError, UserError, reason_of
from core.files.atomic_write import private_folder, write_text
from core.files.regular_file import read_text
from core.messages import LineName, Message, join

FORMAT = 1
"""The newest format of a preset that is read."""

_LARGEST = 1_000_000  # bytes of a preset's file
_REMEDY = Message("Correct the file or remove it.")
_LONGEST = 1000  # letters of what it leaves out


@dataclass(frozen=True)
class PresetLine:
    """A line of a preset: one of the template, a ready-made pair ("straps"), or one through ``places``.

    ``places`` are written as for ``parse_line``. ``length`` [1] is where it starts, None leaves it off;
    ``width`` [mm], ``stiffness`` [1], ``title``, ``colour`` and ``linked`` as in ``LineSettings``.
    """

    line: str
    places: str = ""
    length: float | None = None
    width: float | None = None
    title: str = ""
    colour: str = ""
    stiffness: float | None = None
    linked: bool = True


@dataclass(frozen=True)
class Preset:
    """A set of lines by its ``title``; ``leaves_out`` says what it cannot hold.

    ``template`` is that of the places, empty if it names none: then it goes with every template.
    Raises LineError for a title that cannot be shown.
    """

    title: str
    lines: tuple[PresetLine, ...]
    leaves_out: str = ""
    template: str = ""

    def __post_init__(self) -> None:
        if not is_printable(self.title, LONGEST_TITLE) or not is_printable(self.leaves_out, _LONGEST):
            raise LineError(
                Message("The title of the preset is too long or contains unprintable characters."),
                Message("Use at most {count} characters.", count=LONGEST_TITLE),
            )

    def lines_on_template(self, template: Template) -> Iterator[tuple[PresetLine, tuple[CustomLine, ...]]]:
        """Yield each line with the own lines that it is, none for one of the template. Raises LineError."""
        pairs = ready_made_lines(template)
        for line in self.lines:
            if line.places:
                yield line, (parse_line(f"{line.line}={line.places}", template),)
            elif line.line in pairs:
                yield line, pairs[line.line]
            elif line.line in template.lines:
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
        if values.pop("format") != FORMAT:
            raise ValueError(f"it is not of format {FORMAT}")
        lines = tuple(_line(each) for each in values.pop("lines"))
        preset = Preset(str(values.pop("title")), lines, **{key: str(text) for key, text in values.items()})
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
    texts = (line.line, line.places, line.title, line.colour)
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


def save_preset(preset: Preset) -> Path:
    """Write a preset into the designer's own folder, over one of the same name. Raises ProjectError."""
    path = user_file(preset.title)
    private_folder(path.parent)
    text = json.dumps({"format": FORMAT, **asdict(preset)}, indent=1, ensure_ascii=False)
    write_text(path, text, private=True)
    return path


def preset_from(design: Design, title: str) -> Preset:
    """Return the lines of a design as a preset: those that are worn, and all own ones."""
    template = read_template(design.template)
    own = {line.name: line for line in design.own_lines}
    if design.active_elastics():
        raise LineError(
            Message("Elastic lengths are specific to one body and cannot be saved in a preset."),
            Message("Choose “No elastic” for all lines first: the preset then contains lengths on the body."),
        )
    names = sorted(design.active_lines() - own.keys()) + list(own)
    lines = tuple(_as_preset(name, design, own.get(name), template) for name in names)
    if not lines:
        raise LineError(
            Message("The design has no lines to save as a preset."),
            Message("Shorten or add a line first."),
        )
    return Preset(title, lines, template=design.template if own else "")


def _as_preset(name: str, design: Design, line: CustomLine | None, template: Template) -> PresetLine:
    traits = design.line_settings(name)
    places = "" if line is None else format_path(line, template)
    length = design.ratio(name) if name in design.active_lines() else None
    dress = (traits.width, traits.title, traits.colour, traits.stiffness, traits.linked)
    return PresetLine(name, places, length, *dress)


def with_preset(design: Design, preset: Preset) -> Design:
    """Return the design with the lines of a preset; its other lines stay, and are taken off unless locked.

    Ready-made lines that are there stay as they were led; those through places are led through these. Its
    lengths are those of lines of the model: elastics are chosen anew. Raises LineError if the preset's places
    are those of another template, or a line of it is locked.
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
    after = design.with_lines_reset()
    for line, own in preset.lines_on_template(read_template(design.template)):
        names = [each.name for each in own] or [line.line]
        present = {each.name: each for each in after.own_lines}
        for each in own:
            if each.name not in present or (line.places and each != present[each.name]):
                after = after.with_custom_line(each)
        for name in names:
            if after.line_settings(name).locked:
                continue
            usual = after.line_settings(name)
            after = after.with_line(name, line.length).with_line_settings(_dressed(usual, line))
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
            wanted.update([each.name for each in own] or [line.line])
    return bool(wanted) and design.active_lines() == wanted


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
