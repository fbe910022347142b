"""One measure before and after as a plain value, and how it is written."""

from __future__ import annotations

from dataclasses import dataclass

from app.i18n.catalog import colon, number, tr
from app.i18n.lengths import decimal_length, shown_digits, shown_unit, shown_value
from core.measurements.uncertain_value import digits, rounded


@dataclass(frozen=True)
class MeasureView:
    """One measure before and after, in ``unit``; what is not known is None, and ``note`` may say why.

    ``reference`` says from where it is counted, ``tip`` how it is taken, ``iso`` what the standard calls it.
    An ``estimate`` may be off by ``plus_minus``; what it was taken from is ``sure`` to that share [1], if
    that is known. ``key`` is that of a measure of the body, ``own`` if it is the designer's; ``group`` is
    its heading. The change of an ``exact`` one is told elsewhere too: it is the same figure everywhere.
    ``off`` is how far before, after and change may be off, ``off_faint`` if that is of a former shape;
    ``off_told`` says from what, or that it is not known. ``moves`` names how bust points moved, where that
    is the change.
    """

    label: str
    unit: str
    before: float | None
    after: float | None
    reference: str = ""
    key: str = ""
    group: str = ""
    note: str = ""
    plus_minus: float = 0.0
    estimate: bool = False
    tip: str = ""
    iso: str = ""
    sure: float | None = None
    own: bool = False
    exact: bool = False
    off: tuple[float | None, ...] = ()
    off_faint: bool = False
    off_told: tuple[str, ...] = ()
    moves: str = ""

    @property
    def change(self) -> float | None:
        """By how much it grew, if that is known: as it is written, so that the columns of a table agree."""
        if self.after is None or self.before is None or self.exact:
            return self.change_at(digits_of(self.unit))
        shown = [round(shown_value(each, self.unit), self._digits) for each in (self.after, self.before)]
        return (shown[0] - shown[1]) / shown_value(1.0, self.unit)

    def change_at(self, digits: int) -> float | None:
        """Return by how much it grew where so many decimals are written."""
        if self.after is None or self.before is None:
            return None
        if self.exact:
            return self.after - self.before
        return round(self.after, digits) - round(self.before, digits)

    @property
    def known(self) -> bool:
        """Whether it was measured at all."""
        return self.before is not None or self.after is not None

    @property
    def caption(self) -> str:
        """What stands under it: from where it is counted, how sure it is, or why it is missing."""
        if not self.known:
            return self.note
        if not self.estimate:
            return self.reference
        if not self.plus_minus or self.off:  # what is off stands beside it, with all sources
            return tr("an estimate")
        off = self.written(self.plus_minus)
        return tr("an estimate, ± {off} {unit}").format(off=off, unit=self.unit_shown)

    @property
    def details(self) -> tuple[str, ...]:
        """What is told where there is room: how it is taken, its name in the standard, how sure it is."""
        if not self.key:
            return self.off_told
        named = tr("ISO 8559-1: {name}").format(name=self.iso) if self.iso else tr("Not in ISO 8559-1")
        sure = tr("What it is taken from is sure to {percent} %")
        said = (
            self.tip,
            "" if self.own else named,
            "" if self.sure is None or not self.known else sure.format(percent=number(100 * self.sure, 0)),
            "" if self.note == self.caption else self.note,
        )
        return (*(each for each in said if each), *self.off_told)

    def written(self, value: float | None, signed: bool = False) -> str:
        """Return a value as it stands in the table."""
        return "" if value is None else number(shown_value(value, self.unit), self._digits, signed)

    def written_off(self, off: float) -> str:
        """Return how far a value may be off as it stands in the table."""
        return length_off(off) if self.unit == "mm" else plus_minus(off)

    @property
    def unit_shown(self) -> str:
        """The unit in which values are written."""
        return shown_unit(self.unit)

    @property
    def _digits(self) -> int:
        return shown_digits(digits_of(self.unit), self.unit)

    def told(self) -> str:
        """Return all that is told of it under the pointer."""
        return "\n".join((self.label, *self.details))

    def spoken(self) -> str:
        """Return it as it is read out."""
        values = [
            f"{self.written(each)} {self.unit_shown}"
            for each in (self.before, self.after)
            if each is not None
        ]
        return f"{self.label}{colon()}{' → '.join(values)} {self.caption}".rstrip()


def plus_minus(off: float) -> str:
    """Return how far a figure may be off as it is written."""
    return f"± {number(rounded(off), digits(off))}"


def length_off(off: float) -> str:
    """Return how far a length [mm] may be off as it is written, in the unit in use; never as nothing."""
    told, least = rounded(off), 10.0 ** -shown_digits(digits(off)) / shown_value(1.0)
    return f"± {decimal_length(max(told, least), digits(off))}"


def digits_of(unit: str) -> int:
    """Return how many decimals are written in a unit."""
    return 0 if unit == "ml" else 1
