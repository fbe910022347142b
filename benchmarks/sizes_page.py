"""Put the tables of docs/sizes.md there, from the tables of sizes and what the code makes of girths.

Run: python benchmarks/sizes_page.py; a test says when it is time.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

from pages import put, table

sys.path.insert(0, str(Path(__file__).parents[1]))

from core.measurements.size_explanation import plain
from core.measurements.size_table import Scale, SizeTable
from core.measurements.sizes import built_in, size, sizes

BODY = (723.0, 871.0)
"""Under-bust and bust girth of the body that the page sizes in every system [mm]."""


def told() -> dict[str, str]:
    """Return the generated parts of the page by the names of their marks."""
    return {"rules": _rules(), "worked examples": _examples(), "one body": _body(), "sources": _sources()}


def _rules() -> str:
    heads = ("system", "key", "unit", "bands", "cup from bust less", "cups")
    rows = (
        (
            each.title.en,
            f"`{each.key}`",
            each.unit,
            _scale(each.bands),
            each.cup_from.replace("underbust", "under-bust"),
            _scale(each.cups),
        )
        for each in built_in()
    )
    return table(heads, rows)


def _scale(scale: Scale) -> str:
    """Return the first two steps and the last with what the source names, and the side of a border."""
    steps = [f"{step.name}: {_named(step.least, step.most)}" for step in scale.steps]
    return ", ".join([*steps[:2], "…", steps[-1]]) + f"; border: {'larger' if scale.upward else 'smaller'}"


def _named(least: float, most: float) -> str:
    return plain(least) if least == most else f"{plain(least)} to {plain(most)}"


def _examples() -> str:
    heads = ("system", "under-bust", "bust", "size", "the way there", "source")
    return table(heads, (row for each in built_in() for row in _example_rows(each)))


def _example_rows(each: SizeTable) -> Iterator[tuple[str, ...]]:
    for example in each.examples:
        answer = size(each, example.underbust * each.unit_mm, example.bust * each.unit_mm)
        girths = (f"{plain(girth)} {each.unit}" for girth in (example.underbust, example.bust))
        yield each.system, *girths, answer.label, " ".join(answer.rule), example.source


def _body() -> str:
    heads = ("system", "size", "the way there", "next band up", "next cup up", "sister sizes")
    rows = []
    for answer in sizes(*BODY).values():
        ups = [f"{x.label}, {plain(x.missing_mm)} mm" for x in answer.neighbours if x.up]
        sisters = ", ".join(each.label for each in answer.sisters)
        rows.append((answer.table.system, answer.label, " ".join(answer.rule), *ups, sisters))
    return table(heads, rows)


def _sources() -> str:
    parts = []
    for each in built_in():
        lines = [f"**{each.title.en}**", ""]
        lines += [f"- {source.name}: {source.words.en}" for source in each.sources]
        lines += [f"- *Doubt:* {doubt.en}" for doubt in each.doubts]
        parts.append("\n".join(lines))
    return "\n\n".join(parts)


if __name__ == "__main__":
    for name, text in told().items():
        put("sizes.md", name, text)
