"""Results of a folder in the table and the distributions: read beside the window, extended by a run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from PySide6.QtCore import QObject, Signal

from app.batch.batch_design import BatchDesign, content_key
from app.batch.design_file import stored_key
from app.batch.schema import NUMBER, columns_of, measure_keys
from app.batch.stored_rows import has_results, read_results
from app.gui.features.batch.dialog import BatchDialog
from app.gui.session.jobs import Job
from app.gui.session.settings import get_setting
from app.i18n.catalog import tr
from app.presenters.batch import BatchRow, Cells, batch_row, counts_text
from app.presenters.batch_distribution import distribution, plotted_columns
from core.errors import UserError
from core.measurements.sizes import built_in
from core.progress import Progress

if TYPE_CHECKING:
    from app.gui.context import AppContext

_Loaded = tuple[list[BatchDesign], list[BatchRow]]


class BatchResults(QObject):
    """Fill table and distributions; ``loaded`` carries the designs of results that were read."""

    loaded = Signal(list)

    def __init__(self, context: AppContext, dialog: BatchDialog) -> None:
        super().__init__(dialog)
        self._context, self._dialog, self._model = context, dialog, dialog.model
        self._designs: list[BatchDesign] = []
        self._numbers: list[str] = []
        self._folder: Path | None = None
        self._job: Job | None = None
        self._model.arranged.connect(self._show)
        dialog.card.chosen.connect(self._show_distribution)
        self._show()

    def is_of_other(self, folder: Path, designs: Sequence[BatchDesign]) -> bool:
        """Return whether a folder holds the results of other designs."""
        return stored_key(folder) not in (None, content_key(designs))

    def show_folder(self, folder: Path) -> None:
        """Show the results in a folder, nothing if there are none."""
        if folder != self._folder:
            self._folder = folder
            self._begin([])
        self.load()

    def load(self) -> None:
        """Read the results of the folder again."""
        folder = self._folder
        self._context.jobs.cancel(self._job)
        if folder is not None and has_results(folder):
            text = tr("Reading results…")
            self._job = self._context.jobs.run(
                text, lambda progress: _read(folder, progress), self._take, self._fail
            )

    def begin(self, folder: Path, designs: Sequence[BatchDesign]) -> None:
        """Prepare for the rows of a run; rows of these designs that are shown, or in the folder, stay."""
        is_shown = folder == self._folder and content_key(designs) == content_key(self._designs)
        self._folder = folder
        if not is_shown:
            self._begin(designs)
            self.load()

    def add(self, rows: Sequence[Mapping[str, Any]]) -> None:
        """Add rows as a run prints them."""
        self._model.add([batch_row(row, self._numbers) for row in rows])

    def design_of(self, row: BatchRow) -> BatchDesign | None:
        """Return the design that a row was computed with."""
        return next((each for each in self._designs if each.name == row.variant), None)

    def _begin(self, designs: Sequence[BatchDesign]) -> None:
        self._context.jobs.cancel(self._job)
        self._designs = list(designs)
        numeric = [each for each in columns_of(designs) if each.kind == NUMBER]
        self._numbers = [each.name for each in numeric]
        places = {name: place for place, name in enumerate(self._numbers)}
        system = get_setting("size_system")
        known = system if system in {table.key for table in built_in()} else "jp"
        plotted = plotted_columns([(each.name, each.unit) for each in numeric], measure_keys())
        self._dialog.card.set_columns(plotted if designs else [])
        self._model.begin(Cells(places, known), several=len(designs) > 1)

    def _take(self, loaded: object) -> None:
        designs, rows = cast(_Loaded, loaded)
        running = bool(self._designs) and content_key(designs) == content_key(self._designs)
        if not running:
            self._begin(designs)
        self._model.add(row for row in rows if row.key not in self._model.rows or not running)
        self._model.arrange()
        self.loaded.emit(designs)

    def _fail(self, problem: Exception) -> None:
        if isinstance(problem, UserError):
            self._dialog.notices.show_notice("bad", problem.message, problem.hint, lasting=True)
        else:
            self._context.notifications.error(problem)

    def _show(self) -> None:
        dialog, model = self._dialog, self._model
        dialog.show_rows(bool(model.rows))
        dialog.counts.setText(counts_text(model.rows.values()))
        self._show_distribution()

    def _show_distribution(self) -> None:
        card, model = self._dialog.card, self._model
        shown = None
        if card.column is not None and model.shown:
            place, names = self._numbers.index(card.column.name), [each.name for each in self._designs]
            shown = distribution(model.shown, card.column, place, names)
        card.show_distribution(shown)


def _read(folder: Path, progress: Progress) -> _Loaded:
    designs, rows = read_results(folder, progress)
    numbers = [each.name for each in columns_of(designs) if each.kind == NUMBER]
    return designs, [batch_row(row, numbers) for row in rows]
