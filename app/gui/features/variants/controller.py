"""Variants of the design: which is shown, a new one, one fewer, and all of them side by side."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Qt, Signal

from app.gui.widgets.basic import Segment, ToolButton
from app.gui.widgets.menu import Menu
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr
from app.presenters.assessment import AssessmentView
from app.presenters.variants import variant_titles
from core.document.design import Design
from core.document.document import VARIANTS
from core.pipeline.converged import converged_frame
from core.pipeline.frame import Frame

if TYPE_CHECKING:
    from app.gui.context import AppContext
    from app.gui.session.jobs import Job

_MOST_KEPT = 12


class VariantsController(QObject):
    """Own the ``segment`` A B C and the ``button`` of the title bar, and solve variants that are not shown.

    ``solved`` is emitted when one more of these is. ``assess`` returns the overall verdict of a frame.
    """

    solved = Signal()

    def __init__(self, context: AppContext, assess: Callable[[Frame], AssessmentView]) -> None:
        super().__init__(context.session)
        self._context, self._assess = context, assess
        self._session = context.session
        self._solved: dict[Design, Frame] = {}
        self._unsolvable: set[Design] = set()
        self._job: Job | None = None
        self._asked = False
        self._beside: dict[str, Design] | None = None
        self.segment = Segment([(name, name) for name in VARIANTS])
        self.segment.chosen.connect(self.choose)
        for name in VARIANTS:
            self._set_up(name)
        self._fill_menu()
        self.button = ToolButton("columns", action=self.beside)
        context.session.design_changed.connect(lambda _: self.show_variants())
        context.view.compared.connect(self._show_way)
        self.show_variants()

    def choose(self, name: str) -> None:
        """Show a variant; one that is not there yet begins as a copy of the one that is shown."""
        self._session.show_variant(name)
        self.show_variants()

    def set_shown(self, shown: bool) -> None:
        """Show or hide variants."""
        self.segment.setVisible(shown)
        self.show_variants()

    def show_variants(self) -> None:
        """Show which variants there are, and bring what is seen side by side up to date."""
        document = self._session.document
        there = document.variants if document is not None else {}
        shown = document.shown if document is not None else ""
        self.segment.setEnabled(document is not None)
        self.button.setVisible(len(there) > 1 and not self.segment.isHidden())
        self.segment.set_choice(shown)
        for name in VARIANTS:
            button = self.segment.button(name)
            text = (
                tr("Variant {name}") if name in there else tr("Variant {name}: starts as a copy of {shown}")
            )
            set_tip(button, text.format(name=name, shown=shown))
            button.setAccessibleName(button.toolTip())
            button.setText(name if name in there else f"+{name}")
        if self._context.view.beside.way == "variants" and self._beside != self._others():
            self.show_side_by_side()

    def show_side_by_side(self) -> None:
        """Show all variants side by side, as soon as those that are not worked on are solved."""
        document, frame = self._session.document, self._session.frame
        if document is None or frame is None:
            return
        others = self._others()
        if not others:
            self._beside = None
            if self._context.view.beside.way == "variants":
                self._context.view.compare_by("after")
            else:
                texts = (
                    tr("Only one variant."),
                    tr("Choose B or C at the top to create a copy."),
                )
                self._context.notifications.info(*texts)
            return
        missing = [each for each in others.items() if each[1] not in self._solved]
        self._asked = bool(missing)
        if missing:
            self._solve(*missing[0])
            return
        self._beside = others
        shown = [
            (name, None) if name == document.shown else (name, self._solved[design])
            for name, design in document.designs
        ]
        titles = variant_titles(self.frames(), self._assess)
        self._context.view.show_variants(
            [(title, each) for title, (_, each) in zip(titles, shown, strict=True)]
        )

    def flip_side_by_side(self) -> None:
        """Show all variants side by side, or the one that is worked on alone again."""
        if self._context.view.beside.way == "variants":
            self._context.view.compare_by("after")
        else:
            self.show_side_by_side()
        self._show_way()

    def frames(self) -> list[tuple[str, Design, Frame | None]]:
        """Return all variants, each with its frame if it is solved; that of the shown one may be at work."""
        document, frame = self._session.document, self._session.frame
        if document is None:
            return []
        variants = [(name, design, self._solved.get(design)) for name, design in document.designs]
        # While a line is dragged the frame is that of a design which is not decided yet.
        if frame is not None and (frame.is_running or frame.stages.design == document.design):
            place = [name for name, _ in document.designs].index(document.shown)
            variants[place] = (document.shown, frame.stages.design, frame)
        return variants

    def solve_others(self) -> None:
        """Solve one more unsolved variant, if any; ``solved`` is emitted after it."""
        for name, design in self._others().items():
            if design not in self._solved and design not in self._unsolvable:
                self._solve(name, design)
                return

    def close_side_by_side(self) -> None:
        """Forget what belongs to another body, and what is being solved for it."""
        self._context.jobs.cancel(self._job)
        self._job, self._asked = None, False
        self._solved.clear()
        self._unsolvable.clear()
        self._beside = None
        if self._context.view.beside.way == "variants":
            self._context.view.compare_by("after")
        self.show_variants()

    def _show_way(self) -> None:
        """Light what puts variants side by side as long as they are."""
        self.beside.setChecked(self._context.view.beside.way == "variants")

    def _others(self) -> dict[str, Design]:
        document = self._session.document
        if document is None:
            return {}
        return {name: design for name, design in document.designs if name != document.shown}

    def _solve(self, name: str, design: Design) -> None:
        near = self._session.frame
        if near is None or self._job in self._context.jobs.at_work():
            return
        self._job = self._context.jobs.run(
            tr("Solving variant {name}…").format(name=name),
            partial(converged_frame, design, near.stages),
            partial(self._take, design),
            partial(self._give_up, design),
            waited=True,
        )

    def _give_up(self, design: Design, error: Exception) -> None:
        self._job, self._asked = None, False
        self._unsolvable.add(design)
        self._context.notifications.error(error)

    def _take(self, design: Design, frame: object) -> None:
        if isinstance(frame, Frame):
            self._job = None
            self._solved[design] = frame
            for old in list(self._solved)[:-_MOST_KEPT]:
                del self._solved[old]
            if self._asked:
                self.show_side_by_side()
            self.solved.emit()

    def _set_up(self, name: str) -> None:
        button = self.segment.button(name)
        button.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        button.customContextMenuRequested.connect(
            lambda place: self._menu_of(name).popup(button.mapToGlobal(place))
        )

    def _menu_of(self, name: str) -> Menu:
        menu = Menu(self.segment)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        document = self._session.document
        there = document.variants if document is not None else {}
        remove = menu.addAction(tr("Remove variant {name}").format(name=name))
        remove.setEnabled(name in there and len(there) > 1)
        remove.triggered.connect(lambda: self._session.remove_variant(name))
        menu.addAction(self.beside)
        return menu

    def _fill_menu(self) -> None:
        actions = self._context.actions
        actions.submenu("edit", "variants", tr("Variants"))
        for place, name in enumerate(VARIANTS, start=1):
            text = tr("Variant {name}").format(name=name)
            actions.add("variants", text, f"Alt+{place}", do=partial(self.choose, name), of_document=True)
        actions.rule("variants")
        actions.add("variants", tr("Remove this variant"), do=self._remove_shown, of_document=True)
        sentence = tr("Show all variants side by side with linked cameras")
        title, flip = tr("Variants side by side"), self.flip_side_by_side
        self.beside = actions.add(
            "variants", title, "Shift+V", sentence, do=flip, checkable=True, of_document=True
        )

    def _remove_shown(self) -> None:
        if self._session.document is not None:
            self._session.remove_variant(self._session.document.shown)
