"""The list of the pictures of the window in README and guide: what each shows, in which size and language."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace

import advice_scenes
import batch_scenes
import scenes
from scenes import (
    Scene,
    bra,
    for_customer,
    for_somebody,
    in_bra,
    made_of_elastics,
    own_scan,
    sheet,
    step,
    tab,
    vibrating,
)

from app.presenters.samples import STRAP, dressed_sample, sample_design
from core.document.design import Design


@dataclass(frozen=True)
class Shot:
    """A picture by its name under ``docs/pictures``; a ``small`` one is written in 256 colours."""

    name: str
    design: Callable[[], Design]
    scene: Scene
    options: Mapping[str, object] = field(default_factory=dict)
    small: bool = False


SMALL, WIDE, LARGE = (1280, 800), (1440, 800), (1600, 1000)
DARK = {"dark": True, "language": "ja", "size": SMALL}


def _bare_mannequin() -> Design:
    return replace(sample_design("mannequin"), lines=())


def _mannequin() -> Design:
    return sample_design()


def _person() -> Design:
    return sample_design("person")


def runs() -> Iterator[Design]:
    """Give a design whose run settles, one that strains, one that folds and one that vibrates."""
    yield _mannequin().with_line("mid-bust", 0.95)
    yield _mannequin().with_line("mid-bust", 0.89)
    yield _mannequin().with_line("mid-bust", 0.6)
    yield vibrating()


# Of the first customer, in both languages.
FIRST: tuple[tuple[str, Callable[[], Design], Scene], ...] = (
    ("first-scan", own_scan, step("scan")),
    ("first-landmarks", own_scan, scenes.pin_selected),
    ("first-lines", in_bra, tab("lines", STRAP)),
    ("first-garment", in_bra, tab("garment", STRAP)),
    ("first-pressure", in_bra, scenes.pressed_most),
    ("first-report", for_customer, scenes.reported),
)

# Of each screen, in both languages.
SCREENS: tuple[tuple[str, Callable[[], Design], Scene], ...] = (
    ("tour", dressed_sample, scenes.touring),
    ("start", _mannequin, scenes.start_page),
    *((name, _person, step(name)) for name in ("landmarks", "lines", "result")),
    ("ask", _person, scenes.asking),
    ("cups", in_bra, step("lines")),
    ("wish", bra, advice_scenes.wishing),
    ("drawn-profile", bra, advice_scenes.drawing_a_profile),
    ("path", _mannequin, scenes.drawing),
    ("garment", made_of_elastics, tab("garment")),
    ("wipe", bra, scenes.wiped),
    ("pressure", made_of_elastics, scenes.pressed),
    ("variants", _mannequin, scenes.variants),
    ("model", scenes.sliding, scenes.model_page),
    ("report", for_somebody, scenes.reported),
    ("export", made_of_elastics, sheet(scenes.exporting("lines"))),
    ("elastics", made_of_elastics, sheet(lambda window: window.elastics_controller.show())),
    ("preferences", _mannequin, sheet(scenes.preferring)),
    ("commands", _mannequin, sheet(scenes.searched)),
    ("keys", _mannequin, sheet(lambda window: window.help_controller.show_keys())),
)

# Of README and of pages in one language.
ONCE = (
    Shot("window", dressed_sample, scenes.nothing, {"size": LARGE}),
    Shot("map", _mannequin, scenes.mapped, {"size": LARGE}),
    Shot("girdle", lambda: dressed_sample("trunk"), scenes.girdle, {"size": SMALL}, small=True),
    Shot("vibrating", vibrating, scenes.with_control_mesh, {"dark": True, "size": SMALL}),
    Shot("spread", bra, advice_scenes.sure, {"size": LARGE}),
    Shot("even", bra, advice_scenes.even, {"size": SMALL}),
    Shot("worn", bra, advice_scenes.compared, {"size": SMALL}),
    Shot("pattern", _bare_mannequin, scenes.pattern, {"size": LARGE}),
    Shot("batch", dressed_sample, batch_scenes.ran, {"size": SMALL}, small=True),
    Shot("lines-dark-ja", _person, step("lines"), DARK, small=True),
)


def _all() -> Iterator[Shot]:
    yield from ONCE
    for name, design, scene in (*FIRST, *SCREENS):
        english = Shot(name, design, scene, {"size": SMALL}, small=True)
        yield english
        yield replace(english, name=f"ja/{name}", options={"size": SMALL, "language": "ja"})
    yield Shot("ja/pattern", _bare_mannequin, scenes.pattern, {"size": SMALL, "language": "ja"}, small=True)
    yield Shot("ja/map", _mannequin, scenes.mapped, {"size": LARGE, "language": "ja"}, small=True)


SHOTS = tuple(_all())
