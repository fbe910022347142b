"""One thread of BLAS: two make products of a few hundred rows many times slower."""

from __future__ import annotations

from contextlib import AbstractContextManager
from functools import cache

import scipy.linalg  # noqa: F401 (its BLAS must be loaded to be found)
from threadpoolctl import ThreadpoolController


def one_blas_thread() -> AbstractContextManager[object]:
    """Return a context in which BLAS uses one thread."""
    limited: AbstractContextManager[object] = _controller().limit(limits=1)
    return limited


@cache
def _controller() -> ThreadpoolController:
    """Return what is known of the loaded libraries: looking for them takes a hundred times as long."""
    return ThreadpoolController()
