"""Designs and documents of every kind that there can be, made up by hypothesis."""

import json
from dataclasses import replace

from hypothesis import strategies as st

from core.document.calibration_record import Calibration, FittedParameter
from core.document.custom_measures import WORN_TIGHT, CustomMeasurement
from core.document.design import TEMPLATES, WEIGHTS, Design, ScanSource
from core.document.document import VARIANTS, Document
from core.document.elastic import TISSUE_LIMITS, Elastic
from core.document.lines import ActiveLine, CustomLine, LineSettings
from core.document.printable_name import is_blank, is_printable
from core.document.serialization import to_json
from core.landmarks.manual import PlacedMark
from core.landmarks.types import NAMES
from core.mechanics.constraint_lines import RATIO_LIMITS
from core.mechanics.options import CHOICES, RANGES
from core.mechanics.volume import CONTROLS

PLAIN = Design(ScanSource("/scans/body.ply"))
KNOWN = set(json.loads(to_json(PLAIN)))
ALL_KNOWN = {*vars(PLAIN), "format", "length_unit"}

words = st.text(max_size=12)
control = ["Cc", "Cs", "Zl", "Zp"]
letters = st.characters(exclude_categories=control).filter(lambda each: is_printable(each, 1))
names = st.text(letters, max_size=12)
seen_names = st.text(letters, min_size=1, max_size=12).filter(lambda name: not is_blank(name))
anything = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | words,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(words, inner, max_size=3),
    max_leaves=6,
)
sources = st.builds(
    ScanSource,
    path=words,
    member=words,
    unit=st.none() | st.sampled_from(["mm", "cm", "m", "inch"]),
    up=st.none() | words,
    front=st.none() | words,
)
figures = st.floats(-1e6, 1e6)


def unique(made, **limits):
    return st.lists(made, unique_by=lambda each: each.name, **limits).map(tuple)


own_lines = unique(
    st.builds(
        CustomLine,
        seen_names,
        st.lists(st.integers(0, 103), min_size=3, max_size=6, unique=True).map(tuple),
        st.booleans(),
    ),
    max_size=3,
)
elastics = unique(
    st.builds(
        Elastic,
        seen_names,
        st.floats(1.0, 200.0),
        st.lists(st.tuples(st.floats(0.01, 1.0), st.floats(0.1, 10.0)), min_size=1, max_size=5).map(
            lambda steps: tuple(
                (sum((step for step, _ in steps[:k]), 0.0), sum((rise for _, rise in steps[:k]), 0.0))
                for k in range(len(steps) + 1)
            )
        ),
        st.floats(0.0, 200.0),
        names,
        st.booleans(),
    ),
    max_size=3,
)
measures = unique(
    st.builds(CustomMeasurement, seen_names, st.just("girth"), st.just(()), st.floats(-2000.0, 2000.0))
    | st.builds(
        CustomMeasurement,
        seen_names,
        st.sampled_from(["straight", "skin"]),
        st.lists(st.sampled_from(NAMES), min_size=2, max_size=2, unique=True).map(tuple),
    ),
    max_size=3,
)
calibrations = st.builds(
    Calibration,
    seen_names,
    figures,
    figures,
    st.lists(
        st.builds(FittedParameter, seen_names, figures, figures, figures, st.booleans()), max_size=3
    ).map(tuple),
    figures,
)
placed = unique(
    st.builds(PlacedMark, st.sampled_from(NAMES), st.tuples(*[st.floats(-5000.0, 5000.0)] * 3)), max_size=3
)


@st.composite
def traits(draw, made_of):
    colour = st.just("") | st.from_regex("#[0-9a-f]{6}", fullmatch=True)
    number = st.none() | st.floats(*RANGES["line_stiffness"])
    width = st.none() | st.floats(2.0, 100.0)
    elastic = st.sampled_from(["", *(each.name for each in made_of)])
    flags = st.booleans()
    one = st.builds(LineSettings, seen_names, names, colour, flags, flags, number, width, elastic)
    return draw(unique(one, max_size=3))


@st.composite
def designs(draw):
    made_of = draw(elastics)
    words_of = {key: draw(st.sampled_from(choices)) for key, choices in CHOICES.items()}
    if words_of["tissue"] == "solid":
        words_of["line_contact"] = "glued"  # lines cannot slide on a solid
    return draw(
        st.builds(
            Design,
            scan=sources,
            template=st.sampled_from(TEMPLATES),
            line_height=st.floats(0.25, 0.75),
            lines=st.lists(st.builds(ActiveLine, names, st.floats(*RATIO_LIMITS)), max_size=4).map(tuple),
            volume=st.sampled_from(CONTROLS),
            gain=st.none() | st.floats(0.0, 10.0),
            weights=st.sampled_from(WEIGHTS),
            scaled_normals=st.booleans(),
            dense_volume=st.booleans(),
            own_lines=own_lines,
            traits=traits(made_of),
            placed=placed,
            own_measures=measures,
            elastics=st.just(made_of),
            tissue_stiffness=st.floats(*TISSUE_LIMITS),
            customer=names,
            worn_tight_mm=st.floats(*WORN_TIGHT),
            calibration=st.none() | calibrations,
            **{key: st.just(word) for key, word in words_of.items()},
            **{key: st.floats(*limits) for key, limits in RANGES.items()},
            unknown=st.dictionaries(words.filter(lambda word: word not in ALL_KNOWN), anything, max_size=3),
        )
    )


@st.composite
def documents(draw):
    """Documents of up to three variants on one body."""
    document = Document.single(draw(designs()))
    for name in VARIANTS[1 : draw(st.integers(1, 3))]:
        document = document.with_shown(name).with_design(
            replace(draw(designs()), scan=document.design.scan, placed=document.design.placed)
        )
    return document
