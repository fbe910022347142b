"""Renders the pictures of README and guide with the program itself: ``make docs-pictures``."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from PySide6.QtGui import QImage, QPainter

from app.wording.display import off_screen

off_screen()

HOUSE = TemporaryDirectory()
for kind in ("CONFIG", "DATA", "STATE", "CACHE"):  # what was open on this machine is nobody's business
    os.environ[f"XDG_{kind}_HOME"] = str(Path(HOUSE.name) / kind.lower())

import measure_pictures  # noqa: E402 - beside this file
from PySide6.QtWidgets import QApplication  # noqa: E402

from app.commands.picture import save_window, settled_window, wait_until  # noqa: E402
from app.main_window import MainWindow  # noqa: E402
from app.panels.rail import STEP_ICONS  # noqa: E402
from app.printing.figures import make_figures  # noqa: E402
from app.reporting.pages import pages_of  # noqa: E402
from app.reporting.paper import A4, UNITS  # noqa: E402
from app.wording.samples import sample_design  # noqa: E402
from core.design import Design  # noqa: E402
from core.elastics import find_elastic  # noqa: E402

DOCS = Path(__file__).parent.parent / "docs"
PICTURES = DOCS / "pictures"


def step(name: str) -> Callable[[MainWindow], None]:
    """Go to one of the steps."""
    return lambda window: window.desk.go_to(name)


def with_control_mesh(window: MainWindow) -> None:
    window.view.set_layer("control-mesh", True)


def wiped(window: MainWindow) -> None:
    window.desk.go_to("result")
    window.view.viewport.set_view("left")
    window.view.compare_by("wipe")


def mapped(window: MainWindow) -> None:
    window.desk.go_to("result")
    window.map_desk.choose("displacement")
    window.section_desk.set_on(True)


def pressed(window: MainWindow) -> None:
    """Look at the place that is pressed most."""
    window.desk.go_to("result")
    window.inspector.open("garment")
    wait_until(lambda: window.pressure_desk.shown is not None, QApplication.processEvents)
    view = window.view.viewport
    view.frame_points(view.scene.bands.spine("mid-bust")[0])
    window.pressure_desk.card.place.click()
    window.desk.select_line("")


def cut(window: MainWindow) -> None:
    """Show how long to cut the elastics."""
    window.desk.go_to("lines")
    window.inspector.open("garment")
    wait_until(lambda: window.pressure_desk.shown is not None, QApplication.processEvents)


def variants(window: MainWindow) -> None:
    window.variant_desk.choose("B")
    window.session.commit_line("mid-bust", "Mid-bust", 0.9)
    wait_until(window.is_settled, QApplication.processEvents)
    window.variant_desk.show_side_by_side()
    window.inspector.open("history")


def start_page(window: MainWindow) -> None:
    """Show the page with two projects that were saved before."""
    for name, ratio in (("Customer 0398", 0.97), ("Customer 0412", 0.92)):
        window.session.commit_line("mid-bust", "Mid-bust", ratio)
        wait_until(window.is_settled, QApplication.processEvents)
        window.session.save(str(Path(HOUSE.name) / f"{name}.busk"), window.desk._preview())
        window.session.finish_saving()
    window.start_desk.show_page()


def drawing(window: MainWindow) -> None:
    window.line_maker.add("straps")
    wait_until(window.is_settled, QApplication.processEvents)
    window.line_routing.begin("strap left")


def nothing(window: MainWindow) -> None:
    pass


def model_page(window: MainWindow) -> None:
    window.desk.show_model()


def asking(window: MainWindow) -> None:
    window.desk.go_to("scan")
    window.scan_desk.ask()
    wait_until(window.view.question.isVisible, QApplication.processEvents)


def reported(window: MainWindow) -> None:
    window.report_desk.open()
    wait_until(window.report_desk.page.does["pdf"].isEnabled, QApplication.processEvents)


def sliding() -> Design:
    design = replace(sample_design("person"), line_contact="sliding", firm_chest=0.1)
    return design.with_line("mid-bust", 0.93)


def vibrating() -> Design:
    return replace(sample_design().with_line("mid-bust", 0.62), volume="conventional")


def made_of_elastics() -> Design:
    design = sample_design()
    for name, elastic in (("full-bust", "picot 10"), ("mid-bust", "picot 10"), ("under-bust", "plush 15")):
        design = design.with_line(name, 0.78).with_elastic(name, find_elastic(elastic))
    return design


def for_somebody() -> Design:
    return replace(made_of_elastics(), customer="Customer 0412")


Shot = tuple[str, Design, dict[str, object], Callable[[MainWindow], None]]

DARK = {"dark": True, "language": "ja", "size": (1280, 800)}
SHOTS: tuple[Shot, ...] = (
    ("window", sample_design(), {"size": (1600, 1000)}, nothing),
    ("vibrating", vibrating(), {"dark": True, "size": (1280, 800)}, with_control_mesh),
    ("model", sliding(), {"size": (1280, 800)}, model_page),
    ("ask", sample_design("person"), {"size": (1280, 800)}, asking),
    ("wipe", sample_design(), {"size": (1280, 800)}, wiped),
    ("map", sample_design(), {"size": (1600, 1000)}, mapped),
    ("pressure", made_of_elastics(), {"size": (1280, 800)}, pressed),
    ("garment", made_of_elastics(), {"size": (1280, 800)}, cut),
    ("garment-dark-ja", made_of_elastics(), DARK, cut),
    ("report", for_somebody(), {"size": (1280, 800)}, reported),
    ("report-dark-ja", for_somebody(), DARK, reported),
    ("variants", sample_design(), {"size": (1280, 800)}, variants),
    ("path", sample_design(), {"size": (1280, 800)}, drawing),
    ("start", sample_design(), {"size": (1280, 800)}, start_page),
    *(
        (f"{name}{ending}", sample_design("person"), options, step(name))
        for name in STEP_ICONS
        for ending, options in (("", {"size": (1280, 800)}), ("-dark-ja", DARK))
    ),
)


def figures() -> None:
    """Draw the figures of the paper again, and write the page on them."""
    with TemporaryDirectory() as folder:
        page = make_figures(Path(folder))
        for drawn in sorted(Path(folder).glob("fig-*.png")):
            shutil.copy(drawn, PICTURES)
    (DOCS / "reproduction.md").write_text(page(pictures="pictures/", tables=False), encoding="utf-8")


def export_sheets() -> None:
    """Show what can be exported: a sheet of its own over the window."""
    for name, what, options in (("export", "lines", {}), ("export-dark-ja", "turntable", DARK)):
        with settled_window(made_of_elastics(), **options) as window:  # type: ignore[arg-type]
            desk = window.export_desk
            desk.show()
            assert desk.sheet is not None
            desk.sheet.items[what].click()
            wait_until(lambda: not window.jobs.at_work(), QApplication.processEvents)
            desk.sheet.grab().save(str(PICTURES / f"{name}.png"))
            desk.sheet.reject()


def printed_sheets() -> None:
    """Show the pages of a sheet as they are printed: 100 dots to an inch."""
    with settled_window(for_somebody()) as window:
        reported(window)
        handout = window.report_desk.handout
        assert handout is not None
        for name, language, page in (("sheet-1", "en", 0), ("sheet-2", "en", 1), ("sheet-1-ja", "ja", 0)):
            image = QImage(827, 1169, QImage.Format.Format_RGB32)
            image.fill(0xFFFFFF)
            painter = QPainter(image)
            painter.scale(827 / A4[0] / UNITS, 827 / A4[0] / UNITS)
            pages_of(handout, language).paint(painter, page)
            painter.end()
            image.save(str(PICTURES / f"{name}.png"))


def main() -> None:
    PICTURES.mkdir(parents=True, exist_ok=True)
    measure_pictures.draw(PICTURES / "measures")
    for name, design, options, prepare in SHOTS:
        with settled_window(design, **options) as window:  # type: ignore[arg-type]
            prepare(window)
            wait_until(window.is_settled, QApplication.processEvents)
            save_window(window, PICTURES / f"{name}.png")
        print(f"docs/pictures/{name}.png: {(PICTURES / f'{name}.png').stat().st_size // 1024} kB")
    export_sheets()
    printed_sheets()
    figures()


if __name__ == "__main__":
    main()
