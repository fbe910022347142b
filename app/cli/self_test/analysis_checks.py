"""The part of a self-test that tries what advises: how far lines can go, and asking for the result."""

from __future__ import annotations

from app.cli.self_test.checks import check
from app.cli.self_test.fixture import MOVED, Bench


def advice(bench: Bench) -> str:
    """Ask for the lift that a known length gives, and look where that length lies in its line's zones."""
    from core.analysis.inverse_design.quantities import Goal  # noqa: PLC0415 (brings a search along that no other part needs)
    from core.analysis.inverse_design.solve import InverseSolver  # noqa: PLC0415
    from core.analysis.length_limits.zones import length_limits_of  # noqa: PLC0415
    from core.pipeline.build import build  # noqa: PLC0415

    known = bench.design.ratio(MOVED)
    lift = InverseSolver(bench.stages).current_values(["lift"])[0]["lift"]
    other = build(bench.design.with_linked(MOVED, 0.5 * (1.0 + known)), bench.stages)
    reply = InverseSolver(other).solve([Goal("lift", lift)])
    apart = 100.0 * abs(reply.design.ratio(MOVED) - known)
    check(reply.reachable, f"the lift of {lift:.2f} mm is reported as not reachable")
    check(apart < 0.1, f"the target length has an error of {apart:.2f} %")
    leeway = length_limits_of(bench.stages, MOVED)
    check(leeway is not None, "no length of the line has an equilibrium")
    assert leeway is not None
    tone = leeway.at(known).tone
    check(tone in ("green", "amber"), f"{known:.0%} of the line is rated {tone}")
    red = leeway.red_below
    check(red is not None, "no length of the line is rated too short")
    return f"length recovered within {apart:.3f} %, limit at {100.0 * (red or 0.0):.1f} %"
