"""What ``busk even`` does: tells how left and right differ, and finds the lengths that make them alike."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

from app.commands.asked import reasons
from app.commands.settings import dressed, made_of
from app.commands.worn import run_to_body
from core import __version__
from core.advice.evening import Evened, make_even
from core.advice.parting import ENOUGH
from core.design import Design
from core.document import Document
from core.errors import UserError
from core.evenness import BeforeAfter, EvenRow, even_rows, evenness
from core.pipeline import Stages, build
from core.project import SUFFIX, is_project, open_project, save_project
from core.report import shape_warnings

TITLES = {
    "higher": "bust point higher",
    "further_out": "bust point further out",
    "further_aside": "bust point further aside",
    "larger": "breast larger",
    "mean": "skin apart, mean",
    "largest": "skin apart, most",
    "left_more": "left stands out more",
    "right_more": "right stands out more",
}
"""What each figure is called."""


@dataclass(frozen=True, eq=False)
class Even:
    """How left and right differ, and what makes them alike, if that was asked for.

    ``settled`` tells whether what the worn lines do is a result; ``out`` is where a project was saved.
    """

    stages: Stages
    told: BeforeAfter
    settled: bool
    warnings: list[str]
    made: Evened | None = None
    out: str = ""

    @property
    def enough(self) -> bool:
        """Whether nothing is left to be made even."""
        after = self.told.after if self.made is None else self.made.after
        return after.furthest < ENOUGH


def run_even(
    source: str,
    design: Design,
    lengths: Sequence[str],
    elastics: Sequence[str],
    *,
    make: bool,
    out: str = "",
) -> Even:
    """Tell how left and right differ under ``lengths``, NAME=LENGTH, and ``elastics``, LINE=ELASTIC.

    ``make`` finds the lengths that make them alike, unless they are; ``out`` saves them. Raises UserError.
    """
    if out and not make:
        raise UserError("There is nothing to be saved.", "Add --make to find the lengths that make it even.")
    if out and not is_project(out):
        raise UserError(f"{out} is no name of a project.", f"Name one: --out design{SUFFIX}.")
    stages = build(design)
    stages = build(made_of(dressed(design, stages.model.lines, lengths), elastics), stages)
    solution = run_to_body(stages)
    settled = solution.verdict.motion == "settled" and solution.verdict.state != "folded"
    told = evenness(stages, solution.control_points)
    even = Even(stages, told, settled, shape_warnings(solution))
    if make and not even.enough:
        even = replace(even, made=make_even(stages))
    if out:
        found = even.made.reply.design if even.made else stages.design
        document = open_project(source) if is_project(source) else Document.of(found)
        save_project(out, document.with_design(found), stages.scan, None)
        even = replace(even, out=out)
    return even


def even_text(even: Even, as_json: bool, *, made: bool) -> str:
    """Return what is to be printed: sentences for people, or the same figures as JSON."""
    return json.dumps(_figures(even), indent=1) if as_json else "\n".join(_plain(even, made))


def _plain(even: Even, made: bool) -> Iterator[str]:
    rows = even_rows(even.told.before, even.told.after)
    made_rows = {row.key: row.after for row in _made_rows(even)}
    heading = ("before", "after", *(["made even"] if even.made else []))
    yield f"{'':26}" + "".join(f"{each:>17}" for each in heading)
    for row in rows:
        values = [row.before, row.after, *([made_rows[row.key]] if made_rows else [])]
        spread = f"  ± {row.spread:.0f}, an estimate" if row.spread else ""
        yield f"{TITLES[row.key]:26}" + "".join(f"{_said(row, each):>17}" for each in values) + spread
    yield from even.told.notes
    if made:
        yield from _making(even)
    if even.out:
        yield f"written to {even.out}"


def _made_rows(even: Even) -> list[EvenRow]:
    return even_rows(even.made.rest, even.made.after) if even.made else []


def _said(row: EvenRow, value: float | None) -> str:
    if value is None:
        return "-"
    side = "" if not row.sided or abs(value) < 0.05 else "left " if value > 0.0 else "right "
    return f"{side}{abs(value):.1f} {row.unit}"


def _making(even: Even) -> Iterator[str]:
    """Tell what was parted and set, what remains, and why."""
    if even.made is None:
        yield f"Even already: both bust points lie within {ENOUGH:g} mm; nothing was changed."
        return
    reply, before = even.made.reply, even.stages.design
    if even.made.parted:
        yield f"Left and right now change each by itself: {', '.join(even.made.parted)}."
    for line in reply.design.lines:
        whole = line.name.removesuffix(" left").removesuffix(" right")
        former = before.ratio(line.name if line.name in before.worn() else whole)
        yield f"{line.name}: {100.0 * line.ratio:.1f} %; before {100.0 * former:.1f} %"
    kept = [goal.name for goal in even.made.goals if goal.name in ("lift", "out")]
    if kept:
        told = " and ".join(f"{name} {reply.reached[name]:+.1f} mm" for name in kept)
        yield f"Asked to stay besides, both sides together: {told}."
    yield remains(even.made)


def remains(made: Evened) -> str:
    """Return in a sentence how even it is made, and why it is no more so."""
    up, out = abs(made.after.higher), abs(made.after.further_out)
    left = f"{up:.1f} mm in height and {out:.1f} mm to the front"
    if made.even:
        return f"Even: {left} remain."
    if not made.reply.agreed:
        return f"{left} remain: lengths, elastics and pressures did not come to agree."
    return f"{left} remain: {' and '.join(reasons(made.reply))}."


def _figures(even: Even) -> dict[str, Any]:
    made = even.made
    return {
        "rows": {
            row.key: {**asdict(row), "title": TITLES[row.key]}
            for row in even_rows(even.told.before, even.told.after)
        },
        "settled": even.settled,
        "notes": list(even.told.notes),
        "made": None
        if made is None
        else {
            "rows": {row.key: row.after for row in _made_rows(even)},
            "even": made.even,
            "lines": {line.name: 100.0 * line.ratio for line in made.reply.design.lines},
            "parted": list(made.parted),
            "goals": {goal.name: goal.value for goal in made.goals},
            "remain_mm": {"height": made.after.higher, "out": made.after.further_out},
            "because": [] if made.even else reasons(made.reply),
        },
        "definition": "sided rows: positive where the left is higher, further or larger [mm, ml]; skin: "
        "that of one breast less that of the other, mirrored; left and right stand out more by so many ml",
        "written_to": even.out or None,
        "versions": {"busk": __version__},
    }
