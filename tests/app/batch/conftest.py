"""Commands and processes of bodies use the loops as they are defined; other tests may have compiled them."""

from __future__ import annotations

import pytest

from core.geometry import kernels


@pytest.fixture(autouse=True)
def loops_of_commands(monkeypatch: pytest.MonkeyPatch) -> None:
    """Take back the compiled loops, whose results differ in the last digits."""
    monkeypatch.setattr(kernels, "_forms", kernels._Forms())
