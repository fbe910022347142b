"""Sizes of girdles and a ratio as they are shown."""

from __future__ import annotations

from app.presenters.measurements import as_table, measured_views
from app.presenters.sizes import size_views
from core.measurements.definitions import Measure
from core.measurements.girdle_sizes import COLUMNS
from core.measurements.sizes import user_folder

GIRTHS = {"underbust_girth": 723.0, "bust_girth": 871.0, "waist_girth": 668.0, "hip_girth": 930.0}
MEASURED = {key: Measure(key, value, "mm") for key, value in GIRTHS.items()}


def test_a_ratio_has_two_decimals_and_no_unit() -> None:
    before, after = ({"waist_hip_ratio": Measure("waist_hip_ratio", value, "")} for value in (0.7019, 0.683))
    (view,) = measured_views(before, after)
    assert [view.written(each) for each in (view.before, view.after)] == ["0.70", "0.68"]
    assert as_table([view])[1][2:6] == ["", "0.70", "0.68", "-0.02"]


def test_girdle_sizes_of_a_table_of_ones_own_are_listed() -> None:
    folder = user_folder()
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "maker.csv"
    plain, _ = size_views(MEASURED, 0.0)
    try:
        path.write_text(f"{','.join(COLUMNS)}\nM,64,70,87,95\nL,69,77,92,100\n", encoding="utf-8")
        listed, _ = size_views(MEASURED, 0.0)
        none, _ = size_views({**MEASURED, "hip_girth": Measure("hip_girth", 1100.0, "mm")}, 0.0)
        path.write_text("size\nM\n", encoding="utf-8")
        wrong, _ = size_views(MEASURED, 0.0)
    finally:
        path.unlink()
    assert [each.near for each in listed] == [(*each.near, "Girdle, maker: M") for each in plain]
    assert none[0].near[-1] == "Girdle, maker: no size fits waist and hip"
    assert "maker.csv" in wrong[0].near[-1]
