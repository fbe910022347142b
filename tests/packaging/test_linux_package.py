"""What a Linux desktop is told of Busk, and the Debian package, made of a stand-in for the frozen program."""

from __future__ import annotations

import configparser
import importlib
import io
import json
import os
import re
import shutil
import subprocess
import sys
import tarfile
import xml.etree.ElementTree as ET
import zipfile
from pathlib import Path
from types import ModuleType

import pytest

from app.cli.parser import COMMANDS, command_parser, window_parser
from core.scan.readers.registry import FORMATS

LINUX = Path(__file__).parents[2] / "packaging" / "linux"
ENTRIES = sorted(LINUX.glob("*.desktop"))
MIME = "{http://www.freedesktop.org/standards/shared-mime-info}"
DEBIAN = pytest.mark.skipif(
    not (shutil.which("dpkg-deb") and shutil.which("objdump")), reason="needs dpkg-deb and objdump"
)


@pytest.fixture
def of_linux(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """Return what makes the package; its folder is no package of Python."""
    monkeypatch.syspath_prepend(str(LINUX.parent))
    monkeypatch.syspath_prepend(str(LINUX))
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    return importlib.import_module("deb")


def entry(path: Path) -> configparser.ConfigParser:
    read = configparser.ConfigParser(interpolation=None, delimiters=["="])
    read.optionxform = str  # type: ignore[assignment,method-assign]
    read.read(path, encoding="utf-8")
    return read


def mime_types() -> dict[str, ET.Element]:
    root = ET.parse(LINUX / "busk.xml").getroot()
    return {node.get("type", ""): node for node in root.iter(f"{MIME}mime-type")}


@pytest.mark.parametrize("path", ENTRIES, ids=lambda path: path.name)
def test_a_menu_entry_is_valid(path: Path) -> None:
    told = entry(path)["Desktop Entry"]
    assert told["Exec"] == "busk %f"
    assert not [
        key for key in told if f"{key}[ja]" not in told and key in ("GenericName", "Comment", "Keywords")
    ]
    if shutil.which("desktop-file-validate"):
        found = subprocess.run(["desktop-file-validate", path], capture_output=True, text=True, check=False)
        assert found.stdout + found.stderr == ""


def test_a_desktop_finds_the_menu_entry_of_a_window() -> None:
    # In a process of its own: that of the tests has its application already.
    asked = (
        "from app.gui.application import application as a; b = a();"
        " print(b.desktopFileName(), b.applicationName());"
        " print(*(size.width() for size in b.windowIcon().availableSizes()))"
    )
    told = subprocess.run(
        [sys.executable, "-c", asked],
        capture_output=True,
        text=True,
        check=True,
        env=os.environ | {"QT_QPA_PLATFORM": "offscreen"},
    )
    name, class_, *widths = told.stdout.split()
    assert (LINUX / f"{name}.desktop").is_file()
    # The class of an X11 window is the name of the application.
    assert entry(LINUX / "busk.desktop")["Desktop Entry"]["StartupWMClass"] == class_
    assert set(widths) >= {"16", "32", "48", "256"}


def test_every_action_of_the_menu_entry_is_read_by_the_program() -> None:
    told = entry(LINUX / "busk.desktop")
    for action in filter(None, told["Desktop Entry"]["Actions"].split(";")):
        program, *words = told[f"Desktop Action {action}"]["Exec"].split()
        assert program == "busk"
        assert window_parser().parse_args(words).safe_mode


def test_scans_stay_with_the_programs_that_they_belong_to() -> None:
    project, scans = (set(entry(path)["Desktop Entry"]["MimeType"].split(";")) - {""} for path in ENTRIES)
    assert project == {"application/x-busk"}
    assert all(type_.startswith("model/") for type_ in scans)
    # Of several entries for a type a desktop takes the first of the alphabet.
    assert ENTRIES[1].name > "meshlab.desktop"
    assert ENTRIES[1].name > "org.freecad.FreeCAD.desktop"


def said(match: ET.Element, data: bytes) -> bool:
    """Tell whether a rule of the magic holds for a file, with one of those inside it if there are any."""
    first, _, last = match.get("offset", "").partition(":")
    value = match.get("value", "")
    wanted = (
        int(value).to_bytes(2, "little")
        if match.get("type") == "little16"
        else value.encode().decode("unicode_escape").encode("latin-1")
    )
    if not any(data[start:].startswith(wanted) for start in range(int(first), int(last or first) + 1)):
        return False
    inner = match.findall(f"{MIME}match")
    return not inner or any(said(each, data) for each in inner)


def zip_of(folder: Path, name: str, text: str) -> bytes:
    with zipfile.ZipFile(folder / "other.zip", "w") as other:
        other.writestr(name, text)
    return (folder / "other.zip").read_bytes()


def test_a_project_is_known_by_its_name_and_by_what_is_in_it(tmp_path: Path) -> None:
    node = mime_types()["application/x-busk"]
    (rule,) = node.findall(f"{MIME}magic/{MIME}match")
    projects = sorted(LINUX.parent.parent.glob("tests/releases/*/*.busk"))
    assert [path.name for path in projects if not said(rule, path.read_bytes())] == []
    project = zipfile.ZipFile(projects[0]).read("design.json").decode()
    assert said(rule, zip_of(tmp_path, "design.json", project))
    for name, text in (
        ("readme.txt", "no project"),
        ("design.json", '{"pages": 3}'),
        ("design.json", '{\n "format": 1,\n "pages": 3}'),
        ("design.json5", project),
        ("design.json/", ""),
    ):
        assert not said(rule, zip_of(tmp_path, name, text)), f"{name} in somebody else's zip"
    assert [glob.get("pattern") for glob in node.iter(f"{MIME}glob")] == ["*.busk"]


def test_only_scans_that_can_be_opened_get_a_type() -> None:
    globs = {
        glob.get("pattern", "") for node in mime_types().values() for glob in node.iter(f"{MIME}glob")
    } - {"*.busk"}
    assert globs
    assert {pattern.removeprefix("*.") for pattern in globs} <= set(FORMATS)
    for node in mime_types().values():
        assert [
            text.get("{http://www.w3.org/XML/1998/namespace}lang") for text in node.iter(f"{MIME}comment")
        ] == [
            None,
            "ja",
        ]


def test_the_manual_page_names_every_command_and_option(of_linux: ModuleType) -> None:
    page = importlib.import_module("man_page").man_page(1700000000)
    assert page.startswith(".TH BUSK 1 2023-11-14")
    plain = re.sub(r"\\f[BIR]|\\&", "", page).replace("\\-", "-")
    parts = dict(
        zip(
            re.findall(r"^\.SS busk (\S+)$", plain, re.M),
            re.split(r"^\.SS .*$", plain, flags=re.M)[1:],
            strict=True,
        )
    )
    assert list(parts) == list(COMMANDS)
    for command, text in parts.items():
        for action in command_parser(command)._actions:
            assert all(name in text for name in action.option_strings if name not in ("-h", "--help")), (
                command
            )
    assert not re.search(r"^['.](?!(SH|SS|TH|TP|B|I|br)\b)", page, re.M)


def stand_in(folder: Path) -> Path:
    """A frozen program in small: one real executable, a library that belongs to nobody, a link."""
    (folder / "_internal").mkdir(parents=True)
    shutil.copy("/bin/true", folder / "busk")
    (folder / "_internal" / "data.txt").write_text("data")
    (folder / "_internal" / "data.txt").chmod(0o600)
    (folder / "_internal" / "link").symlink_to("data.txt")
    (folder / "_internal" / "licences").mkdir()
    part = {"name": "numpy", "version": "2.4", "licenses": [{"expression": "BSD-3-Clause"}]}
    (folder / "_internal" / "licences" / "bill.json").write_text(json.dumps({"components": [part]}))
    return folder


@DEBIAN
def test_the_package_holds_the_program_and_all_that_desktops_need(
    of_linux: ModuleType, tmp_path: Path
) -> None:
    made = of_linux.make_deb(stand_in(tmp_path / "busk"), tmp_path / "out", "9.8.7", level=1)
    listing = subprocess.run(
        ["dpkg-deb", "--contents", made], capture_output=True, text=True, check=True
    ).stdout
    rows = {row.split()[5][1:]: row.split() for row in listing.splitlines()}
    assert made.name.startswith("busk_9.8.7_")
    assert {row[1] for row in rows.values()} == {"root/root"}
    assert {row[3] for row in rows.values()} == {"2023-11-14"}
    assert rows["/usr/bin/busk"][-1] == "../lib/busk/busk"
    assert rows["/usr/lib/busk/busk"][0] == "-rwxr-xr-x"
    assert rows["/usr/lib/busk/_internal/data.txt"][0] == "-rw-r--r--"
    assert {
        *(f"/usr/share/applications/{path.name}" for path in ENTRIES),
        "/usr/share/mime/packages/busk.xml",
        "/usr/share/icons/hicolor/16x16/apps/busk.png",
        "/usr/share/icons/hicolor/512x512/mimetypes/application-x-busk.png",
        "/usr/share/icons/hicolor/scalable/apps/busk.svg",
        "/usr/share/man/man1/busk.1.gz",
        "/usr/share/doc/busk/copyright",
        "/usr/share/doc/busk/changelog.gz",
    } <= set(rows)
    out = subprocess.run(["dpkg-deb", "--fsys-tarfile", made], capture_output=True, check=True).stdout
    with tarfile.open(fileobj=io.BytesIO(out)) as tar:
        owned = tar.extractfile("./usr/share/doc/busk/copyright")
        assert owned is not None
        assert b"\n  numpy 2.4: BSD-3-Clause\n" in owned.read()
    fields = subprocess.run(["dpkg-deb", "--field", made], capture_output=True, text=True, check=True).stdout
    assert "Version: 9.8.7" in fields
    assert re.search(r"^Depends: libc6 \(>= 2\.\d+\), xkb-data$", fields, re.M)
    assert re.search(r"^Recommends: .*\bxdg-utils\b", fields, re.M), "Qt opens guide and folders by xdg-open"
    again = of_linux.make_deb(tmp_path / "busk", tmp_path / "again", "9.8.7", level=1)
    assert made.read_bytes() == again.read_bytes()


def test_a_library_that_debian_does_not_know_is_refused(of_linux: ModuleType) -> None:
    needs = importlib.import_module("needs")
    told = needs.depends({"libc.so.6", "ld-linux-x86-64.so.2", "libGL.so.1", "libglib-2.0.so.0"}, "2.31")
    assert told == "libc6 (>= 2.31), libgl1, libglib2.0-0t64 | libglib2.0-0, xkb-data"
    with pytest.raises(LookupError, match=r"libstrange\.so\.1"):
        needs.depends({"libstrange.so.1"}, "2.31")


@pytest.mark.parametrize("name", ["busk", "busk-project"])
def test_the_pictures_can_be_told_apart_when_small(of_linux: ModuleType, name: str) -> None:
    small = importlib.import_module("icon_files").picture(name, 16)
    colors = {small.pixelColor(x, y).name() for x in range(16) for y in range(16)}
    assert len(colors) > 40
    assert small.pixelColor(0, 0).alpha() < 128


def test_two_answers_are_held_against_each_other(of_linux: ModuleType) -> None:
    same = importlib.import_module("same_answer").is_same
    assert same(1000.0, 1000.0 + 1e-7)
    assert not same(1.0, 1.0 + 1e-8)
    assert not same(None, 1.0)
