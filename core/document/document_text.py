"""A document as texts by name, as projects and recovery folders keep it."""

from __future__ import annotations

import json
from collections.abc import Mapping

from core.document.document import Document
from core.document.document_limits import check_values
from core.document.json_values import parsed
from core.document.serialization import WITH_VARIANTS, from_json, from_values, to_json, to_values
from core.errors import ProjectError, UserError
from core.messages import Message

DESIGN, VARIANTS = "design.json", "variants.json"
"""The name of the text of the design that is shown, and of that of its variants, if there are any."""


def to_texts(document: Document) -> dict[str, str]:
    """Return what is written of a document, by name."""
    others = {name: to_values(each) for name, each in document.designs if name != document.shown}
    if document == Document.single(document.design):
        return {DESIGN: to_json(document.design)}
    # An older program would drop the variants at its next save: it must not read this.
    variants = {"shown": document.shown, "others": others}
    # Nor one that could read the design that is shown, but not a variant of it: it says by itself why.
    written = max([WITH_VARIANTS, *(each["format"] for each in others.values())])
    return {DESIGN: to_json(document.design, written), VARIANTS: json.dumps(variants, indent=1)}


def from_texts(texts: Mapping[str, str]) -> Document:
    """Read a document; there must be at least its design. Raises ProjectError if it is none."""
    design = from_json(texts[DESIGN])
    if VARIANTS not in texts:
        return Document.single(design)
    try:
        check_values(texts[VARIANTS])
        told = parsed(texts[VARIANTS])
        shown, others = told["shown"], {name: from_values(each) for name, each in told["others"].items()}
        if shown in others:
            raise ValueError("more than one design is shown")
        return Document(tuple(sorted({**others, shown: design}.items())), shown).with_design(design)
    except ProjectError:
        raise
    except (UserError, ValueError, KeyError, TypeError, AttributeError) as broken:
        raise ProjectError(
            Message("The project's variants cannot be read."), Message("Open a backup.")
        ) from broken
