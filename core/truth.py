"""Known answers for a folder of bodies: truth.json, where landmarks lie and what a tape measures there."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from core.errors import UserError
from core.landmark import NAMES, SIDES
from core.mesh import Floats, Points
from core.standing.upright import MILLIMETRES

FILE = "truth.json"
MOST_BYTES = 100_000_000

OTHER_NAMES = {
    **{f"nipple_{side}": f"bust_point_{side}" for side in SIDES},
    **{f"breast_lowest_{side}": f"lowest_{side}" for side in SIDES},
    "front_mid_bust": "front_centre",
    "front_mid_underbust": "front_centre_underbust",
}
"""Names of landmarks in other sets of bodies, and ours."""

APEXES = tuple(f"bust_apex_{side}" for side in SIDES)
"""The foremost points of the breasts: they are not looked for, but the bust point may lie near them."""


class TruthError(UserError):
    """The known answers cannot be read."""


@dataclass(frozen=True)
class KnownGirth:
    """What a tape reads at height ``level`` [mm], and at heights above and below it, ascending [mm]."""

    level: float
    tape: float
    offsets: tuple[float, ...] = ()
    tapes: tuple[float, ...] = ()

    def at(self, level: float) -> float | None:
        """Return what it reads at another height [mm], None if that is not known."""
        away = level - self.level
        if not self.offsets or not self.offsets[0] <= away <= self.offsets[-1]:
            return None
        return float(np.interp(away, self.offsets, self.tapes))


@dataclass(frozen=True, eq=False)
class Truth:
    """What is known of one file.

    ``points`` by our names, each (3,) [file units]. ``to_mm``, shape (4, 4), takes the file to the canonical
    frame; without ``stands`` only its scale is known. ``gone`` are the sides without a breast; ``refuse``
    tells that the file holds no body that could be measured.
    """

    name: str
    file: str
    kinds: tuple[str, ...]
    points: Mapping[str, Points]
    girths: Mapping[str, KnownGirth]
    to_mm: Floats
    stands: bool
    gone: tuple[str, ...]
    refuse: bool


def read_truths(folder: Path) -> tuple[list[Truth], list[str]]:
    """Return what truth.json in ``folder`` knows of each file, and the names there that mean nothing here.

    Raises TruthError.
    """
    content = _read_json(folder)
    truths, strange = [], set()
    for section in ("bodies", "scans"):
        entries = content.get(section) or {}
        if not isinstance(entries, dict):
            raise TruthError(f"'{section}' in {FILE} is no table of files by name.", "See docs/accuracy.md.")
        for name, entry in entries.items():
            try:
                truth, unknown = _truth(name, entry)
            except (KeyError, TypeError, ValueError, AttributeError, np.linalg.LinAlgError) as problem:
                raise TruthError(
                    f"What {FILE} tells about '{name}' cannot be understood: {problem}.",
                    "Its form is told in docs/accuracy.md.",
                ) from problem
            truths.append(truth)
            strange |= unknown
    if not truths:
        raise TruthError(f"{FILE} names no file.", "It needs 'bodies' or 'scans': see docs/accuracy.md.")
    if not any(truth.points or truth.girths or truth.refuse for truth in truths):
        raise TruthError(
            f"{FILE} holds no landmark and no girth that is known here.", f"Landmarks: {', '.join(NAMES)}."
        )
    return truths, sorted(strange)


def _read_json(folder: Path) -> dict[str, Any]:
    path = folder / FILE
    try:
        if path.stat().st_size > MOST_BYTES:
            raise TruthError(f"{path} is too large to be a list of landmarks.", "See docs/accuracy.md.")
        content = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise TruthError(
            f"There is no {FILE} in {folder}.", "It tells where the landmarks are: see docs/accuracy.md."
        ) from None
    except OSError as problem:
        raise TruthError(f"{path} cannot be read: {problem.strerror}.", "Choose another folder.") from problem
    except (ValueError, RecursionError) as problem:
        raise TruthError(f"{path} is not JSON: {problem}.", "Write it again.") from problem
    if not isinstance(content, dict):
        raise TruthError(f"{FILE} holds no table of bodies or scans.", "See docs/accuracy.md.")
    return content


def _truth(name: str, entry: dict[str, Any]) -> tuple[Truth, set[str]]:
    """Return what an entry of truth.json tells, and which names of landmarks in it mean nothing here."""
    file = str(entry["file"])
    if Path(file).name != file:
        raise ValueError(f"{file} is not the plain name of a file in the folder")
    to_mm, stands = _to_mm(entry)
    told, matrix = entry.get("landmarks_file") or {}, np.eye(4)
    if not told:
        told = entry.get("landmarks_canonical_mm") or entry.get("landmarks") or {}
        matrix = _inverse(to_mm)
    points, strange = {}, set()
    for key, point in told.items():
        ours = OTHER_NAMES.get(key, key)
        if ours not in (*NAMES, *APEXES):
            strange.add(key)
        elif point is not None:
            points[ours] = matrix[:3, :3] @ _numbers(point, 3) + matrix[:3, 3]
    flags = entry.get("flags") or {}
    gone = tuple(side for side in SIDES if flags.get("missing") == side)
    kinds = tuple(map(str, entry.get("kinds") or ()))
    refuse = bool(entry.get("refuse", False))
    girths = {str(k): _girth(v) for k, v in (entry.get("girths") or {}).items() if v is not None}
    return Truth(str(name), file, kinds, points, girths, to_mm, stands, gone, refuse), strange


def _to_mm(entry: dict[str, Any]) -> tuple[Floats, bool]:
    """Return the matrix from the file to the canonical frame, and whether its turn is known."""
    if "canonical_to_file" in entry:
        return _inverse(_numbers(entry["canonical_to_file"], 16).reshape(4, 4)), True
    unit = entry.get("unit", "mm")
    if unit not in MILLIMETRES:
        raise ValueError(f"its unit is none of {', '.join(MILLIMETRES)}")
    matrix, stands = np.eye(4), "landmarks" in entry
    if "up_direction_file" in entry and "front_direction_file" in entry:
        up, front = (_numbers(entry[f"{which}_direction_file"], 3) for which in ("up", "front"))
        left = np.cross(up, front)  # facing -y with z up, the left is +x: z x (-y) = x
        up, left = up / np.linalg.norm(up), left / np.linalg.norm(left)
        matrix[:3, :3], stands = np.stack([left, np.cross(up, left), up]), True
    matrix[:3, :3] *= MILLIMETRES[unit]
    return matrix, stands


def _inverse(matrix: Floats) -> Floats:
    return np.asarray(np.linalg.inv(matrix))


def _numbers(values: Any, count: int) -> Floats:
    numbers = np.asarray(values, dtype=np.float64).ravel()
    if numbers.shape != (count,) or not np.isfinite(numbers).all():
        raise ValueError(f"{count} finite numbers are needed where {values!r:.60} stands")
    return numbers


def _girth(entry: dict[str, Any]) -> KnownGirth:
    level, tape = (float(_numbers(entry[key], 1)[0]) for key in ("level_z", "tape"))
    steps = sorted((float(at), float(value)) for at, value in (entry.get("tape_by_offset_mm") or {}).items())
    return KnownGirth(level, tape, tuple(at for at, _ in steps), tuple(value for _, value in steps))
