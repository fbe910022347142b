"""Texts of a report in the language in use, as plain values for the painter."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import groupby
from typing import Any

from app.i18n.catalog import colon, joined, language, listed, number, tr
from app.i18n.lengths import shown_digits, shown_value
from app.presenters.assessment import AssessmentView, assessment_view
from app.presenters.measurements import digits_of, length_uncertainty, measure_title, plus_minus
from app.presenters.messages import line_title, render, render_all
from app.presenters.pressure import rating_text
from app.presenters.uncertainty import source_text
from core.document.lines import partner_of
from core.export.report_data import Report
from core.garment.pressure import pressure_limits
from core.measurements.definitions import LOWER_KEYS, definition_of
from core.measurements.sizes import built_in
from core.measurements.table import OWN
from core.measurements.uncertain_value import AFTER, BEFORE, CHANGE

NOTHING = "\N{EN DASH}"
"""What stands in a table where nothing is known."""


REASONS = 4
"""How many reasons of the overall verdict stand at the head of a sheet."""

KEY_MEASURES = ("bust_girth", "underbust_girth", "bust_point_distance", "bust_point_to_fold", "cup_depth")
"""What a bra is made to, first of all."""

LOWER_KEY_MEASURES = ("waist_girth", "hip_girth")
"""What a girdle is made to, with the lower trunk in the design."""


@dataclass(frozen=True)
class MeasureRow:
    """A row of the measures, as it is printed; one that is missing has no ``values`` but a ``note``.

    ``off`` stands under the figures: how far each may be off.
    """

    title: str
    unit: str
    values: tuple[str, ...]
    note: str = ""
    off: tuple[str, ...] = ()


def piece_title(line: str, title: str) -> str:
    """Return what a line is called: as the designer named it, else in the language in use."""
    if title == line:
        return line_title(line)
    side = {"left": tr("left"), "right": tr("right")}.get(line.rpartition(" ")[2]) if partner_of(line) else ""
    return listed((title, side)) if side else title


def project_words(sheet: Report) -> str:
    """Return of what the sheet is: the project, and which variant of it."""
    heading = sheet.heading
    variant = tr("Variant {name}").format(name=heading.variant) if heading.variant else ""
    return " · ".join(filter(None, (heading.project, variant)))


def assessment_text(sheet: Report) -> AssessmentView:
    """Return the overall verdict on a sheet in words."""
    return assessment_view(sheet.assessment)


def size_words(sheet: Report) -> str:
    """Return the size as each system writes it, and which others lie within what girths may be off."""
    within = sheet.sizes[0].get("within_off")
    words = tr("Also within ±: {sizes}") if within else tr("No other size within ±.")
    text = words.format(sizes=listed(within or ())) if within is not None and sheet.sizes[0]["inside"] else ""
    return "\n".join(filter(None, (text, other_sizes(sheet))))


def other_sizes(sheet: Report) -> str:
    """Return the size as each system writes it, the chosen one first; a star where others find another."""
    text = (
        f"{system_word(each)} {each['size'] or NOTHING}{'*' * bool(each['caution'])}" for each in sheet.sizes
    )
    # What belongs together is not parted at the end of a line, nor does a line begin with a dot.
    return "\N{NO-BREAK SPACE}· ".join(each.replace(" ", "\N{NO-BREAK SPACE}") for each in text)


def key_measures(sheet: Report) -> tuple[dict[str, Any], ...]:
    """Return the rows of the few measures that a garment is made to."""
    has_lower = any(row["key"] in LOWER_KEYS for row in sheet.measures)
    made_to = (*KEY_MEASURES, *(LOWER_KEY_MEASURES if has_lower else ()))
    keys = {f"{key}{side}" for key in made_to for side in ("", "_left", "_right")}
    return tuple(row for row in sheet.measures if row["key"] in keys and is_known(row))


def measure_rows(sheet: Report) -> list[tuple[str, list[MeasureRow]]]:
    """Return the measures in groups; those that are missing for one reason stand in one row."""
    rows = [(_group(row["key"]), row) for row in sheet.measures]
    order = list(dict.fromkeys(group for group, _ in rows))
    found = []
    for group in order:
        those = [row for name, row in rows if name == group]
        shown = [_measure_row(row, sheet) for row in those if is_known(row)]
        missing = [row for row in those if not is_known(row)]
        for note, same in groupby(missing, key=lambda row: row["note"]):
            title = listed([measure_title(row) for row in same])
            shown.append(MeasureRow(title, "", (), f"{title}{colon()}{render(note)}"))
        found.append((group, shown))
    return found


def pressure_legend() -> list[tuple[str, str]]:
    """Return each light with what it says of the largest pressure."""
    limits = pressure_limits()
    amber, red = number(limits.amber_kpa, 0), number(limits.red_kpa, 0)
    told = {
        "green": tr("below {kpa} kPa").format(kpa=amber),
        "amber": tr("from {kpa} kPa").format(kpa=amber),
        "red": tr("from {kpa} kPa").format(kpa=red),
    }
    return [(light, f"{rating_text(light)}{colon()}{words}") for light, words in told.items()]


def foot_words(sheet: Report) -> str:
    """Return what was at work, for the foot of each page."""
    mesh = tr("{count}-polygon control mesh").format(count=sheet.model["template"])
    return " · ".join((f"Busk {sheet.versions['busk']}", mesh, sheet.scan))


def _measure_row(row: dict[str, Any], sheet: Report) -> MeasureRow:
    digits = digits_of(row["unit"])
    figures = (
        value_text(row["before"], digits, row["unit"]),
        value_text(row["after"], digits, row["unit"]),
        _change(row, digits),
    )
    figures = figures if sheet.is_valid else (figures[0], NOTHING, NOTHING)
    offs = (
        [sheet.off.get(f"{kind}:{row['key']}") for kind in (BEFORE, AFTER, CHANGE)] if sheet.is_valid else []
    )
    off_words = length_uncertainty if row["unit"] == "mm" else plus_minus
    told = tuple("" if off is None else off_words(off) for off in offs)
    told = told if any(told) else ()
    unit = row["unit"].replace("2", "\N{SUPERSCRIPT TWO}")
    unit = "" if unit == "mm" else unit
    if row["estimate"]:
        alone = row["plus_minus"] >= 0.5 and not told  # else it is in what stands below
        off = f" ± {value_text(row['plus_minus'], digits, row['unit'])}" if alone else ""
        unit = f"{unit} {tr('est.')}{off}".strip()
    return MeasureRow(measure_title(row), unit, figures, off=told)


def _change(row: dict[str, Any], digits: int) -> str:
    """Return the change of what is printed, so that the columns agree."""
    digits, unit = shown_digits(digits, row["unit"]), row["unit"]
    if row["before"] is None or row["after"] is None:
        change = row["difference"]
        return NOTHING if change is None else number(shown_value(change, unit), digits, signed=True)
    after, before = (round(shown_value(row[when], unit), digits) for when in ("after", "before"))
    return number(after - before, digits, signed=True)


def _group(key: str) -> str:
    return tr("Custom") if key.startswith(OWN) else render(definition_of(key)[0].group)


def is_known(row: dict[str, Any]) -> bool:
    """Return whether a measure was found, before or after."""
    return row["before"] is not None or row["after"] is not None


def system_word(size: dict[str, Any]) -> str:
    """Return what a system of sizes is called beside a size."""
    key = str(size["key"])
    return key.upper() if len(key) == 2 else str(size["system"])


def value_text(value: float | None, digits: int, unit: str = "") -> str:
    """Return a figure in ``unit`` as it is printed, or NOTHING; millimetres in the unit in use."""
    if value is None:
        return NOTHING
    return number(shown_value(value, unit), shown_digits(digits, unit))


def cut_notes(sheet: Report) -> list[str]:
    """Return what holds for all of the cut list."""
    height = tr("Height: centre front above (+) or below (−) the bust points, on the body.")
    return [height, *render_all(sheet.cuts.notes)]


def note_groups(sheet: Report) -> Iterator[tuple[str, list[str]]]:
    """Return the notes beside the cut list: what to check, what is omitted."""
    if beyond := _beyond_the_head(sheet):
        yield tr("To review"), beyond
    told = tr("Before: measured on the scan. After: measured on the reshaped body of the model.")
    taken = tr(
        "Definitions of the measurements: see Measurements in the user guide, and the data file of "
        "this report."
    )
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
