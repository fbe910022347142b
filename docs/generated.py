"""Parts of the reference that are generated from the program when the guide is built."""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable, Iterable, Iterator, Sequence

from app.cli.parser import COMMANDS, command_parser
from core.measurements.definitions import DEFINITIONS
from core.measurements.size_table import Scale
from core.measurements.sizes import built_in, short, sizes

SHARED = 4
"""Options of at least so many commands are listed once, for all of them."""

EXAMPLE = (723.0, 871.0)
"""Under-bust and bust girth of the body that the page of sizes uses [mm]."""

API = {
    "Scan and landmarks": ("core.scan.body.read_scan", "core.landmarks.detect.find_landmarks"),
    "Design and solution": (
        "core.pipeline.build.build",
        "core.pipeline.solve.solve",
        "core.pipeline.solve.Solution",
    ),
    "Measurements and sizes": (
        "core.measurements.table.measures",
        "core.measurements.table.before_after",
        "core.measurements.sizes.sizes",
    ),
    "Garment": (
        "core.garment.elastic_library.find_elastic",
        "core.garment.match_shape.match_lengths",
        "core.garment.cut_list.cut_list",
        "core.garment.pressure_list.pressure_list",
    ),
    "Files": (
        "core.document.storage.project_file.open_project",
        "core.document.storage.project_file.save_project",
        "core.export.mesh.write_mesh",
    ),
}
"""The public functions and classes by subject."""


def with_generated_parts(text: str) -> str:
    """Return a page with the parts that its marks name. Raises KeyError for a mark without a part."""
    return re.sub(r"<!-- generated: (.*?) -->", lambda mark: PARTS[mark[1]](), text)


def table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table in Markdown."""
    lines = [" | ".join(cells) for cells in (heads, ["---"] * len(heads), *rows)]
    return "\n".join(f"| {line} |" for line in lines)


def commands() -> str:
    """Return all commands with their options, those of many commands first."""
    takers: dict[tuple[str, str], list[str]] = {}
    for command in COMMANDS:
        for option in _options(command):
            takers.setdefault(option, []).append(command)
    shared: dict[tuple[str, ...], list[tuple[str, str]]] = {}
    for option, of in takers.items():
        if len(of) >= SHARED:
            shared.setdefault(tuple(of), []).append(option)
    parts = ["### Common options"]
    for of, options in shared.items():
        parts += [f"Of {', '.join(of)}:", table(("option", "meaning"), options)]
    for command, help_ in COMMANDS.items():
        parts += [f"### busk {command}", f"{help_[:1].upper()}{help_[1:]}."]
        own = [option for option in _options(command) if len(takers[option]) < SHARED]
        parts += [table(("option", "meaning"), own)] if own else []
    return "\n\n".join(parts)


def _options(command: str) -> Iterator[tuple[str, str]]:
    for action in command_parser(command)._actions:
        if action.dest != "help" and action.help != argparse.SUPPRESS:
            yield _option(action), _cell((action.help or "").replace("%%", "%"))


def _option(action: argparse.Action) -> str:
    name = action.option_strings[0] if action.option_strings else ""
    value = action.metavar or "\\|".join(action.choices or ())
    more = " ..." if isinstance(action, argparse._AppendAction) else ""
    words = (name, "" if action.nargs == 0 else value)
    return f"`{' '.join(filter(None, words))}{more}`"


def _cell(text: str) -> str:
    return re.sub(r"([|*<])", r"\\\1", text)


def api() -> str:
    """Return the documentation of the public functions and classes, as directives of autodoc."""
    parts = []
    for title, names in API.items():
        parts.append(f"## {title}")
        for name in names:
            kind = "class" if name.rpartition(".")[2][0].isupper() else "function"
            parts.append(f"```{{eval-rst}}\n.. auto{kind}:: {name}\n```")
    return "\n\n".join(parts)


def measurements() -> str:
    """Return the definitions of all measurements with their pictures."""
    heads = ("", "measurement", "unit", "in the standard", "definition")
    rows = []
    for each in DEFINITIONS.values():
        title = f"{each.title}{', left and right' if each.sided else ''}"
        picture = f"![{each.title}](../pictures/measures/{each.key}.png)"
        rows.append((picture, title, each.unit, each.iso or "-", str(each.text)))
    return table(heads, rows)


def size_rules() -> str:
    """Return the steps of every size table."""
    heads = ("system", "key", "unit", "bands", "cup from bust less", "cups")
    rows = [
        (
            each.title.en,
            f"`{each.key}`",
            each.unit,
            _scale(each.bands),
            each.cup_from.replace("underbust", "under-bust"),
            _scale(each.cups),
        )
        for each in built_in()
    ]
    return table(heads, rows)


def _scale(scale: Scale) -> str:
    steps = [
        f"{step.name}: {short(step.least)}" + ("" if step.least == step.most else f" to {short(step.most)}")
        for step in scale.steps
    ]
    return ", ".join([*steps[:2], "…", steps[-1]]) + f"; border: {'larger' if scale.upward else 'smaller'}"


def size_example() -> str:
    """Return the size of one body in every system."""
    rows = []
    for answer in sizes(*EXAMPLE).values():
        ups = [f"{each.label}, {short(each.missing_mm)} mm" for each in answer.neighbours if each.up]
        sisters = ", ".join(each.label for each in answer.sisters)
        rows.append((answer.table.system, answer.label, *ups, sisters))
    return table(("system", "size", "next band", "next cup", "sister sizes"), rows)


def size_sources() -> str:
    """Return sources and doubts of all size tables, each once with the systems that it concerns."""
    parts = []
    for title, said in (
        ("Sources", lambda each: [f"{source.name}: {source.words.en}" for source in each.sources]),
        ("Doubts", lambda each: [doubt.en for doubt in each.doubts]),
    ):
        of: dict[str, list[str]] = {}
        for each in built_in():
            for sentence in said(each):
                of.setdefault(sentence, []).append(each.key)
        parts += [f"### {title}", "\n".join(f"- {_cell(text)} ({', '.join(of[text])})" for text in of)]
    return "\n\n".join(parts)


PARTS: dict[str, Callable[[], str]] = {
    "commands": commands,
    "api": api,
    "measurements": measurements,
    "size rules": size_rules,
    "size example": size_example,
    "size sources": size_sources,
}
"""What each mark of a page stands for."""
