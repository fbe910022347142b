"""Measures for pattern programs: a table, JSON, and the files of SeamlyMe (.smis) and Valentina (.vit)."""

from __future__ import annotations

import csv
import io
import json
import os
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from importlib import resources
from pathlib import Path
from xml.etree import ElementTree as Xml

from core.document.printable_name import printable
from core.errors import UserError
from core.export.csv_cells import cell
from core.export.units_and_axes import UNITS
from core.files.atomic_write import write_text
from core.messages import Message

Values = Mapping[str, tuple[float, str]]
"""Values with their units by key, lengths in mm; areas and volumes have units of their own."""

_NO_NAME = re.compile(r"[^\w@]+")  # what a formula of a pattern cannot have in a name
_XML_VERSIONS = {"smis": "0.3.4", "vit": "0.5.1"}  # the newest that also older programs open
LENGTHS_ALONE = tuple(_XML_VERSIONS)
"""The files that hold neither areas nor volumes."""

_XML_UNITS = {"mm": "mm", "cm": "cm", "in": "inch"}
_NOBODY = {"birth-date": "1800-01-01", "gender": "unknown", "email": ""}  # what both write for "not told"


@dataclass(frozen=True)
class MeasurementTable:
    """What a file of measures tells: values, the unit of lengths in it, titles by key, and a note."""

    values: Values
    unit: str = "cm"
    titles: Mapping[str, str] = field(default_factory=dict)
    note: str = ""

    def in_unit(self, key: str) -> tuple[float, str]:
        """Return a value and its unit as they stand in the file."""
        value, unit = self.values[key]
        return (value / UNITS[self.unit], self.unit) if unit == "mm" else (value, unit)

    @property
    def lengths(self) -> dict[str, float]:
        """Return the lengths alone, in the unit of the file."""
        return {key: self.in_unit(key)[0] for key, (_, unit) in self.values.items() if unit == "mm"}


def write_measurements(path: str | os.PathLike[str], sheet: MeasurementTable) -> None:
    """Write measures as CSV, JSON, .smis or .vit by the name's ending; the last two hold lengths alone.

    Raises UserError for another ending, a unit that the file cannot have, or a place that cannot be written.
    """
    target, sheet = Path(path), replace(sheet, note=printable(sheet.note))
    text = MEASURE_FORMATS[measurement_file_kind(path, sheet.unit)](sheet)
    write_text(target, text)


def measurement_file_kind(path: str | os.PathLike[str], unit: str) -> str:
    """Return the kind of measures file that a name ends in. Raises UserError if it or the unit cannot be."""
    kind = Path(path).suffix.lower().lstrip(".")
    units = _XML_UNITS if kind in _XML_VERSIONS else UNITS
    if kind not in MEASURE_FORMATS:
        raise UserError(
            Message("Measurements cannot be exported as .{kind}.", kind=kind),
            Message("Choose one of: {choices}.", choices=", ".join(MEASURE_FORMATS)),
        )
    if unit not in units:
        raise UserError(
            Message(".{kind} files do not support the unit {unit}.", kind=kind, unit=unit),
            Message("Choose one of: {choices}.", choices=", ".join(units)),
        )
    return kind


def seamly_names(lengths: Mapping[str, float]) -> dict[str, tuple[float, str]]:
    """Return lengths by their names in SeamlyMe and Valentina, each with our key where the name is our own.

    Those of one name are taken at their mean, and also told one by one.
    """
    found = {
        name: (sum(lengths[key] for key in known) / len(known), "")
        for name, of in _known().items()
        if (known := [key for key in of if key in lengths])
    }
    single = {of[0] for of in _known().values() if len(of) == 1}
    for key, value in lengths.items():
        if key not in single:
            name = plain = "@" + _NO_NAME.sub("_", key).replace("@", "_")
            count = 1
            while name in found:
                count += 1
                name = f"{plain}_{count}"
            found[name] = value, key
    return found


@cache
def _known() -> dict[str, list[str]]:
    text = (resources.files("resources") / "measure_names.json").read_text(encoding="utf-8")
    return {name: told["of"] for name, told in json.loads(text)["names"].items()}


def _as_csv(sheet: MeasurementTable) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\r\n")
    writer.writerow(["measure", "title", "value", "unit"])
    for key in sheet.values:
        value, unit = sheet.in_unit(key)
        writer.writerow([cell(key), cell(sheet.titles.get(key, key)), f"{value:z.3f}", unit])
    return text.getvalue()


def _as_json(sheet: MeasurementTable) -> str:
    measures = {}
    for key in sheet.values:
        value, unit = sheet.in_unit(key)
        measures[key] = {"title": sheet.titles.get(key, key), "value": round(value, 4), "unit": unit}
    return json.dumps({"note": sheet.note, "measures": measures}, indent=1, ensure_ascii=False) + "\n"


def _as_xml(sheet: MeasurementTable, kind: str) -> str:
    """Return a file of SeamlyMe or Valentina: the two differ in root, version and the customer's name."""
    root = Xml.Element(kind)
    named = {"family-name": "", "given-name": ""} if kind == "smis" else {"customer": ""}
    heading = {
        "version": _XML_VERSIONS[kind],
        "read-only": "false",
        "notes": sheet.note,
        "unit": _XML_UNITS[sheet.unit],
        "pm_system": "998",  # none of the textbooks that they know
    }
    for tag, text in heading.items():
        Xml.SubElement(root, tag).text = text
    personal = Xml.SubElement(root, "personal")
    for tag, text in (named | _NOBODY).items():
        Xml.SubElement(personal, tag).text = text
    body = Xml.SubElement(root, "body-measurements")
    for name, (value, key) in seamly_names(sheet.lengths).items():
        title = {"full_name": sheet.titles.get(key, key)} if key else {}
        Xml.SubElement(body, "m", {"name": name, "value": f"{value:z.3f}"} | title)
    Xml.indent(root)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{Xml.tostring(root, encoding="unicode")}\n'


MEASURE_FORMATS: dict[str, Callable[[MeasurementTable], str]] = {
    "csv": _as_csv,
    "json": _as_json,
    "smis": lambda sheet: _as_xml(sheet, "smis"),
    "vit": lambda sheet: _as_xml(sheet, "vit"),
}
"""The kinds of measures files by their endings."""
