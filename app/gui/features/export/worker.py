"""One file on its way out of the context."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from app.gui.session.jobs import Job
from app.i18n.catalog import tr
from app.presenters.export import ExportOptions, ExportSource
from app.presenters.export_preview import ExportPreview, prepare_export
from core.progress import Progress

if TYPE_CHECKING:
    from app.gui.context import AppContext


class ExportWorker:
    """Makes a file ready in a thread, draws its pictures piece by piece here, and writes it in a thread.

    Each of these is a job that the user waits for and may leave; then nothing is written. At the end a notice
    says what was written and where, or why not.
    """

    def __init__(
        self, context: AppContext, what: str, path: Path, outcome: ExportSource, manner: ExportOptions
    ) -> None:
        self._context, self.path, self._about = context, path, f"export {what}"
        self._make = partial(prepare_export, what, path, outcome, manner)
        self._job: Job | None = None

    @property
    def at_work(self) -> bool:
        """Return whether the file is still on its way."""
        return self._job in self._context.jobs.at_work()

    def begin(self) -> None:
        """Start the first job."""
        self._run(tr("Saving {name}…"), self._prepare, self._prepared)

    def _prepare(self, progress: Progress) -> tuple[ExportPreview, list[Path]]:
        ready = self._make()
        progress("writing", 0.05)
        return ready, [] if ready.draw else self._write(ready, None, progress)

    def _prepared(self, found: object) -> None:
        ready, files = cast(tuple[ExportPreview, list[Path]], found)
        if ready.draw is None:
            self._done(ready, files)
            return
        words, jobs = tr("Rendering {name}…").format(name=self.path.name), self._context.jobs
        self._job = jobs.run_pieces(
            words, ready.draw(), partial(self._drawn, ready), self._failed, waited=True
        )

    def _drawn(self, ready: ExportPreview, pictures: Any) -> None:
        write = partial(self._write, ready, pictures)
        self._run(tr("Saving {name}…"), write, lambda files: self._done(ready, cast(list[Path], files)))

    def _write(self, ready: ExportPreview, pictures: Any, progress: Progress) -> list[Path]:
        return ready.write(self.path, pictures, progress) or [self.path]

    def _run(self, words: str, work: Any, done: Any) -> None:
        text = words.format(name=self.path.name)
        self._job = self._context.jobs.run(text, work, done, self._failed, waited=True)

    def _failed(self, error: Exception) -> None:
        self._context.notifications.error(error, self._about)

    def _done(self, ready: ExportPreview, files: list[Path]) -> None:
        first, last = files[0].name, files[-1].name
        name = first if len(files) == 1 else tr("{first} to {last}").format(first=first, last=last)
        text = tr("{name} saved, {details}.") if ready.how else tr("{name} saved.")
        self._context.notifications.file_written(
            self._about, text.format(name=name, details=ready.how), str(files[0])
        )
