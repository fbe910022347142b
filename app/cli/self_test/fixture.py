"""The bench of a self-test: a folder, the sample solved once, and the window while it is open."""

from __future__ import annotations

from contextlib import ExitStack
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.self_test.checks import check
from app.presenters.samples import sample_design
from core.document.design import Design
from core.document.document import Document

if TYPE_CHECKING:
    from app.gui.main_window import MainWindow
    from app.presenters.export import ExportSource
    from core.pipeline.build import Stages
    from core.pipeline.solve import Solution

MOVED = "mid-bust"
"""The line that is worn on the bench, and moved in the window."""


class Bench:
    """What the parts of a self-test share; what is worked out for one is there for the next."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.held = ExitStack()
        self.window: MainWindow | None = None
        self.heard: list[str] = []

    @cached_property
    def design(self) -> Design:
        """A design on the sample, one line of which is worn."""
        return sample_design().with_line(MOVED, 0.93)

    @cached_property
    def stages(self) -> Stages:
        """All that comes before solving."""
        from core.pipeline.build import build  # noqa: PLC0415 (what cannot be imported is told by the part it is for)

        return build(self.design)

    @cached_property
    def solution(self) -> Solution:
        """The design, solved by the adaptive control."""
        from core.pipeline.solve import solve  # noqa: PLC0415

        return solve(self.stages)

    @cached_property
    def outcome(self) -> ExportSource:
        """What files are written of."""
        from app.presenters.export import ExportSource  # noqa: PLC0415

        return ExportSource(self.solution.stages, self.solution.control_points, self.solution.records)

    @cached_property
    def project(self) -> Path:
        """The design as a project file."""
        from core.document.storage.project_file import save_project  # noqa: PLC0415

        path = self.folder / "self-test \N{LATIN SMALL LETTER E WITH ACUTE} 試し.busk"
        save_project(path, Document.single(self.design), self.stages.scan, None)
        return path

    def check_silence(self) -> None:
        """Raise PartError if something was heard since the last time."""
        heard, self.heard[:] = list(self.heard), []
        check(not heard, "; ".join(dict.fromkeys(heard)))

    def shown(self) -> MainWindow:
        """The window; it must be open."""
        assert self.window is not None, "the window is not open"
        return self.window
