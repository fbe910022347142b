"""Girdle sizes from the user's own table: both girths decide, and a faulty line is named."""

from pathlib import Path

import pytest

from core.errors import SizeError
from core.measurements.girdle_sizes import COLUMNS, girdle_tables, read_girdle_table
from core.measurements.sizes import user_folder

HEAD = ",".join(COLUMNS)
TABLE = f"{HEAD}\nM,64,70,87,95\nL,69,77,92,100\nL wide,69,77,98,106\n"


def test_a_size_fits_both_girths_the_nearest_first(tmp_path: Path) -> None:
    path = tmp_path / "maker.csv"
    path.write_text(TABLE, encoding="utf-8")
    table = read_girdle_table(path)
    assert table.title == "maker"
    assert table.sizes(670.0, 900.0) == ("M",)
    assert table.sizes(695.0, 935.0) == ("M", "L")
    assert table.sizes(770.0, 985.0) == ("L", "L wide")
    assert table.sizes(640.0, 870.0) == ("M",), "the ends of a step belong to it"
    assert table.sizes(670.0, 1000.0) == (), "a waist of M and a hip of L are neither"


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("size,waist,hip\nM,70,90\n", "its columns must be size, waist_from"),
        (f"{HEAD}\n", "no sizes"),
        (f"{HEAD}\nM,64,70,87,95\nL,69,x,92,100\n", "line 3 must have four numbers"),
        (f"{HEAD}\nM,64,70,87\n", "line 2 must have four numbers"),
        (f"{HEAD}\nM,70,64,87,95\n", "line 2 has a girth"),
        (f"{HEAD}\nM,nan,70,87,95\n", "line 2 has a girth"),
        (f"{HEAD}\n,64,70,87,95\n", "line 2 has no name"),
    ],
)
def test_a_faulty_table_is_refused_with_its_line(tmp_path: Path, text: str, why: str) -> None:
    path = tmp_path / "maker.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(SizeError, match=why):
        read_girdle_table(path)


def test_tables_of_the_folder_are_read_and_none_is_shipped() -> None:
    folder = user_folder()
    folder.mkdir(parents=True, exist_ok=True)
    assert girdle_tables() == ([], [])
    files = {"maker.csv": TABLE, "wrong.csv": "size\nM\n"}
    for name, text in files.items():
        (folder / name).write_text(text, encoding="utf-8")
    try:
        tables, problems = girdle_tables()
    finally:
        for name in files:
            (folder / name).unlink()
    assert [table.title for table in tables] == ["maker"]
    assert "wrong.csv" in str(problems[0])
