"""Format uncertainties: ± of measurements, its meaning and sources."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from app.i18n.catalog import joined, language, listed, number, tr
from app.i18n.lengths import length, shown_unit
from app.presenters.measurements import MeasureView, length_uncertainty, plus_minus
from app.presenters.messages import render
from core.analysis.uncertainty.input_uncertainty import origins
from core.export.report_data import NOT_MODELLED
from core.garment.pressure import LEFT_OUT
from core.measurements.uncertain_value import AFTER, BEFORE, CHANGE, LIFT, OUT, OutputUncertainties

LEAST = 0.01
"""A source with a smaller share of the variance is not named [1]."""


def source_text(source: str) -> str:
    """Return a source in a word or two."""
    return {
        "landmarks": tr("landmarks"),
        "scan": tr("scan"),
        "tissue": tr("tissue"),
        "line": tr("line stiffness"),
        "tape": tr("cutting and sewing"),
        "elastic": tr("elastics"),
        "root": tr("upper end of the breast root"),
        "model": tr("model error"),
    }[source]


def source_sentences() -> tuple[str, ...]:
    """Return where each source's size comes from, in the language in use."""
    return tuple(words.told(language()) for words in origins().values())


def limitation_sentences() -> tuple[str, ...]:
    """Return what no value includes, in the words of the report."""
    return tuple(render(each) for each in (*NOT_MODELLED, *LEFT_OUT))


def with_uncertainty(
    views: Iterable[MeasureView], spread: OutputUncertainties | None, faint: bool
) -> list[MeasureView]:
    """Return measures with their ±; ``faint`` are those of a former shape."""
    if spread is None:
        return list(views)
    return [_with_off(view, spread, faint) for view in views]


def _with_off(view: MeasureView, spread: OutputUncertainties, faint: bool) -> MeasureView:
    keys = _keys(view)
    offs = tuple(None if key is None else spread.plus_minus(key) for key in keys)
    told = tuple(
        None if off is None or value is None else off
        for off, value in zip(offs, (view.before, view.after, view.change), strict=True)
    )
    if not any(each is not None for each in told):
        followed = not view.key
        return replace(view, off_told=(_without_off(),)) if followed else view
    return replace(view, off=told, off_faint=faint, off_told=_shares(keys, told, spread, view.unit))


def _keys(view: MeasureView) -> tuple[str | None, str | None, str | None]:
    if view.key:
        return f"{BEFORE}:{view.key}", f"{AFTER}:{view.key}", f"{CHANGE}:{view.key}"
    return None, None, view.moves or None


def _without_off() -> str:
    """Return why the figures that come with every frame have no ±: for most none is worked out."""
    return tr("Of the solver values, only those of the bust points have an uncertainty (±).")


def _shares(
    keys: Iterable[str | None], offs: Iterable[float | None], spread: OutputUncertainties, unit: str
) -> tuple[str, ...]:
    heads = (tr("Before"), tr("After"), tr("Change"))
    lines = []
    for key, off, head in zip(keys, offs, heads, strict=True):
        doubt = spread.by_output.get(key) if key else None
        if doubt is None or off is None:
            continue
        parts = [
            f"{source_text(source)} {number(100.0 * share, 0)} %"
            for source, share in doubt.shares.items()
            if share >= LEAST
        ]
        told = length_uncertainty(off) if unit == "mm" else plus_minus(off)
        text = tr("{head}: {off} {unit}").format(head=head, off=told, unit=shown_unit(unit))
        lines.append(f"{text} ({listed(parts)})" if parts else text)
    return tuple(lines)


def uncertainty_view(spread: OutputUncertainties | None, waiting: str, faint: bool) -> UncertaintyView:
    """Return the text below the measurements; ``waiting`` is the reason why there is no ± yet."""
    if spread is None:
        return UncertaintyView(waiting, short=tr("No ± yet: details") if waiting else "")
    meaning = tr("± is twice the standard deviation: 95 % of cases if errors are normally distributed.")
    told = tr("± of the previous shape: details") if faint else tr("± covers 95 % of cases: details")
    shares = tr("Point to a measurement to show the share of each source of uncertainty.")
    text = joined([meaning, shares, _without_off(), *map(render, spread.cautions)])
    return UncertaintyView(text, _contact(spread), faint, told)


def _contact(spread: OutputUncertainties) -> str:
    if LIFT not in spread.other:
        return ""
    up, out = (length(spread.other[key], signed=True) for key in (LIFT, OUT))
    if spread.contact == "sliding":
        text = tr("With sliding lines: bust points {up} up, {out} forward.")
    else:
        text = tr("With bonded lines: bust points {up} up, {out} forward.")
    between = tr("Real contact is between bonded and sliding; the ± does not include this difference.")
    told = text.format(up=up, out=out)
    return f"{told} {between}" if language() == "en" else f"{told}{between}"


@dataclass(frozen=True)
class UncertaintyView:
    """What stands in the card: what ± means, or why there is none yet; what the other skin ``contact`` makes.

    ``faint`` words are of a former shape. ``short`` stands at the head of the measures and leads here.
    """

    meaning: str
    contact: str = ""
    faint: bool = False
    short: str = ""
