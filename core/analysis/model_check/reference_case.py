"""Reference cases: displacements of the bust by an independent finite-element model, read from files."""

from __future__ import annotations

import io
import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from core.control_mesh.template import TEMPLATES, Template, read_template
from core.document.cup import Cup
from core.errors import UserError, reason_of
from core.files.regular_file import read_regular
from core.geometry.mesh import MAX_COORDINATE, Floats, Points, frozen
from core.messages import Message

SUFFIX = ".npz"

STANDING = (0.0, 0.0, -1.0)
"""Gravity in which the body was scanned [9.81 m/s^2]."""

_LARGEST = 64_000_000
"""Bytes of the largest case that is read, packed or not; cases of some thousand nodes have 0.1 MB."""

_BROKEN = (zipfile.BadZipFile, zlib.error, EOFError, RuntimeError, ValueError, MemoryError)
_HINT = Message("Obtain the file again. The format is described on the page about validation.")

Arrays = Mapping[str, npt.NDArray[Any]]


@dataclass(frozen=True, eq=False)
class ReferenceCase:
    """One body in one state, as displacement from the scan; all lengths in mm, z up, the body faces -y.

    ``rest`` (n, 3) are nodes of the skin and ``displacement`` (n, 3) how far they move. ``body`` names the
    file of the body, which is looked for beside the case, in ``folder``. ``control_points`` (c, 3) are those
    of the ``template`` on that body; ``lines`` are sequences of them, all worn at ``ratio`` [1] of their rest
    length piece by piece, with ``line_stiffness_n`` [N] per unit of strain. ``gravity`` (3,) is in units of
    9.81 m/s^2; ``bust_points`` (2, 3) are the left and the right one. ``cup`` is that of both breasts, if
    any. ``kind`` is "weight", "sling" (lines along a column), "mid-bust" (along a row), "cup" (without lines)
    or "other".
    """

    name: str
    folder: Path
    body: str
    template: str
    control_points: Points
    lines: tuple[tuple[int, ...], ...]
    ratio: float
    line_stiffness_n: float
    shear_modulus_kpa: float
    gravity: tuple[float, ...]
    cup: Cup | None
    kind: str
    rest: Points
    displacement: Points
    bust_points: Points


def included_cases() -> dict[str, Path]:
    """Return the files of the cases that come with the program, by name."""
    folder = Path(str(resources.files("resources") / "reference"))
    return {file.stem: file for file in sorted(folder.glob(f"*{SUFFIX}"))}


def case_file(name: str) -> Path:
    """Return the file of a case that comes with the program, or of a file name. Raises UserError."""
    included, path = included_cases(), Path(name)
    if name in included:
        return included[name]
    if path.suffix.lower() == SUFFIX:
        return path
    ask = Message("Specify a file ({SUFFIX}).", SUFFIX=SUFFIX)
    choices = Message("Choose one of: {choices}.", choices=", ".join(included))
    raise UserError(Message("There is no reference case '{name}'.", name=name), choices if included else ask)


def read_case(path: Path) -> ReferenceCase:
    """Read a case. Raises UserError if the file is missing, broken or incomplete."""
    reader = _Reader(path.name, _arrays(path))
    template = _template(reader)
    lines, kind = _lines(reader, template)
    rest = reader.numbers("rest", (-1, 3))
    displacement = reader.numbers("displacement", rest.shape)
    if not displacement.any():
        raise reader.error(Message("no node moves"))
    gravity = tuple(reader.numbers("gravity", (3,)).tolist())
    cup = _cup(reader)
    if cup is not None:
        kind = "other" if lines else "cup"
    elif not lines and gravity == STANDING:
        raise reader.error(Message("it has neither lines nor cups nor another gravity than standing"))
    points = len(template.row), 3
    return ReferenceCase(
        path.stem,
        path.parent,
        reader.text("body"),
        template.name,
        reader.numbers("control_points", points),
        lines,
        reader.positive("ratio"),
        reader.positive("tape_ea_n"),
        reader.positive("shear_modulus_kpa"),
        gravity,
        cup,
        kind,
        rest,
        displacement,
        frozen([reader.numbers(f"bust_{side}", (3,)) for side in ("left", "right")]),
    )


def _arrays(path: Path) -> Arrays:
    """Return what a file holds, never an object to be made of it. Raises UserError."""
    try:
        data = read_regular(path, _LARGEST)
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            if sum(member.file_size for member in archive.infolist()) > _LARGEST:
                raise ValueError("too large")
        with np.load(io.BytesIO(data), allow_pickle=False) as arrays:
            return {name: np.asarray(arrays[name]) for name in arrays.files}
    except FileNotFoundError:
        raise UserError(
            Message("{file} does not exist.", file=str(path)),
            Message("Check the name, or choose another one."),
        ) from None
    except OSError as problem:
        raise UserError(
            Message("{file} cannot be read: {problem}.", file=path.name, problem=reason_of(problem)),
            Message("Check the file, or choose another case."),
        ) from problem
    except _BROKEN as problem:
        raise UserError(Message("{file} is not a reference case.", file=path.name), _HINT) from problem


@dataclass(frozen=True, eq=False)
class _Reader:
    """The arrays of a file, each checked as it is read."""

    file: str
    arrays: Arrays

    def error(self, reason: Message) -> UserError:
        """Return the error of an unusable case."""
        problem = Message("{file} is not a usable reference case: {reason}.", file=self.file, reason=reason)
        return UserError(problem, _HINT)

    def array(self, name: str, kinds: str, shape: tuple[int, ...]) -> npt.NDArray[Any]:
        """Return an array of one of the numpy ``kinds``; -1 in its ``shape`` stands for any length but 0."""
        if name not in self.arrays:
            raise self.error(Message("'{name}' is missing", name=name))
        array = self.arrays[name]
        fits = array.ndim == len(shape) and all(
            have == want or (want == -1 and have > 0) for have, want in zip(array.shape, shape, strict=True)
        )
        if not fits or array.dtype.kind not in kinds:
            raise self.error(Message("'{name}' does not have the expected shape or type", name=name))
        return array

    def numbers(self, name: str, shape: tuple[int, ...]) -> Floats:
        """Return an array of finite numbers."""
        array = frozen(self.array(name, "fiu", shape))
        if not (np.abs(array) < MAX_COORDINATE).all():
            raise self.error(Message("'{name}' contains values that are not finite", name=name))
        return array

    def positive(self, name: str) -> float:
        """Return a number above 0."""
        number = float(self.numbers(name, ()))
        if number <= 0.0:
            raise self.error(Message("'{name}' is not positive", name=name))
        return number

    def text(self, name: str) -> str:
        """Return a text that is a file name without a folder."""
        text = str(self.array(name, "U", ()))
        if not text or Path(text).name != text or "\\" in text:
            raise self.error(Message("'{name}' is not a file name", name=name))
        return text


def _template(reader: _Reader) -> Template:
    """Return the template whose control mesh a case has."""
    faces, fixed = reader.array("control_faces", "iu", (-1, 3)), reader.array("control_fixed", "b", (-1,))
    for template in map(read_template, TEMPLATES):
        if np.array_equal(faces, template.faces) and np.array_equal(fixed, template.fixed):
            return template
    raise reader.error(Message("its control mesh is not that of a template"))


def _cup(reader: _Reader) -> Cup | None:
    """Return the cup of a case, None if it has none: a moulded one without wire unless told otherwise."""
    if "cup" not in reader.arrays:
        return None
    lift, forward, gather = reader.numbers("cup", (3,)).tolist()
    coverage = str(reader.array("cup_coverage", "U", ()))
    kind = str(reader.array("cup_kind", "U", ())) if "cup_kind" in reader.arrays else "moulded"
    numbers = {"lift": lift, "forward": forward, "gather": gather}
    if kind == "sewn":
        sewn = reader.numbers("cup_sewn", (3,)).tolist()
        numbers |= dict(zip(("across", "upright", "cloth"), sewn, strict=True))
    if wire := "cup_wire" in reader.arrays:
        numbers["wire_width"] = float(reader.numbers("cup_wire", ()))
    try:
        return Cup(kind, coverage, wire=wire, **numbers)
    except UserError as problem:
        raise reader.error(Message("its cup is not one that Busk can compute")) from problem


def _lines(reader: _Reader, template: Template) -> tuple[tuple[tuple[int, ...], ...], str]:
    """Return the control points of each line, and the kind of the case.

    Rows below 0 fill up the table where a line has fewer points than another.
    """
    if reader.arrays.get("line_rows", np.ones(1)).size == 0:
        return (), "weight"
    rows = reader.array("line_rows", "iu", (-1, -1))
    columns = reader.array("line_columns", "iu", rows.shape)
    lines, kinds = [], set()
    for row, column in zip(rows, columns, strict=True):
        used = row >= 0
        places = np.stack([row[used], column[used]], axis=1).tolist()
        if len(places) < 2 or not all(template.grid.has(place) for place in places):
            raise reader.error(Message("a line leaves the control mesh"))
        lines.append(tuple(template.point(*place) for place in places))
        along = (np.ptp(row[used]) == 0, np.ptp(column[used]) == 0)
        kinds.add({(True, False): "mid-bust", (False, True): "sling"}.get(along, "other"))
    return tuple(lines), kinds.pop() if len(kinds) == 1 else "other"
