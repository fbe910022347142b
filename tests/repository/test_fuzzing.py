"""The fuzzing harness notices every kind of failure, and no past failure comes back."""

import json
import sys
from pathlib import Path

import pytest

sys.path[:0] = [str(Path(__file__).parents[2] / "benchmarks")]

import fuzz  # noqa: E402
from fuzzing.limited import FAILURES, Worker  # noqa: E402

pytestmark = pytest.mark.skipif(not Path("/proc/self/clear_refs").exists(), reason="the limits need Linux")


@pytest.fixture(scope="module")
def worker():
    worker = Worker(seconds=60.0)
    yield worker
    worker.close()


@pytest.mark.parametrize("fault", FAILURES)
def test_every_kind_of_failure_is_noticed(fault):
    strict = Worker(seconds=1.0 if fault == "hang" else 60.0, megabytes=400.0)
    try:
        assert strict.run("faults", fault).outcome == fault
        assert strict.run("faults", "none").outcome == "ok"  # another worker goes on
    finally:
        strict.close()


@pytest.mark.parametrize("past", fuzz.corpus(), ids=lambda past: json.dumps(past)[:60])
def test_no_past_failure_comes_back(worker, past):
    ending = worker.run(past["kind"], past["recipe"])
    assert not ending.failed, ending


@pytest.mark.parametrize("kind", fuzz.SHARES)
def test_a_case_is_the_same_each_time(kind):
    first, second = (fuzz.recipe_of(kind, 3, 5) for _ in range(2))
    assert first == second == json.loads(json.dumps(first))
    assert first != fuzz.recipe_of(kind, 4, 5)


def test_a_failure_is_made_simpler():
    class Told:
        """Fails where a change of the kind 3 is left."""

        def run(self, kind, recipe):
            failed = any(number == 3 for _, number in recipe["changes"])
            return fuzz.Ending("traceback" if failed else "ok", "x", 0.0, 0.0)

    recipe = {"changes": [["bent", 1], ["torn", 3], ["holed", 5]], "edge": 0, "placed": 7}
    small = fuzz.simplest(Told(), "bodies", recipe, fuzz.Ending("traceback", "x", 0.0, 0.0))
    assert small == {"changes": [["torn", 3]], "edge": 40, "placed": None}
