"""A turntable: the reshaped body turns once round, as one moving picture or as a series of pictures."""

from __future__ import annotations

import os
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import IO

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from app.rendering.offscreen import OffscreenRenderer, Picture, with_background
from core.errors import UserError
from core.files.atomic_write import atomic_path
from core.messages import Message
from core.progress import Pieces, Progress, part_of, quiet

FORMATS = ("gif", "webp", "png")
"""Kinds of turntables by their endings; "png" is a series of pictures, numbered from 1."""

_LIMITS = {"frames": (2, 360), "seconds": (0.5, 60.0), "width": (64, 4096), "height": (64, 4096)}
_COMPOSED = 0.3  # the part of writing that is done when all lies on its background
_BRIGHT = 70  # how far apart red, green and blue of a bright colour are, of 255
_LIGHT_INK, _DARK_INK = "#57534E", "#C9CCD3"
_FONT = {True: "NotoSansJP-Regular.otf", False: "Inter-Regular.ttf"}  # by whether there are other letters


@dataclass(frozen=True)
class Turntable:
    """How the body turns: once round in ``frames`` pictures and ``seconds``, ``size`` in pixels.

    ``side_by_side`` shows it before on the left and after on the right, with ``labels`` below. Raises
    UserError for what cannot be.
    """

    frames: int = 36
    size: tuple[int, int] = (640, 720)
    seconds: float = 6.0
    dark: bool = False
    side_by_side: bool = False
    labels: tuple[str, str] = ("before", "after")

    def __post_init__(self) -> None:
        refusals = {
            "frames": Message("The number of turntable frames {value} is out of range."),
            "seconds": Message("The turntable duration {value} s is out of range."),
            "width": Message("The turntable width of {value} pixels is out of range."),
            "height": Message("The turntable height of {value} pixels is out of range."),
        }
        values = (self.frames, self.seconds, *self.size)
        for (name, refusal), value in zip(refusals.items(), values, strict=True):
            low, high = _LIMITS[name]
            if not low <= value <= high:
                raise UserError(
                    refusal.fill(value=f"{value:g}"),
                    Message("Enter a value from {low} to {high}.", low=f"{low:g}", high=f"{high:g}"),
                )


def turntable_kind(path: str | os.PathLike[str]) -> str:
    """Return the kind of turntable that a name ends in. Raises UserError if Busk does not make it."""
    kind = Path(path).suffix.lower().lstrip(".")
    if kind not in FORMATS:
        raise UserError(
            Message("Turntables cannot be exported as .{kind}.", kind=kind),
            Message("Choose one of: {choices}.", choices=", ".join(FORMATS)),
        )
    return kind


def render_turntable(studio: OffscreenRenderer, turntable: Turntable) -> Pieces[list[Picture]]:
    """Return the pictures of one turn, from the front towards the subject's left.

    Where before and after stand beside each other, all of before come first.
    """
    scene, (width, height) = studio.scene, turntable.size
    parts = 1 + turntable.side_by_side
    each, shots = 1.0 / (parts * turntable.frames), list[Picture]()
    size = width // parts, height
    studio.frame_worn(size, "front")
    start = scene.view.orbit(0.0, 4.0)
    for before in (True, False)[-parts:]:
        scene.before(before)
        scene.set_visible("bands", not before)
        for k in range(turntable.frames):
            scene.set_camera(start.orbit(360.0 * k / turntable.frames, 0.0))
            shots.append((yield from part_of(studio.render(size), each * len(shots), each)))
    return shots


def write_turntable(
    path: str | os.PathLike[str],
    shots: Sequence[Picture],
    turntable: Turntable,
    progress: Progress = quiet,
) -> list[Path]:
    """Write what ``render_turntable`` has drawn, and return the files.

    Raises UserError for another ending or a place that cannot be written to; Cancelled leaves no file.
    """
    kind, targets = turntable_kind(path), turntable_files(path, turntable.frames)
    if not targets[0].parent.is_dir():
        raise UserError(
            Message("Folder {folder} does not exist.", folder=str(targets[0].parent)),
            Message("Create the folder, or choose another one."),
        )
    pictures = _composed(shots, turntable, progress)
    with ExitStack() as stack:
        partials = [stack.enter_context(atomic_path(each)) for each in targets]
        groups = [[each] for each in pictures] if kind == "png" else [pictures]
        for k, (partial, group) in enumerate(zip(partials, groups, strict=True)):
            progress("writing", _COMPOSED + (1.0 - _COMPOSED) * k / len(groups))
            with open(partial, "wb") as file:
                _encode(file, kind, group, turntable.seconds)
        progress("writing", 1.0)
    return targets


def turntable_files(path: str | os.PathLike[str], frames: int) -> list[Path]:
    """Return the files that a turntable of this name is: one, or a numbered series of PNG."""
    target = Path(path)
    if turntable_kind(path) != "png":
        return [target]
    digits = len(str(frames))
    return [target.with_stem(f"{target.stem}-{k:0{digits}}") for k in range(1, frames + 1)]


def _composed(shots: Sequence[Picture], turntable: Turntable, progress: Progress) -> list[Image.Image]:
    """Return the pictures on their background, before and after beside each other if that is wished."""
    pictures = []
    for k in range(turntable.frames):
        progress("writing", _COMPOSED * k / turntable.frames)
        parts = [with_background(shot, turntable.dark) for shot in shots[k :: turntable.frames]]
        pictures.append(
            _labelled(np.concatenate(parts, axis=1), turntable)
            if len(parts) > 1
            else Image.fromarray(parts[0])
        )
    return pictures


def _labelled(pixels: np.ndarray, turntable: Turntable) -> Image.Image:
    """Return a picture of two halves with what each shows written below."""
    picture = Image.fromarray(pixels)
    size = max(12, picture.height // 32)
    for k, label in enumerate(turntable.labels):
        font_file = resources.files("resources") / "fonts" / _FONT[not label.isascii()]
        with resources.as_file(font_file) as path:
            font = ImageFont.truetype(str(path), size)
        place = picture.width * (1 + 2 * k) / 4, picture.height - 0.8 * size
        ink = _DARK_INK if turntable.dark else _LIGHT_INK
        ImageDraw.Draw(picture).text(place, label, ink, font, anchor="ms")
    return picture


def _encode(file: IO[bytes], kind: str, pictures: list[Image.Image], seconds: float) -> None:
    if kind == "png":
        pictures[0].save(file, "PNG", optimize=True)
        return
    each = round(100.0 * seconds / len(pictures)) * 10  # [ms]; a GIF counts in hundredths of a second
    moving = {"save_all": True, "duration": max(each, 20), "loop": 0}
    if kind == "webp":
        pictures[0].save(file, "WEBP", append_images=pictures[1:], quality=88, **moving)
        return
    palette = _palette(pictures)
    plain = [each.quantize(palette=palette, dither=Image.Dither.FLOYDSTEINBERG) for each in pictures]
    plain[0].save(file, "GIF", append_images=plain[1:], optimize=False, **moving)


def _palette(pictures: Sequence[Image.Image]) -> Image.Image:
    """Return one palette for all pictures: with a palette each, still parts would flicker.

    What is brightly coloured, the bands, counts as much as all the rest: it is little, and what matters.
    """
    pixels = np.concatenate([np.asarray(each)[::2, ::2].reshape(-1, 3) for each in pictures[::3]])
    bright = pixels[np.ptp(pixels.astype(np.int16), axis=1) > _BRIGHT]
    if len(bright):
        pixels = np.concatenate([pixels, np.resize(bright, pixels.shape)])
    return Image.fromarray(pixels[None]).quantize(256, method=Image.Quantize.MEDIANCUT)
