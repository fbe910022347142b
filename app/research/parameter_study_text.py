"""What the search found, in words and as a table for the page: where two statements of the paper hold."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import astuple, dataclass, fields

import numpy as np

from app.research.cases import BODIES, LINE, TEMPLATE, Study
from app.research.parameter_study import FIRST_TURNS, RATIOS, TEMPLATES, Finding, mirrored_mean
from core.mechanics.iteration import LineTargets, iterate
from core.mechanics.model import ConstrainedModel, constrained_model

COLUMNS = tuple(field.name for field in fields(Finding))
_HEADING = (
    "| line, law, contact | a2 - a1, bust point / apex [mm] | b2 - b1, bust point / apex [mm] | higher "
    "| first error a2, b2 [%] | b2 larger |\n|---|---|---|---|---|---|"
)


@dataclass(frozen=True)
class Pair:
    """The same case on both bodies, each on the paper's template for it: ``a`` mannequin, ``b`` person."""

    a: Finding
    b: Finding

    @property
    def higher(self) -> bool:
        """Whether the bust points end higher under the adaptive force on both bodies."""
        return self.a.higher_mm > 0.0 and self.b.higher_mm > 0.0

    @property
    def larger(self) -> bool:
        """Whether the person has the larger first error."""
        return self.b.first_error_percent > self.a.first_error_percent

    @property
    def shakes(self) -> bool:
        """Whether the conventional force vibrates on both bodies, and the adaptive one on none."""
        both = (self.a, self.b)
        return all(x.conventional == "vibrating" and x.adaptive != "vibrating" for x in both)

    @property
    def words(self) -> str:
        """The case without its length."""
        firm = ", firm chest" if self.a.firm_chest else ""
        return f"{self.a.route}, {self.a.law}, {self.a.contact}{firm}"


def rows_of(found: Sequence[Finding]) -> list[tuple[object, ...]]:
    """Return the findings as rows under COLUMNS."""
    return [astuple(finding) for finding in found]


def pairs_of(found: Sequence[Finding], template: str = "") -> list[Pair]:
    """Return the cases on a template, or on the paper's for each body, both bodies side by side."""
    own = [finding for finding in found if finding.template == (template or TEMPLATE[finding.body])]
    a, b = ([finding for finding in own if finding.body == body] for body in BODIES.values())
    return [Pair(one, other) for one, other in zip(a, b, strict=False)]


def search_words(found: Sequence[Finding], study: Study) -> dict[str, str]:
    """Return what the page says of the search, by the names of its blanks."""
    pairs = pairs_of(found)
    return {
        "cases": str(len(found)),
        "pairs": str(len(pairs)),
        "lengths": ", ".join(f"{100 * ratio:.0f}" for ratio in RATIOS) + " %",
        "higher": "\n".join(_of_length(pairs, ratio) for ratio in RATIOS),
        "higher_always": _always([pair for pair in pairs if pair.higher]),
        "larger_always": _always([pair for pair in pairs if pair.larger]),
        "both_always": _always([pair for pair in pairs if pair.higher and pair.larger]),
        "both_statements": str(sum(pair.higher and pair.larger for pair in pairs)),
        "whole": str(sum(pair.higher and pair.larger and pair.shakes for pair in pairs)),
        "by_contact": _shares(pairs, {"sliding": _slides, "glued": lambda pair: not _slides(pair)}),
        "by_route": _shares(pairs, {"lines that draw up": _draws_up, "others": lambda p: not _draws_up(p)}),
        **{f"larger_{number}": _larger(pairs_of(found, number)) for number in TEMPLATES},
        "twin": _twin(study),
        "search_table": _table([pair for pair in pairs if pair.a.set_percent == 100 * RATIOS[0]]),
    }


def _of_length(pairs: Sequence[Pair], ratio: float) -> str:
    here = [pair for pair in pairs if pair.a.set_percent == 100.0 * ratio]
    higher, larger, shakes = (
        sum(getattr(pair, what) for pair in here) for what in ("higher", "larger", "shakes")
    )
    apex = sum(pair.a.apex_higher_mm > 0.0 and pair.b.apex_higher_mm > 0.0 for pair in here)
    further = sum(pair.a.further_mm > 0.0 and pair.b.further_mm > 0.0 for pair in here)
    return (
        f"- At {100 * ratio:.0f} %, of {len(here)} cases: bust points higher on both bodies in {higher}, "
        f"apex higher in {apex}, apex further forward in {further}; first error of the person larger in "
        f"{larger}; the conventional force vibrates on both and the adaptive on neither in {shakes}."
    )


def _larger(pairs: Sequence[Pair]) -> str:
    return f"{sum(pair.larger for pair in pairs)} of {len(pairs)}"


def _slides(pair: Pair) -> bool:
    return pair.a.contact == "sliding"


def _draws_up(pair: Pair) -> bool:
    """Tell whether the line ends at the upper edge of the control mesh."""
    return any(word in pair.a.route for word in ("straps", "slings", "oblique"))


def _shares(pairs: Sequence[Pair], kinds: Mapping[str, Callable[[Pair], bool]]) -> str:
    """Return how often both statements hold for each kind of case."""
    words = []
    for name, belongs in kinds.items():
        those = [pair for pair in pairs if belongs(pair)]
        higher, larger = sum(pair.higher for pair in those), sum(pair.larger for pair in those)
        words.append(f"{name}: the first in {higher}, the second in {larger} of {len(those)} cases")
    return "; ".join(words)


def _always(pairs: Sequence[Pair]) -> str:
    """Return the cases that stand in ``pairs`` with every length."""
    words = [pair.words for pair in pairs]
    names = [name for name in dict.fromkeys(words) if words.count(name) == len(RATIOS)]
    return "; ".join(names) if names else "none"


def _table(pairs: Sequence[Pair]) -> str:
    # The paper's own line comes first, at its three heights.
    pairs = sorted(pairs, key=lambda pair: not pair.a.route.startswith(f"{LINE} 0"))
    rows = [
        f"| {pair.words} | {pair.a.higher_mm:+.3f} / {pair.a.apex_higher_mm:+.2f} "
        f"| {pair.b.higher_mm:+.3f} / {pair.b.apex_higher_mm:+.2f} | {'yes' if pair.higher else 'no'} "
        f"| {pair.a.first_error_percent:.3f}, {pair.b.first_error_percent:.3f} "
        f"| {'yes' if pair.larger else 'no'} |"
        for pair in pairs
    ]
    return "\n".join([_HEADING, *rows])


def _twin(study: Study) -> str:
    """Return the first error of the person beside that of its symmetric twin."""
    stages = study.stages("person")
    words = []
    for ratio in RATIOS:
        errors = []
        for control in (stages.control, mirrored_mean(stages.control)):
            model = constrained_model(control, worn=(LINE,))
            errors.append(_first_error(model, tuple(ratio if e.name == LINE else 1.0 for e in model.lines)))
        words.append(f"{100 * errors[0]:.3f} against {100 * errors[1]:.3f} % at {100 * ratio:.0f} %")
    away = np.linalg.norm(mirrored_mean(stages.control).mesh.vertices - stages.control.mesh.vertices, axis=1)
    apart = f"the control points are {away.mean():.1f} mm apart on the mean, {away.max():.1f} at most"
    return f"{', '.join(words)}; {apart}"


def _first_error(model: ConstrainedModel, ratios: tuple[float, ...]) -> float:
    run = iterate(model, lambda: LineTargets(ratios), turns=FIRST_TURNS)
    return max(abs(measured.error) for _, measured in run)
