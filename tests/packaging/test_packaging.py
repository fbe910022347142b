"""What goes into the frozen program, and the bill of it: on made-up entries, without building anything."""

from __future__ import annotations

import io
import re
import subprocess
import sys
import tarfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "packaging"))

import bill  # noqa: E402
import bill_part  # noqa: E402
import lean  # noqa: E402
import package  # noqa: E402

LINKS = {
    "vtkA.so": {"libvtkB.so", "libstdc++.so.6"},
    "libvtkB.so": {"libvtkC.so"},
    "libvtkC.so": set(),
    "libvtkAlone.so": {"libvtkC.so"},
}


def needs(source: str) -> set[str]:
    return LINKS[source]


def entry(place: str, kind: str = "BINARY") -> lean.Entry:
    return place, place.rsplit("/", 1)[-1], kind


@pytest.fixture
def one_module(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lean, "vtk_modules", lambda: frozenset({"vtkA"}))


@pytest.mark.usefixtures("one_module")
def test_a_library_stays_exactly_if_something_that_stays_is_linked_to_it() -> None:
    shipped = [entry("vtkmodules/vtkA.so", "EXTENSION"), entry("vtkmodules/vtkOther.so", "EXTENSION")]
    shipped += [entry(f"vtkmodules/{name}") for name in LINKS if name.startswith("lib")]
    kept, _ = lean.lean(shipped, [], needs)
    assert [place for place, _, _ in kept] == [
        "vtkmodules/vtkA.so",
        "vtkmodules/libvtkB.so",
        "vtkmodules/libvtkC.so",
    ]


@pytest.mark.usefixtures("one_module")
def test_a_link_goes_with_its_library() -> None:
    shipped = [entry("vtkmodules/vtkA.so", "EXTENSION"), entry("vtkmodules/libvtkB.so")]
    links = [
        ("libvtkB.so", "vtkmodules/libvtkB.so", "SYMLINK"),
        ("libvtkC.so", "vtkmodules/libvtkC.so", "SYMLINK"),
    ]
    _, data = lean.lean(shipped, links, needs)
    assert data == links[:1]


@pytest.mark.parametrize(
    ("place", "stays"),
    [
        ("PySide6/Qt/plugins/platforms/libqxcb.so", True),
        ("PySide6/Qt/plugins/platforms/libqoffscreen.so", True),
        ("PySide6/Qt/plugins/platforminputcontexts/libibusplatforminputcontextplugin.so", True),
        ("PySide6/Qt/plugins/platformthemes/libqgtk3.so", False),
        ("PySide6/Qt/plugins/tls/libqopensslbackend.so", False),
        ("libstdc++.so.6", False),
        ("libxcb-cursor.so.0", True),
    ],
)
def test_plugins_and_libraries_of_the_desktop_are_told_by_name(place: str, stays: bool) -> None:
    assert lean.wanted(place, "BINARY") is stays


def test_data_that_is_read_stays() -> None:
    assert lean.is_read("PySide6/Qt/translations/qtbase_ja.qm")
    assert not lean.is_read("PySide6/Qt/translations/qtbase_fr.qm")
    assert lean.is_read("resources/samples/mannequin.ply")
    assert not lean.is_read("numpy/_core/tests/data/a.csv")


def test_nothing_is_stripped_that_was_edited_after_linking_or_is_under_the_lgpl() -> None:
    untouched = [
        "numpy.libs/libscipy_openblas64_-1.so",
        "scipy.libs/libgfortran.so.5",
        "pillow.libs/libtiff.so.6",
    ]
    assert not any(map(lean.may_be_stripped, [*untouched, "PySide6/Qt/lib/libQt6Core.so.6"]))
    assert lean.may_be_stripped("vtkmodules/libvtkCommonCore.so")


def test_what_busk_takes_of_vtk_is_in_the_program() -> None:
    wanted = set()
    for path in (ROOT / "app").rglob("*.py"):
        wanted |= set(re.findall(r"from vtkmodules\.(vtk\w+)", path.read_text("utf-8")))
    assert wanted
    assert wanted <= lean.vtk_modules()


def test_busk_reads_and_writes_no_file_with_vtk() -> None:
    """The readers of VTK are left out: whoever calls one needs them back (packaging/lean.py)."""
    calls = re.compile(
        r"\bpv\.(read|save_meshio|get_reader)\b|\.export_(gltf|obj|vrml|html)\(|vtkmodules\.vtkIO"
    )
    texts = {path.name: path.read_text("utf-8") for path in (ROOT / "app").rglob("*.py")}
    assert [name for name, text in texts.items() if calls.search(text)] == []


@pytest.mark.skipif(sys.platform != "linux", reason="asks objdump of ELF files")
def test_libraries_tell_what_they_are_linked_to() -> None:
    import _ctypes  # noqa: PLC0415  (there is none on other systems)

    try:
        found = lean.linked_to(_ctypes.__file__)
    except FileNotFoundError:
        pytest.skip("objdump is not installed here")
    assert any(name.startswith("libffi") for name in found)


def test_a_bill_without_licence_or_text_is_refused() -> None:
    text = {"LICENSE": "Do what you like."}
    good = bill.Part("good", "1", "MIT", "python", text)
    bad = [
        bill.Part("nameless", "1", "", "python", text),
        bill.Part("wordless", "1", "MIT", "python", {"LICENSE": " "}),
        bill.Part("wrong", "1", "no such licence", "python", text),
    ]
    assert bill.faults([good]) == []
    assert [line.split()[0].strip(":") for line in bill.faults([good, *bad])] == [
        "nameless",
        "wordless",
        "wrong",
    ]


@pytest.mark.parametrize(
    "licence", ["LGPL-2.1-or-later", "GPL-3.0-or-later WITH GCC-exception-3.1", "MPL-2.0"]
)
def test_a_bill_without_the_whole_text_of_a_licence_that_wants_it_is_refused(licence: str) -> None:
    (name,) = bill_part.wanted_whole(licence)
    whole = bill.our_texts([name])
    assert bill.faults([bill.Part("part", "1", licence, "within", whole)]) == []
    (text,) = whole.values()
    for told in (text[: len(text) // 2], f"It is under {name}, see elsewhere."):
        assert bill.faults([bill.Part("part", "1", licence, "within", {"LICENSE": told})])


def test_every_row_that_names_its_texts_brings_whole_what_wants_to_be_whole() -> None:
    rows = [row for row in bill.KNOWN["within"] if bill_part.wanted_whole(row["licence"]) and "texts" in row]
    assert {"libquadmath", "Eigen", "Qt"} <= {row["name"] for row in rows}
    parts = [
        bill.Part(row["name"], "", row["licence"], "within", bill.our_texts(row["texts"])) for row in rows
    ]
    assert bill.faults(parts) == []


def test_a_package_with_compiled_files_or_fonts_must_say_what_is_inside(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    origins = {
        place: str(file.locate())
        for name in ("potpourri3d", "numpy")
        for file in bill.metadata.distribution(name).files or ()
        if (place := str(file)).endswith((".so", ".py", ".pyd"))
    }
    assert bill.unasked(origins) == []
    monkeypatch.setitem(bill.KNOWN, "within", [row for row in bill.KNOWN["within"] if row["of"] == "numpy"])
    (told,) = bill.unasked(origins)
    assert told.startswith("potpourri3d may bring")
    monkeypatch.setitem(bill.KNOWN, "nothing within", {"potpourri3d": "so it is said"})
    assert bill.unasked(origins) == []


def test_every_licence_that_is_known_is_one_that_the_world_knows() -> None:
    rows = [*bill.KNOWN["ours"], *bill.KNOWN["within"]]
    named = [
        *bill.KNOWN["python"].values(),
        *bill.KNOWN["system"].values(),
        *(row["licence"] for row in rows),
    ]
    assert [licence for licence in named if bill_part._problem(licence)] == []


def test_the_texts_that_the_bill_names_are_here() -> None:
    for row in bill.KNOWN["within"]:
        assert all(text.strip() for text in bill.our_texts(row.get("texts", ["MIT"])).values())
    for row in bill.KNOWN["ours"]:
        assert row["text"].startswith("site/") or (ROOT / row["text"]).is_file()


def test_a_bill_for_machines_has_what_cyclonedx_asks_for() -> None:
    parts = [bill.busk(), bill.Part("fmt", "", "MIT", "within", {"MIT.txt": "..."}, "vtk")]
    told = bill.cyclone(parts)
    assert (told["bomFormat"], told["specVersion"], told["version"]) == ("CycloneDX", "1.6", 1)
    assert told["metadata"]["component"]["name"] == "Busk"
    assert [row["bom-ref"] for row in told["components"]] == ["vtk-fmt"]
    assert told["components"][0]["licenses"] == [{"expression": "MIT"}]


def test_the_archive_is_the_same_whoever_packs_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    packed = []
    for mode, name in ((0o700, "one"), (0o755, "two")):
        program = tmp_path / name / "busk"
        (program / "_internal").mkdir(parents=True)
        (program / "busk").write_text("program")
        (program / "busk").chmod(mode)
        (program / "_internal" / "data").write_text(" data")
        stream = io.BytesIO()
        package.write_tar(stream, program, "busk-1")
        packed.append(stream.getvalue())
    assert packed[0] == packed[1]
    with tarfile.open(fileobj=io.BytesIO(packed[0])) as tar:
        assert tar.getnames() == [
            "busk-1/README.txt",
            "busk-1/busk",
            "busk-1/busk/_internal",
            "busk-1/busk/_internal/data",
            "busk-1/busk/busk",
        ]
        assert tar.getmember("busk-1/busk/busk").mode == 0o755


def test_a_step_that_there_is_not_is_refused() -> None:
    run = subprocess.run(
        [sys.executable, ROOT / "packaging" / "package.py", "bake"], capture_output=True, check=False
    )
    assert run.returncode == 2
    assert b"No such step: bake" in run.stderr
