"""Names, wherever they are typed or read: what one file or screen could not show has none of them."""

import io
import json
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree as Xml

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from small_project import DESIGN

from app.cli.environment import PlainStream, set_up_streams
from core.document.calibration_record import Calibration
from core.document.custom_measures import CustomMeasurement
from core.document.elastic import Elastic
from core.document.lines import ActiveLine, CustomLine, LineSettings
from core.document.printable_name import is_printable, printable, repeated, shown
from core.document.serialization import from_json, to_json
from core.errors import UserError
from core.export.band_geometry import Strip
from core.export.csv_cells import cell, csv_text
from core.export.drawings import write_strips
from core.export.measurement_files import MeasurementTable, write_measurements
from core.garment.elastic_csv import elastic_from_csv
from core.garment.presets import Preset, PresetLine, preset_of
from core.messages import EMPTY

BAD = ("a\ud800b", "a\x01b", "a\x1b[31mb", "a\nb", "a\x7f", "a\x9bb", "\u202egnp.exe", "\u2066a")
BAD += ("a\u2028b", "a\uffffb", "n" * 2000)
FAMILY, PERSIAN = "\U0001f469\u200d\U0001f467", "\u0645\u06cc\u200c\u062e\u0648\u0627\u0647\u0645"
GOOD = (
    "mid-bust",
    "胸の線",
    "Zoë's strap",
    FAMILY,
    PERSIAN,
    "<b>x</b>",
    "=1+1",
    "wide\u3000space",
    "x\u0301",
)

MAKERS: dict[str, Callable[[str], object]] = {
    "worn line": lambda name: ActiveLine(name, 0.9),
    "own line": lambda name: CustomLine(name, (1, 2)),
    "line's title": lambda name: LineSettings("strap", name),
    "traits": LineSettings,
    "elastic": lambda name: Elastic(name, 12.0, ((0.0, 0.0), (0.5, 6.0))),
    "measure": lambda name: CustomMeasurement(name, "girth"),
    "customer": lambda name: replace(DESIGN, customer=name),
    "calibration": lambda name: Calibration(name, 1.0, 1.0),
    "preset": lambda name: Preset(name, (PresetLine("mid-bust", length=0.9),)),
    "preset's file": lambda name: preset_of(
        json.dumps({"format": 1, "title": name, "lines": [{"line": "mid-bust", "length": 0.9}]})
    ),
}


@pytest.mark.parametrize("what", MAKERS)
def test_everything_that_has_a_name_has_one_that_can_be_shown(what: str) -> None:
    for name in BAD:
        with pytest.raises((UserError, ValueError)) as refused:
            MAKERS[what](name)
        assert shown(str(refused.value)) == str(refused.value)
    for name in GOOD:
        MAKERS[what](name)


@pytest.mark.parametrize("name", ["a\ud800b", "a\x01b", "\u202ea", "n" * 2000])
def test_names_in_projects_and_tables_are_refused_as_typed_ones_are(name: str) -> None:
    values = json.loads(to_json(replace(DESIGN, own_lines=(CustomLine("strap", (1, 2)),))))
    for key, part in (("own_lines", 0), ("lines", 0)):
        changed = json.loads(json.dumps(values))
        changed[key][part]["name"] = name
        with pytest.raises(UserError, match="too long or contains unprintable"):
            from_json(json.dumps(changed))
    with pytest.raises(UserError):
        elastic_from_csv(f"# name: {name}\n# width_mm: 12\nelongation %,force N\n20,1\n40,2\n", "roll")


@pytest.mark.parametrize("name", ["", "  ", "\u3000", "\u200b", "\u200d\u2060"])
def test_a_name_that_nobody_can_see_is_none(name: str) -> None:
    for what in ("own line", "elastic", "measure", "preset's file"):
        with pytest.raises((UserError, ValueError)):
            MAKERS[what](name)


def test_a_name_twice_is_found() -> None:
    assert repeated(["a", "b", "a", "b"]) == "a"
    assert repeated(iter("abc")) == ""


@given(st.text(st.characters(), max_size=20) | st.text(st.sampled_from("".join(BAD[:-1])), max_size=20))
def test_every_file_takes_a_text_that_was_made_printable(text: str) -> None:
    made = printable(text)
    assert printable(made) == made
    made.encode()
    Xml.fromstring(f"<a>{made.replace('&', '').replace('<', '').replace(']]>', '')}</a>")
    if is_printable(text, 20):
        assert made == text


FORMULAS = ("=1+1", "@SUM(1)", "+1+cmd|x", "-1+cmd|x", "\t=1", "\r=1", "\n=1", " =1", "\u3000=1", "\xa0=1")
FORMULAS += tuple(f"{sign}1{more}" for sign in "\uff1d\uff0b\uff0d\uff20" for more in ("", "+cmd"))  # wide


@pytest.mark.parametrize("text", FORMULAS)
def test_no_spreadsheet_works_a_name_out(text: str) -> None:
    assert str(cell(text)).startswith("'")
    assert csv_text(["name"], [[text]]).removeprefix("name\n").lstrip('"').startswith("'")


@pytest.mark.parametrize("text", ["mid-bust", "-12.5", "+3 %", "- 4,5", "胸", "a=b"])
def test_figures_and_names_stay_as_they_are(text: str) -> None:
    assert cell(text) == text


def test_drawings_and_measures_of_a_file_with_any_name_are_whole(tmp_path: Path) -> None:
    odd = "body\x1b\x01\udcf6\uffff.ply"
    strip = Strip("strap", "strap", 100.0, 12.0, (), EMPTY)
    write_strips(tmp_path / "strips.svg", [strip], odd)
    Xml.parse(tmp_path / "strips.svg")
    write_strips(tmp_path / "strips.dxf", [strip], odd)
    for kind in ("csv", "json", "smis", "vit"):
        write_measurements(tmp_path / f"m.{kind}", MeasurementTable({"bust": (900.0, "mm")}, "cm", {}, odd))
    Xml.parse(tmp_path / "m.smis")
    Xml.parse(tmp_path / "m.vit")
    assert np.all([b"\x1b" not in each.read_bytes() for each in tmp_path.iterdir()])


def test_a_terminal_gets_no_control_characters(monkeypatch: pytest.MonkeyPatch) -> None:
    streams = {name: io.TextIOWrapper(io.BytesIO(), "utf-8") for name in ("stdout", "stderr")}
    for name, stream in streams.items():
        monkeypatch.setattr(sys, name, stream)
    set_up_streams()
    set_up_streams()
    assert isinstance(sys.stdout, PlainStream)
    print("a\x1b[31mb\x9bc\u202ed\te\rf", "\udcf6", file=sys.stderr)
    print("胸", flush=True)
    sys.stderr.flush()
    written = {name: stream.buffer.getvalue().decode() for name, stream in streams.items()}
    assert written == {"stdout": "胸\n", "stderr": "a\\x1b[31mb\\x9bc\\u202ed\te\rf \\udcf6\n"}
