"""A small project and a scan with its garment on, which needs other numbers than the project has."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from benchmarks.worn_pairs import scanned, worn_mesh, written
from core.document.design import Design
from core.document.document import Document
from core.document.storage.project_file import open_project, save_project
from core.pipeline.build import build


def released_design() -> Design:
    """Return the design of a released project, on a body of 2,100 corners."""
    return open_project(Path(__file__).parents[1] / "releases/0.1.0/first.busk").design


def write_worn_pair(folder: Path, hole: float) -> tuple[str, str, str]:
    """Write a project, its worn scan with a hole [mm], and a scan of another body; return the paths."""
    design = replace(released_design(), volume="exact", firm_chest=0.03).with_line("mid-bust", 0.88)
    stages = build(design)
    truth = worn_mesh(stages, replace(design, line_stiffness=6.0, firm_chest=0.1))
    mesh, _ = scanned(truth, stages, np.random.default_rng(4), noise=0.2, resampled=False, hole=hole)
    project = folder / "plan.busk"
    save_project(project, Document.single(design), stages.scan, None)
    other = stages.body.mesh.moved(stages.body.mesh.vertices * (1.15, 1.0, 1.0))
    return str(project), written(mesh, folder / "worn.ply"), written(other, folder / "other.ply")
