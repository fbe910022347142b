"""A document as text: an older Busk is told that it cannot read it, whichever variant it could not read."""

from __future__ import annotations

import json
from dataclasses import replace

from core.document.design import Design, ScanSource
from core.document.document import Document
from core.document.serialization import DESIGN, WITH_ELASTICS, WITH_VARIANTS, from_texts, to_texts
from core.garment.elastic_library import find_elastic

PLAIN = Design(ScanSource("anna.ply")).with_line("mid-bust", 0.9)
ELASTIC = PLAIN.with_elastic("mid-bust", find_elastic("picot 10"))


def written(document: Document) -> int:
    return int(json.loads(to_texts(document)[DESIGN])["format"])


def test_the_format_is_that_of_the_newest_variant() -> None:
    two = replace(Document.single(PLAIN), designs=(("A", PLAIN), ("B", PLAIN.with_line("mid-bust", 0.8))))
    hidden = replace(two, designs=(("A", PLAIN), ("B", ELASTIC)))
    assert written(Document.single(PLAIN)) == 1
    assert written(two) == WITH_VARIANTS
    assert written(hidden) == WITH_ELASTICS
    assert written(replace(hidden, shown="B")) == WITH_ELASTICS
    assert from_texts(to_texts(hidden)) == hidden
