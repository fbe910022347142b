"""What becomes of the run when one of its processes dies."""

from typing import Any

import pytest


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: Any, error: object) -> None:
    """A process that dies is a failure, also where none of its tests had begun."""
    if error:
        node.config.pluginmanager.get_plugin("session").testsfailed += 1
