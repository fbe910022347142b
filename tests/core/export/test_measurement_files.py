"""Measures that leave the program: what SeamlyMe and Valentina ask for, read back with an XML parser."""

import csv
import json
import re
from xml.etree import ElementTree

import pytest

from core.errors import UserError
from core.export.measurement_files import MeasurementTable, seamly_names, write_measurements
from core.measurements.definitions import KEYS

VALUES = {
    "bust_girth": (912.34, "mm"),
    "underbust_girth": (752.2, "mm"),
    "bust_point_distance": (184.0, "mm"),
    "bust_point_to_fold_left": (81.0, "mm"),
    "bust_point_to_fold_right": (83.0, "mm"),
    "cup_depth_left": (62.5, "mm"),
    "breast_volume_left": (431.0, "ml"),
    "own:Strap <front> & 'back'": (312.0, "mm"),
    "own:Strap (front) + back": (313.0, "mm"),
    "own:Strap [front] - back": (314.0, "mm"),
}
TITLES = {"cup_depth_left": "Cup depth, left", "own:Strap <front> & 'back'": "Strap <front> & 'back'"}
SHORT_NAME = re.compile(r"""[^\d\s*/&|!<>^\-()–+−=?:;'"][^\s*/&|!<>^\-()–+−=?:;"]*""")  # as both formats say


@pytest.fixture(params=["smis", "vit"])
def kind(request):
    return request.param


def read(path):
    root = ElementTree.parse(path).getroot()
    return root, {m.get("name"): float(m.get("value")) for m in root.iterfind("body-measurements/m")}


def test_known_measures_have_the_names_that_patterns_use(tmp_path, kind):
    write_measurements(tmp_path / f"anna.{kind}", MeasurementTable(VALUES, "cm"))
    _, found = read(tmp_path / f"anna.{kind}")
    assert found["bust_circ"] == pytest.approx(91.234)
    assert found["lowbust_circ"] == pytest.approx(75.22)
    assert found["bustpoint_to_bustpoint"] == pytest.approx(18.4)
    assert found["bustpoint_to_lowbust"] == pytest.approx(8.2)
    assert (found["@bust_point_to_fold_left"], found["@bust_point_to_fold_right"]) == (8.1, 8.3)
    assert not any("volume" in name for name in found)  # a length is all that these programs know


def test_every_name_is_one_that_a_formula_can_hold_and_comes_once(tmp_path, kind):
    write_measurements(tmp_path / f"anna.{kind}", MeasurementTable(VALUES, "mm", TITLES))
    root, found = read(tmp_path / f"anna.{kind}")
    names = [m.get("name") for m in root.iterfind("body-measurements/m")]
    assert len(names) == len(set(names)) == len(VALUES)  # the volume goes, the mean of both folds comes
    assert all(SHORT_NAME.fullmatch(name) for name in names)
    assert (found["@own_Strap_front_back_"], found["@own_Strap_front_back"]) == (312.0, 313.0)
    assert found["@own_Strap_front_back_2"] == 314.0  # only its signs were others
    titles = {m.get("name"): m.get("full_name") for m in root.iterfind("body-measurements/m")}
    assert titles["@own_Strap_front_back_"] == "Strap <front> & 'back'"
    assert titles["bust_circ"] is None  # it has one there, in the user's language


@pytest.mark.parametrize(
    ("unit", "word", "length"), [("mm", "mm", 912.34), ("cm", "cm", 91.234), ("in", "inch", 35.919)]
)
def test_the_unit_is_told_and_kept(tmp_path, kind, unit, word, length):
    write_measurements(tmp_path / f"anna.{kind}", MeasurementTable(VALUES, unit))
    root, found = read(tmp_path / f"anna.{kind}")
    assert root.findtext("unit") == word
    assert found["bust_circ"] == pytest.approx(length)


def test_the_parts_stand_in_the_order_that_the_format_asks_for(tmp_path, kind):
    write_measurements(tmp_path / f"anna.{kind}", MeasurementTable(VALUES, note="reshaped < & >"))
    root, _ = read(tmp_path / f"anna.{kind}")
    heading = ["version", "read-only", "notes", "unit", "pm_system", "personal", "body-measurements"]
    names = ["family-name", "given-name"] if kind == "smis" else ["customer"]
    assert (root.tag, [part.tag for part in root]) == (kind, heading)
    assert [part.tag for part in root.find("personal")] == [*names, "birth-date", "gender", "email"]
    assert root.findtext("version") == {"smis": "0.3.4", "vit": "0.5.1"}[kind]
    assert (root.findtext("notes"), root.findtext("read-only")) == ("reshaped < & >", "false")


def test_one_fold_alone_is_its_own_mean():
    assert seamly_names({"bust_point_to_fold_left": 80.0})["bustpoint_to_lowbust"] == (80.0, "")


def test_every_measure_that_has_a_name_there_is_one_of_busk():
    known = {name for key in KEYS for name in seamly_names({key: 1.0}) if not name.startswith("@")}
    assert len(known) == 9


def test_a_table_and_json_hold_everything_with_its_unit(tmp_path):
    sheet = MeasurementTable(VALUES, "cm", TITLES, "reshaped")
    write_measurements(tmp_path / "anna.csv", sheet)
    write_measurements(tmp_path / "anna.json", sheet)
    with open(tmp_path / "anna.csv", newline="", encoding="utf-8") as file:
        rows = {row["measure"]: row for row in csv.DictReader(file)}
    told = json.loads((tmp_path / "anna.json").read_text("utf-8"))
    assert (list(rows), list(told["measures"]), told["note"]) == (list(VALUES), list(VALUES), "reshaped")
    assert (rows["bust_girth"]["value"], rows["bust_girth"]["unit"]) == ("91.234", "cm")
    assert (rows["breast_volume_left"]["value"], rows["breast_volume_left"]["unit"]) == ("431.000", "ml")
    assert told["measures"]["cup_depth_left"] == {"title": "Cup depth, left", "value": 6.25, "unit": "cm"}


@pytest.mark.parametrize(
    ("name", "unit", "said"),
    [
        ("a.xls", "cm", "csv, json, smis, vit"),
        ("a.smis", "m", "mm, cm, in"),
        ("a.csv", "ell", "mm, cm, m, in"),
    ],
)
def test_what_cannot_be_is_refused_with_a_choice(tmp_path, name, unit, said):
    with pytest.raises(UserError, match=said):
        write_measurements(tmp_path / name, MeasurementTable(VALUES, unit))
    assert list(tmp_path.iterdir()) == []
