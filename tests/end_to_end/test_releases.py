"""Releases: every version's projects open and mean the same, and the list of changes tells which are out."""

import importlib.util
import json
import re
import zipfile
from pathlib import Path

import pytest

from core import __version__
from core.document.serialization import FORMAT
from core.document.storage.project_file import open_project, read_scan_file, save_project, with_scan
from core.errors import ProjectError

ROOT = Path(__file__).parents[2]
RELEASES = ROOT / "tests" / "releases"
NEW = ("tissue", "sag", "density", "posture", "cup", "lower", "pattern")
"""What no released version writes yet."""

PROJECTS = sorted(RELEASES.glob("*/*.busk"))
NEWEST = max(RELEASES.iterdir(), key=lambda folder: [int(number) for number in folder.name.split(".")])
NAMES = [path.relative_to(RELEASES).as_posix() for path in PROJECTS]
HEADING = re.compile(r"^## (\d\S*) \((unreleased|\d{4}-\d{2}-\d{2})\)$")


def release_files():
    """The script that wrote the files: both ask the same way what comes of a design."""
    path = ROOT / "packaging" / "release_files.py"
    spec = importlib.util.spec_from_file_location("release_files", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def expected(project):
    return json.loads(project.with_suffix(".json").read_text("utf-8"))


def lost(told, now, at=""):
    """What was told and is not there now, by its place; keys that came later are no loss."""
    if isinstance(told, dict):
        for key, value in told.items():
            if isinstance(now, dict) and key in now:
                yield from lost(value, now[key], f"{at}.{key}")
            else:
                yield f"{at}.{key} is gone"
    elif isinstance(told, list) and isinstance(now, list) and len(told) == len(now):
        for number, (value, other) in enumerate(zip(told, now, strict=True)):
            yield from lost(value, other, f"{at}[{number}]")
    elif told != now:
        yield f"{at}: {told!r} became {now!r}"


def test_what_is_lost_is_noticed():
    told = {"scan": {"unit": "mm"}, "lines": [{"ratio": 0.9}], "gain": None}
    assert list(lost(told, told | {"later": 1})) == []
    now = {"scan": {}, "lines": [{"ratio": 0.8}], "gain": 0.0}
    assert list(lost(told, now)) == [
        ".scan.unit is gone",
        ".lines[0].ratio: 0.9 became 0.8",
        ".gain: None became 0.0",
    ]
    assert list(lost(told, now | {"lines": []}))[1] == ".lines: [{'ratio': 0.9}] became []"


@pytest.mark.parametrize("project", PROJECTS, ids=NAMES)
def test_a_released_project_loses_nothing(project):
    told, document = expected(project), open_project(project)
    values = {name: release_files().values_of(design) for name, design in document.designs}
    now = {"shown": document.shown, "designs": values}
    assert list(lost({key: told[key] for key in now}, now)) == []
    assert [design.unknown for design in document.variants.values()] == [{}] * len(document.designs)


@pytest.mark.parametrize("project", PROJECTS, ids=NAMES)
def test_a_released_project_comes_to_the_same_figures(project):
    told = expected(project)["figures"]
    assert told
    for name, design in open_project(project).designs:
        found = dict(release_files().figures_of(design))
        assert told[name].keys() - found.keys() == set()
        for what, value in told[name].items():
            # Other processors multiply in another order: 4e-7 at most was seen between four kinds of them.
            same = value if isinstance(value, str) else pytest.approx(value, rel=1e-6, abs=1e-5)
            assert found[what] == same, f"{name}: {what}"


@pytest.mark.parametrize("project", PROJECTS, ids=NAMES)
def test_a_released_project_is_saved_and_opened_again(project, tmp_path):
    document = open_project(project)
    scan, path = read_scan_file(document.design.scan), tmp_path / "again.busk"
    again = save_project(path, document, scan, None)
    assert again == open_project(path)
    assert with_scan(again, "", again.design.scan.member) == with_scan(
        document, "", document.design.scan.member
    )
    assert read_scan_file(again.design.scan).data == scan.data


def test_the_projects_hold_all_that_a_project_can_hold():
    """In the newest folder every value of a design is once another than the usual one."""
    usual = release_files().values_of(release_files().Design(release_files().ScanSource("")))
    designs = [each for path in NEWEST.glob("*.busk") for each in expected(path)["designs"].values()]
    always_usual = {key for key in usual if all(each.get(key, usual[key]) == usual[key] for each in designs)}
    assert always_usual == {"unknown", *NEW}
    assert any(set(expected(path)["designs"]) == {"A", "B", "C"} for path in NEWEST.glob("*.busk"))


def test_released_files_are_small():
    assert PROJECTS
    assert [path.name for path in PROJECTS if path.stat().st_size > 100_000] == []


def test_a_project_of_a_later_format_is_refused_in_a_sentence(tmp_path):
    project, first = tmp_path / "later.busk", NEWEST / "first.busk"
    with zipfile.ZipFile(first) as archive:
        design = json.loads(archive.read("design.json"))
    with zipfile.ZipFile(project, "w") as archive:
        archive.writestr("design.json", json.dumps(design | {"format": FORMAT + 1}))
    with pytest.raises(
        ProjectError, match=rf"format {FORMAT + 1}.*reads formats up to {FORMAT}.*Update Busk"
    ):
        open_project(project)


def headings():
    lines = (ROOT / "CHANGELOG.md").read_text("utf-8").splitlines()
    return [line for line in lines if line.startswith("## ")]


def test_the_list_of_changes_begins_with_this_version_and_says_of_each_when_it_came():
    found = [HEADING.match(line) for line in headings()]
    assert all(found), "write '## 1.2.3 (unreleased)' or '## 1.2.3 (2027-01-31)'"
    assert found[0][1] == __version__
    assert [match[2] for match in found[1:] if match[2] == "unreleased"] == []
    numbers = [tuple(map(int, match[1].split("."))) for match in found]
    assert numbers == sorted(set(numbers), reverse=True)


def test_every_version_that_is_out_has_left_its_projects():
    out = {match[1] for match in map(HEADING.match, headings()) if match and match[2] != "unreleased"}
    there = {path.name for path in RELEASES.iterdir() if list(path.glob("*.busk"))}
    assert out - there == set(), "packaging/release_files.py writes them"
    assert there - out <= {__version__}, "a folder of a version that nobody has released"
    assert [path.name for path in PROJECTS if not path.with_suffix(".json").exists()] == []
