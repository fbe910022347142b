"""Choice of the design of a batch run: the open one, a preset, a project, or that of the results shown."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from app.batch.batch_design import BatchDesign, batch_design, preset_design
from app.gui.features.batch.setup import BatchSetup
from app.gui.widgets.file_dialogs import ask_project
from app.i18n.catalog import listed, tr
from app.presenters.messages import preset_title
from core.document.design import Design, ScanSource
from core.document.storage.project_file import open_project
from core.errors import UserError
from core.garment.presets import Preset, built_in, user_presets

if TYPE_CHECKING:
    from app.gui.context import AppContext

OPEN, STORED, PRESET, PROJECT = "open", "stored", "preset", "project"


class DesignChoice(QObject):
    """Fill the menu of designs, and return the chosen ones.

    ``changed`` when another one is chosen, ``failed`` carries why a project cannot be read. What is chosen is
    kept as it was: edits of the open design count until a run starts.
    """

    changed = Signal()
    failed = Signal(object)

    def __init__(self, context: AppContext, setup: BatchSetup) -> None:
        super().__init__(setup)
        self._context, self._setup = context, setup
        self.kind = OPEN
        self._fixed: list[BatchDesign] = []
        self._stored: list[BatchDesign] = []
        setup.design_field.menu_.aboutToShow.connect(self._fill)
        context.session.design_changed.connect(lambda _: self.follow())
        self.follow()

    @property
    def name(self) -> str:
        """Return what the design is called, empty without one."""
        designs = self.designs()
        if self.kind == OPEN:
            return self._context.session.name if designs else ""
        return designs[0].name if designs else ""

    def designs(self) -> list[BatchDesign]:
        """Return the chosen designs; none if no design is open, or no variant is chosen."""
        if self.kind != OPEN:
            return list(self._fixed)
        session = self._context.session
        if session.document is None:
            return []
        variants = session.document.variants
        if len(variants) == 1:
            return [_neutral(session.name, session.document.design)]
        chosen = self._setup.chosen_variants
        return [_neutral(f"{session.name} {name}", each) for name, each in variants.items() if name in chosen]

    def choose_open(self) -> None:
        """Choose the open design."""
        self._pick(OPEN, [])

    def keep(self, designs: Sequence[BatchDesign]) -> None:
        """Choose the designs of the results shown, whatever is edited or opened from now on."""
        self._stored = self._fixed = list(designs)
        self._choose(STORED)

    def offer(self, designs: Sequence[BatchDesign]) -> None:
        """Offer the designs of the results shown; what is chosen stays."""
        self._stored = list(designs)

    def follow(self) -> None:
        """Show the open design with its variants, if it is chosen."""
        document = self._context.session.document
        if self.kind != OPEN:
            text = listed(each.name for each in self._fixed)
            shown = tr("{name} (design of the results)") if self.kind == STORED else "{name}"
            self._setup.set_design(shown.format(name=text), ())
        elif document is None:
            self._setup.set_design(tr("Choose design…"), ())
        else:
            former = self._setup.variants
            chosen = self._setup.chosen_variants if former else [document.shown]
            boxes = [(name, name in chosen) for name in document.variants]
            title = tr("{name} (current design)").format(name=self._context.session.name)
            self._setup.set_design(title, boxes)

    def _fill(self) -> None:
        """List what there is now: presets may have come."""
        menu, session = self._setup.design_field.menu_, self._context.session
        menu.clear()
        if session.document is not None:
            text = tr("{name} (current design)").format(name=session.name)
            menu.addAction(text, self.choose_open)
        if self._stored:
            text = tr("{name} (design of the results)").format(
                name=listed(each.name for each in self._stored)
            )
            menu.addAction(text, lambda: self._pick(STORED, self._stored))
        menu.addSeparator()
        presets = menu.add_submenu(tr("Presets"))
        for preset in (*built_in(), *user_presets()[0]):
            presets.addAction(preset_title(preset), partial(self._pick_preset, preset))
        menu.addAction(tr("Project file…"), self._ask_project)

    def _pick_preset(self, preset: Preset) -> None:
        self._pick(PRESET, [_neutral(*preset_design(preset))])

    def _ask_project(self) -> None:
        path = ask_project(self._setup.window(), tr("Design of a project"))
        if not path:
            return
        try:
            self._pick(PROJECT, [_neutral(Path(path).stem, open_project(path).design)])
        except UserError as problem:
            self.failed.emit(problem)

    def _pick(self, kind: str, designs: Sequence[BatchDesign]) -> None:
        self._fixed = list(designs)
        self._choose(kind)
        self.changed.emit()

    def _choose(self, kind: str) -> None:
        self.kind = kind
        self.follow()


def _neutral(name: str, design: Design) -> BatchDesign:
    """Return a design without what is of its own body: unit and axes of each scan are detected."""
    return batch_design(name, replace(design, scan=ScanSource("")), (), (), ())
