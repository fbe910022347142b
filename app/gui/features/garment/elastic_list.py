"""The elastics to choose from in their order: none, own ones, those of the project and of the library."""

from __future__ import annotations

from collections.abc import Iterable

from app.i18n.catalog import tr
from app.presenters.messages import elastic_title
from core.document.elastic import Elastic
from core.errors import LineError
from core.garment.elastic_library import built_in, user_elastics

Entry = tuple[str, Elastic | None]
"""What an elastic is called in the list, and the elastic; None is no elastic."""


def elastic_entries(kept: Iterable[Elastic]) -> tuple[list[Entry], list[LineError]]:
    """Return the elastics, with why some tables of one's own cannot be read.

    ``kept`` are those that the project brings along. An elastic of one's own takes the place of one of the
    library of the same name.
    """
    own, problems = user_elastics()
    known = {each.name: each for each in (*built_in(), *own)}
    brought = [each for each in kept if known.get(each.name) != each]
    here, twice = tr("{name}, in this project"), tr("{name}, from this project")
    return [
        (tr("No elastic"), None),
        *((each.name, each) for each in own),
        *(
            ((twice if each.name in known else here).format(name=elastic_title(each.name)), each)
            for each in brought
        ),
        *((elastic_title(each.name), each) for each in built_in() if known[each.name] == each),
    ], problems
