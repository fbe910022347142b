"""What the pictures of the documentation show: designs, and how a window is brought to what is seen.

Imported by the scripts that draw once Qt draws off-screen and the folders of the program are their own.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from PySide6.QtWidgets import QApplication, QDialog, QWidget

from app.cli.commands.picture import wait_until
from app.gui.features.help.command_palette import CommandPalette
from app.gui.features.project.recent_files import forget_file, recent_files
from app.gui.main_window import MainWindow
from app.gui.session.settings import set_setting
from app.i18n.catalog import language
from app.presenters.samples import dressed_sample, sample_design, sample_path
from core.document.design import Design, ScanSource, new_design
from core.garment.elastic_library import find_elastic
from core.garment.presets import find_preset, with_preset
from core.pattern.block_library import find_block

Scene = Callable[[MainWindow], QWidget | None]
"""Brings a window to what is shown; returns the part that the picture is of, None for all of it."""

HOUSE = TemporaryDirectory()
"""Holds the projects and scans that pictures show the names of."""


def use_own_folders() -> None:
    """Let the program write into folders that are gone afterwards: what was open here is private."""
    for kind in ("CONFIG", "DATA", "STATE", "CACHE"):
        os.environ[f"XDG_{kind}_HOME"] = str(Path(HOUSE.name) / kind.lower())


def wait_for(ready: Callable[[], bool]) -> None:
    """Let events pass until something is so."""
    wait_until(ready, QApplication.processEvents)


# -- designs


def own_scan() -> Design:
    """Return a customer's scan as it is opened: nothing is told of it, no line is set."""
    path = Path(HOUSE.name) / "customer 0412.ply"
    if not path.exists():
        shutil.copy(sample_path("person"), path)
    return new_design(ScanSource(str(path)))


def bra() -> Design:
    """Return the lines of a bra on the net, on a customer's scan, the straps shorter than in the preset."""
    design = with_preset(replace(own_scan(), tissue="net"), find_preset("Bra"))
    for name in ("strap left", "strap right"):
        design = design.with_line(name, 0.98)
    return design


def in_bra() -> Design:
    """Return the bra of the samples on a customer's scan, its cups higher."""
    design = replace(dressed_sample("person"), scan=own_scan().scan)
    assert design.cup is not None
    return replace(design, cup=replace(design.cup, lift=25.0))


def for_customer() -> Design:
    """Return the same with the name of the customer."""
    return replace(in_bra(), customer="Customer 0412")


def sliding() -> Design:
    """Return a line that slides over a firm chest."""
    design = replace(sample_design("person"), line_contact="sliding", firm_chest=0.1)
    return design.with_line("mid-bust", 0.93)


def vibrating() -> Design:
    """Return a line far too short under the conventional force."""
    return replace(sample_design().with_line("mid-bust", 0.62), volume="conventional")


def made_of_elastics() -> Design:
    """Return three lines that are made of elastics."""
    design = sample_design()
    for name, elastic in (("full-bust", "picot 10"), ("mid-bust", "picot 10"), ("under-bust", "plush 15")):
        design = design.with_line(name, 0.78).with_elastic(name, find_elastic(elastic))
    return design


def for_somebody() -> Design:
    """Return the same with the name of a customer."""
    return replace(made_of_elastics(), customer="Customer 0412")


# -- scenes


def nothing(window: MainWindow) -> None:
    """Leave the window as it opens."""


def girdle(window: MainWindow) -> None:
    """Show the whole body, with the waist selected in the list."""
    window.selection.select_line("waist")
    window.view.viewport.frame_all()


def pattern(window: MainWindow) -> None:
    """Show the pieces of a two-part cup, with the cup seam selected."""
    window.navigation.show_step("pattern")
    controller = window.pattern_controller
    controller.choose_block(find_block("two-part-cup"))
    wait_for(controller.is_current)
    controller.select_seam("cup seam left")


def step(name: str) -> Scene:
    """Go to one of the steps."""

    def there(window: MainWindow) -> None:
        window.navigation.show_step(name)

    return there


def tab(name: str, line: str = "") -> Scene:
    """Open a tab beside the lines, with a line selected or as it is."""

    def there(window: MainWindow) -> None:
        window.navigation.show_step("lines")
        window.navigation.show_panel(name)
        if line:
            window.selection.select_line(line)
        if name == "garment":
            wait_for(lambda: window.pressure_controller.shown is not None)

    return there


def with_control_mesh(window: MainWindow) -> None:
    """Show the control mesh."""
    window.view.set_layer("control-mesh", True)


def wiped(window: MainWindow) -> None:
    """Wipe between before and after, seen from the front."""
    window.navigation.show_step("result")
    window.view.viewport.set_view("front")
    window.view.compare_by("wipe")
    window.selection.select_line("")


def mapped(window: MainWindow) -> None:
    """Show a map with the section plane."""
    window.navigation.show_step("result")
    window.maps_controller.choose("displacement")
    window.sections_controller.set_on(True)


def pressed(window: MainWindow) -> None:
    """Look at the place that is pressed most."""
    window.navigation.show_step("result")
    window.navigation.show_panel("garment")
    wait_for(lambda: window.pressure_controller.shown is not None)
    view = window.view.viewport
    view.frame_points(view.scene.bands.spine("mid-bust")[0])
    window.pressure_controller.card.place.click()
    window.selection.select_line("")


def pressed_most(window: MainWindow) -> None:
    """Go to the place that is pressed most."""
    tab("garment")(window)
    window.pressure_controller.card.place.click()


def pin_selected(window: MainWindow) -> None:
    """Select a landmark, seen from the front."""
    window.navigation.show_step("landmarks")
    window.view.viewport.set_view("front")
    window.landmarks.rows["bust_point_left"].click()


def variants(window: MainWindow) -> None:
    """Put two variants side by side."""
    window.variants_controller.choose("B")
    window.lines_controller.commit_length("mid-bust", 0.9)
    wait_for(window.is_settled)
    window.variants_controller.show_side_by_side()
    window.navigation.show_panel("variants")


def start_page(window: MainWindow) -> None:
    """Show the page with two projects that were saved before, and nothing else."""
    for path in recent_files():
        forget_file(path)
    for name, ratio in (("Customer 0398", 0.97), ("Customer 0412", 0.92)):
        window.lines_controller.commit_length("mid-bust", ratio)
        wait_for(window.is_settled)
        window.session.save(str(Path(HOUSE.name) / f"{name}.busk"), window.project_controller._preview())
        window.session.finish_saving()
    window.start_controller.show_page()


def drawing(window: MainWindow) -> None:
    """Lead a strap through other control points."""
    window.add_lines_controller.add("straps")
    wait_for(window.is_settled)
    window.path_tool.begin("strap left")


def model_page(window: MainWindow) -> None:
    """Open the page of all choices of the model."""
    window.model_controller.show()


def asking(window: MainWindow) -> None:
    """Ask which way the front is."""
    window.navigation.show_step("scan")
    window.scan_controller.ask()
    wait_for(window.view.question.isVisible)


def reported(window: MainWindow) -> None:
    """Show the sheet to work from."""
    window.report_controller.open()
    wait_for(window.report_controller.page.does["pdf"].isEnabled)


def touring(window: MainWindow) -> None:
    """Begin the tour."""
    window.start_controller.take_tour()
    wait_for(lambda: window.is_settled() and window.start_controller.tour.mark.isVisible())


def verdict(window: MainWindow) -> QWidget:
    """Show the strip under the view alone."""
    return window.strip


def preferring(window: MainWindow) -> None:
    """Open the preferences, the language of the window chosen."""
    set_setting("language", language())
    window.preferences_controller.show()


def sheet(show: Callable[[MainWindow], object]) -> Scene:
    """Open a sheet over the window, and show it alone."""

    def there(window: MainWindow) -> QWidget:
        before = set(window.findChildren(QDialog))
        show(window)
        opened = (each for each in window.findChildren(QDialog) if each not in before and each.isVisible())
        return next(opened)

    return there


def searched(window: MainWindow) -> None:
    """Search the commands by a word of the trade."""
    window.help_controller.find_command()
    found = next(each for each in window.findChildren(CommandPalette) if each.isVisible())
    found.search.setText("カップ" if language() == "ja" else "lift")


def exporting(what: str) -> Callable[[MainWindow], None]:
    """Open the sheet of the export with one of its kinds chosen."""

    def there(window: MainWindow) -> None:
        desk = window.export_controller
        desk.show()
        assert desk.sheet is not None
        desk.sheet.items[what].click()
        wait_for(lambda: not window.jobs.at_work())

    return there
