"""Renders the pictures of README and guide with the program itself: ``make docs-pictures``.

With names it draws these alone: ``python packaging/docs_pictures.py lines ja/lines``.
"""

from __future__ import annotations

import shutil
import sys
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from PIL import Image
from PySide6.QtGui import QImage, QPainter

from app.rendering.display import off_screen

off_screen()

import scenes  # noqa: E402 - beside this file, as are those below

scenes.use_own_folders()

import guide_pictures  # noqa: E402
import measure_pictures  # noqa: E402
from guide_pictures import SHOTS, WIDE  # noqa: E402

from app.cli.commands.picture import draw_picture, save_window, settled_window  # noqa: E402
from app.presenters.samples import sample_design  # noqa: E402
from app.report.pages import pages_of  # noqa: E402
from app.report.painter import A4, UNITS  # noqa: E402
from app.research.commands.figures import make_figures  # noqa: E402

PICTURES = Path(__file__).parent.parent / "docs" / "pictures"
KEPT = 16
"""So many colours of a picture stay to the last bit."""


def draw(shot: guide_pictures.Shot) -> None:
    """Bring a window to what a picture shows, and save it or a part of it."""
    path, options = PICTURES / f"{shot.name}.png", dict[str, Any](shot.options)
    path.parent.mkdir(parents=True, exist_ok=True)
    with settled_window(shot.design(), **options) as window:
        part = shot.scene(window)
        # What is asked for is seen, and not taken.
        scenes.wait_for(lambda: window.is_settled() or window.target_shape_controller.is_open)
        save_window(window, path)
        if part is not None:
            part.grab().save(str(path))
    if shot.small:
        with_few_colours(path)
    print(f"docs/pictures/{shot.name}.png: {path.stat().st_size // 1024} kB")


def with_few_colours(path: Path) -> None:
    """Write a picture again in 256 colours: a third of the size, and the eye sees no difference.

    The most frequent ones, those of panels and letters, stay as they are; the rest is mixed of what an octree
    finds. A median cut, as Pillow has it, loses the small coloured parts.
    """
    image = Image.open(path).convert("RGB")
    frequent = sorted(image.getcolors(image.width * image.height), reverse=True)[:KEPT]
    octree = image.quantize(256 - KEPT, method=Image.Quantize.FASTOCTREE).getpalette()[: 3 * (256 - KEPT)]
    colours = Image.new("P", (1, 1))
    colours.putpalette([value for _, colour in frequent for value in colour] + octree)
    mixed = image.quantize(palette=colours, dither=Image.Dither.FLOYDSTEINBERG)
    places, exact = np.array(mixed), np.asarray(image)
    for place, (_, colour) in enumerate(frequent):
        places[(exact == colour).all(axis=2)] = place
    mixed.putdata(places.ravel().tolist())
    mixed.save(path, optimize=True)


def verdicts() -> None:
    """Put the words of four runs under each other, in both languages."""
    for folder, language in (("", "en"), ("ja/", "ja")):
        strips = []
        for design in guide_pictures.runs():
            with settled_window(design, size=WIDE, language=language) as window:
                save_window(window, PICTURES / f"{folder}verdicts.png")
                strips.append(window.strip.grab().toImage())
        room = QImage(strips[0].width(), sum(each.height() for each in strips), strips[0].format())
        painter = QPainter(room)
        for place, strip in enumerate(strips):
            painter.drawImage(0, place * strip.height(), strip)
        painter.end()
        room.save(str(PICTURES / f"{folder}verdicts.png"))
        with_few_colours(PICTURES / f"{folder}verdicts.png")


def figures() -> None:
    """Draw the figures of the paper again."""
    with TemporaryDirectory() as folder:
        make_figures(Path(folder))
        for drawn in sorted(Path(folder).glob("fig-*.png")):
            shutil.copy(drawn, PICTURES)


def printed_sheets() -> None:
    """Show the pages of a sheet as they are printed: 100 dots to an inch."""
    with settled_window(scenes.for_somebody()) as window:
        scenes.reported(window)
        handout = window.report_controller.handout
        assert handout is not None
        for name, language, page in (("sheet-1", "en", 0), ("sheet-2", "en", 1), ("sheet-1-ja", "ja", 0)):
            image = QImage(827, 1169, QImage.Format.Format_RGB32)
            image.fill(0xFFFFFF)
            painter = QPainter(image)
            painter.scale(827 / A4[0] / UNITS, 827 / A4[0] / UNITS)
            pages_of(handout, language).paint(painter, page)
            painter.end()
            image.save(str(PICTURES / f"{name}.png"))


def unloaded() -> None:
    """Show the breasts from the side as scanned and without their weight, side by side."""
    standing = replace(sample_design("person"), lines=(), tissue="solid")
    with TemporaryDirectory() as folder:
        drawn = []
        for posture in ("standing", "unloaded"):
            path = Path(folder) / f"{posture}.png"
            draw_picture(replace(standing, posture=posture), path, view="left", size=(700, 800))
            drawn.append(Image.open(path).convert("RGB"))
        both = Image.new("RGB", (1400, 800))
        for place, image in enumerate(drawn):
            both.paste(image, (700 * place, 0))
        both.save(PICTURES / "unloaded.png")
    with_few_colours(PICTURES / "unloaded.png")


OTHERS = {
    "unloaded": unloaded,
    "measures": lambda: measure_pictures.draw(PICTURES / "measures"),
    "verdicts": verdicts,
    "sheets": printed_sheets,
    "figures": figures,
}
"""What is drawn several at a time."""


def main() -> None:
    wanted = sys.argv[1:] or [*OTHERS, *(shot.name for shot in SHOTS)]
    unknown = set(wanted) - {*OTHERS, *(shot.name for shot in SHOTS)}
    if unknown:
        sys.exit(f"No such picture: {', '.join(sorted(unknown))}")
    for name, draw_them in OTHERS.items():
        if name in wanted:
            draw_them()
    for shot in SHOTS:
        if shot.name in wanted:
            draw(shot)


if __name__ == "__main__":
    main()
