"""What the window says of the variants of a design beside each other: figures, and how far they are apart."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from app.panels.variants import Figure, FigureRow, VariantsView
from app.presenting.bust import bust_move, bust_sentence
from app.presenting.lines import line_colours, line_title, row_title
from app.presenting.verdict import is_result, kept_volume, state_of
from app.showing.verdict_chip import state_title
from app.wording.words import tr
from core.design import Design
from core.live import Frame

Variants = Sequence[tuple[str, Design, Frame | None]]
"""Variants by name, with the frame of those that are solved."""

_TOLD = 2  # lengths that differ which have room over a body


def variants_view(variants: Variants, shown: str) -> VariantsView:
    """Return the table of variants, of which one is ``shown``."""
    states = tuple(state_of(frame) if frame else "" for _, _, frame in variants)
    names = tuple(name for name, _, _ in variants)
    return VariantsView(names, names.index(shown), states, (*_lengths(variants), *_results(variants)))


def as_table(view: VariantsView) -> list[list[str]]:
    """Return the table as plain cells: a heading, the verdicts, each figure and what it differs by."""
    first, *others = view.names
    differences = [f"{name} - {first}" for name in others]
    verdicts = [state_title(state) if state else tr("Not solved yet") for state in view.states]
    rows = [
        [tr("Figure"), tr("Unit"), *view.names, *differences],
        [tr("Verdict"), "", *verdicts, *[""] * len(others)],
    ]
    for row in view.rows:
        for figure in row.figures:
            cells = [*figure.values, *(figure.apart(place) for place in range(1, len(view.names)))]
            written = ["" if each is None else f"{each:.{figure.digits}f}" for each in cells]
            rows.append([row.label, figure.unit, *written])
    return rows


def variant_titles(variants: Variants) -> list[str]:
    """Return what stands over the bodies of variants: name and verdict, bust point, lengths that differ."""
    differing = [row for row in _lengths(variants) if len(set(row.figures[0].values)) > 1]
    return [
        "\n".join(
            (
                _head(name, frame),
                *([bust_sentence(bust_move(frame))] if frame is not None and is_result(frame) else []),
                *(f"{row.label} {row.figures[0].written(place)}" for row in differing[:_TOLD]),
            )
        )
        for place, (name, _, frame) in enumerate(variants)
    ]


def _head(name: str, frame: Frame | None) -> str:
    title = tr("Variant {name}").format(name=name)
    return title if frame is None else f"{title}   {state_title(state_of(frame))}"


def _lengths(variants: Variants) -> list[FigureRow]:
    """Return a row for each line, or linked pair, whose length is set."""
    rests = [_rests(frame) for _, _, frame in variants]
    heads: dict[str, str] = {}
    for (_, design, _), rest in zip(variants, rests, strict=True):
        for name in rest:
            if name == min(design.linked(name)):
                heads.setdefault(name, row_title(name, design))
            elif name in heads or len(design.linked(name)) == 1:
                heads[name] = line_title(name, design)
    rows = []
    for name, title in heads.items():
        ratios = [_ratio(design, name, rest) for (_, design, _), rest in zip(variants, rests, strict=True)]
        lengths = [
            None if ratio is None or name not in rest else ratio * rest[name]
            for ratio, rest in zip(ratios, rests, strict=True)
        ]
        percent = tuple(None if ratio is None else 100.0 * ratio for ratio in ratios)
        rows.append(
            FigureRow(title, (Figure("%", 1, False, percent), Figure("mm", 1, False, tuple(lengths))))
        )
    return rows


def _rests(frame: Frame | None) -> dict[str, float]:
    """Return the lines whose length can be set with their length at rest [mm], in the order of the list."""
    if frame is None:
        return {}
    lines = {line.name: line for line in frame.stages.model.lines}
    return {name: lines[name].rest_length for name in line_colours(lines) if lines[name].constrains}


def _ratio(design: Design, name: str, rest: dict[str, float]) -> float | None:
    """Return what a line is set to; one that is not there, or not known to be, has no length."""
    return design.ratio(name) if name in rest or name in design.worn() else None


def _results(variants: Variants) -> list[FigureRow]:
    """Return the rows of what came of it; a run that vibrates or a shape that is no body has none."""
    frames = [frame if frame is not None and is_result(frame) else None for _, _, frame in variants]

    def row(label: str, *told: tuple[str, int, Callable[[Frame], float]]) -> FigureRow:
        return FigureRow(
            label,
            tuple(
                Figure(unit, digits, True, tuple(None if f is None else read(f) for f in frames))
                for unit, digits, read in told
            ),
        )

    return [
        row(tr("Bust point, up"), ("mm", 1, lambda frame: bust_move(frame).mean.up)),
        row(tr("Bust point, forward"), ("mm", 1, lambda frame: bust_move(frame).mean.forward)),
        row(
            tr("Volume error"),
            ("%", 2, lambda frame: kept_volume(frame)[0]),
            ("ml", 1, lambda frame: kept_volume(frame)[1]),
        ),
    ]
