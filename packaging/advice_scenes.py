"""Scenes of what advises: how sure figures are, how even left and right are, a scan with the garment on."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from scenes import HOUSE, bra, wait_for

from app.main_window import MainWindow
from core.answer import answer_of
from core.export import write_mesh
from core.pipeline import Stages, build
from core.tffd import deform

_NOISE = 1.0  # of the made scan [mm]


def sure(window: MainWindow) -> None:
    """Show how far measures and the curve of a section may be off."""
    window.desk.go_to("result")
    window.section_desk.set_on(True)
    window.result.select("bust_girth")
    wait_for(lambda: window.spread_desk.shown[0] is not None and not window.jobs.at_work())


def even(window: MainWindow) -> None:
    """Show how left and right differ, in figures and on the body."""
    window.desk.go_to("result")
    wait_for(lambda: not window.jobs.at_work())
    window.view.viewport.set_view("front")
    window.even_desk.card.look.click()


def compared(window: MainWindow) -> None:
    """Compare with a scan that has the garment on, made by somewhat softer lines."""
    stages = window.session.frame.stages
    window.worn_desk.show_page()
    window.worn_desk.read(worn_scan(stages))
    wait_for(lambda: window.worn_desk.worn is not None and not window.jobs.at_work())
    window.map_desk.choose("worn")
    window.worn_desk.calibrate()
    wait_for(lambda: not window.jobs.at_work())


def worn_scan(stages: Stages) -> str:
    """Write a scan with the garment on as another design predicts it; returns the file's name."""
    other = build(replace(bra(), line_stiffness=9.0, firm_chest=0.1), stages)
    places = deform(other.binding, answer_of(other).place.points)
    places += _NOISE * np.random.default_rng(7).normal(size=places.shape)
    path = Path(HOUSE.name) / "customer 0412 in the bra.ply"
    write_mesh(path, stages.body.mesh.moved(places + np.array([120.0, -40.0, 15.0])))
    return str(path)
