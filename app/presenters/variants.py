"""Compare the variants of a design: values side by side, and their distances."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from app.i18n.catalog import number, tr
from app.i18n.lengths import length_number, shown_unit
from app.presenters.assessment import AssessmentView
from app.presenters.bust_shift import bust_sentence, bust_shift
from app.presenters.lines import line_colours, row_title
from app.presenters.messages import elastic_title, line_title
from app.presenters.status import is_result
from core.document.design import Design
from core.garment.cut_list import CutRow, cut_list_of
from core.garment.pressure_list import PressureList
from core.pipeline.live_solver import Frame
from core.pipeline.warnings import controlled_volume

Variants = Sequence[tuple[str, Design, Frame | None]]
"""Variants by name, with the frame of those that are solved."""

Pressed = Callable[[Frame], PressureList | None]
"""What the lines of a frame press with, if that is known."""

_TOLD = 2  # lengths that differ which have room over a body


Judged = Callable[[Frame], AssessmentView]
"""The overall verdict of a frame, as far as it is known."""


def variants_view(variants: Variants, shown: str, pressed: Pressed, judged: Judged) -> VariantsView:
    """Return the table of variants, of which one is ``shown``."""
    overall = [None if frame is None else judged(frame) for _, _, frame in variants]
    levels = tuple("" if view is None else view.level for view in overall)
    verdicts = tuple(tr("Not computed") if view is None else view.headline for view in overall)
    names = tuple(name for name, _, _ in variants)
    rows = *_lengths(variants), *_pieces(variants, pressed), *_results(variants)
    return VariantsView(names, names.index(shown), levels, verdicts, rows)


def as_table(view: VariantsView) -> list[list[str]]:
    """Return the table as plain cells: a heading, the verdicts, each figure and what it differs by."""
    first, *others = view.names
    differences = [f"{name} - {first}" for name in others]
    rows = [
        [tr("Quantity"), tr("Unit"), *view.names, *differences],
        [tr("Verdict"), "", *view.verdicts, *[""] * len(others)],
    ]
    for row in view.rows:
        for figure in row.figures:
            rows.append([row.label, figure.unit, *figure.cells()])
    return rows


def variant_titles(variants: Variants, judged: Judged) -> list[str]:
    """Return what stands over the bodies of variants: name and verdict, bust point, lengths that differ."""
    differing = [row for row in _lengths(variants) if len(set(row.figures[0].values)) > 1]
    return [
        "\n".join(
            (
                _head(name, frame, judged),
                *([bust_sentence(bust_shift(frame))] if frame is not None and is_result(frame) else []),
                *(f"{row.label} {row.figures[0].written(place)}" for row in differing[:_TOLD]),
            )
        )
        for place, (name, _, frame) in enumerate(variants)
    ]


def _head(name: str, frame: Frame | None, judged: Judged) -> str:
    title = tr("Variant {name}").format(name=name)
    return title if frame is None else f"{title}   {judged(frame).headline}"


def _lengths(variants: Variants) -> list[VariantRow]:
    """Return a row for each line, or linked pair, whose length is set.

    Of one that is made of an elastic in any variant it is what is reached on the body: what is set for an
    elastic is its length unstretched, and nothing that a line of another kind can be compared with.
    """
    rests = [_rests(frame) for _, _, frame in variants]
    heads: dict[str, str] = {}
    for (_, design, _), rest in zip(variants, rests, strict=True):
        for name in rest:
            if name == design.linked_lines(name)[0]:
                heads.setdefault(name, row_title(name, design))
            elif name in heads or len(design.linked_lines(name)) == 1:
                heads[name] = line_title(name, design)
    rows = []
    elastic = {name for _, design, _ in variants for name in design.active_elastics()}
    for name, title in heads.items():
        if name in elastic:
            rows.append(_reached(name, tr("{line}, on body").format(line=title), variants))
            continue
        ratios = [_ratio(design, name, rest) for (_, design, _), rest in zip(variants, rests, strict=True)]
        lengths = [
            None if ratio is None or name not in rest else ratio * rest[name]
            for ratio, rest in zip(ratios, rests, strict=True)
        ]
        percent = tuple(None if ratio is None else 100.0 * ratio for ratio in ratios)
        rows.append(
            VariantRow(
                title, (VariantValues("%", 1, False, percent), VariantValues("mm", 1, False, tuple(lengths)))
            )
        )
    return rows


def _reached(name: str, title: str, variants: Variants) -> VariantRow:
    """Return how long a line is on the body, if its variant is solved."""
    lengths = tuple(None if frame is None else frame.line_lengths.get(name) for _, _, frame in variants)
    rests = (_rests(frame).get(name) for _, _, frame in variants)
    percent = tuple(
        100.0 * length / rest if length and rest else None
        for length, rest in zip(lengths, rests, strict=True)
    )
    return VariantRow(title, (VariantValues("%", 1, False, percent), VariantValues("mm", 1, False, lengths)))


def _pieces(variants: Variants, pressed: Pressed) -> list[VariantRow]:
    """Return a row for each line that is made of an elastic: to cut, of what, and what it presses with."""
    frames = [frame if frame is not None and is_result(frame) else None for _, _, frame in variants]
    cuts = [{} if frame is None else {row.line: row for row in cut_list_of(frame).rows} for frame in frames]
    lists = [
        pressed(frame) if frame is not None and frame.stages.design.active_elastics() else None
        for frame in frames
    ]
    press = [{} if each is None else {row.line: row.max_kpa for row in each.rows} for each in lists]
    made = {name for _, design, _ in variants for name in design.active_elastics()}
    return [
        VariantRow(
            _piece_title(name, design, [each[name] for each in cuts if name in each]),
            (
                VariantValues(
                    "mm", 0, False, tuple(each[name].cut_mm if name in each else None for each in cuts)
                ),
                VariantTexts(
                    tuple(elastic_title(design.line_settings(name).elastic) for _, design, _ in variants)
                ),
                VariantValues("kPa", 1, False, tuple(each.get(name) for each in press)),
            ),
        )
        for name, design in _named(variants).items()
        if name in made and name == design.band_of(name)[0]
    ]


def _named(variants: Variants) -> dict[str, Design]:
    """Return all lines in the order of the list, each with a design that has it."""
    found: dict[str, Design] = {}
    for _, design, frame in variants:
        lines = frame.stages.drawn_lines if frame is not None else ()
        found = dict.fromkeys(line_colours(line.name for line in lines), design) | found
    return {name: found[name] for name in line_colours(found)}


def _piece_title(name: str, design: Design, rows: Sequence[CutRow]) -> str:
    title = line_title(name, design)
    if any(row.front_only for row in rows):
        return tr("{line}: front part, elastic, contact pressure").format(line=title)
    return tr("{line}: cut length, elastic, contact pressure").format(line=title)


def _rests(frame: Frame | None) -> dict[str, float]:
    """Return the lines whose length can be set with their length at rest [mm], in the order of the list."""
    if frame is None:
        return {}
    lines, design = {line.name: line for line in frame.stages.drawn_lines}, frame.stages.design
    bands = {name: design.band_of(name) for name in line_colours(lines)}
    return {
        name: sum(lines[part].rest_length for part in band if part in lines)
        for name, band in bands.items()
        if name == band[0] and any(lines[part].constrains for part in band if part in lines)
    }


def _ratio(design: Design, name: str, rest: dict[str, float]) -> float | None:
    """Return what a line is set to; one that is not there, or not known to be, has no length."""
    return design.ratio(name) if name in rest or name in design.active_lines() else None


def _results(variants: Variants) -> list[VariantRow]:
    """Return the rows of what came of it; a run that vibrates or a shape that is no body has none."""
    frames = [frame if frame is not None and is_result(frame) else None for _, _, frame in variants]

    def row(label: str, *told: tuple[str, int, Callable[[Frame], float]]) -> VariantRow:
        return VariantRow(
            label,
            tuple(
                VariantValues(unit, digits, True, tuple(None if f is None else read(f) for f in frames))
                for unit, digits, read in told
            ),
        )

    return [
        row(tr("Bust point lift"), ("mm", 1, lambda frame: bust_shift(frame).mean.up)),
        row(tr("Bust point, forward"), ("mm", 1, lambda frame: bust_shift(frame).mean.forward)),
        row(
            tr("Volume error"),
            ("%", 2, lambda frame: controlled_volume(frame)[0]),
            ("ml", 1, lambda frame: controlled_volume(frame)[1]),
        ),
    ]


@dataclass(frozen=True)
class VariantValues:
    """One figure of each variant in ``unit``, None where it is not known; a change is ``signed``."""

    unit: str
    digits: int
    signed: bool
    values: tuple[float | None, ...]

    def written(self, place: int) -> str:
        """Return the figure of a variant, ready to read."""
        value = self.values[place]
        return "–" if value is None else f"{self._number(value)} {shown_unit(self.unit)}"

    def _number(self, value: float) -> str:
        written = length_number if self.unit == "mm" else number
        return written(value, self.digits, self.signed)

    def apart(self, place: int) -> float | None:
        """Return by how much a variant differs from the first, if both are known."""
        value, first = self.values[place], self.values[0]
        return None if value is None or first is None else value - first

    def cells(self) -> list[str]:
        """Return the figures and what the others differ by from the first, for a table."""
        told = [*self.values, *(self.apart(place) for place in range(1, len(self.values)))]
        return ["" if each is None else f"{each:.{self.digits}f}" for each in told]


@dataclass(frozen=True)
class VariantTexts:
    """Words for each variant, empty where there are none: they have no unit and differ by nothing."""

    values: tuple[str, ...]
    unit: str = ""
    digits: int = 0

    def written(self, place: int) -> str:
        """Return the words of a variant."""
        return self.values[place] or "–"

    def apart(self, place: int) -> None:
        """Return None: texts have no difference."""

    def cells(self) -> list[str]:
        """Return the words, for a table."""
        return [*self.values, *[""] * (len(self.values) - 1)]


@dataclass(frozen=True)
class VariantRow:
    """A row of values: the first counts, a second gives it in another unit."""

    label: str
    figures: tuple[VariantValues | VariantTexts, ...]


@dataclass(frozen=True)
class VariantsView:
    """Variants by name, which of them is shown, their figures, and the level and headline of each verdict.

    A variant that is not solved yet has an empty level.
    """

    names: tuple[str, ...]
    shown: int
    levels: tuple[str, ...]
    verdicts: tuple[str, ...]
    rows: tuple[VariantRow, ...]
