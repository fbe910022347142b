"""Search for models in which two statements of the paper hold that the default model does not show (ours).

Section 6 says that the nipples end higher under the adaptive force than under the conventional one, and that
an asymmetric body has the larger error at first. The paper prints neither its line nor its law, so all lines,
templates and laws that can be had here are tried, none of them tuned.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import astuple, dataclass, fields, replace
from itertools import product

import numpy as np

from app.research.cases import BODIES, LINE, TEMPLATE, Study
from core.control_mesh.fit import ControlMesh
from core.geometry.mesh import Floats
from core.geometry.mirror_plane import mirror
from core.mechanics.convergence import assess_convergence
from core.mechanics.gain_limit import gain_limit
from core.mechanics.iteration import LineTargets, Record, Watch, iterate
from core.mechanics.model import ConstrainedModel, constrained_model
from core.mechanics.options import CONTACTS, LAWS, ModelOptions
from core.pipeline.build import Stages
from core.pipeline.stages import GAIN_SHARE

TEMPLATES = ("120", "168")
LINE_HEIGHTS = (0.25, 0.5, 0.75)
RATIOS = (0.97, 0.9, 0.6)
FIRM = (0.0, 0.1)
TURNS = 100
"""Turns of a case; 300 give the same answer to both questions in every one of them."""

FIRST_TURNS = 10
"""Turns that count as "the initial stage"."""

LAST_TURNS = 10
"""Turns whose mean counts as the end: a vibrating run has no single one."""

Build = Callable[[str, str, float], Stages]
"""Gives the stages of a body on a template with the mid-bust line at a height."""


@dataclass(frozen=True)
class Finding:
    """One case, solved with both forces; differences are adaptive less conventional, at the end.

    ``route`` names the line and ``set_percent`` its length; heights and distances are those of the bust
    points' mean and of the apex [mm]; ``lift_mm`` is against rest; ``first_error_percent`` is the largest
    adaptive volume error in the first turns.
    """

    body: str
    template: str
    route: str
    law: str
    contact: str
    firm_chest: float
    set_percent: float
    conventional: str
    adaptive: str
    higher_mm: float
    apex_higher_mm: float
    further_mm: float
    lift_mm: float
    apex_lift_mm: float
    first_error_percent: float
    first_error_ml: float


def search(
    bodies: Iterable[str], build: Build, tell: Callable[[str], None] = lambda _: None
) -> list[Finding]:
    """Solve every case on every body; ``tell`` hears of each body and template begun."""
    found: list[Finding] = []
    for body, template in product(bodies, TEMPLATES):
        tell(f"{body}, {template} triangles")
        for height in LINE_HEIGHTS:
            stages = build(body, template, height)
            lines = routes(stages.control)
            named = {"mid-bust": lines["mid-bust"]} if height != LINE_HEIGHTS[1] else lines
            for name, paths in named.items():
                route = f"{name} {height:g}" if name == "mid-bust" else name
                # The paper's line is tried with every law; the others with the default one, to end in time.
                for mechanics in mechanics_of(LAWS if route == "mid-bust 0.5" else LAWS[:1]):
                    found += _cases(stages, paths, mechanics, (body, template, route))
    return found


def mechanics_of(laws: Iterable[str]) -> Iterator[ModelOptions]:
    """Yield the mechanics of member laws with every contact, with and without the firm chest."""
    for law, contact, firm in product(laws, CONTACTS, FIRM):
        yield ModelOptions(member_law=law, line_contact=contact, firm_chest=firm)


def routes(control: ControlMesh) -> dict[str, dict[str, tuple[int, ...]]]:
    """Return the lines that are tried, as paths over the control points by name, one or several worn at once.

    They are given by cells of the template: row, and column counted from the centre.
    """
    place = _places(control)
    mid = control.paths["mid-bust"]
    low, bust = int(control.row[mid[0]]), int(control.row[control.bust_points[0]])
    top, side = int(control.row.max()) - 1, int(control.column.max()) - 1
    tip = int(control.column[control.bust_points[0]])

    def both(*cells: tuple[int, int]) -> dict[str, tuple[int, ...]]:
        return {
            name: tuple(place[row, sign * column] for row, column in cells)
            for name, sign in (("left", 1), ("right", -1))
        }

    up = range(low, top + 1)
    straps = both(*((row, tip) for row in up))
    ring = [(bust - 1, c) for c in range(tip - 1, tip + 2)]
    ring += [(bust, tip + 1)] + [(bust + 1, c) for c in range(tip + 1, tip - 2, -1)] + [(bust, tip - 1)]
    sling = [*((row, tip + 1) for row in reversed(up)), (low, tip), *((row, tip - 1) for row in up)]
    return {
        "mid-bust": {"mid-bust": mid},
        "full-bust": {"full-bust": control.paths["full-bust"]},
        "straps": straps,
        "mid-bust and straps": {"mid-bust": mid, **straps},
        "slings": both(*sling),
        "oblique": both((low, side), (low, tip + 1), (low, tip), (bust, tip - 1), (bust + 1, 0), (top, 0)),
        "ring": both(*ring, ring[0]),
    }


def _cases(
    stages: Stages, paths: Mapping[str, tuple[int, ...]], mechanics: ModelOptions, names: tuple[str, str, str]
) -> Iterator[Finding]:
    model = constrained_model(replace(stages.control, paths=paths), mechanics=mechanics)
    gain = GAIN_SHARE * gain_limit(model)
    for ratio in RATIOS:
        targets = LineTargets((ratio,) * len(model.lines), "conventional", gain)
        conventional, before = _run(model, targets, stages.watch)
        adaptive, records = _run(model, replace(targets, control="adaptive"), stages.watch)
        rest = _ends(stages.watch, [stages.control.mesh.vertices])
        first = max(records[:FIRST_TURNS], key=lambda each: abs(each.error))
        yield Finding(
            names[0],
            names[1],
            names[2],
            mechanics.member_law,
            mechanics.line_contact,
            mechanics.firm_chest,
            100.0 * ratio,
            assess_convergence(before).motion,
            assess_convergence(records).motion,
            float(adaptive[0] - conventional[0]),
            float(adaptive[1] - conventional[1]),
            float(adaptive[2] - conventional[2]),
            float(adaptive[0] - rest[0]),
            float(adaptive[1] - rest[1]),
            100.0 * abs(first.error),
            abs(first.error_ml),
        )


def _run(model: ConstrainedModel, targets: LineTargets, watch: Watch) -> tuple[Floats, list[Record]]:
    """Return what ``_ends`` measures over the last turns, and all records."""
    states, records = zip(*iterate(model, lambda: targets, turns=TURNS), strict=True)
    places = [model.tensegric.expand(state.moved) for state in states[-LAST_TURNS:]]
    return _ends(watch, places), list(records)


def _ends(watch: Watch, places: list[Floats]) -> Floats:
    """Return mean height of the bust points, height and protrusion of the apex, shape (3,) [mm]."""
    marks = [watch(points) for points in places]
    heights = [
        (0.5 * (m.bust_point_left_z + m.bust_point_right_z), m.apex_z, m.apex_protrusion) for m in marks
    ]
    return np.asarray(np.mean(heights, axis=0))


def _places(control: ControlMesh) -> dict[tuple[int, int], int]:
    """Return the control point at each row and column of the template."""
    cells = zip(control.row.tolist(), control.column.tolist(), strict=True)
    return {cell: at for at, cell in enumerate(cells)}


def mirrored_mean(control: ControlMesh) -> ControlMesh:
    """Return the control mesh that lies halfway between this one and its mirror image: its symmetric twin."""
    place = _places(control)
    other = [place[row, -column] for row, column in place]
    middle = float(control.mesh.vertices[control.column == 0, 0].mean())
    there = mirror(control.mesh.vertices[other], middle)
    return replace(control, mesh=control.mesh.moved(0.5 * (control.mesh.vertices + there)))


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
        """Return whether the bust points end higher under the adaptive force on both bodies."""
        return self.a.higher_mm > 0.0 and self.b.higher_mm > 0.0

    @property
    def larger(self) -> bool:
        """Return whether the person has the larger first error."""
        return self.b.first_error_percent > self.a.first_error_percent

    @property
    def shakes(self) -> bool:
        """Return whether the conventional force vibrates on both bodies, and the adaptive one on none."""
        both = (self.a, self.b)
        return all(x.conventional == "vibrating" and x.adaptive != "vibrating" for x in both)

    @property
    def words(self) -> str:
        """Return the case without its length."""
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
    """Return the text on the search, by the names of the blanks of the page."""
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
    """Return whether the line ends at the upper edge of the control mesh."""
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
