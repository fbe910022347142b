"""What the window says while the result is asked for, in both languages."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.i18n.catalog import using_language
from app.presenters.samples import sample_design
from app.presenters.target_shape import (
    bust_movement_text,
    change_text,
    deviation_text,
    formatted_value,
    is_met,
    is_near,
    locked_lines_text,
    pressure_text,
    result_text,
    step_text,
    target_result_text,
    target_title,
    unlimited_text,
)
from core.analysis.inverse_design.bust_quantities import GIRTH
from core.analysis.inverse_design.profile_quantities import profile_name
from core.analysis.inverse_design.quantities import NAMES
from core.analysis.inverse_design.quantity import Goal
from core.analysis.inverse_design.solve import InverseResult
from core.document.design import Design


def design() -> Design:
    return sample_design().with_line("mid-bust", 0.93).with_line("full-bust", 0.999)


def reply(**changes: object) -> InverseResult:
    plain = InverseResult(
        design(), {"lift": 2.04}, False, 1.0, (), (), (), False, True, {}, 4.0, (), 1.0, 3, longest=0.999
    )
    return replace(plain, **changes)


GOALS = (Goal("lift", 5.0),)


@pytest.mark.parametrize(
    ("changes", "english", "japanese"),
    [
        ({"reachable": True}, "All targets reached.", "すべての目標に到達します。"),
        (
            {"at_limit": ("full-bust", "mid-bust")},
            (
                "Not reachable. Closest result: Bust point lift +2.0 mm. Stopped at a "
                "limit: Full bust: longest length, 99.9 %; Mid-bust: shortest length, 93.0 %."
            ),
            (
                "到達できません。最も近い結果：BPの上昇 +2.0 mm。限界に達しました：トップバスト：最長の"
                "長さ 99.9 %；バスト下部：最短の長さ 93.0 %。"
            ),
        ),
        (
            {"at_pressure_limit": ("mid-bust",), "strained": True},
            (
                "Not reachable. Closest result: Bust point lift +2.0 mm. Stopped at a "
                "limit: Mid-bust: contact pressure limit of 4.0 kPa; skin strain limit of 20 %."
            ),
            (
                "到達できません。最も近い結果：BPの上昇 +2.0 mm。限界に達しました：バスト下部：接触圧"
                "の上限 4.0 kPa；肌のひずみの限界 20 %。"
            ),
        ),
        (
            {"slack": ("full-bust",)},
            (
                "Not reachable. Closest result: Bust point lift +2.0 mm. Stopped at a "
                "limit: Full bust: slack, the tension would be negative."
            ),
            (
                "到達できません。最も近い結果：BPの上昇 +2.0 mm。限界に達しました：トップバスト："
                "たるみ（張力が負になります）。"
            ),
        ),
        (
            {"agreed": False},
            (
                "Closest result: Bust point lift +2.0 mm. The iteration over lengths, elastics and "
                "contact pressure did not converge."
            ),
            "最も近い結果：BPの上昇 +2.0 mm。長さ、ゴムテープ、接触圧の反復が収束しませんでした。",
        ),
    ],
)
def test_an_answer_is_one_sentence(changes: dict[str, object], english: str, japanese: str) -> None:
    answer = reply(**changes)
    assert result_text(answer, GOALS) == english
    with using_language("ja"):
        assert result_text(answer, GOALS) == japanese


def test_of_a_profile_it_is_told_how_far_it_is_off() -> None:
    heights = [profile_name("left", 300.0), profile_name("left", 310.0)]
    goals = [Goal(name, 100.0) for name in heights]
    answer = reply(reached={heights[0]: 103.0, heights[1]: 96.0})
    because = "No limit is reached: the active lines cannot produce this movement."
    said = "Not reachable. Closest result: profile deviation 3.5 mm on average (4.0 mm maximum). "
    assert result_text(answer, goals) == said + because
    with using_language("ja"):
        assert "最も近い結果：輪郭のずれが平均 3.5 mm（最大 4.0 mm）。限界には" in result_text(answer, goals)
    both = [*goals, Goal(profile_name("right", 300.0), 100.0)]
    answer = replace(answer, reached={**answer.reached, both[-1].name: 106.0})
    assert "Closest result: Profile through the left bust point: deviation 3.5 mm on " in result_text(
        answer, both
    )
    assert step_text([*GOALS, *goals]) == (
        "Targets: Bust point lift +5.0 mm, Profile through the left bust point"
    )


def test_changes_are_told_line_by_line_and_what_presses() -> None:
    before = design().with_line("mid-bust", 0.95)
    assert change_text(before, reply(pressure={"mid-bust": 2.46})) == [
        "Mid-bust 95.0 → 93.0 % (\N{MINUS SIGN}2.0)",
        "contact pressure at most 2.5 kPa",
    ]
    assert change_text(design(), reply()) == ["No line changes"]
    assert (
        change_text(design(), reply(unchecked=("mid-bust",)))[-1]
        == "contact pressure not checked: see Garment"
    )
    some = reply(unchecked=("full-bust",), pressure={"mid-bust": 2.46})
    assert change_text(design(), some)[-2:] == [
        "contact pressure at most 2.5 kPa",
        "contact pressure of Full bust not checked: see Garment",
    ]
    assert locked_lines_text(design(), ["mid-bust", "strap left"]) == "Locked, not changed: Mid-bust."
    assert locked_lines_text(design(), []) == ""


def test_every_figure_has_a_title_of_its_own_in_both_languages() -> None:
    titles = {target_title(name) for name in NAMES}
    assert len(titles) == len(NAMES)
    with using_language("ja"):
        assert not titles & {target_title(name) for name in NAMES}


def test_a_profile_that_is_nearly_met_is_reached_within_so_much() -> None:
    goals = [Goal(profile_name("left", height), 200.0) for height in (340.0, 350.0)]
    names = [goal.name for goal in goals]
    near = reply(reached=dict(zip(names, (200.2, 199.6), strict=True)))
    assert result_text(near, goals) == "Reached within 0.4 mm."
    assert deviation_text(goals, near.reached, "profile left") == "mean deviation 0.3 mm, maximum 0.4 mm"
    assert is_met(near, goals)
    assert not is_met(near, [*goals[:1], Goal(names[1], 201.0)])
    both = replace(near, reached={**near.reached, "lift": 4.0})
    assert not is_met(both, [*goals, Goal("lift", 4.2)]), "a figure is met within less"


def test_what_a_hand_draws_is_met_on_average() -> None:
    goals = [Goal(profile_name("left", 300.0 + 10.0 * at), 200.0) for at in range(10)]

    def off_by(least: float, most: float, **others: float) -> InverseResult:
        reached = {goal.name: 200.0 + least for goal in goals} | {goals[0].name: 200.0 + most} | others
        return reply(reached=reached)

    near = off_by(-0.1, 3.0)
    assert result_text(near, goals) == "Reached with a mean deviation of 0.4 mm, maximum 3.0 mm."
    assert (is_near(near, goals), is_met(near, goals)) == (True, False)
    with using_language("ja"):
        assert result_text(near, goals) == "平均 0.4 mm、最大 3.0 mm のずれで到達できます。"
    now = {goal.name: 200.9 for goal in goals}
    assert result_text(near, goals, None, now) == "Reached with a mean deviation of 0.4 mm, maximum 3.0 mm."
    now = {goal.name: 200.5 for goal in goals}
    said = "Closest result: mean deviation 0.4 mm, maximum 3.0 mm (before: 0.5 mm). No limit is reached: "
    assert result_text(near, goals, None, now).startswith(said), "what hardly comes nearer is not met"
    assert not is_near(off_by(1.1, 1.0), goals), "a millimetre is seen"
    assert not is_near(off_by(0.1, 5.2), goals), "nor is one place far off"
    assert not is_near(replace(near, agreed=False), goals)
    wish = Goal("lift", 4.0)
    assert is_near(off_by(-0.1, 3.0, lift=4.02), [*goals, wish])
    assert not is_near(off_by(-0.1, 3.0, lift=4.2), [*goals, wish])
    assert not is_near(reply(reached={"lift": 4.0}), [wish]), "of profiles alone"


def test_of_a_drawn_profile_it_is_told_what_it_was_off_and_how_the_bust_point_moves_along() -> None:
    goals = [Goal(profile_name("left", height), 200.0) for height in (300.0, 310.0)]
    names = [goal.name for goal in goals]
    off = reply(reached=dict(zip(names, (206.0, 199.0), strict=True)), strained=True)
    now = {names[0]: 203.0, names[1]: 199.0, "lift": 7.3, "out": -5.3}
    then = {"lift": 6.5, "out": -5.33}
    said = result_text(off, goals, None, now)
    assert said.startswith(
        "Not reachable. Closest result: profile deviation 3.5 mm on average (6.0 mm maximum), 2.0 mm before. "
    )
    assert bust_movement_text(goals, now, then) == "Other changes: Bust point lift +7.3 → +6.5 mm"
    with using_language("ja"):
        assert "（変更前 2.0 mm）。限界に達しました：" in result_text(off, goals, None, now)
        assert bust_movement_text(goals, now, then) == "あわせて変わる値：BPの上昇 +7.3 → +6.5 mm"
    assert bust_movement_text([*goals, Goal("lift", 6.5)], now, then) == "", "it is asked for"
    assert bust_movement_text([Goal("out", -4.0)], now, then) == "", "no profile is"
    assert bust_movement_text(goals, {}, then) == "", "not known yet"


def test_values_of_a_row_are_now_and_the_result_with_its_change() -> None:
    now, then = {"lift": -0.21, GIRTH: 872.4}, {"lift": 0.42, GIRTH: 869.4}
    assert formatted_value(now["lift"], signed=True) == "\N{MINUS SIGN}0.2"
    assert formatted_value(None, signed=True) == ""
    assert target_result_text(now, then, "lift") == "+0.4 (+0.6)"
    assert target_result_text(now, then, GIRTH) == "869.4 (\N{MINUS SIGN}3.0)"
    assert target_result_text({}, then, "lift") == target_result_text(now, {}, "lift") == ""
    assert pressure_text({"a": 12.9, "b": 1.0}, {"a": 2.0, "b": 4.0}) == ("12.9", "4.0 (\N{MINUS SIGN}8.9)")
    assert pressure_text({}, {}) == ("", "")


def test_what_the_limit_of_pressure_costs_is_one_sentence() -> None:
    free = reply(pressure={"mid-bust": 25.8})
    assert unlimited_text(free, GOALS, {}) == (
        "Closest result without the contact pressure limit: Bust point lift +2.0 mm, at 25.8 kPa."
    )
    met = replace(free, reachable=True)
    assert unlimited_text(met, GOALS, {}) == (
        "All targets are reached without the contact pressure limit, at 25.8 kPa."
    )
