"""Of which design the result is asked: the session's, or what is made of it first."""

from __future__ import annotations

from collections.abc import Callable

from app.gui.session.session import Session
from app.presenters.target_shape import missing_input_text
from core.document.design import Design


class TargetDesign:
    """Holds the ``design`` that is asked, until ``leave``; ``said`` tells what was made of the session's."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._prepare: Callable[[Design], Design] | None = None
        self.design: Design | None = None
        self.said = ""

    def begin(self, prepare: Callable[[Design], Design] | None, text: str) -> None:
        """Use what ``prepare`` makes of the session's design."""
        self._prepare, self.said = prepare, text if prepare is not None else ""
        self.follow()

    def follow(self) -> None:
        """Use the session's present design."""
        design = self._session.design
        self.design = design if design is None or self._prepare is None else self._prepare(design)

    def leave(self) -> None:
        """Use no design."""
        self._prepare, self.design, self.said = None, None, ""

    @property
    def missing(self) -> str:
        """Return what has to be done before targets can be solved, if anything."""
        # What is prepared is not in the frame yet; that its lines can move something is known.
        if self._prepare is not None or self.design is None:
            return ""
        return missing_input_text(self.design, self.moving)

    @property
    def asks(self) -> bool:
        """Return whether there are lines that can be asked for anything."""
        return self._session.frame is not None and self.design is not None and not self.missing

    @property
    def inactive(self) -> tuple[str, ...]:
        """Return the lines of the bust that are off and could move it; below are too many to list."""
        design = self.design
        if design is None:
            return ()
        active = design.all_active_lines()
        off = (name for name in self.moving if design.line_group(name) == "bust" and name not in active)
        return tuple(name for name in off if not design.line_settings(name).locked)

    @property
    def moving(self) -> list[str]:
        """Return the lines that lie on points which move."""
        frame = self._session.frame
        return [] if frame is None else [line.name for line in frame.stages.lines if line.constrains]
