"""Read the known values of a folder of bodies: truth.json with landmarks and tape measurements."""

from __future__ import annotations

import errno
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from core.errors import UserError, reason_of
from core.files.regular_file import read_text
from core.geometry.mesh import Floats, Points
from core.landmarks.types import NAMES, SIDES
from core.messages import Message
from core.scan.orientation.pose import MILLIMETRES

FILE = "truth.json"
MOST_BYTES = 100_000_000
FORM = Message("The format is described in the user guide, page Validation.")
TINY = 1e-9

ROUNDED = 5e-3
"""A written matrix is rounded: so far its square may be from that of one that only turns and scales [1]."""

Table = dict[str, Any]

OTHER_NAMES = {
    **{f"nipple_{side}": f"bust_point_{side}" for side in SIDES},
    **{f"breast_lowest_{side}": f"lowest_{side}" for side in SIDES},
    "front_mid_bust": "front_centre",
    "front_mid_underbust": "front_centre_underbust",
    "waist_natural_front": "waist",
    "hip_front": "hip",
    "belly_front": "belly",
}
"""Names of landmarks in other sets of bodies, and ours."""

LEVELLED = (
    *("crotch", "waist", "belly", "hip"),
    *(f"{pair}_{side}" for pair in ("buttock", "gluteal_fold") for side in SIDES),
)
"""The landmarks of the lower trunk that are judged, by their heights alone."""

GIRTHS = ("bust", "underbust", "underbust_stable")
"""The girths that are judged."""

SIZED = ("unit", "canonical_to_file", "landmarks", "landmarks_canonical_mm")
"""An entry with one of these defines the size of its body."""

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
    frame; without ``stands`` it knows no turn, without ``sized`` no scale. ``gone`` are the sides without a
    breast; ``refuse`` tells that the file holds no body that could be measured, ``degraded`` that it is no
    clean body.
    """

    name: str
    file: str
    kinds: tuple[str, ...]
    points: Mapping[str, Points]
    girths: Mapping[str, KnownGirth]
    to_mm: Floats
    stands: bool
    sized: bool
    gone: tuple[str, ...]
    refuse: bool
    degraded: bool


def read_truths(folder: Path) -> tuple[list[Truth], list[str]]:
    """Return what truth.json in ``folder`` knows of each file, and the names there that mean nothing here.

    Raises TruthError.
    """
    content = _read_json(folder)
    truths, strange = [], set[str]()
    for section in ("bodies", "scans"):
        entries = content.get(section) or {}
        if not isinstance(entries, dict):
            raise TruthError(
                Message("'{section}' in {file} is not a table of files by name.", section=section, file=FILE),
                FORM,
            )
        for name, entry in entries.items():
            try:
                truth, unknown = _truth(name, _as_table("what it tells", entry), section == "scans")
            except ValueError as problem:
                raise TruthError(
                    Message(
                        "The entry '{name}' of {file} cannot be used: {why}.",
                        file=FILE,
                        name=name,
                        why=str(problem),
                    ),
                    FORM,
                ) from problem
            truths.append(truth)
            strange |= unknown
    if not truths:
        raise TruthError(Message("{file} lists no files under 'bodies' or 'scans'.", file=FILE), FORM)
    return truths, sorted(strange)


def _read_json(folder: Path) -> Table:
    path = folder / FILE
    try:
        content = json.loads(read_text(path, MOST_BYTES))
    except FileNotFoundError:
        raise TruthError(
            Message(
                "{folder} does not contain {file} with the landmark positions.",
                file=FILE,
                folder=folder,
            ),
            FORM,
        ) from None
    except OSError as problem:
        if problem.errno == errno.EFBIG:
            raise TruthError(
                Message("{path} is too large for a list of landmarks.", path=path), FORM
            ) from problem
        raise TruthError(
            Message("{file} cannot be read: {problem}.", file=path, problem=reason_of(problem)),
            Message("Choose another folder."),
        ) from problem
    except (ValueError, RecursionError) as problem:
        where = f"line {problem.lineno}" if isinstance(problem, json.JSONDecodeError) else "the first line"
        raise TruthError(
            Message("{path} is not valid JSON. Check {where}.", path=path, where=where), FORM
        ) from problem
    if not isinstance(content, dict):
        raise TruthError(Message("{file} contains no table of bodies or scans.", file=FILE), FORM)
    return content


def _truth(name: str, entry: Table, degraded: bool) -> tuple[Truth, set[str]]:
    """Return the values of an entry of truth.json, and its unknown names. Raises ValueError."""
    file = entry.get("file")
    if not isinstance(file, str) or file != Path(file).name:
        raise ValueError("'file' must be a file name without a folder")
    to_mm, stands = _to_mm(entry)
    where, matrix = "landmarks_file", np.asarray(np.eye(4))
    told = _table(entry, where)
    if not told:
        where = "landmarks_canonical_mm" if entry.get("landmarks_canonical_mm") else "landmarks"
        told, matrix = _table(entry, where), np.asarray(np.linalg.inv(to_mm))
    points, strange = {}, set()
    for key, point in told.items():
        ours = OTHER_NAMES.get(key, key)
        if ours not in (*NAMES, *LEVELLED, *APEXES):
            strange.add(key)
        elif point is not None:
            points[ours] = matrix[:3, :3] @ _numbers(f"{where}: {key}", point, 3) + matrix[:3, 3]
    girths = {key: value for key, value in _table(entry, "girths").items() if value is not None}
    strange |= {f"girth {key}" for key in girths if key not in GIRTHS}
    kinds = entry.get("kinds") or ()
    missing = _table(entry, "flags").get("missing")
    truth = Truth(
        name,
        file,
        tuple(map(str, kinds)) if isinstance(kinds, list) else (str(kinds),) if kinds else (),
        points,
        {key: _girth(f"girths: {key}", girths[key]) for key in GIRTHS if key in girths},
        to_mm,
        stands,
        any(key in entry for key in SIZED),
        tuple(side for side in SIDES if missing == side),
        bool(entry.get("refuse", False)),
        bool(entry.get("degraded", degraded)),
    )
    return truth, strange


def _to_mm(entry: Table) -> tuple[Floats, bool]:
    """Return the matrix from the file to the canonical frame, and whether its turn is known."""
    if "canonical_to_file" in entry:
        matrix = _numbers("canonical_to_file", entry["canonical_to_file"], 16).reshape(4, 4)
        turn, scale = matrix[:3, :3], np.cbrt(max(np.linalg.det(matrix[:3, :3]), 0.0))
        even = np.abs(turn @ turn.T - scale**2 * np.eye(3)).max() < ROUNDED * scale**2
        if not even or not np.array_equal(matrix[3], [0, 0, 0, 1]):
            raise ValueError("'canonical_to_file' must be a matrix of rotation, scale and translation")
        return np.asarray(np.linalg.inv(matrix)), True
    unit = entry.get("unit", "mm")
    if not isinstance(unit, str) or unit not in MILLIMETRES:
        raise ValueError(f"'unit' must be one of {', '.join(MILLIMETRES)}")
    matrix, stands = np.eye(4), "landmarks" in entry
    if "up_direction_file" in entry and "front_direction_file" in entry:
        keys = ("up_direction_file", "front_direction_file")
        up, front = (_numbers(key, entry[key], 3) for key in keys)
        left = np.cross(up, front)  # facing -y with z up, the left is +x: z x (-y) = x
        if np.linalg.norm(left) < TINY * np.linalg.norm(up) * np.linalg.norm(front) or not left.any():
            raise ValueError("'up_direction_file' and 'front_direction_file' must be two directions")
        up, left = up / np.linalg.norm(up), left / np.linalg.norm(left)
        matrix[:3, :3], stands = np.stack([left, np.cross(up, left), up]), True
    matrix[:3, :3] *= MILLIMETRES[unit]
    return matrix, stands


def _table(entry: Table, key: str) -> Table:
    return _as_table(f"'{key}'", entry.get(key) or {})


def _as_table(what: str, value: Any) -> Table:
    if not isinstance(value, dict):
        raise ValueError(f"{what} must be a table of names and values")
    return value


def _numbers(key: str, values: Any, count: int) -> Floats:
    try:
        numbers = np.asarray(values, dtype=np.float64).ravel()
    except (TypeError, ValueError):
        numbers = np.empty(0)
    if numbers.shape != (count,) or not np.isfinite(numbers).all():
        raise ValueError(f"'{key}' must be {f'{count} numbers' if count > 1 else 'a number'}")
    return numbers


def _girth(key: str, value: Any) -> KnownGirth:
    entry = _as_table(f"'{key}'", value)
    level, tape = (float(_numbers(f"{key}: {part}", entry.get(part), 1)[0]) for part in ("level_z", "tape"))
    rows = list(_table(entry, "tape_by_offset_mm").items())
    steps = _numbers(f"{key}: tape_by_offset_mm", rows, 2 * len(rows)).reshape(-1, 2)
    steps = steps[np.argsort(steps[:, 0])]
    return KnownGirth(level, tape, tuple(steps[:, 0].tolist()), tuple(steps[:, 1].tolist()))
