"""Lengths in the real window are in the unit in use: wherever one is written, painted, read out or a tip."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from ask_tools import answered
from garment_tools import chooser_of
from PySide6.QtCore import QObject, QSettings
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QComboBox, QStyle, QStyleOptionFrame, QTreeWidget
from window_tools import Script, points, run_main, settled
from worn_pair import released_design

import app.gui.features.uncertainty.controller
from app.gui.main_window import MainWindow
from app.gui.widgets.value_edit import InlineEdit
from app.i18n.catalog import LANGUAGES
from core.analysis.uncertainty.input_uncertainty import origins
from core.document.custom_measures import CustomMeasurement
from core.document.document import Document
from core.document.storage.project_file import save_project
from core.garment.elastic_library import built_in
from core.pipeline.build import build

pytestmark = pytest.mark.usefixtures("empty_house", "landmarks_known", "few_elastics")

WRITTEN = ("text", "toolTip", "accessibleName", "accessibleDescription", "whatsThis", "statusTip")
IN_MM = re.compile(r"(?<![A-Za-z])mm(?![A-Za-z])|millimetre|ミリ", re.IGNORECASE)
MEANT = re.compile(
    r"^(mm|Millimetres|ミリメートル)$"  # the unit of a file, to be chosen
    r"|in mm, z-up|mm、z が上|In mm, the trunk girth|mm では胴まわり"  # as files hold it
    r"|points in mm|制御点の表（mm）|in millimetres\.|プロッター用（mm）"
    r"|−20mm, 440mm|−20mm、440mm"  # what can be typed, whatever unit is shown
    r"|constant force per millimetre|1 ミリごとに"  # how cables answer
)


@pytest.fixture
def design(tmp_path: Path) -> str:
    """A small body with two lines, one of an elastic, and a girth at a height."""
    small = released_design()
    own = (
        CustomMeasurement("Ribs", "girth", ("waist_front",), 60.0),
        CustomMeasurement("Chest", "girth", (), 250.0),
    )
    worn = replace(small, own_measures=own).with_line("mid-bust", 0.93).with_line("full-bust", 0.95)
    elastic = next(each for each in built_in() if each.width_mm == 12.0)
    worn = worn.with_elastic("mid-bust", elastic)
    path = tmp_path / "plan.busk"
    save_project(path, Document.single(worn), build(worn).scan, None)
    return str(path)


@pytest.fixture
def painted(monkeypatch: pytest.MonkeyPatch) -> set[str]:
    """Return what is painted letter by letter, as it comes: it is no text of a widget."""
    found: set[str] = set()
    draw = QPainter.drawText

    def heard(painter: QPainter, *what: object) -> object:
        found.update(each for each in what if isinstance(each, str))
        return draw(painter, *what)

    monkeypatch.setattr(QPainter, "drawText", heard)
    return found


def written(root: QObject) -> Iterator[str]:
    """Give all that is written on, and told of, a widget and what is in it."""
    for each in (root, *root.findChildren(QObject)):
        for name in WRITTEN:
            if isinstance(text := each.property(name), str):
                yield text
        if isinstance(each, QComboBox):
            yield from (each.itemText(place) for place in range(each.count()))
        if isinstance(each, QTreeWidget):
            rows = [each.headerItem(), *(each.topLevelItem(row) for row in range(each.topLevelItemCount()))]
            yield from (row.text(column) for row in rows if row for column in range(each.columnCount()))


def too_narrow(root: QObject) -> Iterator[str]:
    """Give what a field has no room for."""
    for field in root.findChildren(InlineEdit):
        option = QStyleOptionFrame()
        field.initStyleOption(option)
        inside = field.style().subElementRect(QStyle.SubElement.SE_LineEditContents, option, field)
        room = (
            inside.width() - field.textMargins().right() - field.textMargins().left() - 4
        )  # Qt's own margin
        if field.isVisible() and field.fontMetrics().horizontalAdvance(field.text()) > room:
            yield field.text()


@pytest.mark.parametrize(("unit", "language"), [("in", "en"), ("cm", "ja")])
def test_no_length_is_left_in_millimetres(
    design: str, painted: set[str], unit: str, language: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(app.gui.features.uncertainty.controller, "PAUSE", 50)
    QSettings().setValue("unit", unit)
    QSettings().setValue("language", language)
    seen: dict[str, str] = {}
    cut_off: set[str] = set()

    def script(window: MainWindow) -> Script:
        yield settled(window)
        for where in every_part(window):
            if not isinstance(where, str):
                yield where
                continue
            for _ in range(6):
                yield lambda: True
            for text in (*written(window), *painted):
                seen.setdefault(text, where)
            painted.clear()
            cut_off.update(f"{where}: {each}" for each in too_narrow(window))

    assert run_main([design], script) == 0
    left = [f"{where}: {text}" for text, where in seen.items() if IN_MM.search(without_meant(text))]
    assert left == []
    assert sorted(cut_off) == []
    assert len([text for text in seen if re.search(rf"\d {unit}(?![A-Za-z])", text)]) > 60, "it was seen"


def without_meant(text: str) -> str:
    """Return a text without what is said of files, of what can be typed, and of measured values of others."""
    plain = text.replace("\N{WORD JOINER}", "")
    for code in LANGUAGES:
        for words in origins().values():
            plain = plain.replace(words.told(code), "")
    return MEANT.sub("", plain)


def every_part(window: MainWindow) -> Iterator[str | Callable[[], bool]]:
    """Show one part of the window after the other: gives its name once it is shown, or what to wait for."""
    for step in window.rail.items:
        window.navigation.show_step(step)
        yield step
    for name in ("garment", "variants", "history", "worn"):
        window.navigation.show_panel(name)
        yield name
    window.garment.rows["mid-bust"].elastic.click()
    yield lambda: not window.jobs.at_work()
    yield "chooser of elastics"
    chooser_of(window).close()
    window.model_controller.show()
    yield "model"
    for name in window.lines.rows:
        window.selection.select_line(name)
        yield name
    for name in window.landmarks.rows:
        window.selection.select_landmark(name)
        yield name
    for name in ("displacement", "strain", "sides", "pull", "pressure"):
        window.maps_controller.choose(name)
        window.maps_controller.pin(points(window)[0], "")
        yield name
    window.sections_controller.set_on(True)
    for axis in "xyz":
        window.sections_controller.choose_axis(axis)
        yield f"section {axis}"
    window.sections_controller.set_on(False)
    window.navigation.show_step("result")
    yield (
        lambda: (
            window.uncertainty_controller.shown[0] is not None and not window.uncertainty_controller.shown[1]
        )
    )
    yield "measures"
    window.custom_measures_controller.action.trigger()
    yield "custom measurements"
    window.ask_door.click()
    yield answered(window)
    yield "targets"
    window.target_shape_controller.card.cancel.click()
    yield settled(window)
    window.garment.elastics_requested.emit()
    yield "elastics"
    window.elastics_controller.sheet.close()
    window.export_controller.show()
    for what in window.export_controller.sheet.items:
        window.export_controller._choose_export(what)
        yield lambda: not window.jobs.at_work()
        yield f"export {what}"
    window.export_controller.sheet.close()
    window.report_controller.open()
    yield window.report_controller.page.does["pdf"].isEnabled
    yield "sheet"
