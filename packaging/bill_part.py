"""A part of the bill of materials, and what must be known of it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from packaging.licenses import InvalidLicenseExpression, canonicalize_license_expression

GPL_3 = ("GNU GENERAL PUBLIC LICENSE Version 3, 29 June 2007", "END OF TERMS AND CONDITIONS")
WHOLE = {
    "GPL-2.0": ("GNU GENERAL PUBLIC LICENSE Version 2, June 1991", "END OF TERMS AND CONDITIONS"),
    "GPL-3.0": GPL_3,
    "LGPL-2.1": (
        "GNU LESSER GENERAL PUBLIC LICENSE Version 2.1, February 1999",
        "END OF TERMS AND CONDITIONS",
    ),
    "LGPL-3.0": ("GNU LESSER GENERAL PUBLIC LICENSE Version 3, 29 June 2007", *GPL_3),
    "MPL-2.0": (
        "Mozilla Public License Version 2.0",
        'Exhibit B - "Incompatible With Secondary Licenses" Notice',
    ),
}
"""Licences that want their whole text beside the program: how each begins and how it ends."""


@dataclass(frozen=True)
class Part:
    """Something that somebody has made and that is shipped: ``texts`` are file names with what they say."""

    name: str
    version: str
    licence: str
    kind: str
    texts: Mapping[str, str] = field(default_factory=dict)
    within: str = ""
    """The part that brings it along."""

    @property
    def key(self) -> str:
        """Return the name of its folder among the licences, the same on every machine."""
        return re.sub(r"[^a-z0-9.]+", "-", f"{self.within}-{self.name}".lower()).strip("-")

    @property
    def purl(self) -> str:
        """Return the address of the package, as bills of materials write it."""
        kinds = {"python": "pypi", "system": "deb/debian"}
        return f"pkg:{kinds.get(self.kind, 'generic')}/{self.key}@{self.version or 'unversioned'}"


def faults(parts: Iterable[Part]) -> list[str]:
    """Return what the bill lacks, a sentence each; nothing if all is well."""
    found = []
    for part in parts:
        if not part.licence:
            found.append(f"{part.name} has no known licence: name it in packaging/licences/known.json.")
        elif not any(text.strip() for text in part.texts.values()):
            found.append(f"{part.name} has no text of its licence.")
        elif problem := _problem(part.licence):
            found.append(f"{part.name}: {problem}")
        found += [
            f"{part.name} lacks the whole text of {name}."
            for name in wanted_whole(part.licence)
            if not _is_whole(name, part)
        ]
    return found


def wanted_whole(expression: str) -> list[str]:
    """Return the licences of an expression that want their whole text beside the program."""
    return re.findall(r"\b(?:[AL]?GPL|MPL)-\d\.\d", expression)


def _is_whole(name: str, part: Part) -> bool:
    text = " ".join(" ".join(part.texts.values()).split())
    return name in WHOLE and all(words in text for words in WHOLE[name])


def _problem(expression: str) -> str:
    try:
        canonicalize_license_expression(expression)
    except InvalidLicenseExpression as error:
        return str(error)
    return ""
