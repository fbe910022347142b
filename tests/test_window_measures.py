"""The tab of measures in the real window: the body measured once the run rests, beside the window."""

from __future__ import annotations

from itertools import groupby

import pytest

from app.main_window import MainWindow
from app.presenting.measures import as_table
from core.measures import before_after
from tests.window_tools import Script, run_main, settled, undrawn

pytestmark = pytest.mark.usefixtures("empty_house")


def measured(window: MainWindow) -> bool:
    """The body as it is now has been measured and is shown so."""
    return window.is_settled() and bool(window.result.measured) and not window.result.stale


def test_the_body_is_measured_where_it_is_seen_once_the_run_rests() -> None:
    def script(window: MainWindow) -> Script:
        undrawn(window)
        yield settled(window)
        assert not window.result.measured, "nobody has looked"
        window.desk.go_to("result")
        assert not window.result.measured, "the window does not wait for it"
        yield lambda: measured(window)
        as_the_core_measures(window)
        yield from former_measures_fade_until_the_run_rests(window)
        as_the_core_measures(window)

    run_main([], script)


def as_the_core_measures(window: MainWindow) -> None:
    frame = window.session.frame
    assert frame is not None
    before, after = before_after(frame.stages, frame.control_points)
    shown = {view.key: view for view in window.result.measured}
    assert sorted(shown) == sorted(after)
    groups = [view.group for view in shown.values()]
    assert len(list(groupby(groups))) == len(set(groups)), "each heading stands once"
    for key, view in shown.items():
        assert view.after == after[key].value
        assert view.before == (before[key].value if key in before else None)
    followed = frame.marks.apex_z - frame.stages.rest_marks.apex_z
    assert shown["apex_lift"].after == pytest.approx(followed, abs=0.01)
    hip, volume = shown["hip_girth"], shown["breast_volume_left"]
    assert (hip.after, "hip" in hip.caption) == (None, True)
    assert (volume.estimate, "±" in volume.caption) == (True, True)
    assert len(window.result.rows) > 5, "what is followed while it solves stays"


def former_measures_fade_until_the_run_rests(window: MainWindow) -> Script:
    former = window.result.measured
    name = next(iter(window.lines.rows))
    window.session.commit_line(name, name, 0.93)
    yield lambda: window.result.stale
    assert window.result.measured == former, "greyed, not gone"
    told = [row[0] for row in as_table([*window.result.rows])]
    assert former[0].label not in told
    yield lambda: measured(window)
    assert window.result.measured != former
