"""Warnings about a solution and its shape, in sentences."""

from __future__ import annotations

from typing import Protocol

from core.geometry.mesh import Points
from core.mechanics.convergence import Convergence
from core.messages import LineName, Message, join
from core.pipeline.build import Stages


class ShownState(Protocol):
    """A body as it is shown, a ``Frame`` or a ``Solution``: control points (n, 3) [mm], and how it stands."""

    @property
    def stages(self) -> Stages:
        """Return the built stages of the design."""

    @property
    def control_points(self) -> Points:
        """Return the control points [mm]."""

    @property
    def region_points(self) -> tuple[Points, ...]:
        """Return the control points of each region, the bust's first [mm]."""

    @property
    def verdict(self) -> Convergence:
        """Return how the runs of all regions stand."""

    @property
    def bust_verdict(self) -> Convergence:
        """Return how the run of the bust stands."""


def controlled_volume(shown: ShownState) -> tuple[float, float]:
    """Return how far the kept volume of the bust is from that at rest, of that of its control mesh [%, ml].

    It is the body's own where the exact answer keeps that, else that of the control mesh; while it swings,
    the mean of its swing.
    """
    stages, rest = shown.stages, shown.stages.model.volume.rest_volume
    if shown.bust_verdict.state == "vibrating":
        change = shown.bust_verdict.error * rest
    elif stages.design.dense_volume and stages.design.volume == "exact":
        change = float(stages.body_change(shown.control_points).sum())
    else:
        change = stages.model.volume.volume(shown.control_points) - rest
    return 100.0 * change / rest, change / 1000.0


def shape_warnings(shown: ShownState) -> list[Message]:
    """Return in a sentence what is wrong with a folded or overstrained shape."""
    condition, state = shown.verdict.condition, shown.verdict.state
    if condition is None or state not in ("folded", "overstrained"):
        return []
    if state == "folded":
        turn = f"{condition.largest_rotation:.0f}"
        text = Message(
            "The mesh is folded: a triangle of the control mesh has rotated by {degrees} degrees.",
            degrees=turn,
        )
    else:
        low, high = f"{100.0 * condition.shortest:.0f}", f"{100.0 * condition.longest:.0f}"
        text = Message(
            "The mesh is overstrained: edges of the control mesh are at {low} to {high} % of "
            "their original lengths.",
            low=low,
            high=high,
        )
    return [join((text, Message("The shape does not represent a real body.")))]


def immovable_lines(stages: Stages) -> list[Message]:
    """Return a sentence for each line that is worn where no length can move anything.

    One that is made of an elastic is there to be cut: of it there is nothing to be told.
    """
    own = {line.name for line in stages.design.own_lines}
    still = [line.name for line in stages.model.lines if not line.constrains]
    return [
        Message(
            "{name} is on fixed points: measured only, not affected by line lengths.",
            name=LineName(name),
        )
        if name in own
        else Message(
            "{name} is on the rib cage: measured only, not affected by line lengths.",
            name=LineName(name),
        )
        for name in still
        if name in stages.design.active_lines() and name not in stages.design.active_elastics()
    ]


def warnings(stages: Stages) -> list[Message]:
    """Return in sentences what did not go as well as it should on the way to the model."""
    patch = stages.patch
    faded = (
        []
        if patch.rule == "flood"
        else [Message("The blend region is computed from distances to the border: {why}", why=patch.reason)]
    )
    return [*stages.control.warnings, *faded, *_lower_warnings(stages)]


def _lower_warnings(stages: Stages) -> list[Message]:
    """Return in sentences why there is no lower trunk, or what is doubtful about it."""
    if stages.lower_problem is not None:
        missing = Message("The lower trunk cannot be modelled.")
        return [join((missing, stages.lower_problem.message, stages.lower_problem.hint))]
    if stages.lower is None:
        return []
    return [*stages.lower.landmarks.warnings, *stages.lower.control.warnings]
