"""Scenes of what is asked for and of what advises: how sure, how even, how near to a worn scan."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from scenes import HOUSE, bra, wait_for

from app.gui.main_window import MainWindow
from core.analysis.inverse_design.profile_quantities import skin_of
from core.analysis.inverse_design.quantity import Goal
from core.deformation.tffd import deform
from core.export.mesh import write_mesh
from core.pipeline.build import Stages, build
from core.pipeline.solve import exact_solution

_NOISE = 1.0  # of the made scan [mm]


def wishing(window: MainWindow) -> None:
    """Ask for bust points higher up, and wait for the answer on the body."""
    wait_for(window.is_settled)
    window.view.viewport.set_view("left")
    window.target_shape_controller.begin([Goal("lift", 9.0)])
    wait_for(
        lambda: (
            window.target_shape_controller.answer is not None
            and not window.target_shape_controller.work.at_work
        )
    )
    wanted = window.target_shape_controller.answer.reply.design
    wait_for(lambda: window.session.frame.stages.design == wanted)


def drawing_a_profile(window: MainWindow) -> None:
    """Ask for a profile, drawn on the body as other lengths would make it, and wait for the answer."""
    wait_for(window.is_settled)
    desk = window.target_shape_controller
    desk.begin()
    wait_for(lambda: desk.answer is not None and not desk.work.at_work)
    desk.drawing.begin("left")
    profile = desk.drawn["profile left"]
    stages = window.session.frame.stages
    other = bra().with_line("strap left", 0.88).with_line("strap right", 0.88).with_line("mid-bust", 0.98)
    outs, _ = skin_of(stages, "left", profile.handle_positions[:, 0])(
        exact_solution(build(other, stages)).place.points
    )
    steps = np.stack([np.zeros(len(outs)), outs - profile.handle_positions[:, 1]], axis=1)
    desk.drawing.draw(
        "profile left", replace(profile, steps=steps, manual_handles=frozenset(range(len(outs))))
    )
    desk.ask()
    wait_for(lambda: desk.answer.reply is not None and not desk.work.at_work)
    wanted = desk.answer.reply.design
    wait_for(lambda: window.session.frame.stages.design == wanted)
    wait_for(lambda: window.session.is_at_rest and not window.jobs.at_work())


def sure(window: MainWindow) -> None:
    """Show how far measures and the curve of a section may be off."""
    window.navigation.show_step("result")
    window.sections_controller.set_on(True)
    window.result.select("bust_girth")
    wait_for(lambda: window.uncertainty_controller.shown[0] is not None and not window.jobs.at_work())


def even(window: MainWindow) -> None:
    """Show how left and right differ, in figures and on the body."""
    window.navigation.show_step("result")
    wait_for(lambda: not window.jobs.at_work())
    window.view.viewport.set_view("front")
    window.symmetry_controller.card.look.click()


def compared(window: MainWindow) -> None:
    """Compare with a scan that has the garment on, made by somewhat softer lines."""
    stages = window.session.frame.stages
    window.scan_comparison_controller.show_page()
    window.scan_comparison_controller.read(worn_scan(stages))
    wait_for(lambda: window.scan_comparison_controller.worn is not None and not window.jobs.at_work())
    window.maps_controller.choose("worn")
    window.scan_comparison_controller.calibrate()
    wait_for(lambda: not window.jobs.at_work())


def worn_scan(stages: Stages) -> str:
    """Write a scan with the garment on as another design predicts it; returns the file's name."""
    other = build(replace(bra(), line_stiffness=9.0, firm_chest=0.1), stages)
    places = deform(other.binding, exact_solution(other).place.points)
    places += _NOISE * np.random.default_rng(7).normal(size=places.shape)
    path = Path(HOUSE.name) / "customer 0412 in the bra.ply"
    write_mesh(path, stages.body.mesh.moved(places + np.array([120.0, -40.0, 15.0])))
    return str(path)
