"""The packages that a batch run needs beside those of the program: the extra ``batch``."""

from __future__ import annotations

from importlib.util import find_spec

from core.errors import UserError
from core.messages import Message

PACKAGES = ("cryptography", "dask", "distributed", "psutil", "pyarrow")


def missing_error(why: str) -> UserError:
    """Return the error of a run without its packages."""
    return UserError(
        Message("A batch run needs packages that are not installed: {why}.", why=why),
        Message("Install Busk from its source with the extra batch."),
    )


def missing_packages() -> list[str]:
    """Return the packages of the extra that are not installed; none of them is loaded."""
    return [name for name in PACKAGES if find_spec(name) is None]
