"""Compare left and right, and compute the line lengths that balance them."""

from __future__ import annotations

import json
from argparse import ArgumentParser, Namespace
from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from typing import Any

from app.cli.design import check_project_name, save_design, stages_of
from app.cli.options import add_forms, add_lines, add_project_output, add_scan
from app.cli.output import finish, table_lines
from app.cli.solved_design import is_converged
from app.presenters.assessment import assessment_lines
from app.presenters.symmetry import balance_result_texts, not_balanced_reason, split_titles, symmetry_view
from app.presenters.target_shape import change_text, reasons
from core import __version__
from core.analysis.symmetry.balance import BalanceResult, balance_sides
from core.analysis.symmetry.compare import BeforeAfter, SideDifference, compare_sides, symmetry_rows
from core.analysis.symmetry.split_sides import split_sides, uneven_pairs
from core.control_mesh.template import read_template
from core.document.design import Design
from core.errors import UserError
from core.garment.assessment import Assessment, assess
from core.landmarks.warnings import edit_warnings
from core.messages import Message, plain
from core.pipeline.build import Stages, build
from core.pipeline.solve import solve, solve_valid
from core.pipeline.warnings import shape_warnings

TITLES = {
    "higher": "bust point higher",
    "further_out": "bust point further forward",
    "further_aside": "bust point further lateral",
    "in_all": "total protrusion difference",
    "mean": "skin distance, mean",
    "largest": "skin distance, maximum",
    "seat_higher": "left buttock point higher",
    "seat_further_back": "left buttock point further back",
    "seat_fold_higher": "left gluteal fold higher",
    "left_more": "left protrudes more",
    "right_more": "right protrudes more",
}
"""Titles of the rows in JSON."""


@dataclass(frozen=True, eq=False)
class Symmetry:
    """The comparison of left and right, and what balances them, if that was requested.

    ``converged`` tells whether the design is a result. The balance is computed from exact solutions, and
    ``compared`` is then too; ``as_set`` is the comparison of the balanced design as it is solved, None if
    that does not converge. ``assessment`` is the overall verdict on ``design``.
    """

    stages: Stages
    compared: BeforeAfter
    converged: bool
    warnings: list[Message]
    assessment: Assessment
    made: BalanceResult | None = None
    as_set: SideDifference | None = None
    out: str = ""

    @property
    def balanced(self) -> bool:
        """Return whether left and right are equal enough."""
        after = self.compared.after if self.made is None else self.made.after
        return not uneven_pairs(self.stages, after)

    @property
    def design(self) -> Design:
        """Return the balanced design, or the given one if no balance is worth its changes."""
        return self.made.result.design if self.made and self.made.is_worthwhile else self.stages.design


def add_options(parser: ArgumentParser) -> None:
    """Add the options of ``busk symmetry``."""
    add_scan(parser)
    add_lines(parser)
    balance = "compute line lengths that balance left and right; lines across both sides are split"
    parser.add_argument("--balance", action="store_true", help=balance)
    add_project_output(parser)
    add_forms(parser)


def run(options: Namespace) -> int:
    """Print the comparison, and save the balanced design. Raises UserError."""
    if options.out and not options.balance:
        raise UserError(Message("No result to save."), Message("Add --balance to compute balanced lengths."))
    check_project_name(options.out)
    found = compare(stages_of(options), balance=options.balance)
    save_design(options.input, options.out, found.design, found.stages)
    found = replace(found, out=options.out)
    text = json.dumps(symmetry_data(found), indent=1) if options.json else "\n".join(_text(found))
    return finish(text, found.converged and (found.balanced or not options.balance), found.warnings)


def compare(stages: Stages, *, balance: bool) -> Symmetry:
    """Compare left and right of a solved design; ``balance`` computes lengths unless they are equal."""
    solution = solve_valid(stages)
    compared = compare_sides(stages, *solution.region_points)
    warnings = [*edit_warnings(stages.body), *shape_warnings(solution)]
    found = Symmetry(stages, compared, is_converged(solution), warnings, assess(solution))
    if not balance or found.balanced:
        return found
    made = balance_sides(stages)
    # Adaptive control keeps both volumes together and the exact solution each: they are not comparable.
    found = replace(found, compared=replace(compared, after=made.before), made=made)
    again = solve(build(found.design, stages))
    after = compare_sides(again.stages, *again.region_points).after if is_converged(again) else None
    return replace(found, as_set=after, assessment=assess(again))


def _text(found: Symmetry) -> Iterator[str]:
    yield from (*assessment_lines(found.assessment, found.design), "")
    summary, made = symmetry_view(found.compared, found.stages), found.made
    rows = [[view.title, view.before, view.after] for view in summary.views]
    heading = ["L: left, R: right", "before", "after"]
    if made is not None:
        balanced = symmetry_view(BeforeAfter(made.rest, made.after, ()), found.stages)
        rows = [[*row, view.after] for row, view in zip(rows, balanced.views, strict=True)]
        heading.append("balanced" if made.is_balanced else "nearest")
    yield from (*table_lines([heading, *rows]), "", summary.says, *map(str, found.compared.notes))
    if made is not None:
        yield from ("", *_balance(found, made))
    if found.out:
        yield f"written to {found.out}{', unchanged' if found.design is found.stages.design else ''}"


def _balance(found: Symmetry, made: BalanceResult) -> Iterator[str]:
    """Yield the changes that balance left and right, their price, and what remains."""
    before = found.stages.design
    if not made.is_worthwhile:
        yield from not_balanced_reason(made.gain, made.loss)
        return
    if made.split:
        yield f"Left and right unlinked: {', '.join(split_titles(before, made.split))}."
        before = split_sides(before, read_template(before.template), made.split)
    yield from change_text(before, made.result)
    values = [
        {**made.differences(each), **{name: both[at] for name, both in made.kept.items()}}
        for at, each in enumerate((made.before, made.after))
    ]
    yield from filter(None, balance_result_texts(made.result, made.goals, *values))
    if before.volume != "exact":
        as_set = found.as_set and symmetry_view(BeforeAfter(made.rest, found.as_set, ()), found.stages).says
        yield f"With the volume control of the design: {as_set or 'the solver does not converge.'}"


def _because(made: BalanceResult) -> list[str]:
    """Return why no better balance was found: what both sides do is kept if nothing else hinders."""
    reply = made.result
    hindered = reply.at_limit or reply.strained or reply.at_pressure_limit
    if hindered or made.kept.keys().isdisjoint(goal.name for goal in made.goals):
        return reasons(reply)
    return ["a further gain would reduce lift or protrusion"]


def _after(after: SideDifference) -> dict[str, float | None]:
    return {row.key: row.after for row in symmetry_rows(after, after)}


def symmetry_data(found: Symmetry) -> dict[str, Any]:
    """Return a comparison of left and right as plain values, ready for JSON."""
    made = found.made
    rows = symmetry_rows(found.compared.before, found.compared.after)
    return {
        "assessment": found.assessment.as_data(),
        "rows": {row.key: {**asdict(row), "title": TITLES[row.key]} for row in rows},
        "answer": "exact" if made else found.stages.design.volume,
        "settled": found.converged,
        "notes": plain(found.compared.notes),
        "made": None
        if made is None
        else {
            "rows": _after(made.after),
            "even": made.is_balanced,
            "worth": made.is_worthwhile,
            "lines": {
                line.name: 100.0 * line.ratio for each in made.result.design.regions for line in each.lines
            },
            "parted": list(made.split),
            "goals": {goal.name: goal.value for goal in made.goals},
            "remain_mm": {"height": made.after.higher, "out": made.after.further_out},
            "kept_mm": {name: {"before": was, "after": now} for name, (was, now) in made.kept.items()},
            "as_solved": None if found.as_set is None else _after(found.as_set),
            "because": [] if made.is_balanced else _because(made),
        },
        "definition": (
            "signed rows: positive if the left side is higher, further or protrudes more [mm, ml]; "
            "skin: one breast minus the mirrored other; in_all is left_more minus right_more"
        ),
        "written_to": found.out or None,
        "versions": {"busk": __version__},
    }
