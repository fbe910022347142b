"""What is said of scans that should be doubted, and of those that should not: one row for each set.

Run: python benchmarks/doubt_table.py DIR [--only men forms] [--each]. DIR holds the sets of make_people.py;
``expects`` in their truth.json names the doubt that should be raised. Refusing counts as raising it.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections import Counter
from pathlib import Path
from typing import Any

sys.path[:0] = [str(Path(__file__).parent.parent)]

from core.errors import UserError  # noqa: E402
from core.landmarks.detect import find_landmarks  # noqa: E402
from core.scan.body import body_of  # noqa: E402
from core.scan.readers.registry import scan_bytes  # noqa: E402

HINTS = {"size": "size", "no breasts": "flat", "clothes": "clothes", "lean": "lean", "no body": ""}
"""The hint that an expected doubt should raise; a doubt without one has to be refused."""


def said(folder: Path, file: str) -> list[str]:
    """Return "refused", or the kinds of hints, "upright" for a lean that was corrected, and "asked"."""
    try:
        body = body_of(file, scan_bytes(folder / file))
        found = find_landmarks(body)
    except UserError:
        return ["refused"]
    words = [hint.kind for hint in found.hints] + ["asked"] * (not body.pose.is_certain)
    return words + ["upright"] * (body.pose.tilt > 0.0)


def is_raised(known: dict[str, Any], words: list[str]) -> bool:
    """Tell whether what a file expects was said; "flat" names clothes as well, and asking names the size."""
    wanted = {"refused"} | {HINTS[name] for name in known["expects"]}
    wanted |= {"flat"} if "clothes" in known["expects"] else set()
    wanted |= {"asked"} if "size" in known["expects"] else set()
    wanted |= {"upright"} if "lean" in known["expects"] else set()
    return bool(wanted & set(words))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", nargs="+", default=[])
    parser.add_argument("--each", action="store_true")
    options = parser.parse_args()
    for file in sorted(options.folder.glob("*/truth.json")):
        if options.only and file.parent.name not in options.only:
            continue
        known = json.loads(file.read_text(encoding="utf-8"))["scans"]
        words = {name: said(file.parent, entry["file"]) for name, entry in known.items()}
        counts = dict(Counter(word for each in words.values() for word in each))
        doubtful = {name: entry for name, entry in known.items() if entry.get("expects")}
        raised = sum(is_raised(entry, words[name]) for name, entry in doubtful.items())
        alarms = sum(bool(set(words[name]) & set(HINTS.values())) for name in known if name not in doubtful)
        print(
            f"{file.parent.name}: {len(known)} files; raised as expected {raised} of {len(doubtful)}; "
            f"hints on ordinary bodies {alarms} of {len(known) - len(doubtful)}; {counts}",
            flush=True,
        )
        for name in words if options.each else ():
            print(f"  {name} {' '.join(known[name]['kinds'])}: {' '.join(words[name]) or 'nothing'}")


if __name__ == "__main__":
    main()
