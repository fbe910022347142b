"""Design: all that the designer decided, one small immutable value. Everything else follows from it."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cached_property, reduce
from typing import Any

from core.control_mesh.lower_template import HIGH_HIP_ROW, read_lower_template
from core.document.calibration_record import Calibration
from core.document.cup import Cup
from core.document.custom_measures import WORN_TIGHT, CustomMeasurement, check_customer, with_measurement
from core.document.document_limits import (
    MOST_ELASTICS,
    MOST_LINES,
    MOST_MEASURES,
    MOST_POINTS,
    MOST_ROWS,
    check_counts,
    check_flags,
    check_numbers,
    check_words,
)
from core.document.elastic import TISSUE_LIMITS, TISSUE_STIFFNESS, Elastic, check_elastics
from core.document.garment_pattern import GarmentPattern
from core.document.lines import BUST, LOWER, ActiveLine, CustomLine, LineSettings, partner_of
from core.document.lower_trunk import LOWER_SETTINGS, LowerTrunk, line_group, lower_line_names
from core.document.printable_name import repeated
from core.errors import LandmarkError, LineError, UserError
from core.landmarks.manual import PlacedMark
from core.mechanics.constraint_lines import RATIO_LIMITS
from core.mechanics.options import CHOICES, DEFAULT_LINE_STIFFNESS, DENSITY, RANGES, SAG, ModelOptions
from core.mechanics.volume import CONTROLS
from core.messages import LineName, Message, SettingName
from core.scan.source import ScanSource

__all__ = ["TEMPLATES", "WEIGHTS", "Design", "ScanSource", "new_design"]

WEIGHTS = ("smooth", "paper")
TEMPLATES = ("168", "120")


@dataclass(frozen=True)
class Design:
    """The document: what is saved, undone and solved.

    A line that is not in ``lines`` is not worn: it is measured only. ``line_height`` [1] is where the
    mid-bust line runs between fold (0) and bust point (1). ``gain`` [probe units] is that of the conventional
    force; None stands for 0.97 of the limit at which it starts to vibrate at rest. ``scaled_normals`` lets
    what stands off the control mesh grow with it; ``dense_volume`` lets the exact answer hold the volume of
    the body itself and not that of the control mesh. For the choices of the model see ``options``.
    ``own_lines`` are lines beside those of the templates of all regions, ``traits`` how lines are treated
    where that is not as usual, ``placed`` the landmarks that were placed by hand, ``own_measures`` what is
    measured beside the usual, ``elastics`` those that lines are made of, with their curves, so that a project
    opens elsewhere. ``tissue_stiffness`` [N/m] tells what the model's forces are in newtons, an estimate (see
    docs/explanation/forces.md). ``customer`` is whom it is for, in whatever words, ``worn_tight_mm`` what
    her sizes take off the under-bust. ``calibration`` names the scan with the garment on that its numbers
    come from, if any. ``cup`` is what both breasts are worn in, if anything. ``lower`` adds the region below
    the bust, which a scan needs legs for. ``pattern`` is what its pieces are cut by, if they are wanted.
    ``unknown`` keeps what a later version wrote.
    """

    scan: ScanSource
    template: str = "168"
    line_height: float = 0.5
    lines: tuple[ActiveLine, ...] = ()
    volume: str = "adaptive"
    gain: float | None = None
    line_stiffness: float = DEFAULT_LINE_STIFFNESS
    line_contact: str = "glued"
    weights: str = "smooth"
    scaled_normals: bool = False
    dense_volume: bool = False
    member_law: str = "force-density"
    prestress: float = 0.5
    line_force: str = "implicit"
    line_hold: str = "spring"
    firm_chest: float = 0.0
    volume_of: str = "each"
    tissue: str = "net"
    sag: float = SAG
    density: float = DENSITY
    posture: str = "standing"
    own_lines: tuple[CustomLine, ...] = ()
    traits: tuple[LineSettings, ...] = ()
    placed: tuple[PlacedMark, ...] = ()
    own_measures: tuple[CustomMeasurement, ...] = ()
    elastics: tuple[Elastic, ...] = ()
    tissue_stiffness: float = TISSUE_STIFFNESS
    customer: str = ""
    worn_tight_mm: float = 0.0
    calibration: Calibration | None = None
    cup: Cup | None = None
    lower: LowerTrunk | None = None
    pattern: GarmentPattern | None = None
    unknown: Mapping[str, Any] = field(default_factory=dict, hash=False)

    def __post_init__(self) -> None:
        self._check_counts()
        self._check_settings()
        check_customer(self.customer)
        for line in self.lines:
            if not RATIO_LIMITS[0] <= line.ratio <= RATIO_LIMITS[1]:
                raise LineError(
                    Message(
                        "{line} cannot be set to {percent} % of its original length.",
                        line=LineName(line.name),
                        percent=f"{100 * line.ratio:.1f}",
                    ),
                    Message(
                        "Enter {low} to {high} %.",
                        low=f"{100 * RATIO_LIMITS[0]:.0f}",
                        high=f"{100 * RATIO_LIMITS[1]:.0f}",
                    ),
                )
        self._check_names()
        traits = [each for region in self.regions for each in region.traits]
        check_elastics(self.elastics, {each.name: each.elastic for each in traits if each.elastic})

    def _check_names(self) -> None:
        below = () if self.lower is None else sorted(lower_line_names())
        self._check_lower_names()
        if twice := repeated((*(line.name for line in self.own_lines), *below)):
            raise LineError(
                Message("Two lines are named '{name}'.", name=LineName(twice)),
                Message("Give each line a unique name."),
            )
        if twice := repeated(line.name for line in self.traits):
            raise LineError(
                Message("The line {name} has contradictory settings.", name=LineName(twice)),
                Message("Specify the settings of each line only once."),
            )
        if twice := repeated(mark.name for mark in self.placed):
            raise LandmarkError(
                Message("The landmark {name} is specified twice.", name=twice),
                Message("Specify each name only once."),
            )
        if twice := repeated(measure.name for measure in self.own_measures):
            raise UserError(
                Message("Two measurements are named '{name}'.", name=twice),
                Message("Give each measurement a unique name."),
            )

    def _check_lower_names(self) -> None:
        """Refuse lines of the lower trunk that are none, and parts of lines that are not there."""
        own = {line.name for line in self.own_lines if line.region == BUST}
        parts = [line for line in self.own_lines if line.continues]
        loose = [line.name for line in parts if self.lower is not None and line.continues not in own]
        if loose or len({line.continues for line in parts}) < len(parts):
            name = (loose or [line.name for line in parts])[-1]
            raise LineError(
                Message("The line {line} cannot continue another line.", line=LineName(name)),
                Message("Draw the line again."),
            )
        if self.lower is None:
            return
        known = self.lower_names
        named = {line.name for line in self.lower.lines} | {traits.name for traits in self.lower.traits}
        for name in sorted(named - known):
            raise LineError(
                Message("There is no line '{line}'.", line=LineName(name)),
                Message("Available lines: {lines}.", lines=", ".join(sorted(known))),
            )

    def _check_counts(self) -> None:
        check_counts(
            (
                *(
                    (len(lines), MOST_LINES, Message("lines"))
                    for lines in (self.lines, self.own_lines, self.traits)
                ),
                (sum(map(CustomLine.count, self.own_lines)), MOST_POINTS, Message("points of custom lines")),
                (len(self.own_measures), MOST_MEASURES, Message("custom measurements")),
                (len(self.elastics), MOST_ELASTICS, Message("elastics")),
                (
                    sum(len(each.curve) for each in self.elastics),
                    MOST_ROWS,
                    Message("rows in tables of elastics"),
                ),
            )
        )

    def _check_settings(self) -> None:
        check_words(
            (
                (self.template, TEMPLATES, SettingName("template")),
                (self.volume, CONTROLS, SettingName("volume control")),
                (self.weights, WEIGHTS, SettingName("t-FFD weighting")),
                *((getattr(self, key), words, SettingName(key)) for key, words in CHOICES.items()),
            )
        )
        check_flags((getattr(self, key), SettingName(key)) for key in ("scaled_normals", "dense_volume"))
        check_numbers(
            (
                (self.line_height, 0.25, 0.75, SettingName("mid-bust line height")),
                *((getattr(self, key), *limits, SettingName(key)) for key, limits in RANGES.items()),
                (1.0 if self.gain is None else self.gain, 0.0, 10.0, SettingName("gain")),
                (self.tissue_stiffness, *TISSUE_LIMITS, SettingName("tissue stiffness")),
                (self.worn_tight_mm, *WORN_TIGHT, SettingName("tape tension allowance")),
            )
        )

    @property
    def model_options(self) -> ModelOptions:
        """Return the choices of the model among the settings."""
        return ModelOptions(**{field.name: getattr(self, field.name) for field in fields(ModelOptions)})

    def setting(self, name: str) -> Any:
        """Return a setting, a field or one of ``LOWER_SETTINGS``: its default without a lower trunk."""
        if name in LOWER_SETTINGS:
            return getattr(self.lower or LowerTrunk(), LOWER_SETTINGS[name])
        return getattr(self, name)

    def with_settings(self, changes: Mapping[str, Any]) -> Design:
        """Return the design with settings changed; one of ``LOWER_SETTINGS`` adds the lower trunk."""
        below = {LOWER_SETTINGS[name]: value for name, value in changes.items() if name in LOWER_SETTINGS}
        fields = {name: value for name, value in changes.items() if name not in LOWER_SETTINGS}
        if below:
            fields["lower"] = replace(self.lower or LowerTrunk(), **below)
        return replace(self, **fields)

    def ratio(self, name: str) -> float:
        """Return the ratio of a line, 1 if it is not worn."""
        return next((line.ratio for line in self.region_of(name).lines if line.name == name), 1.0)

    @property
    def regions(self) -> tuple[Design, ...]:
        """Return the design of each region by itself, the bust's first."""
        return (self,) if self.lower is None else (self, self.lower_design)

    @cached_property
    def lower_design(self) -> Design:
        """Return what is decided of the lower trunk as a design of its own, on a net without cups.

        Raises ValueError without that region.
        """
        if self.lower is None:
            raise ValueError("the design has no lower trunk")
        lower = self.lower
        return replace(
            self,
            lines=lower.lines,
            traits=lower.traits,
            own_lines=self.lines_of(LOWER),
            cup=None,
            lower=None,
            pattern=None,
            tissue="net",
            firm_chest=lower.firmness,
            volume_of="each",
            dense_volume=False,
            tissue_stiffness=lower.stiffness,
        )

    @cached_property
    def lower_names(self) -> frozenset[str]:
        """Return the names of all lines of the lower trunk, the designer's own among them."""
        return lower_line_names() | {line.name for line in self.lines_of(LOWER)}

    def lines_of(self, region: str) -> tuple[CustomLine, ...]:
        """Return the designer's own lines of a region."""
        return tuple(line for line in self.own_lines if line.region == region)

    def region_of(self, name: str) -> Design:
        """Return the design of the region that a line belongs to."""
        return self.lower_design if self.lower is not None and name in self.lower_names else self

    def _with_region(self, region: Design) -> Design:
        """Return the design with what another one of the lower trunk decides of its lines."""
        assert self.lower is not None
        lower = replace(self.lower, lines=region.lines, traits=region.traits)
        known = {each.name: each for each in (*self.elastics, *region.elastics)}
        used = {each.elastic for each in (*self.traits, *region.traits) if each.elastic}
        return replace(self, lower=lower, elastics=tuple(known[name] for name in sorted(used)))

    def wearing(self, names: Collection[str]) -> Design:
        """Return the design with lines of one region worn, those that are not at 100 %, locked or not."""
        region = self.region_of(next(iter(names)))
        off = sorted(set(names) - region.active_lines())
        after = replace(region, lines=(*region.lines, *(ActiveLine(name, 1.0) for name in off)))
        return after if region is self else self._with_region(after)

    def active_lines(self) -> frozenset[str]:
        """Return the names of the lines that are worn."""
        return frozenset(line.name for line in self.lines)

    def all_active_lines(self) -> frozenset[str]:
        """Return the names of the lines that are worn in any region."""
        return frozenset(line.name for region in self.regions for line in region.lines)

    @property
    def is_bare(self) -> bool:
        """Return whether nothing reshapes the body: no line, no cup, and it stands as it was scanned."""
        lies = self.tissue == "solid" and self.posture != "standing"
        below = self.lower is not None and bool(self.lower.lines)
        return not self.lines and self.cup is None and not lies and not below

    def line_stiffnesses(self) -> dict[str, float]:
        """Return the stiffness [1] of each worn line that has its own."""
        own = {each.name: each.stiffness for each in self.traits if each.name in self.active_lines()}
        return {name: stiffness for name, stiffness in own.items() if stiffness is not None}

    def active_elastics(self) -> dict[str, Elastic]:
        """Return the elastic of each worn line that has one."""
        elastics = {elastic.name: elastic for elastic in self.elastics}
        made = {each.name: each.elastic for each in self.traits if each.elastic}
        return {name: elastics[elastic] for name, elastic in made.items() if name in self.active_lines()}

    def with_elastic(self, name: str, elastic: Elastic | None) -> Design:
        """Return the design with a line made of an elastic, and as wide; of none in particular if None.

        Lines that share an elastic of this name share its curve.
        """
        if (region := self.region_of(name)) is not self:
            return self._with_region(region.with_elastic(name, elastic))
        if elastic is None:
            return self.with_line_settings(replace(self.line_settings(name), elastic="", width=None))
        others = tuple(each for each in self.elastics if each.name != elastic.name)
        design = replace(self, elastics=tuple(sorted((*others, elastic), key=lambda each: each.name)))
        traits = replace(self.line_settings(name), elastic=elastic.name, width=elastic.width_mm)
        return design.with_line_settings(traits)

    def is_equivalent(self, other: Design) -> bool:
        """Tell whether another design is solved alike: customer, measures, names, calibration do not act."""
        mine, others = (
            reduce(
                Design.with_line_settings,
                [traits.mechanical() for region in each.regions for traits in region.traits],
                each,
            )
            for each in (self, other)
        )
        neutral: dict[str, Any] = {
            "own_measures": (),
            "customer": "",
            "worn_tight_mm": 0.0,
            "calibration": None,
            "pattern": None,
        }
        return replace(mine, **neutral) == replace(others, **neutral)

    def with_template(self, template: str) -> Design:
        """Return the design with another template. Raises LineError if there are own lines of the bust.

        Their control points are those of the template that they were drawn on.
        """
        if self.lines_of(BUST) and template != self.template:
            raise LineError(
                Message(
                    "Custom lines belong to the {template}-polygon control mesh.", template=self.template
                ),
                Message("Remove custom lines before switching."),
            )
        return replace(self, template=template)

    def with_custom_line(self, line: CustomLine) -> Design:
        """Return the design with an own line, in the place of one of the same name if there is one.

        One of the lower trunk adds that region.
        """
        lower = LowerTrunk() if self.lower is None and line.region == LOWER else self.lower
        own = (*self.own_lines, line)
        if line.name in {each.name for each in self.own_lines}:
            self._check_unlocked(line.name)
            own = tuple(line if each.name == line.name else each for each in self.own_lines)
        return replace(self, own_lines=own, lower=lower)

    def without_custom_line(self, name: str) -> Design:
        """Return the design without an own line, its part below the bust, and what was decided of them.

        Raises LineError if it is locked.
        """
        gone = self.band_of(name)
        after = self
        for each in gone:
            after._check_unlocked(each)
            after = after.with_line(each, None).with_line_settings(LineSettings(each))
        return replace(after, own_lines=tuple(each for each in self.own_lines if each.name not in gone))

    def line_settings(self, name: str) -> LineSettings:
        """Return how a line is treated."""
        usual = LineSettings(name)
        return next((traits for traits in self.region_of(name).traits if traits.name == name), usual)

    def with_line_settings(self, traits: LineSettings) -> Design:
        """Return the design with a line treated in another way."""
        if (region := self.region_of(traits.name)) is not self:
            return self._with_region(region.with_line_settings(traits))
        others = [each for each in self.traits if each.name != traits.name]
        kept = others if traits == LineSettings(traits.name) else [*others, traits]
        used = {each.elastic for each in (*kept, *(self.lower.traits if self.lower else ()))}
        elastics = tuple(each for each in self.elastics if each.name in used)
        return replace(self, traits=tuple(sorted(kept, key=lambda each: each.name)), elastics=elastics)

    def band_of(self, name: str) -> tuple[str, ...]:
        """Return the parts of the band that a line belongs to: one in each region that it runs over."""
        own = {each.name: each.continues for each in self.own_lines}
        upper = own[name] if own.get(name) in own else name
        return (upper, *(each.name for each in self.own_lines if each.continues == upper))

    def linked_lines(self, name: str) -> tuple[str, ...]:
        """Return the lines that share length and lock with the line ``name``, those of the bust first.

        They are the parts of its band, and those of the other side if it is linked.
        """
        band, partner = self.band_of(name), partner_of(name)
        sides = [self.line_settings(each) for each in (name, partner)]
        paired = {line.name for line in self.own_lines} | lower_line_names()
        both = partner in paired and all(side.linked for side in sides)
        alike = sides[0].locked == sides[1].locked and self.ratio(name) == self.ratio(partner)
        names = (*band, *self.band_of(partner)) if both and alike else band
        below = {line.name for line in self.lines_of(LOWER)}
        return tuple(sorted(names, key=lambda each: (each in below, each)))

    def with_link(self, name: str) -> Design:
        """Return the design with a line linked to its partner, which takes its length; a lock is for both.

        Raises LineError if the partner is locked at another length.
        """
        names = (name, partner_of(name))
        locked = any(self.line_settings(each).locked for each in names)
        after = self
        if self.ratio(names[0]) != self.ratio(names[1]):
            worn = name in self.region_of(name).active_lines()
            for each in self.band_of(names[1]):
                after = after.with_line(each, self.ratio(name) if worn else None)
        every = [each for side in names for each in self.band_of(side)]
        traits = [replace(self.line_settings(each), linked=True, locked=locked) for each in every]
        return reduce(Design.with_line_settings, traits, after)

    def with_placed(self, name: str, position: tuple[float, float, float] | None) -> Design:
        """Return the design with a landmark placed in the scan file's frame, or found again (None)."""
        others = tuple(mark for mark in self.placed if mark.name != name)
        placed = others if position is None else (*others, PlacedMark(name, position))
        return replace(self, placed=tuple(sorted(placed, key=lambda mark: mark.name)))

    def with_custom_measurement(self, measure: CustomMeasurement, former: str = "") -> Design:
        """Return the design with an own measure, in the place of the ``former`` one or one of its name.

        Raises UserError if another one than the former has the name already.
        """
        return replace(self, own_measures=with_measurement(self.own_measures, measure, former))

    def without_custom_measurement(self, name: str) -> Design:
        """Return the design without an own measure."""
        return replace(self, own_measures=tuple(each for each in self.own_measures if each.name != name))

    def with_line(self, name: str, ratio: float | None) -> Design:
        """Return the design with the band of a line at ``ratio``, or off (None).

        Raises LineError if it is locked.
        """
        return reduce(lambda design, each: design._with_part(each, ratio), self.band_of(name), self)

    def _with_part(self, name: str, ratio: float | None) -> Design:
        if (region := self.region_of(name)) is not self:
            return self._with_region(region._with_part(name, ratio))
        if ratio != (self.ratio(name) if name in self.active_lines() else None):
            self._check_unlocked(name)
        others = [line for line in self.lines if line.name != name]
        worn = [*others, ActiveLine(name, ratio)] if ratio is not None else others
        return replace(self, lines=tuple(sorted(worn, key=lambda line: line.name)))

    def with_linked(self, name: str, ratio: float | None) -> Design:
        """Return the design with a line and its linked partner at ``ratio``. Raises LineError if locked."""
        return reduce(lambda design, each: design.with_line(each, ratio), self.linked_lines(name), self)

    def with_lines_reset(self) -> Design:
        """Return the design with every line taken off that is not locked, in all regions."""
        return self.with_bust_lines_reset().with_lower_lines_reset()

    def with_bust_lines_reset(self) -> Design:
        """Return the design with every line of the bust taken off that is not locked."""
        return self._without(self.active_lines())

    def with_lower_lines_reset(self) -> Design:
        """Return the design with every line of the lower trunk taken off that is not locked."""
        return self if self.lower is None else self._without(self.lower_design.active_lines())

    def _without(self, names: Collection[str]) -> Design:
        loose = [name for name in sorted(names) if not self.line_settings(name).locked]
        return reduce(lambda design, name: design.with_line(name, None), loose, self)

    def line_group(self, name: str) -> str:
        """Return where a garment has a line: "bust", or one of ``lower_trunk.GROUPS``."""
        own = next((line for line in self.own_lines if line.name == name), None)
        if own is None or own.region == BUST:
            return line_group(name)
        if own.continues:
            return BUST
        rows = [row for row, _ in own.places] or [float(read_lower_template().row[at]) for at in own.points]
        return "waist" if sum(rows) / len(rows) < HIGH_HIP_ROW else "seat"

    def _check_unlocked(self, name: str) -> None:
        if self.line_settings(name).locked:
            raise LineError(
                Message("The line {name} is locked.", name=LineName(name)), Message("Unlock the line first.")
            )


def new_design(scan: ScanSource) -> Design:
    """Return the design that a scan begins with: no line, on solid tissue.

    Fields have the defaults of the first version instead, whose projects have a net and do not say so.
    """
    return Design(scan, tissue="solid")
