"""Put measured tables into docs/accuracy.md: `python benchmarks/accuracy_page.py BODIES [MADE]`.

BODIES and MADE are the folders that ``busk accuracy ... --out`` wrote for the two sets of the page; what
stands between the marks of each set there is replaced by the counts and the table at a glance.
"""

from __future__ import annotations

import sys
from pathlib import Path

from pages import put


def main() -> None:
    for name, folder in zip(("bodies", "made"), sys.argv[1:], strict=False):
        report = (Path(folder) / "accuracy.md").read_text(encoding="utf-8")
        counts = report.split("\n\n")[1]
        glance = report.partition("## At a glance")[2].partition("\n## ")[0].strip()
        put("accuracy.md", name, f"{counts}\n\n{glance}")


if __name__ == "__main__":
    main()
