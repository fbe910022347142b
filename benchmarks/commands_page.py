"""Print again what the commands on the pages print: `python benchmarks/commands_page.py [PAGE ...]`.

Of docs/commands.md and all other pages whose commands stand with their output, or of those that are named.
Where a page has a line of dots, as many lines before and after it are kept as stand there.
"""

from __future__ import annotations

import os
import sys
import tempfile
from contextlib import chdir
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "helpers")]

from app.rendering.display import off_screen  # noqa: E402

off_screen()
os.environ["COLUMNS"] = "100"

from page_commands import PAGES, examples_of, furnish, options, run, shortened  # noqa: E402
from pages import put, table  # noqa: E402


def main() -> None:
    named = [Path(name).resolve() for name in sys.argv[1:]] or PAGES
    with tempfile.TemporaryDirectory() as house:
        for kind in ("CONFIG", "DATA", "STATE", "CACHE"):
            os.environ[f"XDG_{kind}_HOME"] = str(Path(house) / kind.lower())
        for path in named:
            refresh(path)
    put("commands.md", "options", table(("option", "of", "what it does"), options()))


def refresh(path: Path) -> None:
    """Run the examples of a page in a fresh folder, in order, and put what they print below them."""
    examples = [example for example in examples_of(path) if example.said is not None]
    page, told = path.read_text(encoding="utf-8"), []
    with tempfile.TemporaryDirectory() as folder, chdir(folder):
        furnish(Path(folder))
        for example in examples:
            told.append(shortened(example.said or "", run(example)[0]))
            print(example, file=sys.stderr)
    for example, text in reversed(list(zip(examples, told, strict=True))):
        start, end = example.span
        page = page[:start] + text + page[end:]
    if examples:
        path.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
