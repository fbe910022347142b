"""What ``busk even`` does: tells how left and right differ, and finds the lengths that make them alike."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from app.cli.commands.ask import reasons
from app.cli.options import dressed, made_of
from app.cli.solve_design import run_to_body
from app.presenters.assessment import assessment_lines
from core import __version__
from core.analysis.symmetry.balance import EVEN, Evened, make_even
from core.analysis.symmetry.compare import BeforeAfter, Evenness, EvenRow, even_rows, evenness
from core.analysis.symmetry.split_sides import ENOUGH
from core.document.design import Design
from core.document.document import Document
from core.document.storage.backups import backed_up
from core.document.storage.project_file import SUFFIX, is_project, open_project, save_project
from core.errors import UserError
from core.garment.assessment import Assessment, assessed
from core.landmarks.warnings import edit_doubts
from core.pipeline.build import Stages, build
from core.pipeline.solve import Solution, run
from core.pipeline.warnings import shape_warnings

TITLES = {
    "higher": "bust point higher",
    "further_out": "bust point further forward",
    "further_aside": "bust point further lateral",
    "in_all": "total protrusion difference",
    "mean": "skin distance, mean",
    "largest": "skin distance, maximum",
    "left_more": "left protrudes more",
    "right_more": "right protrudes more",
}
"""What each figure is called."""

_CONTROLS = {
    "adaptive": "with adaptive volume control (both breasts combined)",
    "accumulating": "with integral volume control (both breasts combined)",
    "conventional": "with conventional volume control (volume not conserved)",
    "none": "without volume control",
}


@dataclass(frozen=True, eq=False)
class Even:
    """How left and right differ, and what makes them alike, if that was asked for.

    ``settled`` tells whether what the worn lines do is a result; ``out`` is where a project was saved. What
    makes them alike is found among exact answers, and then ``told`` are those too; ``turned`` is how the
    design that was found differs as it is solved, None where its turns do not come to rest. ``assessment`` is
    the overall verdict on the design that was found, or on that which there was.
    """

    stages: Stages
    told: BeforeAfter
    settled: bool
    warnings: list[str]
    assessment: Assessment
    made: Evened | None = None
    turned: Evenness | None = None
    out: str = ""

    @property
    def enough(self) -> bool:
        """Whether nothing is left to be made even."""
        after = self.told.after if self.made is None else self.made.after
        return after.furthest < ENOUGH

    @property
    def found(self) -> Design:
        """The design that was found; that which there was, if none is worth it."""
        return self.made.reply.design if self.made and self.made.worth else self.stages.design


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
        raise UserError("No result to save.", "Add --make to compute balanced lengths.")
    if out and not is_project(out):
        raise UserError(
            f"{out} is not a project file name.", f"Specify a project file: --out design{SUFFIX}."
        )
    stages = build(design)
    stages = build(made_of(dressed(design, stages.model.lines, lengths), elastics), stages)
    solution = run_to_body(stages)
    told = evenness(stages, solution.control_points)
    warnings = [*edit_doubts(stages.body), *shape_warnings(solution)]
    even = Even(stages, told, _settled(solution), warnings, assessed(solution))
    if make and not even.enough:
        made = make_even(stages)
        # The adaptive control keeps both volumes together and the exact answer each: they do not compare.
        even = replace(even, told=replace(told, after=made.before), made=made)
        solved = run(build(even.found, stages))
        even = replace(even, turned=_turned(solved), assessment=assessed(solved))
    if out:
        document = open_project(source) if is_project(source) else Document.of(even.found)
        with backed_up(Path(out)):
            save_project(out, document.with_design(even.found), stages.scan, None)
        even = replace(even, out=out)
    return even


def _turned(solution: Solution) -> Evenness | None:
    """Return how left and right differ as a design is solved, None if that is no result."""
    return evenness(solution.stages, solution.control_points).after if _settled(solution) else None


def _settled(solution: Solution) -> bool:
    return solution.verdict.motion == "settled" and solution.verdict.state != "folded"


def even_text(even: Even, as_json: bool, *, made: bool) -> str:
    """Return what is to be printed: sentences for people, or the same figures as JSON."""
    return json.dumps(_figures(even), indent=1) if as_json else "\n".join(_plain(even, made))


def _plain(even: Even, made: bool) -> Iterator[str]:
    rows = even_rows(even.told.before, even.told.after)
    made_rows = {row.key: row.after for row in _made_rows(even)}
    heading = ("before", "after", *([_heading(even.made)] if even.made else []))
    yield from (*assessment_lines(even.assessment, even.found), "")
    yield f"{'':26}" + "".join(f"{each:>17}" for each in heading)
    for row in rows:
        values = [row.before, row.after, *([made_rows[row.key]] if made_rows else [])]
        yield f"{TITLES[row.key]:26}" + "".join(f"{_said(row, each):>17}" for each in values)
    yield from even.told.notes
    if made:
        yield from _making(even)
    if even.out:
        unchanged = ", unchanged" if even.found is even.stages.design else ""
        yield f"written to {even.out}{unchanged}"


def _heading(made: Evened) -> str:
    return "balanced" if made.even else "nearest"


def _made_rows(even: Even) -> list[EvenRow]:
    return even_rows(even.made.rest, even.made.after) if even.made else []


def _turned_rows(even: Even) -> list[EvenRow]:
    return even_rows(even.turned, even.turned) if even.turned else []


def _said(row: EvenRow, value: float | None) -> str:
    if value is None:
        return "-"
    side = "" if not row.sided or abs(value) < 0.05 else "left " if value > 0.0 else "right "
    return f"{side}{abs(value):.1f} {row.unit}"


def _making(even: Even) -> Iterator[str]:
    """Tell what was parted and set, what remains, and why."""
    if even.made is None:
        yield f"Already balanced: both bust points are within {ENOUGH:g} mm; no change."
        return
    made, before = even.made, even.stages.design
    if made.worth:
        if made.parted:
            yield f"Left and right unlinked: {', '.join(made.parted)}."
        for line in made.reply.design.lines:
            whole = line.name.removesuffix(" left").removesuffix(" right")
            former = before.ratio(line.name if line.name in before.worn() else whole)
            yield f"{line.name}: {100.0 * line.ratio:.1f} %; before {100.0 * former:.1f} %"
    ways = (f"{name} {was:+.1f} to {now:+.1f} mm" for name, (was, now) in made.kept.items())
    yield f"Common movement of both sides, from after to {_heading(made)}: {', '.join(ways)}."
    yield remains(made)
    if not made.worth:
        gained, lost = max(made.gained, 0.0), made.lost
        yield f"Not changed: {gained:.1f} mm gain would move both sides by {lost:.1f} mm."
    elif before.volume != "exact":
        yield as_solved(before.volume, even.turned)


def as_solved(volume: str, turned: Evenness | None) -> str:
    """Return in two sentences what remains as the design is solved, which is not by the exact answer."""
    both = f"The last two columns are exact answers.\nSolved as the design is set, {_CONTROLS[volume]}"
    if turned is None:
        return f"{both} the solver does not converge."
    row = next(row for row in even_rows(turned, turned) if row.key == "in_all")
    more = "" if row.after is None else f"; {TITLES[row.key]}: {_said(row, row.after)}"
    return f"{both} {_left(turned)} remain{more}."


def _left(told: Evenness) -> str:
    return f"{abs(told.higher):.1f} mm in height and {abs(told.further_out):.1f} mm forward"


def remains(made: Evened) -> str:
    """Return in a sentence how even it is made, and why it is no more so."""
    left, reply = _left(made.after), made.reply
    if made.even:
        return f"Balanced: {left} remain."
    if not reply.agreed:
        return f"{left} remain: the iteration over lengths, elastics and contact pressures did not converge."
    return f"{left} remain: {' and '.join(_why(made))}."


def _why(made: Evened) -> list[str]:
    """Return why it is no more even: nothing but lift and way out may stand in the way."""
    reply = made.reply
    hindered = reply.at_end or reply.strained or reply.pressing
    if hindered or len(made.goals) == len(EVEN):
        return reasons(reply)
    return ["a further gain would reduce lift or protrusion"]


def _figures(even: Even) -> dict[str, Any]:
    made = even.made
    return {
        "assessment": even.assessment.as_data(),
        "rows": {
            row.key: {**asdict(row), "title": TITLES[row.key]}
            for row in even_rows(even.told.before, even.told.after)
        },
        "answer": "exact" if made else even.stages.design.volume,
        "settled": even.settled,
        "notes": list(even.told.notes),
        "made": None
        if made is None
        else {
            "rows": {row.key: row.after for row in _made_rows(even)},
            "even": made.even,
            "worth": made.worth,
            "lines": {line.name: 100.0 * line.ratio for line in made.reply.design.lines},
            "parted": list(made.parted),
            "goals": {goal.name: goal.value for goal in made.goals},
            "remain_mm": {"height": made.after.higher, "out": made.after.further_out},
            "kept_mm": {name: {"before": was, "after": now} for name, (was, now) in made.kept.items()},
            "as_solved": None if even.turned is None else {row.key: row.after for row in _turned_rows(even)},
            "because": [] if made.even else _why(made),
        },
        "definition": (
            "signed rows: positive if the left side is higher, further or protrudes more [mm, ml]; "
            "skin: one breast minus the mirrored other; in_all is left_more minus right_more"
        ),
        "written_to": even.out or None,
        "versions": {"busk": __version__},
    }
