"""Notes on the values of a report, in the language in use."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from app.i18n.catalog import colon, joined, language, listed, tr
from app.presenters.messages import render, render_all
from app.presenters.uncertainty import source_text
from app.report.text import REASONS, assessment_text, is_known, system_word
from core.export.report_data import Report
from core.garment.pressure_limits import pressure_limits
from core.measurements.sizes import built_in


def cut_notes(sheet: Report) -> list[str]:
    """Return what holds for all of the cut list."""
    height = tr("Height: centre front above (+) or below (−) the bust points, on the body.")
    return [height, *render_all(sheet.cuts.notes)]


def note_groups(sheet: Report) -> Iterator[tuple[str, list[str]]]:
    """Return the notes beside the cut list: what to check, what is omitted."""
    if beyond := _beyond_the_head(sheet):
        yield tr("To review"), beyond
    told = tr("Before: measured on the scan. After: measured on the reshaped body of the model.")
    taken = tr("Definitions of the measurements: user guide, Measurements, and the data file of this report.")
    yield tr("Measured"), [each for each in (told, taken, size_rule(sheet), size_cautions(sheet)) if each]
    limits = _limits() if sheet.cuts.rows else []
    if estimated := [*_meaning(sheet), *limits, *_unsure(sheet)]:
        yield tr("Estimated"), estimated
    yield tr("Not modelled"), render_all(sheet.left_out)


def _beyond_the_head(sheet: Report) -> list[str]:
    """Return the reasons of the verdict that have no room at the head, and what else is to be looked at."""
    told = {each.message for each in sheet.assessment.findings}
    reasons = [joined(each) for each in assessment_text(sheet).reasons[REASONS:]]
    return [*reasons, *(render(each) for each in sheet.warnings if each not in told)]


def size_rule(sheet: Report) -> str:
    """Return how the size in the chosen system was found, and its sister sizes."""
    if not sheet.sizes:
        return render(sheet.no_size)
    chosen = sheet.sizes[0]
    rule = joined(render_all(chosen["rule"]))
    sisters = listed([each["size"] for each in chosen["sisters"]])
    more = tr("Sister sizes: {sizes}").format(sizes=sisters) if sisters else ""
    return joined([f"{system_word(chosen)}{colon()}{rule}", more])


def size_cautions(sheet: Report) -> str:
    """Return where others find another size, in the words of the tables, or nothing."""
    told: dict[str, list[str]] = {}
    for each in sheet.sizes:
        if each["caution"]:
            told.setdefault(_caution(each), []).append(system_word(each))
    words = tr("; ").join(f"{listed(systems)}{colon()}{caution}" for caution, systems in told.items())
    return tr("* Other size charts give another size. {details}").format(details=words) if words else ""


def _meaning(sheet: Report) -> list[str]:
    """Return what ± means, if it stands on the sheet."""
    if not (sheet.off and sheet.is_valid):
        return []
    sources = listed([source_text(each) for each in sheet.off_sources])
    means = tr("± is twice the standard deviation: 95 % of cases if errors are normally distributed.")
    holds = tr("Included: {sources}. Not included: bonded or sliding skin contact.").format(sources=sources)
    return [joined([means, holds]), *map(render, sheet.off_notes)]


def _limits() -> list[str]:
    """Return how sure the limits of the lights are, and between whose figures they stand."""
    limits = pressure_limits()
    sources = tr("; ").join(each.named(language()) for each in limits.sources)
    return [limits.doubts[0].told(language()), tr("Sources: {names}.").format(names=sources)]


def _unsure(sheet: Report) -> list[str]:
    notes = (row["note"] for row in sheet.measures if row["estimate"] and is_known(row) and row["note"])
    return render_all(list(dict.fromkeys(notes)))


def _caution(size: dict[str, Any]) -> str:
    """Return the caution of a size in the language of the sheet; its data speak English."""
    known = next((table.caution for table in built_in() if table.key == size["key"]), None)
    return known.told(language()) if known else str(size["caution"])
