"""Write the page REPRODUCTION.md: the figures, and the statements of the paper with measured values."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from importlib import resources
from pathlib import Path

from app.research.cases import BODIES, Study
from app.research.claims import AGREES, DIFFERS, PARTLY, Claim, claims
from app.research.figure_style import Figure, write_table
from app.research.lower_claims import lower_claims
from app.research.parameter_study import COLUMNS, RATIOS, Finding, rows_of, search, search_words
from core import __version__
from core.deformation.tffd import GAUSS_WIDTH, HAT_RANGE
from core.files.atomic_write import write_text
from core.mechanics.options import DEFAULT_LINE_STIFFNESS
from core.mechanics.volume import ADAPTIVE_DAMPING, ADAPTIVE_STEP
from core.pipeline.build import Stages
from core.pipeline.stages import GAIN_SHARE

NAME = "REPRODUCTION.md"


def write_page(out: Path, drawn: Sequence[Figure], study: Study, tell: Callable[[str], None] = print) -> None:
    """Write the page, the statements and the search as tables to ``out``.

    Raises UserError if something cannot be written.
    """
    stated, lower = claims(study), lower_claims(study)
    for name, some in (("statements.csv", stated), ("statements-lower-trunk.csv", lower)):
        rows = [(c.where, c.statement, c.found, c.verdict) for c in some]
        write_table(out / name, ("section", "the_paper", "here", "verdict"), rows)
        tell(f"  {out / name}: {len(some)} statements with measured values")

    def build(body: str, template: str, height: float) -> Stages:
        return study.stages(body, template, line_height=height)

    found = search(BODIES.values(), build, lambda part: tell(f"  searching: {part}"))
    write_table(out / "search.csv", COLUMNS, rows_of(found))
    tell(f"  {out / 'search.csv'}: {len(found)} lines, laws and lengths tried")

    write_text(out / NAME, page_of(drawn, stated, lower, found, study))
    tell(f"  {out / NAME}: the page")


def page_of(
    drawn: Sequence[Figure],
    stated: Sequence[Claim],
    lower: Sequence[Claim],
    found: Sequence[Finding],
    study: Study,
) -> str:
    """Return the page as Markdown; ``lower`` are the statements on the lower trunk."""
    form = (resources.files("resources") / "pages" / "reproduction.md").read_text(encoding="utf-8")
    counts = {verdict: sum(c.verdict == verdict for c in stated) for verdict in (AGREES, PARTLY, DIFFERS)}
    return form.format(
        version=__version__,
        count=len(stated),
        agrees=counts[AGREES],
        partly=counts[PARTLY],
        differs=counts[DIFFERS],
        statements=_statements(stated),
        lower_statements=_statements(lower),
        first_length=f"{100 * RATIOS[0]:.0f} %",
        stiffness=DEFAULT_LINE_STIFFNESS,
        share=GAIN_SHARE,
        step=ADAPTIVE_STEP,
        damping=ADAPTIVE_DAMPING,
        gauss=GAUSS_WIDTH,
        hat=HAT_RANGE,
        figures="\n".join(_figure(figure) for figure in drawn),
        **search_words(found, study),
    )


def _statements(found: Sequence[Claim]) -> str:
    rows = [f"| {c.where} | {c.statement} | {c.found} | **{c.verdict}** |" for c in found]
    return "\n".join(["| section | the paper | here | |", "|---|---|---|---|", *rows])


def _figure(figure: Figure) -> str:
    number = figure.name.split("-")[1]
    return (
        f"### Fig. {number}. {figure.title}\n\n![Fig. {number}]({figure.name}.png)\n\n"
        f"{figure.caption} [Table]({figure.name}.csv).\n"
    )
