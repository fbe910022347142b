"""Standard deviations of all uncertain inputs with their sources, as data."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import cache
from importlib import resources

from core.errors import UserError
from core.landmarks.bust_point import SMOOTH
from core.landmarks.types import CERTAIN, Landmark
from core.measurements.size_table import LocalizedText
from core.measurements.uncertain_value import SOURCES
from core.messages import Message


@dataclass(frozen=True)
class InputUncertainty:
    """Standard deviations of the sources.

    ``landmark_mm`` of a landmark in each direction along the skin, ``unsure_landmark_mm`` of one that is not
    sure; ``skin_mm`` of the scan along its normals; ``tissue_ln`` and ``line_ln`` of the logarithm of the
    stiffness of a net and of lines without an elastic, ``sag_ln`` of that of the sag of a solid;
    ``tape_mm`` of the length of a band as it is sewn; ``elastic_ln`` and ``measured_elastic_ln`` of the
    logarithm of an elastic's force. ``net_error`` and ``solid_error`` [1] of the displacement by each model
    of the tissue, over the rms motion of a breast, at least ``net_error_mm`` and ``solid_error_mm``. What is
    told after a ± is ``sds`` of them.
    """

    sds: float = 2.0
    landmark_mm: float = 0.0
    unsure_landmark_mm: float = 0.0
    skin_mm: float = 0.0
    tissue_ln: float = 0.0
    sag_ln: float = 0.0
    line_ln: float = 0.0
    tape_mm: float = 0.0
    elastic_ln: float = 0.0
    measured_elastic_ln: float = 0.0
    net_error: float = 0.0
    net_error_mm: float = 0.0
    solid_error: float = 0.0
    solid_error_mm: float = 0.0

    def __post_init__(self) -> None:
        for name in NUMBERS:
            if not 0.0 <= getattr(self, name) <= 20.0:
                raise UserError(
                    Message(
                        "The value {number} of {name} is out of range.",
                        name=name,
                        number=f"{getattr(self, name):g}",
                    ),
                    Message("Enter a value from 0 to 20."),
                )

    def scaled(self, share: float) -> InputUncertainty:
        """Return all sources so many times as large."""
        return replace(self, **{name: share * getattr(self, name) for name in NUMBERS if name != "sds"})

    def of_landmark(self, mark: Landmark) -> float:
        """Return the standard deviation of a landmark in each direction along the skin [mm]."""
        # A smooth breast tells where it points to, but its nipple lies somewhere about there.
        sure = mark.confidence >= CERTAIN and mark.rule != SMOOTH
        return self.landmark_mm if sure else self.unsure_landmark_mm

    def of_model(self, tissue: str) -> tuple[float, float]:
        """Return the error of a model of the tissue: its share of the motion [1], and its least [mm]."""
        if tissue == "solid":
            return self.solid_error, self.solid_error_mm
        return self.net_error, self.net_error_mm


NUMBERS = tuple(field.name for field in fields(InputUncertainty))
"""The names of all that is assumed."""


@cache
def default_uncertainty() -> InputUncertainty:
    """Return what comes with Busk."""
    return InputUncertainty(**{name: float(_file()[name]) for name in NUMBERS})  # type: ignore[arg-type]


@cache
def origins() -> Mapping[str, LocalizedText]:
    """Return where each source's numbers come from, by source."""
    told = {each["name"]: LocalizedText(each["en"], each["ja"]) for each in _file()["sources"]}  # type: ignore[attr-defined]
    return {name: told[name] for name in SOURCES}


def with_overrides(texts: Sequence[str], base: InputUncertainty) -> InputUncertainty:
    """Return ``base`` with what ``texts`` like "tape_mm=3" say. Raises UserError."""
    told = {}
    for text in texts:
        name, _, value = text.partition("=")
        name = name.strip().replace("-", "_")
        if name not in NUMBERS:
            raise UserError(
                Message("Unknown assumption '{name}'.", name=name),
                Message("Choose one of: {choices}.", choices=", ".join(NUMBERS)),
            )
        try:
            told[name] = float(value)
        except ValueError:
            raise UserError(
                Message("'{value}' is not a number for {name}.", value=value, name=name),
                Message("Enter {name}=2.", name=name),
            ) from None
    return replace(base, **told)


@cache
def _file() -> dict[str, object]:
    text = (resources.files("resources") / "spread.json").read_text(encoding="utf-8")
    values: dict[str, object] = json.loads(text)
    return values
