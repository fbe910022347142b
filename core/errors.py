"""What can go wrong for a user, said in one sentence with what to do."""


class UserError(Exception):
    """A problem that the user can solve: ``message`` says what is wrong, ``hint`` what to do."""

    def __init__(self, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.message = message
        self.hint = hint

    def __str__(self) -> str:
        return f"{self.message} {self.hint}".strip()


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


class ProjectError(UserError):
    """The project file cannot be read or written."""


class SizeError(UserError):
    """A table of sizes cannot be read, or no size can be made of these girths."""
