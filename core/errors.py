"""Errors that a user can solve: a message, and a hint what to do."""

from core.messages import EMPTY, Message, join


class UserError(Exception):
    """A problem that the user can solve: ``message`` states what is wrong, ``hint`` what to do."""

    def __init__(self, message: Message, hint: Message = EMPTY) -> None:
        super().__init__(message)
        self.message = message
        self.hint = hint

    @property
    def text(self) -> Message:
        """Return the message and the hint as one message."""
        return join((self.message, self.hint))

    def __str__(self) -> str:
        return str(self.text)


def reason_of(problem: BaseException) -> str | Message:
    """Return what an exception states: its message, or its text without the number of an OSError."""
    first = problem.args[0] if problem.args else ""
    return getattr(problem, "strerror", None) or (first if isinstance(first, Message) else str(problem))


def as_exception(error: BaseException) -> Exception:
    """Return what a thread raised as an Exception: SystemExit and its like become a RuntimeError."""
    if isinstance(error, Exception):
        return error
    wrapped = RuntimeError(f"{type(error).__name__} in a thread: {error}")
    wrapped.__cause__ = error
    return wrapped


class ScanError(UserError):
    """The scan cannot be read, or it is not an upper body."""


class LandmarkError(UserError):
    """The bust landmarks cannot be found."""


class FitError(UserError):
    """The template control mesh cannot be fitted to the body."""


class LineError(UserError):
    """A constraining line is unknown, or its length cannot be asked for."""


class TissueError(LineError):
    """Solid tissue cannot be computed on the scan."""


class PatternError(UserError):
    """A block, a seam or a pattern piece cannot be made."""


class ProjectError(UserError):
    """The project file cannot be read or written."""


class SizeError(UserError):
    """A table of sizes cannot be read, or no size can be made of these girths."""
