"""What is made is saved, and what is saved is opened: the same limits hold on every side."""

import json
import zipfile
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from made_designs import documents
from small_project import DESIGN, PICTURE, SCAN

import core.document.storage.project_file
from core.document.custom_measures import CustomMeasurement
from core.document.document import Document
from core.document.document_limits import (
    LARGEST_TEXT,
    LARGEST_UNKNOWN,
    MOST_ELASTICS,
    MOST_LINES,
    MOST_MEASURES,
    MOST_NESTED,
    MOST_ROWS,
    MOST_VALUES,
    check_values,
)
from core.document.document_limits import (
    MOST_POINTS as MOST_POINTS_OF_LINES,
)
from core.document.elastic import MOST_POINTS, Elastic
from core.document.lines import ActiveLine, CustomLine, LineSettings
from core.document.serialization import from_json, from_texts, to_json, to_texts
from core.document.storage.project_file import open_project, save_project
from core.errors import ProjectError, UserError

ROW = 1.2345678901234567


def curve(rows: int) -> tuple[tuple[float, float], ...]:
    return tuple((k * ROW / MOST_ROWS, k * ROW / 7.0) for k in range(rows))


def nested(levels: int) -> object:
    value: object = 1
    for _ in range(levels):
        value = [value]
    return value


@settings(deadline=None, max_examples=40, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(documents())
def test_every_document_that_can_be_made_is_saved_and_opened_again(
    tmp_path: Path, document: Document
) -> None:
    path = tmp_path / "anna.busk"
    saved = save_project(path, document, SCAN, PICTURE)
    assert open_project(path) == saved


def test_the_largest_document_fits() -> None:
    """Each name of the widest letters, each table as long as it may be, in every variant."""
    wide = "\N{SPOOL OF THREAD}"
    names = [f"{k:03}" + wide * 117 for k in range(MOST_LINES)]
    rolls = [
        Elastic(f"{k:03}" + wide * 77, 12.0, curve(MOST_ROWS // MOST_ELASTICS), 20.0, wide * 500)
        for k in range(MOST_ELASTICS)
    ]
    points = MOST_POINTS_OF_LINES // MOST_LINES
    largest = replace(
        DESIGN,
        lines=tuple(ActiveLine(name, ROW / 2.0) for name in names),
        own_lines=tuple(CustomLine(name, tuple(range(100, 100 + points))) for name in names),
        traits=tuple(
            LineSettings(
                name, wide * 60, "#e5536b", stiffness=ROW, width=12.0 * ROW, elastic=rolls[k % 200].name
            )
            for k, name in enumerate(names)
        ),
        own_measures=tuple(CustomMeasurement(f"{k}", "girth", (), ROW) for k in range(MOST_MEASURES)),
        elastics=tuple(rolls),
        unknown={"later": ["x" * 40] * (LARGEST_UNKNOWN // 60)},
    )
    document = Document.single(largest)
    for name in "BC":
        document = document.with_shown(name)
    for text in to_texts(document).values():
        check_values(text)
        assert len(text) <= LARGEST_TEXT


def test_more_than_a_document_holds_is_refused_where_it_is_made_and_where_it_is_read() -> None:
    rolls = (Elastic(str(k), 12.0, curve(MOST_POINTS)) for k in range(MOST_ROWS // MOST_POINTS))
    full = replace(DESIGN, elastics=tuple(rolls))
    too_many = {
        "lines": [ActiveLine(str(k), 0.9) for k in range(MOST_LINES + 1)],
        "own_lines": [CustomLine(str(k), (1, 2)) for k in range(MOST_LINES + 1)],
        "traits": [LineSettings(str(k), "t") for k in range(MOST_LINES + 1)],
        "own_measures": [CustomMeasurement(str(k), "girth") for k in range(MOST_MEASURES + 1)],
        "elastics": [*full.elastics, Elastic("one more", 12.0, curve(2))],
    }
    for key, values in too_many.items():
        fewer = replace(full if key == "elastics" else DESIGN, **{key: tuple(values[:-1])})
        text = json.loads(to_json(fewer))
        text[key] += json.loads(to_json(replace(DESIGN, **{key: (values[-1],)})))[key]
        with pytest.raises(UserError, match=r"too many .*: [\d,]+\. Use at most"):
            replace(fewer, **{key: tuple(values)})
        with pytest.raises(UserError, match=r"too many .*: [\d,]+\. Use at most"):
            from_json(json.dumps(text))


@pytest.mark.parametrize("unknown", [{"later": nested(MOST_NESTED)}, {"later": "x" * LARGEST_UNKNOWN}])
def test_what_could_not_be_opened_is_not_saved_and_nothing_is_touched(
    project: Path, unknown: dict[str, object]
) -> None:
    before = project.read_bytes()
    with pytest.raises(ProjectError, match="cannot be opened again"):
        save_project(project, Document.single(replace(DESIGN, unknown=unknown)), SCAN, None)
    assert (project.read_bytes(), [each.name for each in project.parent.iterdir()]) == (before, ["anna.busk"])
    with pytest.raises(ProjectError, match=r"too many nested levels|contains too much"):
        from_json(json.dumps({**json.loads(to_json(DESIGN)), **unknown}))


def test_what_later_versions_nest_is_kept_as_deep_as_it_is_read(project: Path) -> None:
    kept = {"later": nested(MOST_NESTED - 2)}
    document = Document.single(replace(DESIGN, unknown=kept)).with_shown("B")
    for _ in range(2):
        document = save_project(project, document, SCAN, None)
        document = open_project(project)
    assert document.variants["A"].unknown == document.design.unknown == kept


@pytest.mark.parametrize("what", ["LARGEST_TEXT", "LARGEST_SCAN"])
def test_sizes_are_the_same_for_saving_and_for_opening(
    project: Path, monkeypatch: pytest.MonkeyPatch, what: str
) -> None:
    document = open_project(project)
    monkeypatch.setattr(
        core.document.storage.project_file, what, len(SCAN.data) if what == "LARGEST_SCAN" else 100
    )
    if what == "LARGEST_SCAN":
        save_project(project, document, SCAN, None)
        assert core.document.storage.project_file.read_scan_file(document.design.scan).data == SCAN.data
        monkeypatch.setattr(core.document.storage.project_file, what, len(SCAN.data) - 1)
        with pytest.raises(ProjectError, match=r"body\.ply of this project is larger"):
            core.document.storage.project_file.read_scan_file(document.design.scan)
    else:
        with pytest.raises(ProjectError, match=r"design\.json of this project is larger"):
            open_project(project)
    before = project.read_bytes()
    with pytest.raises(ProjectError, match="of this project is larger"):
        save_project(project, document, SCAN, None)
    assert project.read_bytes() == before


def test_a_picture_that_would_not_be_shown_is_left_out(
    project: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(core.document.storage.project_file, "LARGEST_PICTURE", 3)
    save_project(project, Document.single(DESIGN), SCAN, PICTURE)
    with zipfile.ZipFile(project) as archive:
        assert "preview.png" not in archive.namelist()


def test_a_text_of_far_too_many_values_is_refused_before_it_takes_memory() -> None:
    check_values("[" + "1," * (MOST_VALUES // 2))
    with pytest.raises(ValueError, match="too many"):
        check_values("[]," * (MOST_VALUES // 2 + 1))
    with pytest.raises(ProjectError, match="cannot be read"):
        from_json("[" + "[]," * MOST_VALUES + "[]]")
    assert 3 * MOST_VALUES < LARGEST_TEXT


def test_the_same_names_are_read_in_one_pass() -> None:
    """As many as there may be, and they are compared with each other once."""
    lines = tuple(LineSettings(f"line {k}", "t") for k in range(MOST_LINES))
    with pytest.raises(UserError, match="contradictory settings"):
        replace(DESIGN, traits=(*lines[:-1], lines[0]))
    document = Document.single(replace(DESIGN, traits=lines))
    assert from_texts(to_texts(document)) == document
