"""The colours of the window in both themes: ink on paper, colour only for the garment and the verdict."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Tokens:
    """Colours of one theme, each ``"#rrggbb"``; names say the use, never the hue."""

    app: str  # behind the panels
    panel: str
    raised: str  # fields, cards, menus
    hover: str
    pressed: str
    selected: str  # a selected row, a toggle that is on
    line: str  # hairlines
    outline: str  # quiet outline of a control
    control: str  # outline of a control that must be seen
    text: str
    text_quiet: str
    text_caption: str
    accent: str
    on_accent: str
    ink: str  # the primary button
    on_ink: str
    ok: str
    ok_fill: str
    info: str
    info_fill: str
    warn: str
    warn_fill: str
    warn_mark: str  # amber of curves and marks, not of text
    bad: str
    bad_fill: str
    zone_ok: str  # lengths of a line in the groove of its slider
    zone_warn: str
    zone_bad: str
    groove: str
    ghost_curve: str
    exact_curve: str
    waist_curve: str  # zones of the lower trunk
    belly_curve: str
    seat_curve: str
    less: str
    more: str
    floating: str
    floating_alpha: int
    shadow_alpha: int  # of one of ten stacked black shapes
    dark: bool


LIGHT = Tokens(
    app="#ECEAE7",
    panel="#FBFAF8",
    raised="#FFFFFF",
    hover="#F1EFEC",
    pressed="#E6E3DF",
    selected="#E9F0FE",
    line="#E2DFDB",
    outline="#C9C5BF",
    control="#8B867F",
    text="#1C1B1A",
    text_quiet="#57534E",
    text_caption="#6C6761",
    accent="#2459CF",
    on_accent="#FFFFFF",
    ink="#1F1E1D",
    on_ink="#FFFFFF",
    ok="#18794E",
    ok_fill="#E2F3EA",
    info="#2459CF",
    info_fill="#E6EEFD",
    warn="#8A5A00",
    warn_fill="#FCEFD2",
    warn_mark="#C47B00",
    bad="#B3261E",
    bad_fill="#FCE6E3",
    zone_ok="#8FC9AC",
    zone_warn="#EBC263",
    zone_bad="#DE8F86",
    groove="#DAD6D1",
    ghost_curve="#A39D95",
    exact_curve="#57534E",
    waist_curve="#5A3F94",
    belly_curve="#0A7A8C",
    seat_curve="#D1405A",
    less="#2C6FB3",
    more="#C9731B",
    floating="#FBFAF8",
    floating_alpha=232,
    shadow_alpha=4,
    dark=False,
)

DARK = Tokens(
    app="#131416",
    panel="#1B1C1F",
    raised="#24262A",
    hover="#26282C",
    pressed="#303238",
    selected="#1E2C4A",
    line="#2B2D32",
    outline="#3C3F45",
    control="#7C8088",
    text="#EEEDEB",
    text_quiet="#B3B1AE",
    text_caption="#8F8E8D",
    accent="#8DB0FF",
    on_accent="#0F1522",
    ink="#EEEDEB",
    on_ink="#1B1C1F",
    ok="#6CCB9C",
    ok_fill="#17301F",
    info="#8DB0FF",
    info_fill="#1A2540",
    warn="#E8B44C",
    warn_fill="#35280F",
    warn_mark="#E8B44C",
    bad="#FF8B80",
    bad_fill="#3F1B18",
    zone_ok="#3E7D5E",
    zone_warn="#9A7522",
    zone_bad="#96483F",
    groove="#3A3C42",
    ghost_curve="#6E6F72",
    exact_curve="#B3B1AE",
    waist_curve="#B79BF0",
    belly_curve="#4FC3D9",
    seat_curve="#FF8FA3",
    less="#6FA8E6",
    more="#E8A05A",
    floating="#1D1E22",
    floating_alpha=232,
    shadow_alpha=14,
    dark=True,
)

LINE_COLORS = (
    "#5A3F94",  # plum
    "#E5536B",  # rose
    "#0A5F73",  # petrol
    "#7A1F2E",  # wine
    "#E2A32F",  # amber
    "#A9ABC9",  # lavender
    "#6FA3F5",  # sky
    "#8C8B2C",  # two in reserve
    "#C2571A",
)
"""Colours of the constraining lines in both themes; the first seven stay apart for colour-blind eyes."""

CUP_COLOUR = "#8D94C4"
"""Colour of a mark that stands for a cup, in both themes."""

MAP_LESS = ("#1D4E8F", "#4C8CCB", "#A9C8E6")
"""Colours of a map below zero, the least first; zero is the clay of the body."""

MAP_MORE = ("#F2B685", "#D9772B", "#A34A0E")
"""Colours of a map above zero, the largest last."""

MAP_AMOUNT = ("#F2B685", "#D9772B", "#8A3408")
"""Colours of a map of amounts, from a little to the most; nothing is the clay of the body."""
