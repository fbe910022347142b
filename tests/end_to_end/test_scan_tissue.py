"""The tissue that a scan opens on: solid, or the net where it leaves no room for a solid."""

from __future__ import annotations

from pathlib import Path
from typing import NoReturn

import pytest
from window_tools import Script, run_bodiless, settled

from app.gui.main_window import MainWindow
from core.pipeline import build as pipeline

pytestmark = pytest.mark.usefixtures("empty_house", "on_solid")


def test_a_scan_opens_on_solid_tissue(mannequin: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        assert window.session.design.tissue == "solid"
        assert not window.notices.isVisible()
        assert not window.session.unsaved

    run_bodiless([str(mannequin)], script)


def test_a_scan_without_room_for_a_solid_opens_on_the_net_and_says_so(
    mannequin: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def crossed(*_: object) -> NoReturn:
        raise ValueError("the chest wall crosses the skin")

    def script(window: MainWindow) -> Script:
        yield settled(window)
        monkeypatch.setattr(pipeline, "_condensed", pipeline._condensed.__wrapped__)
        monkeypatch.setattr(pipeline, "condense", crossed)
        window.session.open(str(mannequin))
        yield lambda: settled(window)() and window.notices.isVisible()
        assert window.session.design.tissue == "net"
        assert not window.session.unsaved
        shown = window.notices._shown
        assert shown is not None
        assert "The net is used as tissue." in shown.sentence

    run_bodiless([], script)
