"""The model of a design whose lines are made of elastics: they pull as the curves of these say."""

from __future__ import annotations

from collections.abc import Mapping

from core.document.elastic import Elastic
from core.document.lines import ActiveLine
from core.errors import LineError
from core.mechanics.elastic_lines import ElasticLines, FittedModel, Solve, fit_elastics
from core.mechanics.exact_solution import BodyChange, solve_body_exact, solve_exact
from core.mechanics.force_units import newtons_per_unit
from core.mechanics.model import ConstrainedModel
from core.mechanics.newton import Equilibrium
from core.messages import LineName, Message


def solve_elastic_model(
    model: ConstrainedModel,
    lines: tuple[ActiveLine, ...],
    elastics: Mapping[str, Elastic],
    tissue_stiffness: float,
    own_stiffness: Mapping[str, float],
    body_change: BodyChange | None = None,
    *,
    former: FittedModel | None = None,
) -> FittedModel:
    """Return the model in which worn ``lines`` pull as their ``elastics`` do, by line, and its balance.

    The natural length of such a line is what its elastic measures unstretched. ``tissue_stiffness`` [N/m]
    gives the newtons; see ``core.mechanics.elastic_lines``. ``body_change`` is for answers that hold the
    volume of the body itself. On a solid, which has one balance, the search begins at the balance and the
    stiffnesses of a ``former`` model. Raises LineError where an elastic would be stretched beyond its curve,
    or nothing balances.
    """
    worn = {line.name: line.ratio for line in lines}
    ratios = {line.name: worn.get(line.name, 1.0) for line in model.lines}
    newtons = newtons_per_unit(model, tissue_stiffness)
    wish = ElasticLines(model, ratios, elastics, newtons, own_stiffness)
    begin = near = None
    if former is not None and _is_of_same_solid(former.model, model):
        near = former.balance if former.balance.is_converged else None
        begin = former.log_ea if former.elongations.keys() == elastics.keys() else None
    fitted = fit_elastics(wish, _solver(tuple(ratios.values()), body_change, near), begin)
    for name, elongation in fitted.elongations.items():
        if elongation > elastics[name].max_elongation:
            raise elastics[name].overstretch_error(elongation, LineName(name), worn.get(name))
    if not fitted.agreed:
        raise _no_agreement(fitted)
    return fitted


def _is_of_same_solid(former: ConstrainedModel, model: ConstrainedModel) -> bool:
    """Return whether both models are of one solid, and hold the same."""
    alike = (
        former.tensegric.rest is model.tensegric.rest and former.options.volume_of == model.options.volume_of
    )
    return alike and former.options.tissue == model.options.tissue == "solid"


def _solver(ratios: tuple[float, ...], change: BodyChange | None, near: Equilibrium | None) -> Solve:
    """Return what solves the model of each round, the first from ``near`` on."""

    def solve(model: ConstrainedModel) -> Equilibrium:
        nonlocal near
        if change is None:
            found = solve_exact(model, ratios, near=near)
        else:
            found = solve_body_exact(model, ratios, change, near=near)
        # Solid tissue and lines that only pull have one balance; on a net another might be found from there.
        near = found if model.options.tissue == "solid" and found.is_converged else None
        return found

    return solve


def _no_agreement(fitted: FittedModel) -> LineError:
    """Return what to say when the body and the elastics do not come to rest together."""
    return LineError(
        Message("No equilibrium found with elastics for {lines}.", lines=", ".join(fitted.elongations)),
        Message("Set the line lengths closer to 100 %, or remove the elastic."),
    )
