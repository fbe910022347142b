"""Blocks of a sheet flow down columns: gaps, what stays together, what goes on elsewhere; text in lines."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from PySide6.QtWidgets import QApplication

from app.gui.theme.stylesheet import load_fonts
from app.report.layout import Block, Column, place_blocks
from app.report.painter import elide, line_height, text_width, wrap


def columns() -> Iterator[Column]:
    for page in range(9):
        yield Column(page, 10.0, 0.0, 100.0)
        yield Column(page, 60.0, 0.0, 100.0)


def block(height: float, gap: float = 0.0, keep: bool = False) -> Block:
    return Block(height, lambda paper, x, y: None, gap, keep)


def places(*blocks: Block) -> list[tuple[int, float, float]]:
    return [(each.page, each.x, each.y) for each in place_blocks(blocks, columns())[0]]


def test_a_gap_is_between_blocks_and_not_at_the_head_of_a_column() -> None:
    assert places(block(40.0, gap=9.0), block(40.0, gap=9.0), block(40.0, gap=9.0)) == [
        (0, 10.0, 0.0),
        (0, 10.0, 49.0),
        (0, 60.0, 0.0),
    ]


def test_a_heading_goes_on_with_what_it_is_over() -> None:
    heading = block(10.0, keep=True)
    assert places(block(85.0), heading, block(10.0)) == [(0, 10.0, 0.0), (0, 60.0, 0.0), (0, 60.0, 10.0)]
    assert places(block(80.0), heading, block(10.0)) == [(0, 10.0, 0.0), (0, 10.0, 80.0), (0, 10.0, 90.0)]


def test_pages_follow_and_what_fits_nowhere_has_a_column_of_its_own() -> None:
    assert [each[0] for each in places(*[block(60.0)] * 5)] == [0, 0, 1, 1, 2]
    assert places(block(10.0), block(130.0), block(10.0)) == [(0, 10.0, 0.0), (0, 60.0, 0.0), (1, 10.0, 0.0)]


def test_what_is_left_of_the_last_column_is_told() -> None:
    assert place_blocks([block(30.0), block(20.0, gap=5.0)], columns())[1] == Column(0, 10.0, 55.0, 100.0)


@pytest.mark.parametrize(
    "text",
    [
        "A tape lies level round the trunk and bridges hollows. " * 3,
        "メジャーを水平に回し、くぼみは渡します。" * 5,
    ],
)
def test_lines_hold_all_words_and_no_more_than_goes(qapp: QApplication, text: str) -> None:
    load_fonts()
    lines = wrap(text, "small", 40.0)
    assert len(lines) > 3
    assert all(text_width(line, "small") <= 40.0 + 1e-6 for line in lines)
    assert "".join(lines).replace(" ", "") == text.replace(" ", "")
    assert not any(line[0] in "、。" for line in lines), "no line begins with a full stop"


def test_long_names_end_in_dots(qapp: QApplication) -> None:
    load_fonts()
    assert elide("Anna", "body", 30.0) == "Anna"
    short = elide("Anna " * 30, "body", 30.0)
    assert short.endswith("…")
    assert text_width(short, "body") <= 30.0
    assert elide("Anna\nK.", "body", 30.0) == "Anna K.", "a name is one line"
    assert line_height("title") > line_height("small") > 2.0


def test_the_last_line_of_a_text_is_never_a_letter_or_two(qapp: QApplication) -> None:
    load_fonts()
    text = "乳頭をはっきり検出できません。バストポイントは乳房の形から推定しています。"
    for width in range(30, 100):
        lines = wrap(text, "small", float(width))
        assert "".join(lines) == text
        assert len(lines) == 1 or len(lines[-1]) > 3
        assert max(text_width(line, "small") for line in lines) <= width
