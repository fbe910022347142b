"""A leaning body is set upright at the Scan step: by its measured lean, or by an angle that is typed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation
from window_tools import Script, run_bodiless, settled

from app.gui.main_window import MainWindow
from core.scan.body import read_scan
from core.scan.orientation.lean_angles import corrected_up, lean_angles
from core.scan.repair.clipping import clip_above
from tests.end_to_end.test_scan_edits import type_level

pytestmark = pytest.mark.usefixtures("empty_house")

LEAN = 18.0


@pytest.fixture
def leaning(tmp_path: Path, mannequin: Path) -> Path:
    """The mannequin leaning forward in a file that was cut level."""
    mesh = read_scan(mannequin).mesh
    turn = Rotation.from_euler("x", LEAN, degrees=True).as_matrix()
    mesh = mesh.moved(mesh.vertices @ turn.T)
    cut, _ = clip_above(mesh, 2, float(np.percentile(mesh.vertices[:, 2], 15)))
    path = tmp_path / "leaning.ply"
    trimesh.Trimesh(cut.vertices, cut.faces, process=False).export(path)
    return path


def lean(window: MainWindow) -> tuple[float, float]:
    assert window.session.frame is not None
    return lean_angles(window.session.frame.stages.body.pose)


def test_a_leaning_body_is_set_upright_in_steps_that_can_be_undone(leaning: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        notice, panel, stack = window.notices.notice(), window.scan.lean, window.session.undo_stack
        assert notice is not None
        assert "Set upright" in [words for words, _ in notice.actions]
        assert lean(window) == (0.0, 0.0)
        window.navigation.show_step("scan")
        assert panel.upright.isVisible()
        panel.upright.click()
        yield settled(window)
        assert lean(window) == pytest.approx((LEAN, 0.0), abs=6.0)
        assert not panel.upright.isVisible()
        type_level(panel.forward, f"{LEAN:.0f}")
        yield settled(window)
        assert lean(window) == pytest.approx((LEAN, 0.0), abs=0.1)
        type_level(panel.left, "-2")
        yield settled(window)
        assert lean(window) == pytest.approx((LEAN, -2.0), abs=0.3)  # its heading is found again
        type_level(panel.forward, "60")
        assert stack.count() == 3, "too large an angle is refused"
        for _ in range(3):
            window.actions_.undo.trigger()
            yield settled(window)
        assert lean(window) == (0.0, 0.0)

    run_bodiless([str(leaning)], script)


@pytest.mark.parametrize(("forward", "left"), [(12.0, 0.0), (-7.0, 3.0)])
def test_a_corrected_lean_is_read_back(mannequin: Path, forward: float, left: float) -> None:
    pose = read_scan(mannequin).pose
    again = read_scan(mannequin, up=corrected_up(pose, forward, left)).pose
    assert lean_angles(again) == pytest.approx((forward, left), abs=0.2)
