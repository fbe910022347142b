"""Document: all that is saved and undone, up to three variants of the design on one body."""

from __future__ import annotations

from dataclasses import dataclass, replace

from core.document.design import Design
from core.errors import UserError
from core.messages import Message

VARIANTS = ("A", "B", "C")
"""What variants are called, in this order."""

_OF_THE_BODY = ("scan", "placed", "own_measures", "tissue_stiffness", "sag", "customer", "worn_tight_mm")


@dataclass(frozen=True)
class Document:
    """The variants of a design by name, of which one is ``shown``.

    All lie on one body: what is said of the scan, its landmarks, tissue, own measures and of whose it is, is
    said of every variant.
    Raises UserError if a variant has no name of ``VARIANTS`` or the shown one is not there.
    """

    designs: tuple[tuple[str, Design], ...]
    shown: str = "A"

    def __post_init__(self) -> None:
        names = [name for name, _ in self.designs]
        if self.shown not in names or names != sorted(set(names) & set(VARIANTS)):
            raise UserError(
                Message("The variants of this project are inconsistent."), Message("Open a backup.")
            )

    @classmethod
    def single(cls, design: Design) -> Document:
        """Return a document of one variant."""
        return cls(((VARIANTS[0], design),))

    @property
    def design(self) -> Design:
        """Return the design that is shown."""
        return self.variants[self.shown]

    @property
    def customer(self) -> str:
        """Return the customer, empty if none is named."""
        return self.design.customer

    @property
    def variants(self) -> dict[str, Design]:
        """Return the designs by the names of their variants."""
        return dict(self.designs)

    def with_design(self, design: Design) -> Document:
        """Return the document with another design shown; what belongs to the body goes to every variant."""
        designs = self.variants | {self.shown: design}
        return replace(
            self, designs=tuple((name, _on_same_body(each, design)) for name, each in designs.items())
        )

    def with_shown(self, name: str) -> Document:
        """Return the document with another variant shown; a new one begins as the shown one is."""
        designs = {name: self.design} | self.variants
        return Document(tuple(sorted(designs.items())), name)

    def without(self, name: str) -> Document:
        """Return the document without a variant; the last one stays."""
        left = {each: design for each, design in self.designs if each != name} or self.variants
        return Document(tuple(left.items()), self.shown if self.shown in left else min(left))


def _on_same_body(design: Design, model: Design) -> Design:
    same = {key: getattr(model, key) for key in _OF_THE_BODY}
    if all(getattr(design, key) == value for key, value in same.items()):
        return design
    return replace(design, **same)
