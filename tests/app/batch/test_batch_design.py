"""A design of a run holds nothing of one person, and travels as JSON."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from app.batch.batch_design import SCHEMA_VERSION, BatchDesign, batch_design, content_key, design_of_data
from app.batch.schema import HEAD, LINE_COLUMNS, STATES, TAIL, VARYING, columns_of
from core.document.design import Design, ScanSource
from core.document.garment_pattern import GarmentPattern
from core.document.lower_trunk import LowerTrunk
from core.errors import UserError
from core.garment.presets import find_preset, with_preset
from core.landmarks.manual import placed_mark
from core.pattern.block_library import find_block
from core.scan.source import ScanEdits

BARE = Design(ScanSource(""))


def made(lines: tuple[str, ...] = ("mid-bust=-20mm",), design: Design = BARE) -> BatchDesign:
    return batch_design("one", design, lines, [], [])


def test_nothing_of_one_person_is_kept() -> None:
    mark = placed_mark("bust_point_left=0,0,0")
    scan = ScanSource("anna.ply", unit="cm", up="+y", edits=ScanEdits(kept="left"))
    design = made(design=Design(scan, customer="Anna", placed=(mark,))).design
    assert design == Design(ScanSource("", unit="cm", up="+y"))
    assert "nna" not in json.dumps(made(design=Design(scan, customer="Anna")).as_data())


@pytest.mark.parametrize("preset", ["underwired", "girdle", "bodysuit"])
def test_a_design_is_read_from_json_as_it_was(preset: str) -> None:
    design = with_preset(BARE, find_preset(preset))
    line = next(iter(sorted(design.all_active_lines())))
    whole = batch_design(preset, design, [f"{line}=95%"], [f"{line}=plush 12"], ["lift=5mm"])
    again = design_of_data(json.loads(json.dumps(whole.as_data())))
    assert again == whole
    assert content_key([again]) == content_key([whole])


def test_the_key_depends_on_every_part_of_the_design() -> None:
    first = made()
    others = [
        made(("mid-bust=-21mm",)),
        replace(first, targets=("lift=5mm",)),
        made(design=replace(BARE, volume="exact")),
        batch_design("one", BARE, ["mid-bust=-20mm"], ["mid-bust=plush 12"], []),
    ]
    keys = {content_key([each]) for each in (first, *others)} | {content_key([first, others[0]])}
    assert len(keys) == 6
    assert content_key([made()]) == content_key([first])


@pytest.mark.parametrize(
    ("lines", "elastics", "targets"),
    [
        (["no such=95%"], [], []),
        (["mid-bust"], [], []),
        (["mid-bust=95%"], ["under-bust=plush 12"], []),
        (["mid-bust=95%"], ["mid-bust=no such elastic"], []),
        (["mid-bust=95%"], [], ["nothing=5mm"]),
    ],
)
def test_what_is_valid_on_no_body_is_refused_at_once(
    lines: list[str], elastics: list[str], targets: list[str]
) -> None:
    with pytest.raises(UserError):
        batch_design("one", BARE, lines, elastics, targets)


def test_columns_are_fixed_by_the_designs() -> None:
    girdle = with_preset(BARE, find_preset("girdle"))
    both = columns_of([made(), made((), girdle)])
    names = [each.name for each in both]
    assert len(set(names)) == len(names)
    needed = {"scan", "state", "message", "verdict", "bust_mm", "underbust_mm", "volume_error_percent"}
    assert needed | set(VARYING) | {"cup_jp", "band_au", "cut_length_mid-bust_mm"} <= set(names)
    assert {f"tension_{line}_n" for line in girdle.all_active_lines()} <= set(names)
    assert {each.name for each in columns_of([made()])} < set(names)


def test_pieces_and_seams_of_a_pattern_are_columns() -> None:
    pattern = GarmentPattern(find_block("brief"))
    names = [each.name for each in columns_of([made((), replace(BARE, lower=LowerTrunk(), pattern=pattern))])]
    assert {"area_front_cm2", "strain_gusset_percent", "seam_side seam left_mm"} <= set(names)


def test_every_column_is_in_the_reference() -> None:
    page = (Path(__file__).parents[3] / "docs" / "reference" / "batch-columns.md").read_text("utf-8")
    assert f"version {SCHEMA_VERSION}" in page
    for column in (*HEAD, *TAIL):
        assert f"| `{column.name}` | {column.unit} | {column.about} |" in page
    for name, unit, about in LINE_COLUMNS:
        assert f"| `{name.format(name='LINE')}` | {unit} | {about} |" in page
    assert all(f"`{state}`" in page for state in STATES)
