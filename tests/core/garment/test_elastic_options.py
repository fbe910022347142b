"""Elastic options: the effect of an elastic is that of the design, and a refusal names what works."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from app.cli import solved_design
from app.cli.commands import cut
from app.cli.main import main
from core.document.elastic import Elastic
from core.document.lines import ActiveLine
from core.garment.elastic_library import built_in, find_elastic
from core.garment.elastic_options import (
    FIRST_STRETCH,
    KEEP_CUT,
    KEEP_FIT,
    ElasticOption,
    elastic_option,
    nearest,
    outcome_of,
    strongest,
)
from core.garment.match_shape import match_reached_lengths, reached_points
from core.garment.pressure import pressures
from core.messages import LineName
from core.pipeline.build import Stages, build

STRAP = find_elastic("strap 15")
WEAK = Elastic("weak", 10.0, ((0.0, 0.0), (0.3, 0.5)))
SOFT = Elastic("soft", 10.0, ((0.0, 0.0), (3.0, 6.0)))
NAMES = ("mid-bust",)


def worn_at(stages: Stages, ratio: float, line: str = "mid-bust", **choices: object) -> Stages:
    design = replace(stages.design, lines=(ActiveLine(line, ratio),), **choices)  # type: ignore[arg-type]
    return build(design, stages)


@pytest.mark.parametrize("contact", ["glued", "sliding"])
@pytest.mark.parametrize("mode", [KEEP_FIT, KEEP_CUT])
def test_the_effect_is_what_its_design_gives(built: Callable[[str], Stages], contact: str, mode: str) -> None:
    stages = worn_at(built("mannequin"), 0.97, line_contact=contact)
    option = elastic_option(stages, NAMES, STRAP, mode)
    assert option.outcome is not None
    again, before = outcome_of(build(option.outcome.design, stages)), outcome_of(stages)
    assert again == option.outcome
    pressed = pressures(build(again.design, stages), reached_points(build(again.design, stages)))
    assert again.kpa == {name: band.largest for name, band in pressed.items()}
    assert again.kpa["mid-bust"] > 0.0
    reached, former = (each.rows["mid-bust"].reached_front_mm for each in (again, before))
    if mode == KEEP_FIT:
        assert reached == pytest.approx(former, rel=2e-5)
    else:
        assert again.design.ratio("mid-bust") == 0.97
        assert reached > former + 1.0, "an elastic gives way"


@pytest.mark.parametrize(
    ("elastic", "limit"), [(WEAK, "at the maximum elongation, 30 %"), (SOFT, "at the shortest cut length")]
)
@pytest.mark.parametrize("contact", ["glued", "sliding"])
def test_one_that_is_too_weak_is_cut_as_short_as_it_can_be(
    built: Callable[[str], Stages], contact: str, elastic: Elastic, limit: str
) -> None:
    stages = worn_at(built("mannequin"), 0.95, line_contact=contact)
    option = elastic_option(stages, NAMES, elastic, KEEP_FIT)
    assert option.outcome is None
    assert limit in str(option.reason)
    assert option.closest is not None
    row, before = option.closest.rows["mid-bust"], outcome_of(stages).rows["mid-bust"]
    excess = row.reached_front_mm - before.reached_front_mm
    assert f"{excess:.1f} mm too long" in str(option.reason)
    ratio = option.closest.design.ratio("mid-bust")
    assert ratio == pytest.approx(0.5) or row.elongation == pytest.approx(
        0.99 * elastic.max_elongation, rel=1e-3
    )
    assert row.elongation is not None
    assert row.elongation <= elastic.max_elongation


def test_the_length_that_a_refusal_names_works(built: Callable[[str], Stages]) -> None:
    """Whatever the contact, as far as a line is set too short."""
    for contact in ("glued", "sliding"):
        for ratio in (0.5, 0.53, 0.56):
            stages = worn_at(built("mannequin"), ratio, line_contact=contact)
            option = elastic_option(stages, NAMES, find_elastic("strap 10"), KEEP_CUT)
            assert option.problem is not None, "it would be stretched by more than 70 %"
            assert option.closest is not None
            least = float(str(option.problem.hint).removeprefix("Set mid-bust to ").partition(" %")[0])
            assert 100.0 * ratio < least < 63.0
            longer = worn_at(stages, least / 100.0)
            assert elastic_option(longer, NAMES, find_elastic("strap 10"), KEEP_CUT).outcome is not None


def test_numbers_that_round_alike_are_told_apart() -> None:
    message = STRAP.overstretch_error(0.7004, LineName("mid-bust")).message
    assert "requires 70.04 % elongation for mid-bust; the table of the elastic ends at 70 %" in str(message)
    assert "requires 9.95 N for mid-bust; the table of the elastic ends at 9.9 N" in str(
        STRAP.overload_error(9.949, LineName("mid-bust")).message
    )


@pytest.mark.parametrize("hold", ["spring", "held"])
@pytest.mark.parametrize("mode", [KEEP_FIT, KEEP_CUT])
def test_a_slack_line_names_the_length_at_which_an_elastic_pulls(
    built: Callable[[str], Stages], mode: str, hold: str
) -> None:
    stages = worn_at(built("mannequin"), 1.05, line_hold=hold)
    option = elastic_option(stages, NAMES, STRAP, mode)
    assert str(option.reason) == "Slack at this length: set the line to 99 % or less."
    shorter = worn_at(stages, 0.99, line_hold=hold)
    assert elastic_option(shorter, NAMES, STRAP, mode).outcome is not None


def test_a_held_line_takes_what_is_strong_enough_and_keeps_its_shape(built: Callable[[str], Stages]) -> None:
    stages = worn_at(built("mannequin"), 0.95, line_hold="held")
    options = [elastic_option(stages, NAMES, each, KEEP_FIT) for each in (None, *built_in())]
    assert {round(each.outcome.lift, 6) for each in options if each.outcome is not None} == {
        round(outcome_of(stages).lift, 6)
    }
    weak = [each for each in options if each.outcome is None]
    assert weak
    assert all("Too weak: 11.3 N at this length" in str(each.reason) for each in weak)


def test_a_band_on_the_ribs_is_put_on(built: Callable[[str], Stages]) -> None:
    stages = build(replace(built("mannequin").design, lines=()), built("mannequin"))
    option = elastic_option(stages, ("under-bust",), STRAP, KEEP_FIT)
    assert option.outcome is not None
    assert option.outcome.rows["under-bust"].elongation == pytest.approx(FIRST_STRETCH)
    off = elastic_option(build(option.outcome.design, stages), ("under-bust",), None, KEEP_FIT)
    assert off.outcome is not None
    assert not off.outcome.design.active_lines()


def test_a_locked_line_is_refused_before_it_is_chosen(built: Callable[[str], Stages]) -> None:
    stages = worn_at(built("mannequin"), 0.97)
    traits = replace(stages.design.line_settings("mid-bust"), locked=True)
    stages = build(stages.design.with_line_settings(traits), stages)
    assert "locked" in str(elastic_option(stages, NAMES, STRAP, KEEP_FIT).reason)
    assert elastic_option(stages, NAMES, STRAP, KEEP_CUT).outcome is not None


def test_the_nearest_is_alike_and_the_strongest_reaches_furthest(built: Callable[[str], Stages]) -> None:
    stages = worn_at(built("mannequin"), 0.94, line_contact="sliding")
    options = [elastic_option(stages, NAMES, each, KEEP_FIT) for each in built_in()]
    near = nearest(options, STRAP)
    assert near is not None
    assert near.elastic == find_elastic("strap 20")
    usable = {each.elastic.name for each in options if each.outcome is not None and each.elastic is not None}
    assert "Strap 15 mm" not in usable
    limited: list[ElasticOption] = [each for each in options if each.outcome is None]
    best = strongest(limited, NAMES)
    assert best is not None
    assert best.closest is not None
    reached = [each.closest.rows["mid-bust"].reached_front_mm for each in limited if each.closest is not None]
    assert best.closest.rows["mid-bust"].reached_front_mm == min(reached)
    assert nearest(limited, STRAP) is None


def test_the_search_is_not_led_astray_by_its_first_guesses(built: Callable[[str], Stages]) -> None:
    """Guesses beyond the curve or the shortest cut once ended the search though a length was there."""
    stages = worn_at(built("mannequin"), 0.94, line_contact="sliding")
    found = match_reached_lengths(stages, reached_points(stages), {"mid-bust": find_elastic("strap 20")})
    assert found.excess == {}
    row = outcome_of(build(found.design, stages)).rows["mid-bust"]
    assert row.elongation == pytest.approx(0.69, abs=0.01), "close to its end at 70 %"


def test_the_command_line_lists_effects_and_names_the_nearest(
    mannequin: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    few = {name: find_elastic(name) for name in ("strap 15", "strap 20")}
    for module in (cut, solved_design):
        monkeypatch.setattr(module, "library", lambda: few)
    words = ["cut", str(mannequin), "--line", "mid-bust=94%", "--set", "line_contact=sliding"]
    assert main([*words, "--elastics", "mid-bust", "--keep-fit"]) == 0
    listed = capsys.readouterr().out
    assert "Strap 15 mm" in listed
    assert "Too weak" in listed
    assert "Lift: 1" in listed
    assert main([*words, "--elastic", "mid-bust=strap 15", "--keep-fit"]) == 2
    assert "Nearest suitable elastic: Strap 20 mm." in capsys.readouterr().err
    assert main([*words, "--elastic", "mid-bust=strap 20", "--keep-fit"]) in (0, 3)
    assert "with an inextensible band." in capsys.readouterr().out
    assert main([*words, "--elastic", "mid-bust=strap 20", "--keep-fit", "--json"]) in (0, 3)
    assert json.loads(capsys.readouterr().out)["rows"][0]["elastic"] == "Strap 20 mm"
    assert main([*words, "--elastics", "no line"]) == 2
    assert "There is no line 'no line'" in capsys.readouterr().err
    for form in ("--json", "--csv", "--out=list.json"):
        assert main([*words, "--elastics", "mid-bust", form]) == 2
        assert "as text only" in capsys.readouterr().err


def test_the_list_of_elastics_is_written_where_it_is_asked_for(
    mannequin: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cut, "library", lambda: {"strap": find_elastic("strap 15")})
    out = tmp_path / "list.txt"
    assert main(["cut", str(mannequin), "--elastics", "mid-bust", "--out", str(out)]) == 0
    assert capsys.readouterr().out == f"written to {out}\n"
    assert "Strap 15 mm" in out.read_text()
