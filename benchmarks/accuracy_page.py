"""Put measured tables into docs/accuracy.md: `python benchmarks/accuracy_page.py BODIES [MADE]`.

BODIES and MADE are the folders that ``busk accuracy ... --out`` wrote for the two sets of the page; what
stands between the marks of each set there is replaced by the counts and the table at a glance. The figures of
docs/honest.md are taken from the page then; without folders that is all that is done.
"""

from __future__ import annotations

import sys
from pathlib import Path

from pages import DOCS, put, table

HONEST = {
    "bust point [mm]": "bust point, distance [mm]",
    "fold height [mm]": "height of the fold [mm]",
    "underbust level [mm]": "under-bust level [mm]",
    "bust girth [mm]": "bust girth [mm]",
    "underbust girth [mm]": "under-bust girth [mm]",
    "all from 0.5 up, of these off": "landmarks with 50 % or more, of these off by more than 8 mm",
}
"""The rows of the larger set that docs/honest.md shows, and what they are called there."""


def main() -> None:
    for name, folder in zip(("bodies", "made"), sys.argv[1:], strict=False):
        report = (Path(folder) / "accuracy.md").read_text(encoding="utf-8")
        counts = report.split("\n\n")[1]
        glance = report.partition("## At a glance")[2].partition("\n## ")[0].strip()
        put("accuracy.md", name, f"{counts}\n\n{glance}")
    put("honest.md", "measured", honest((DOCS / "accuracy.md").read_text(encoding="utf-8")))


def honest(page: str) -> str:
    """Return the table of docs/honest.md, from what docs/accuracy.md says of the larger set."""
    made = page.partition("<!-- made -->")[2]
    cells = [[cell.strip() for cell in line.split("|")[1:-1]] for line in made.splitlines() if "|" in line]
    figures = {name: rest for name, *rest in cells}
    rows = [(called, *figures[name]) for name, called in HONEST.items()]
    return table(("found, less what is true", *cells[0][1:]), rows)


if __name__ == "__main__":
    main()
