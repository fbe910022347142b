"""``busk export``: every file that it writes, through the real command, and its refusals."""

import json
from pathlib import Path
from xml.etree import ElementTree

import ezdxf
import pytest
import trimesh
from PIL import Image

from app.cli.commands import export as exported
from app.cli.main import main
from core.document.design import Design, ScanSource
from core.document.document import Document
from core.document.storage.project_file import ScanFile, save_project
from core.pipeline.build import build

SAMPLES = Path(__file__).parents[3] / "resources" / "samples"
SCAN = SAMPLES / "mannequin.ply"
OPTIONS = {"control": "control-mesh", "flat": "strips", "measures": "measurements"}


@pytest.fixture(scope="module")
def anna(tmp_path_factory):
    design = Design(ScanSource(str(SCAN))).with_line("mid-bust", 0.95)
    path = tmp_path_factory.mktemp("projects") / "anna.busk"
    save_project(path, Document.single(design), ScanFile(SCAN.name, SCAN.read_bytes()), None)
    return str(path)


def test_all_files_of_a_project_at_once(tmp_path, anna, capsys):
    names = {"body": "x.glb", "control": "y.obj", "lines": "z.dxf", "flat": "w.svg", "measures": "m.smis"}
    words = [
        word
        for what, name in names.items()
        for word in (f"--{OPTIONS.get(what, what)}", str(tmp_path / name))
    ]
    turn = ["--turntable", str(tmp_path / "t.gif"), "--frames", "2", "--size", "64x64"]
    assert main(["export", anna, *words, *turn]) == 0
    said = capsys.readouterr()
    written = [str(tmp_path / name) for name in [*names.values(), "t.gif"]]
    assert [line.partition(": ")[0] for line in said.out.splitlines()][: len(written)] == written
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted([*names.values(), "t.gif"])
    body, control = (trimesh.load_mesh(tmp_path / names[what]) for what in ("body", "control"))
    assert 0.4 < body.extents[1] < 0.7  # metres, y up
    assert 100.0 < control.extents[2] < 400.0  # millimetres, z up
    with Image.open(tmp_path / "t.gif") as picture:
        assert picture.n_frames == 2
    layers = {each.dxf.layer for each in ezdxf.readfile(tmp_path / "z.dxf").modelspace()}
    assert layers == {"mid-bust front", "mid-bust back"}
    assert "Mid-bust" in (tmp_path / "w.svg").read_text("utf-8")
    measures = ElementTree.parse(tmp_path / "m.smis").getroot()
    assert measures.findtext("unit") == "cm"
    assert f"{len(list(measures.iter('m')))} measurements" in said.out


def test_unit_and_axes_are_those_of_the_options(tmp_path, anna):
    words = ["--unit", "cm", "--axes", "y-up"]
    assert main(["export", anna, "--body", str(tmp_path / "x.ply"), *words]) == 0
    assert main(["export", anna, "--body", str(tmp_path / "y.glb")]) == 0
    centimetres, metres = (trimesh.load_mesh(tmp_path / name).bounds for name in ("x.ply", "y.glb"))
    assert centimetres == pytest.approx(100.0 * metres, abs=1e-3)


def test_original_is_the_undeformed_body(tmp_path, anna):
    for name, words in (("before", ["--original"]), ("after", [])):
        files = ["--body", str(tmp_path / f"{name}.ply"), "--measurements", str(tmp_path / f"{name}.json")]
        assert main(["export", anna, *files, "--unit", "mm", *words]) == 0
    before, after = (trimesh.load_mesh(tmp_path / f"{name}.ply") for name in ("before", "after"))
    rest = build(Design(ScanSource(str(SCAN)))).body.mesh
    assert abs(before.vertices - rest.vertices).max() < 1e-3 < abs(after.vertices - rest.vertices).max()
    told = [json.loads((tmp_path / f"{name}.json").read_text("utf-8")) for name in ("before", "after")]
    assert told[0]["measures"]["bust_girth"] != told[1]["measures"]["bust_girth"]
    assert "original" in told[0]["note"]
    assert "apex_lift" not in told[0]["measures"]


def test_a_scan_is_exported_with_the_given_lines(tmp_path, capsys):
    words = ["--line", "under-bust=97%", "--strips", str(tmp_path / "w.dxf")]
    assert main(["export", str(SCAN), *words]) == 0
    assert "Under-bust" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ([], "No output specified"),
        (["--body", "x.step"], ".step files are not supported for export"),
        (["--lines", "x.svg"], "Lines cannot be exported as .svg"),
        (["--strips", "x.pdf"], "Lines cannot be exported as .pdf"),
        (["--measurements", "x.xls"], "Measurements cannot be exported as .xls"),
        (["--measurements", "x.vit", "--unit", "m"], ".vit files do not support the unit m."),
        (["--turntable", "x.mp4"], "Turntables cannot be exported as .mp4"),
        (["--turntable", "x.gif", "--frames", "1"], "turntable frames 1 is out of range"),
        (["--body", "x.ply", "--unit", "ell"], "There is no unit 'ell'"),
        (["--body", "x.ply", "--axes", "x-up"], "There is no axis convention 'x-up'"),
        (["--body", "x.ply", "--control-mesh", "x.ply"], "x.ply is specified for two outputs"),
    ],
)
def test_invalid_files_are_refused_before_solving(monkeypatch, capsys, anna, words, said):
    monkeypatch.setattr(exported, "build", lambda *_: pytest.fail("it has begun to solve"))
    assert main(["export", anna, *words]) == 2
    assert said in capsys.readouterr().err


def test_lines_of_a_design_without_active_lines_are_refused(tmp_path, capsys):
    assert main(["export", str(SCAN), "--lines", str(tmp_path / "z.dxf")]) == 2
    assert "No active lines. Set a line length first." in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []
