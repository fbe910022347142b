"""Put measured tables into docs/accuracy.md: `python benchmarks/accuracy_page.py BODIES [MADE]`.

BODIES and MADE are the folders that ``busk accuracy ... --out`` wrote for the two sets of the page; what
stands between the marks of each set there is replaced by the counts and the table at a glance.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

PAGE = Path(__file__).parents[1] / "docs" / "accuracy.md"
MARKED = "<!-- {0} -->\n{1}<!-- end of {0} -->\n"


def main() -> None:
    page = PAGE.read_text(encoding="utf-8")
    for name, folder in zip(("bodies", "made"), sys.argv[1:], strict=False):
        report = (Path(folder) / "accuracy.md").read_text(encoding="utf-8")
        counts = report.split("\n\n")[1]
        table = report.partition("## At a glance")[2].partition("\n## ")[0].strip()
        told = MARKED.format(name, f"\n{counts}\n\n{table}\n\n")
        page, changes = re.subn(MARKED.format(name, "(?s:.*?)"), lambda _, told=told: told, page)
        assert changes == 1, name
    PAGE.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
