"""What Windows and macOS are told of the program, as far as that can be read on any system."""

import io
import json
import plistlib
import re
import struct
import sys
from pathlib import Path
from types import SimpleNamespace

import PyInstaller.utils.hooks
import pytest
from PIL import Image

from core import __version__
from core.scan.readers.registry import FORMATS

ROOT = Path(__file__).parents[2]
PACKAGING = ROOT / "packaging"
NSI = (PACKAGING / "windows" / "busk.nsi").read_text("utf-8")
WORDS = (PACKAGING / "windows" / "words.nsh").read_text("utf-8")


@pytest.fixture(autouse=True)
def packaging_modules(monkeypatch):
    """The scripts beside the specification find each other as PyInstaller lets them."""
    monkeypatch.setattr(
        sys, "path", [*(str(PACKAGING / name) for name in ("", "windows", "macos")), *sys.path]
    )
    known = set(sys.modules)
    yield
    for name in {"bundle", "installer", "version_info", "icon_files", "lean"} & (sys.modules.keys() - known):
        del sys.modules[name]


class Frozen:
    """Stands in for PyInstaller: keeps what the specification asks of it."""

    def __init__(self):
        self.programs, self.folders, self.bundles = [], [], []

    def names(self, folder):
        return {
            "SPECPATH": str(PACKAGING),
            "workpath": str(folder),
            "Analysis": lambda *_, **told: SimpleNamespace(
                pure=[("core.document.design", "design.py", "PYMODULE")],
                scripts=[],
                binaries=[("libvtkB.so", "vtkmodules/libvtkB.so", "SYMLINK")],
                datas=[(place, source, "DATA") for source, place in told["datas"]],
            ),
            "PYZ": lambda pure: pure,
            "EXE": self.program,
            "COLLECT": lambda *parts, **told: self.folders.append((parts, told)) or self.folders[-1],
            "BUNDLE": lambda *_, **told: self.bundles.append(told),
        }

    def program(self, *_, **told):
        self.programs.append(told)
        return told


def frozen_on(platform, monkeypatch, folder):
    """What the specification makes on another system."""
    monkeypatch.setattr(sys, "platform", platform)
    monkeypatch.setattr(PyInstaller.utils.hooks, "collect_submodules", lambda _: [])
    import lean  # noqa: PLC0415

    monkeypatch.setattr(lean, "vtk_modules", frozenset)  # asking pyvista takes seconds
    frozen = Frozen()
    exec(compile((PACKAGING / "busk.spec").read_text("utf-8"), "busk.spec", "exec"), frozen.names(folder))
    return frozen


@pytest.mark.parametrize("platform", ["linux", "win32", "darwin"])
def test_the_bill_is_told_where_everything_came_from(monkeypatch, tmp_path, platform):
    frozen_on(platform, monkeypatch, tmp_path)
    told = dict(json.loads((tmp_path / "origins.json").read_text("utf-8")))
    assert told["core.document.design"] == "design.py"
    assert Path(told["resources"]) == ROOT / "resources"
    assert "libvtkB.so" not in told, "a link is no part of its own"


def test_windows_gets_a_program_that_prints_and_one_without_a_console(monkeypatch, tmp_path):
    frozen = frozen_on("win32", monkeypatch, tmp_path)
    assert {each["name"]: each["console"] for each in frozen.programs} == {"busk": True, "buskw": False}
    ((parts, told),) = frozen.folders
    assert (parts[:2], told["name"]) == (tuple(frozen.programs), "busk")
    for each in frozen.programs:
        assert Path(each["icon"]).read_bytes()[:4] == b"\0\0\1\0"
        assert f"'FileVersion', '{__version__}'" in Path(each["version"]).read_text("utf-8")
    # On a disk that knows no capitals they are two names, and neither is that of the folder of libraries.
    assert len({each["name"].lower() for each in frozen.programs} | {"_internal"}) == 3
    assert not frozen.bundles


def test_macos_gets_a_bundle_that_stands_in_the_dock(monkeypatch, tmp_path):
    monkeypatch.setenv("BUSK_SIGN_AS", "Developer ID Application: Somebody")
    frozen = frozen_on("darwin", monkeypatch, tmp_path)
    (program,) = frozen.programs
    assert program["console"] is False, "PyInstaller keeps what has a console in the background"
    assert program["codesign_identity"].startswith("Developer ID")
    (told,) = frozen.bundles
    assert (told["name"], told["version"]) == ("Busk.app", __version__)
    icon = Path(told["icon"]).read_bytes()
    assert (icon[:4], struct.unpack(">I", icon[4:8])[0]) == (b"icns", len(icon))
    inside = {name: Path(source) for name, source, *_ in frozen.folders[0][0][2]}
    assert inside["ja.lproj/InfoPlist.strings"].is_file()
    assert inside["busk-project.icns"].is_file()


def test_unsigned_where_nobody_signs(monkeypatch):
    import bundle  # noqa: PLC0415

    monkeypatch.delenv("BUSK_SIGN_AS", raising=False)
    assert bundle.signing() == {}


def test_the_bundle_tells_what_it_opens():
    import bundle  # noqa: PLC0415

    plist = plistlib.loads(plistlib.dumps(bundle.info_plist(__version__)))
    assert plist["CFBundleShortVersionString"] == plist["CFBundleVersion"] == __version__
    (project,) = plist["UTExportedTypeDeclarations"]
    assert project["UTTypeTagSpecification"] == {"public.filename-extension": ["busk"]}
    ours, scans = plist["CFBundleDocumentTypes"]
    assert ours["LSItemContentTypes"] == [project["UTTypeIdentifier"]]
    assert (scans["CFBundleTypeRole"], scans["LSHandlerRank"]) == ("Viewer", "Alternate")
    declared = {each["UTTypeIdentifier"] for each in plist["UTImportedTypeDeclarations"]}
    assert declared == {name for name in scans["LSItemContentTypes"] if not name.startswith("public.")}
    japanese = (PACKAGING / "macos" / "ja.lproj" / "InfoPlist.strings").read_text("utf-8")
    told = dict(re.findall(r'^"(.+)" = "(.+)";$', japanese, re.MULTILINE))
    assert {each["CFBundleTypeName"] for each in (ours, scans)} <= told.keys()


def test_entitlements_are_those_that_compiled_loops_need():
    asked = plistlib.loads((PACKAGING / "macos" / "entitlements.plist").read_bytes())
    security = "com.apple.security.cs."
    assert asked == {f"{security}allow-jit": True, f"{security}allow-unsigned-executable-memory": True}


def test_windows_compares_versions_as_four_numbers():
    import version_info  # noqa: PLC0415

    assert version_info.numbers_of("1.20.3") == (1, 20, 3, 0)
    with pytest.raises(ValueError, match="invalid literal"):
        version_info.numbers_of("1.2.0rc1")
    calls = {}

    def record(kind):
        return lambda *told, **named: calls.setdefault(kind, []).append((told, named))

    kinds = "VSVersionInfo FixedFileInfo StringFileInfo StringTable StringStruct VarFileInfo VarStruct"
    eval(version_info.version_text("buskw", "1.20.3"), {kind: record(kind) for kind in kinds.split()})
    assert calls["FixedFileInfo"][0][1]["filevers"] == (1, 20, 3, 0)
    told = dict(each for each, _ in calls["StringStruct"])
    assert (told["OriginalFilename"], told["FileDescription"]) == ("buskw.exe", "Busk")


def test_icons_are_drawn_size_by_size(tmp_path):
    import icon_files  # noqa: PLC0415

    path = icon_files.write_ico("busk-project", tmp_path / "busk.ico")
    with Image.open(path) as icon:
        assert {size for size, _ in icon.info["sizes"]} == set(icon_files.ICO_SIZES)
        picture = icon.convert("RGBA")
    assert picture.getpixel((0, 0))[3] == 0
    assert picture.getpixel((128, 160))[3] == 255
    # What Pillow scales down of the largest would differ from what the drawing gives at that size.
    with Image.open(path) as icon:
        icon.size = (16, 16)
        kept = io.BytesIO()
        icon.save(kept, "PNG")
    assert Image.open(kept).convert("RGBA").tobytes() == icon_files.drawn("busk-project", 16).tobytes()


def test_the_installer_leaves_alone_what_is_not_its_own():
    commands = [line.split(";")[0].strip() for line in NSI.splitlines()]
    removed = [line for line in commands if line.startswith("RMDir /r")]
    assert removed == ['RMDir /r "$INSTDIR\\_internal"']
    assert not [line for line in commands if "HKLM" in line or "HKCR" in line or "SHCTX" in line]
    assert not [
        line for line in commands if re.search(r"\bPATH\b|Environment", line) and "App Paths" not in line
    ]
    assert "RequestExecutionLevel user" in commands
    keys = re.findall(r"DeleteRegKey (?:/ifempty )?HKCU \"([^\"]+)\"", NSI)
    assert keys
    assert "Software\\Busk" not in keys, "there the program keeps what its user chose"


def test_the_installer_undoes_what_it_writes():
    written = set(re.findall(r'WriteReg\w+ HKCU "([^"]+)"', NSI))
    removed = set(re.findall(r'DeleteReg\w+ (?:/ifempty )?HKCU "([^"]+)"', NSI))
    assert {
        key for key in written if not any(key == each or key.startswith(each + "\\") for each in removed)
    } == set()
    for link in re.findall(r'CreateShortCut "([^"]+)"', NSI):
        assert f'Delete "{link}"' in NSI


def test_the_installer_opens_what_the_program_opens_and_speaks_both_languages():
    offered = set(re.findall(r'insertmacro Opens "\.(\w+)"', NSI))
    tables = {"xyz", "pts", "txt", "csv", "gz"}  # endings that belong to others
    assert offered - {"busk"} == set(FORMATS) - tables
    said = re.findall(r'^!insertmacro Say (\w+) "([^"]+)" \\?\s*"([^"]+)"', WORDS, re.MULTILINE)
    assert {name for name, _, _ in said} == set(re.findall(r"\$\((\w+)\)", NSI))
    assert [name for name, _, japanese in said if japanese.isascii()] == []
