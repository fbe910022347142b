"""Put measured tables into RESULTS.md: `python benchmarks/accuracy_page.py [BODIES MADE [PEOPLE]]`.

BODIES and MADE are the folders that ``busk accuracy ... --out`` wrote for two sets; what stands
between the marks of each set there is replaced by the counts and the table at a glance. PEOPLE holds what
landmark_table.py and doubt_table.py printed of people drawn anew, as landmarks.txt and doubts.txt. The
figures of docs/explanation/limitations.md are taken from there; without folders that is all that is done.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

from pages import RESULTS, put, table

LIMITATIONS = Path(__file__).parents[1] / "docs" / "explanation" / "limitations.md"

HONEST = {
    "bust point [mm]": "bust point, distance from the nipple [mm]",
    "bust point to nipple-apex [mm]": "bust point, from the segment of nipple and apex [mm]",
    "fold height [mm]": "height of the fold [mm]",
    "underbust level [mm]": "under-bust level [mm]",
    "bust girth [mm]": "bust girth [mm]",
    "underbust girth [mm]": "under-bust girth [mm]",
    "all from 0.5 up, of these off": "landmarks with 50 % or more, of these off by more than 8 mm",
}
"""The rows of the larger set that docs/explanation/limitations.md shows, and what they are called there."""


LANDMARKS = {
    "set": "set",
    "files": "files",
    "accepted": "accepted",
    "bust within 5": "bust points within 5 mm",
    "beyond 8": "beyond 8 mm",
    "median": "median [mm]",
    "p95": "95 % [mm]",
    "fold median": "fold height, median [mm]",
    "level within 6": "under-bust level within 6 mm",
    "sure all": "landmarks with 50 % or more",
    "sure & wrong": "of these off by more than 8 mm",
}
"""The columns of landmark_table.py that the page shows, and what they are called there."""

DOUBTS = re.compile(
    r"^(\w+): (\d+) files; raised as expected (\d+) of (\d+); hints on ordinary bodies (\d+) of", re.MULTILINE
)
"""What doubt_table.py prints of a set."""


def main() -> None:
    for name, folder in zip(("bodies", "made"), sys.argv[1:3], strict=False):
        report = (Path(folder) / "accuracy.md").read_text(encoding="utf-8")
        counts = report.split("\n\n")[1]
        glance = report.partition("## Summary")[2].partition("\n## ")[0].strip()
        put(name, f"{counts}\n\n{glance}")
    for folder in map(Path, sys.argv[3:]):
        put("people", people((folder / "landmarks.txt").read_text(encoding="utf-8")))
        put("doubts", doubts((folder / "doubts.txt").read_text(encoding="utf-8")))
    put("measured", honest(RESULTS.read_text(encoding="utf-8")), LIMITATIONS)


def people(printed: str) -> str:
    """Return the columns of the page from a table of landmark_table.py."""
    heads, _, *rows = cells_of(printed)
    columns = {name: k for k, name in reversed([*enumerate(heads)])}  # "p95" is first that of bust points
    return table([*LANDMARKS.values()], ([row[columns[name]] for name in LANDMARKS] for row in rows))


def doubts(printed: str) -> str:
    """Return how often a doubt was raised, and on how many ordinary bodies, from lines of doubt_table.py."""
    rows = [
        (name, count, f"{raised} of {due}" if due != "0" else "", alarms if due == "0" else "")
        for name, count, raised, due, alarms in DOUBTS.findall(printed)
    ]
    heads = ("set", "files", "refused, or hinted at as expected", "hints on ordinary bodies")
    return table(heads, sorted(rows, key=lambda row: (not row[2], row[0])))


def cells_of(text: str) -> list[list[str]]:
    """Return the cells of the tables of a text, row by row."""
    return [[cell.strip() for cell in line.split("|")[1:-1]] for line in text.splitlines() if "|" in line]


def honest(page: str) -> str:
    """Return the table of docs/explanation/limitations.md, from the larger set of RESULTS.md."""
    cells = cells_of(page.partition("<!-- made -->")[2].partition("<!-- end of made -->")[0])
    figures = {name: rest for name, *rest in cells}
    rows = [(called, *figures[name]) for name, called in HONEST.items()]
    return table(("found − true", *cells[0][1:]), rows)


if __name__ == "__main__":
    main()
