"""Read the design of a command from its file and options, and save it as a project."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from app.cli.options import NUMBERS, SWITCHES, WORDS, shown_text, stored_word
from core.control_mesh.template import read_template
from core.document.cup import CUP_RANGES, Cup
from core.document.design import Design, ScanSource
from core.document.document import Document
from core.document.line_notation import parse_line
from core.document.storage.backups import backup_before_write
from core.document.storage.project_file import SUFFIX, is_project, open_project, save_project
from core.errors import UserError
from core.garment.line_requests import with_lines_and_elastics, with_lower_trunk
from core.garment.presets import find_preset, with_preset
from core.landmarks.manual import placed_mark
from core.messages import Message
from core.pipeline.build import Stages, build
from core.scan.source import ScanEdits, hole_centre

_ON = dict.fromkeys(("yes", "on", "true", "1"), True) | dict.fromkeys(("no", "off", "false", "0"), False)
_FIRM = {"yes": 0.1, "on": 0.1, "firm": 0.1, "no": 0.0, "off": 0.0, "free": 0.0}


def design_of(options: argparse.Namespace) -> Design:
    """Return the design of a project, or a new one for a scan, changed by the options. Raises UserError."""
    path = options.input
    design = open_project(path).design if is_project(path) else Design(ScanSource(path))
    axes = {key: getattr(options, key) for key in ("unit", "up", "front") if getattr(options, key, None)}
    scan = design.scan.set_up(**axes)
    design = replace(design, scan=replace(scan, edits=_edits_of(scan.edits, options)))
    for mark in map(placed_mark, getattr(options, "landmark", None) or []):
        design = design.with_placed(mark.name, mark.position)
    return with_options(design, options)


def with_options(design: Design, options: argparse.Namespace) -> Design:
    """Return a design changed by the options that hold for any body. Raises UserError."""
    settings = settings_of(getattr(options, "settings", None) or [])
    design = design.with_template(settings.pop("template", design.template)).with_settings(settings)
    for text in getattr(options, "path", None) or []:
        design = design.with_custom_line(parse_line(text, read_template(design.template)))
    if getattr(options, "preset", None):
        design = with_preset(design, find_preset(options.preset))
    if getattr(options, "cup", None):
        # Cups need solid tissue: who asks for them asks for it.
        tissue = settings.get("tissue", "solid") if options.cup != "none" else design.tissue
        design = replace(design, cup=cup_of(options.cup, design.cup), tissue=tissue)
    design = with_lower_trunk(design, getattr(options, "line", None) or [])
    return replace(design, volume=getattr(options, "volume", None) or design.volume)


def stages_of(options: argparse.Namespace) -> Stages:
    """Build the design of ``design_of`` with the lines and elastics of the options. Raises UserError."""
    return with_lines_and_elastics(build(design_of(options)), options.line or [], options.elastic or [])


def _edits_of(edits: ScanEdits, options: argparse.Namespace) -> ScanEdits:
    """Return the edits of a scan, changed by the options. Raises UserError."""
    named = {"low": "keep_from", "high": "keep_to", "kept": "mirror"}
    given = {key: getattr(options, option, None) for key, option in named.items()}
    edits = replace(edits, **{key: value for key, value in given.items() if value is not None})
    for text in getattr(options, "fill", None) or []:
        edits = replace(edits, fill_all=True) if text == "all" else edits.with_filled(hole_centre(text))
    return edits


def settings_of(pairs: Sequence[str]) -> dict[str, Any]:
    """Return the settings of a design that ``KEY=VALUE`` pairs set; hyphens and underscores are the same.

    Raises UserError with the valid keys or words; ranges are checked by the design.
    """
    values: dict[str, Any] = {}
    for pair in pairs:
        key, equals, value = pair.partition("=")
        key, value = key.strip().lower().replace("-", "_"), value.strip().lower()
        if not equals or key not in _READERS:
            raise UserError(
                Message("'{pair}' is not a setting.", pair=pair),
                Message("Enter KEY=VALUE. Keys: {choices}.", choices=", ".join(_READERS)),
            )
        values[key] = _READERS[key](key, value)
    return values


def cup_of(text: str, cup: Cup | None) -> Cup | None:
    """Return cups changed by ``text``, ``KEY=VALUE,...``; "none" for none. Raises UserError."""
    if text.strip().lower() == "none":
        return None
    values: dict[str, Any] = {}
    for pair in text.split(","):
        key, equals, value = (part.strip().lower() for part in pair.partition("="))
        key = key.replace("-", "_")
        if not equals or key not in _CUP_READERS:
            raise UserError(
                Message("'{pair}' is not a setting of a cup.", pair=pair.strip()),
                Message("Enter KEY=VALUE. Keys: {choices}.", choices=", ".join(_CUP_READERS)),
            )
        values[key] = _CUP_READERS[key](key, value)
    return replace(cup or Cup(), **values)


def _word(key: str, value: str) -> str:
    plain = stored_word(value.replace("_", "-").replace(" ", "-"))
    if plain not in WORDS[key]:
        raise UserError(
            Message("'{value}' is not a value of {key}.", value=value, key=key),
            Message("Choose one of: {choices}.", choices=", ".join(shown_text(key))),
        )
    return plain


def _number(key: str, value: str) -> float:
    try:
        return float(value.replace(",", "."))
    except ValueError:
        raise UserError(
            Message("The {key} '{value}' is not a number.", key=key, value=value),
            Message("Enter for example {key}=1.5.", key=key),
        ) from None


def _gain(key: str, value: str) -> float | None:
    return None if value == "auto" else _number(key, value)


def _firm_chest(key: str, value: str) -> float:
    return _FIRM[value] if value in _FIRM else _number(key, value)


def _switch(key: str, value: str) -> bool:
    if value not in _ON:
        raise UserError(
            Message("'{value}' is not a value of {key}.", value=value, key=key),
            Message("Choose one of: yes, no."),
        )
    return _ON[value]


_READERS: dict[str, Callable[[str, str], Any]] = {
    **dict.fromkeys(WORDS, _word),
    **dict.fromkeys(NUMBERS, _number),
    **dict.fromkeys(SWITCHES, _switch),
    "gain": _gain,
    "firm_chest": _firm_chest,
}


_CUP_READERS: dict[str, Callable[[str, str], Any]] = {
    **dict.fromkeys(("kind", "coverage"), lambda _, value: value),
    **dict.fromkeys(CUP_RANGES, _number),
    "wire": _switch,
}


def check_project_name(out: str) -> None:
    """Raise UserError unless ``out`` is empty or the name of a project file."""
    if out and not is_project(out):
        raise UserError(
            Message("{out} is not a project file name.", out=out),
            Message("Specify a project file: --out design{SUFFIX}.", SUFFIX=SUFFIX),
        )


def save_design(source: str, out: str, design: Design, stages: Stages) -> None:
    """Save a design as the project ``out``: a new one, or that of ``source`` with this design.

    The former file is kept as a backup. Nothing is saved if ``out`` is empty.
    """
    if out:
        document = open_project(source) if is_project(source) else Document.single(design)
        with backup_before_write(Path(out)):
            save_project(out, document.with_design(design), stages.scan, None)
