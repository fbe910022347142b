"""LiveSolver: newest wins, nothing is lost, stop joins, the last good frame survives an error."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
import pytest

from core.document.design import Design, ScanSource
from core.errors import UserError
from core.mechanics.exact_solution import solve_exact
from core.pipeline import live_solver as live
from core.pipeline.build import Stages
from core.pipeline.live_solver import Failure, Frame, LiveSolver

Built = Callable[[str], Stages]
PATIENCE = 90.0
HELD = 1.0
"""Seconds for which a frame is held: far more than an iteration takes, on a busy machine too."""


@pytest.fixture
def solver() -> Iterator[LiveSolver]:
    solving = LiveSolver()
    yield solving
    solving.stop()


def answer(solver: LiveSolver, until: Callable[[Frame], bool], hold: bool = False) -> Frame:
    """The first frame that fits; a failure is raised."""
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline:
        latest = solver.poll(hold)
        if isinstance(latest, Failure):
            raise latest.error
        if latest is not None and until(latest):
            return latest
        time.sleep(0.002)
    raise AssertionError("no such frame")


def settled(solver: LiveSolver, revision: int) -> Frame:
    return answer(solver, lambda frame: frame.revision == revision and not frame.is_running)


def test_the_newest_design_wins(solver: LiveSolver, built: Built) -> None:
    design = built("mannequin").design
    settled(solver, solver.submit(design))
    for ratio in np.linspace(0.99, 0.91, 50):
        last = solver.submit(design.with_line("mid-bust", float(ratio)))
    frame = settled(solver, last)
    assert frame.stages.design.ratio("mid-bust") == pytest.approx(0.91)
    exact = solve_exact(frame.stages.model, (1.0, 0.91, 1.0))
    points = frame.stages.model.tensegric.expand(exact.state.moved)
    assert np.abs(points - frame.control_points).max() < 0.3


def test_no_record_is_lost_while_lengths_change(solver: LiveSolver, built: Built) -> None:
    design = built("mannequin").design
    settled(solver, solver.submit(design, fresh=True))
    for ratio in (0.96, 0.95, 0.94, 0.93):
        revision = solver.submit(design.with_line("mid-bust", ratio))
        time.sleep(0.02)
    frame = settled(solver, revision)
    for records in frame.tracks.values():
        assert [record.iteration for record in records] == list(range(len(records)))


def test_fresh_begins_a_new_run_without_a_jump(solver: LiveSolver, built: Built) -> None:
    design = built("mannequin").design
    before = settled(solver, solver.submit(design, fresh=True))
    revision = solver.submit(design.with_line("mid-bust", 0.965), fresh=True)
    after = answer(solver, lambda frame: frame.revision == revision)
    assert after.tracks["adaptive"][0].iteration == 0
    assert after.tracks["adaptive"][0].lengths == before.tracks["adaptive"][-1].lengths
    settled(solver, revision)


def test_stop_joins_even_in_the_middle_of_work(built: Built) -> None:
    solver = LiveSolver()
    solver.submit(built("mannequin").design)
    time.sleep(0.05)
    solver.stop()
    assert not [thread for thread in threading.enumerate() if thread.name == "busk-solver"]


def test_a_failure_is_told_and_the_solver_goes_on(solver: LiveSolver, built: Built) -> None:
    design = built("mannequin").design
    settled(solver, solver.submit(design))
    bad = solver.submit(Design(ScanSource("no-such-scan.ply")))
    deadline = time.monotonic() + PATIENCE
    failure = None
    while failure is None and time.monotonic() < deadline:
        latest = solver.poll()
        failure = latest if isinstance(latest, Failure) else None
        time.sleep(0.002)
    assert failure is not None
    assert failure.revision == bad
    assert isinstance(failure.error, UserError)
    assert settled(solver, solver.submit(design)).verdict.state == "settled"


def test_frames_after_a_failure_belong_to_the_design_before_it(solver: LiveSolver, built: Built) -> None:
    # Vibrating, so that turns are still made when the failure comes.
    design = replace(built("mannequin").design.with_line("mid-bust", 0.6), volume="conventional")
    good = solver.submit(design)
    answer(solver, lambda frame: frame.revision == good)
    answer(solver, lambda _: True, hold=True)
    bad = solver.submit(Design(ScanSource("no-such-scan.ply")))
    solver.resume()
    with pytest.raises(UserError):
        answer(solver, lambda frame: frame.revision == bad)
    solver.poll()
    assert answer(solver, lambda _: True).revision == good


def test_no_turn_is_made_while_a_frame_is_shown(solver: LiveSolver, built: Built) -> None:
    design = replace(built("mannequin").design.with_line("mid-bust", 0.6), volume="conventional")
    revision = solver.submit(design)
    first, under_way = answer(solver, lambda frame: frame.revision == revision, hold=True), 0
    time.sleep(HELD)
    # What was under way may still come; on a busy machine it comes late.
    while (more := solver.poll(hold=True)) is not None:
        assert isinstance(more, Frame)
        first, under_way = more, under_way + 1
        assert under_way < 4, "turns are made all the same"
        time.sleep(0.1)
    solver.resume()
    second = answer(solver, lambda _: True)
    assert second.tracks["adaptive"][-1].iteration > first.tracks["adaptive"][-1].iteration
    assert second.seconds - first.seconds < HELD, "what is not worked is not counted"


def test_no_frame_is_published_without_an_iteration(
    solver: LiveSolver, built: Built, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As on a busy machine: the waits of the solver are over before who shows a frame releases it."""
    monkeypatch.setattr(live, "_HAND_RESTS", 0.0)
    monkeypatch.setattr(live, "_NAP", 0.0)
    design = replace(built("mannequin").design.with_line("mid-bust", 0.6), volume="conventional")
    solver.set_pace(1000.0)
    revision = solver.submit(design)
    seen = [answer(solver, lambda frame: frame.revision == revision, hold=True)]
    while len(seen) < 10:
        for _ in range(20):
            time.sleep(0.001)
            seen += [frame for frame in [solver.poll(hold=True)] if isinstance(frame, Frame)]
        solver.resume()
        seen.append(answer(solver, lambda _: True, hold=True))
    turns = [frame.tracks["adaptive"][-1].iteration for frame in seen]
    assert turns == list(range(turns[0], turns[0] + len(turns)))


def test_lengths_that_a_hand_leaves_while_a_frame_is_shown_are_never_solved(
    solver: LiveSolver, built: Built, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(live, "_HAND_RESTS", PATIENCE)
    design = built("mannequin").design
    revision = solver.submit(design.with_line("mid-bust", 0.99))
    answer(solver, lambda frame: frame.revision == revision, hold=True)
    for ratio in np.linspace(0.98, 0.91, 8):
        last = solver.submit(design.with_line("mid-bust", float(ratio)))
        time.sleep(0.01)
        assert solver.poll(hold=True) is None, "the last picture is still being made"
    solver.resume()
    assert answer(solver, lambda _: True).revision == last


def test_at_a_pace_each_turn_is_shown_and_a_new_length_does_not_wait(
    solver: LiveSolver, built: Built
) -> None:
    design = built("mannequin").design
    settled(solver, solver.submit(design))
    solver.set_pace(40.0)
    revision = solver.submit(design.with_line("mid-bust", 0.95), fresh=True)
    seen = [answer(solver, lambda frame: frame.revision == revision)]
    start = time.monotonic()
    while len(seen) < 6:
        seen.append(answer(solver, lambda _: True))
    first = len(seen[0].tracks["adaptive"])
    assert [len(frame.tracks["adaptive"]) for frame in seen] == list(range(first, first + 6))
    assert time.monotonic() - start >= 4 / 40.0, "five turns with four pauses between them"
    solver.set_pace(0.001)
    revision = solver.submit(design.with_line("mid-bust", 0.94))
    assert answer(solver, lambda frame: frame.revision == revision).is_running
    solver.set_pace(None)
    assert settled(solver, revision).verdict.state == "settled"


def test_the_stages_at_work_are_named(built: Built) -> None:
    told: list[str] = []
    solver = LiveSolver(lambda what, _: told.append(what))
    settled(solver, solver.submit(built("mannequin").design))
    solver.stop()
    assert told[0] == "read scan"
    assert "fit control mesh" in told
    assert told[-1] == ""


@pytest.mark.parametrize("control", ["adaptive", "conventional", "none", "exact"])
def test_each_control_shows_its_own_answer(solver: LiveSolver, built: Built, control: str) -> None:
    design = replace(built("mannequin").design, volume=control)
    frame = settled(solver, solver.submit(design))
    share = abs(frame.error_ml) / (frame.stages.model.volume.rest_volume / 1000.0)
    low, high = {
        "adaptive": (0, 1e-5),
        "exact": (0, 1e-9),
        "conventional": (5e-4, 3e-3),
        "none": (4e-3, 2e-2),
    }[control]
    assert low <= share <= high
    assert {"adaptive", "conventional"} <= set(frame.tracks)


@pytest.mark.parametrize(("large", "calls"), [(1, 1), (10**9, 0)])
def test_compiled_loops_are_loaded_once_and_only_for_a_large_body(
    solver: LiveSolver, built: Built, monkeypatch: pytest.MonkeyPatch, large: int, calls: int
) -> None:
    warmed: list[str] = []
    monkeypatch.setattr(live, "LARGE", large)
    monkeypatch.setattr(live.kernels, "warm", lambda: warmed.append(threading.current_thread().name))
    design = built("mannequin").design
    settled(solver, solver.submit(design))
    settled(solver, solver.submit(design.with_line("mid-bust", 0.95)))
    solver.stop()
    assert warmed == ["busk-warm"] * calls


def test_an_exact_answer_that_is_not_found_is_said_and_the_last_frame_stays(
    solver: LiveSolver, built: Built, monkeypatch: pytest.MonkeyPatch
) -> None:
    design = replace(built("mannequin").design, volume="exact")
    settled(solver, solver.submit(design))
    lost = replace(solve_exact(built("mannequin").model, (1.0, 1.0, 1.0)), residual=np.inf)
    with monkeypatch.context() as patch:
        patch.setattr("core.mechanics.solver_comparison.solve_exact", lambda *_, **__: lost)
        solver.submit(design.with_line("mid-bust", 0.8))
        with pytest.raises(UserError, match="No equilibrium found"):
            answer(solver, lambda frame: frame.stages.design.ratio("mid-bust") == 0.8)
    assert settled(solver, solver.submit(design)).verdict.motion == "settled"
