"""What the picture of a batch run shows: a season of made bodies in the bra of the samples."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import trimesh
from PySide6.QtWidgets import QWidget
from scenes import HOUSE, wait_for

from app.gui.main_window import MainWindow
from app.presenters.samples import sample_path

COUNT = 16


def ran(window: MainWindow) -> QWidget:
    """Run the design on a folder of scans, and select a body that is to be checked."""
    os.environ["HOME"] = HOUSE.name  # a picture shows no folder of this machine
    window.batch_controller.show()
    workspace = window.batch_controller.workspace
    assert workspace is not None
    dialog = workspace.dialog
    dialog.resize(1180, 760)
    workspace.choose_scans([str(_scans())])
    dialog.run.click()
    wait_for(lambda: not workspace.run.is_running)
    workspace.model.arrange()
    dialog.table.setCurrentIndex(workspace.model.index(1, 0))
    dialog.table.setFocus()
    return dialog


def _scans() -> Path:
    """Return a folder of bodies that are larger, wider or deeper than the samples, and a broken file."""
    folder, chance = Path(HOUSE.name) / "spring fittings", np.random.default_rng(3)
    if not folder.exists():
        folder.mkdir()
        for number in range(COUNT):
            body = trimesh.load(sample_path(("person", "mannequin")[number % 2]), process=False)
            body.apply_transform(np.diag([*(1.0 + chance.normal(0.0, [0.05, 0.05, 0.02])), 1.0]))
            body.export(folder / f"customer {number + 401:04}.ply")
        (folder / "customer 0417.ply").write_bytes(b"")
    return folder
