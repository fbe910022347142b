"""Elastics as the command line lists them: the effect of each on a line, and the nearest that can be used."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from app.cli.options import dressed, made_of
from app.cli.output import told
from app.i18n.catalog import joined
from app.presenters.elastics import choice_view, effect_words, mode_words, next_step, title_of
from core.document.design import Design
from core.document.elastic import ElasticError
from core.errors import LineError, UserError
from core.garment.elastic_library import library
from core.garment.elastic_options import KEEP_CUT, KEEP_FIT, elastic_option, outcome_of
from core.pipeline.build import Stages, build


def run_elastics(
    design: Design, lines: Sequence[str], elastics: Sequence[str], name: str, as_worn: bool
) -> str:
    """Return the elastics of the library for a line as a table, with its linked partner. Raises UserError."""
    stages = build(design)
    design = made_of(dressed(design, stages.model.lines, lines), elastics)
    line = next((each.name for each in stages.model.lines if each.name.lower() == name.strip().lower()), None)
    if line is None:
        known = ", ".join(each.name for each in stages.model.lines)
        raise LineError(f"There is no line '{name}'.", f"Available lines: {known}.")
    stages, mode = build(design, stages), KEEP_FIT if as_worn else KEEP_CUT
    names, rigid = design.linked(line), None
    rows = [f"{'':28}{'elong. %':>10}{'cut mm':>9}{'body mm':>9}{'lift mm':>9}"]
    for elastic in (None, *library().values()):
        option = elastic_option(stages, names, elastic, mode)
        rigid = option.outcome if elastic is None else rigid
        view = choice_view(title_of(elastic), option, rigid, names, design)
        figures = (
            f"{view.stretch or '-':>10}{view.cut or '-':>9}{view.reached or '-':>9}{view.lift or '-':>9}"
        )
        rows.append(f"{view.title[:27]:28}{figures}  {view.note}".rstrip())
    return "\n".join([mode_words(mode, design), "", *rows])


def elastics_text(listed: Callable[[], str], kind: str, out: str | None) -> str:
    """Return the table to print, or write it to a file ``out``; see ``told``. Raises UserError."""
    return told({"": lambda make: make(), "csv": _refused, "json": _refused}, listed, kind, out)


def _refused(_: object) -> str:
    raise UserError(
        "The list of elastics is available as text only.",
        "Remove --json, --csv and file names with these endings.",
    )


def effect_of(stages: Stages, plain: Stages) -> tuple[str, ...]:
    """Return the lift of a design with elastics against that of a ``plain`` one, if both have a balance."""
    try:
        return (effect_words(outcome_of(stages), outcome_of(plain)),)
    except LineError:
        return ()


def with_next_step(problem: ElasticError, plain: Stages, requested: Design, mode: str) -> LineError:
    """Return the problem of an elastic with the nearest that can be used for its line instead.

    ``plain`` are the stages without elastics, ``requested`` is the design with them.
    """
    wanted = requested.worn_elastics()[problem.line]
    names = plain.design.linked(problem.line)
    try:
        options = [elastic_option(plain, names, each, mode) for each in (wanted, *library().values())]
    except LineError:
        return problem  # without elastics nothing balances either
    return LineError(problem.message, joined((problem.hint, next_step(options[0], options, names))))
