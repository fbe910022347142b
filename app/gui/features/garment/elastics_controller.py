"""The library of elastics: shown, imported from tables, exported and deleted."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from app.gui.features.garment.elastics_dialog import ElasticsDialog
from app.gui.features.garment.panel import GarmentPanel
from app.gui.widgets.dialog import ask
from app.gui.widgets.file_dialogs import ask_file, ask_save
from app.i18n.catalog import tr
from app.i18n.lengths import length
from app.presenters.elastics import elastic_views
from core.document.elastic import Elastic
from core.document.storage.project_file import safe_name
from core.errors import UserError
from core.garment.elastic_library import (
    ALLOWANCE,
    built_in,
    library,
    read_elastic,
    remove_elastic,
    save_elastic,
    specified_allowance,
    user_elastics,
    write_elastic,
    write_template,
)

if TYPE_CHECKING:
    from app.gui.context import AppContext


class ElasticsController(QObject):
    """Show the dialog of elastics, and carry out its commands; refusals are shown in the dialog."""

    def __init__(self, context: AppContext, panel: GarmentPanel) -> None:
        super().__init__(context.session)
        self._context = context
        do = context.actions
        do.rule("lines")
        text = tr("View, import and delete elastics")
        do.add("lines", tr("Elastics…"), tip=text, do=self.show)
        text = tr("Show cut length, elastic and elongation of all active lines")
        do.add("lines", tr("Cut list"), tip=text, do=self._show_cuts, of_document=True)
        panel.elastics_requested.connect(self.show)
        self.sheet: ElasticsDialog | None = None

    def show(self) -> None:
        """Show the elastics there are."""
        self.sheet = sheet = ElasticsDialog(self._context.window)
        sheet.finished.connect(self._forget)
        sheet.import_requested.connect(self.bring_in)
        sheet.export_requested.connect(self.hand_on)
        sheet.template_requested.connect(self.save_template)
        sheet.delete_requested.connect(self.take_away)
        self._fill()
        sheet.open()

    def bring_in(self) -> None:
        """Prompt for a table of the user and add its elastic."""
        sheet = self.sheet
        path = ask_file(sheet or self._context.window, tr("Import elastic"))
        if not path or sheet is None:
            return
        try:
            elastic = _beside_ours(read_elastic(Path(path)))
            taken = elastic.name in {each.name for each in user_elastics()[0]}
            question = tr("A custom elastic {name} already exists. Replace it?").format(name=elastic.name)
            if taken and ask(sheet, question, "", [("replace", tr("Replace"))]) != "replace":
                return
            save_elastic(elastic)
            seams = "" if specified_allowance(Path(path)) else _assumed()
        except UserError as problem:
            sheet.notices.clear()
            sheet.notices.show_notice("bad", problem.message, problem.hint, lasting=True)
            return
        sheet.notices.clear()
        text = tr("Custom elastic {name} added.").format(name=elastic.name)
        sheet.notices.show_notice("ok", text, seams, lasting=bool(seams))
        self._fill(elastic.name)

    def hand_on(self, name: str) -> None:
        """Prompt for a file and write an elastic as a table."""
        design = self._context.session.design
        known = {each.name: each for each in (*(design.elastics if design else ()), *library().values())}
        title = tr("Export elastic")
        self._write(title, name, lambda path: write_elastic(path, known[name]), "")

    def save_template(self) -> None:
        """Prompt for a file and write an empty table."""
        hint = tr("Enter your measurements, then import the file.")
        self._write(tr("Export empty table"), "elastic", write_template, hint)

    def _write(self, title: str, name: str, write: Callable[[Path], None], hint: str) -> None:
        sheet = self.sheet
        path = ask_save(sheet or self._context.window, title, f"{safe_name(name)}.csv", "CSV (*.csv)", ".csv")
        if not path or sheet is None:
            return
        sheet.notices.clear()
        try:
            write(Path(path))
        except UserError as problem:
            sheet.notices.show_notice("bad", problem.message, problem.hint, lasting=True)
        else:
            sheet.notices.show_notice("ok", tr("{name} saved.").format(name=Path(path).name), hint)

    def take_away(self, name: str) -> None:
        """Delete a custom elastic after confirmation."""
        sheet = self.sheet
        question = tr("Delete elastic {name}?").format(name=name)
        text = tr(
            "The table of the elastic will be deleted from your folder. Projects that use the elastic keep "
            "the curve."
        )
        if sheet is None or ask(sheet, question, text, [("delete", tr("Delete"))]) != "delete":
            return
        try:
            remove_elastic(name)
        except UserError as problem:
            sheet.notices.show_notice("bad", problem.message, problem.hint, lasting=True)
        self._fill()

    def _fill(self, marked: str = "") -> None:
        sheet, design = self.sheet, self._context.session.design
        if sheet is None:
            return
        own, problems = user_elastics()
        sheet.set_elastics(elastic_views(own, built_in(), design.elastics if design else ()), marked)
        for problem in problems:
            sheet.notices.show_notice("warn", problem.message, problem.hint, lasting=True)

    def _show_cuts(self) -> None:
        self._context.navigation.show_step("lines")
        self._context.navigation.show_panel("garment")
        self._context.navigation.focus_panel()

    def _forget(self) -> None:
        self.sheet = None


def _assumed() -> str:
    """Return what goes into every length to cut though no table told it."""
    words = tr("The elastic has no seam allowance: {length} is added to each cut length.")
    return words.format(length=length(ALLOWANCE, 0))


def _beside_ours(elastic: Elastic) -> Elastic:
    """Return an elastic under a name that none of ours has: in lists they could not be told apart."""
    if elastic.name not in {each.name for each in built_in()}:
        return elastic
    return replace(elastic, name=tr("{name}, custom").format(name=elastic.name))
