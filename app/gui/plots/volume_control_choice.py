"""The choice of the volume control, with what each does."""

from __future__ import annotations

from app.gui.widgets.basic import Segment
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr

CONTROLS = ("adaptive", "conventional", "none", "exact")
"""Ways to control the volume, as named in the run."""


def control_segment() -> Segment:
    """Return the segment of the volume controls; its choices are named as in ``CONTROLS``."""
    titles = (tr("Adaptive"), tr("Conventional"), tr("Off"), tr("Exact"))
    result = Segment(tuple(zip(CONTROLS, titles, strict=True)), small=True)
    for control, tip in zip(CONTROLS, _control_tips(), strict=True):
        set_tip(result.button(control), tip)
    return result


def _control_tips() -> tuple[str, str, str, str]:
    return (
        tr("Keeps the volume with an adaptive force: it learns in each turn how strong it must be"),
        tr("Keeps the volume with a force in proportion to the volume error; it may vibrate"),
        tr("Does not keep the volume"),
        tr("Keeps the volume exactly: the balance is solved at once"),
    )
