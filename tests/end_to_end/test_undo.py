"""After an undo the window is settled once the answer to it is there, not while another is on its way."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from window_tools import Script, points, run_bodiless, settled

from app.gui.main_window import MainWindow

pytestmark = pytest.mark.usefixtures("empty_house")


def test_an_undo_before_the_answer_waits_for_its_own(mannequin: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        before, session = points(window).copy(), window.session
        former = session.frame
        session.choose_template("120")
        session.undo_stack.undo()
        assert session.frame is former, "nothing has answered yet"
        assert not window.is_settled()
        yield settled(window)
        assert session.frame is not former
        assert np.allclose(points(window), before)
        assert session.frame.stages.design is session.design

    run_bodiless([str(mannequin)], script)
