"""Define the parts of all figures: table, caption, files, and one style for print."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure as Sheet
from matplotlib.font_manager import fontManager

from app.rendering.palette import LIGHT, LINE_COLORS
from core.files.atomic_write import atomic_path

COLOURS = {
    "conventional": LIGHT.warn_mark,
    "adaptive": LIGHT.accent,
    "accumulating": LINE_COLORS[2],
    "exact": LIGHT.exact_curve,
    "none": LIGHT.ghost_curve,
    "rest": LIGHT.text_caption,
}
"""One colour for each volume control in all figures; apart for colour-blind eyes and in grey."""

WIDTH = 7.2
"""Width of a figure on the page [inch]: two columns of a journal."""

DOTS = 170  # per inch

STYLE: Any = {
    "font.family": "Inter",
    "font.size": 8.0,
    "axes.titlesize": 8.5,
    "axes.titleweight": "semibold",
    "axes.titlelocation": "left",
    "axes.labelsize": 8.0,
    "axes.labelcolor": LIGHT.text_quiet,
    "axes.edgecolor": LIGHT.control,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": LIGHT.line,
    "grid.linewidth": 0.5,
    "xtick.color": LIGHT.text_quiet,
    "ytick.color": LIGHT.text_quiet,
    "xtick.labelsize": 7.5,
    "ytick.labelsize": 7.5,
    "text.color": LIGHT.text,
    "lines.linewidth": 1.3,
    "lines.solid_capstyle": "round",
    "legend.frameon": False,
    "legend.fontsize": 7.5,
    "figure.dpi": DOTS,
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
    "axes.unicode_minus": True,
}


@dataclass(frozen=True, eq=False)
class Figure:
    """A drawn figure: file name without ending, title, caption, and its table as ``rows`` under ``columns``.

    Each column names its unit; the caption says in words what the table holds.
    """

    name: str
    title: str
    caption: str
    columns: tuple[str, ...]
    rows: Sequence[Sequence[object]]
    sheet: Sheet

    def save(self, folder: Path) -> None:
        """Write ``name``.png and ``name``.csv to ``folder``. Raises UserError if that cannot be done."""
        write_table(folder / f"{self.name}.csv", self.columns, self.rows)
        with atomic_path(folder / f"{self.name}.png") as partial:
            self.sheet.savefig(partial, format="png", dpi=DOTS, metadata={"Software": "Busk"})


def write_table(path: Path, columns: Sequence[str], rows: Sequence[Sequence[object]]) -> None:
    """Write a CSV file whose headings name their units. Raises UserError if that cannot be done."""
    with atomic_path(path) as partial, open(partial, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows([_plain(value) for value in row] for row in rows)


def _plain(value: object) -> object:
    return f"{value:.7g}" if isinstance(value, float) else value


@contextmanager
def print_style() -> Iterator[None]:
    """Draw in the figures' style and with the window's letters, within this context only."""
    known = {font.fname for font in fontManager.ttflist}
    for path in (resources.files("resources") / "fonts").iterdir():
        if path.name.endswith(".ttf") and str(path) not in known:
            fontManager.addfont(str(path))
    with mpl.rc_context(STYLE):
        yield


def sheet(height: float) -> Sheet:
    """Return an empty sheet of the usual width and ``height`` [inch]."""
    drawn = Sheet(figsize=(WIDTH, height), layout="constrained")
    FigureCanvasAgg(drawn)
    return drawn


def show(axes: Axes, picture: npt.NDArray[np.uint8], title: str = "") -> None:
    """Place a rendered picture on axes without a frame, its white margin cut away."""
    axes.imshow(picture)
    axes.set_axis_off()
    if title:
        axes.set_title(title, loc="center")


def trimmed(pictures: Sequence[npt.NDArray[np.uint8]], margin: int = 12) -> list[npt.NDArray[np.uint8]]:
    """Return pictures of one size, all cut to the smallest box that holds the ink of each of them."""
    ink = np.any([(picture < 250).any(axis=2) for picture in pictures], axis=0)
    rows, columns = np.flatnonzero(ink.any(axis=1)), np.flatnonzero(ink.any(axis=0))
    top, left = max(rows[0] - margin, 0), max(columns[0] - margin, 0)
    return [picture[top : rows[-1] + margin + 1, left : columns[-1] + margin + 1] for picture in pictures]
