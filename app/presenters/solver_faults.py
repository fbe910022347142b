"""Faults of the solver in words: what failed, what stays, and the mark on results that are out of date."""

from __future__ import annotations

from dataclasses import replace

from app.i18n.catalog import tr
from app.presenters.convergence import StripVerdict
from app.presenters.states import state_title


def solver_fault_words(error: Exception) -> tuple[str, str]:
    """Return what failed while a shape was computed, and what to do."""
    if isinstance(error, MemoryError):
        return (
            tr("There is not enough memory to compute the shape."),
            tr("Your design is kept and can be saved. Close other programs, then try again."),
        )
    return (
        tr("An error inside Busk stopped the computation of the shape."),
        tr("Your design is kept and can be saved. The view shows the last computed shape."),
    )


def fault_words(error: Exception) -> tuple[str, str]:
    """Return what failed in any other work, and what to do."""
    if isinstance(error, MemoryError):
        return tr("There is not enough memory for this."), tr("Close other programs, then try again.")
    return tr("Something went wrong inside Busk."), tr("Your design is kept. The log tells more.")


def not_computed() -> str:
    """Return that there are no results of the present design, because its shape was not computed."""
    return tr("Not computed: the view shows the last computed shape.")


def out_of_date(verdict: StripVerdict) -> StripVerdict:
    """Return the verdict on a frame that is not that of the present design, marked as such."""
    title = state_title("stale")
    return replace(verdict, level="stale", headline=title, state="stale", hint=not_computed(), settling=False)
