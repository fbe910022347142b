"""The MakeHuman base mesh as data: vertices mixed from its targets, bent at the shoulders, subdivided.

Reads the CC0 files base.obj, targets/**.target.gz and rigs/standard/weights.default.json with numpy alone.
Lengths are decimetres in the files and millimetres here, in the canonical frame (z up, facing -y, +x left).
"""

from __future__ import annotations

import gzip
import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from pathlib import Path

import numpy as np
from scipy import sparse

from core.geometry.mesh import Faces, Flags, Floats, Indices, Points

LADDERS = {
    "gender": ((0.0, "female"), (1.0, "male")),
    "age": ((0.1875, "child"), (0.5, "young"), (1.0, "old")),
    "muscle": ((0.0, "minmuscle"), (0.5, "averagemuscle"), (1.0, "maxmuscle")),
    "weight": ((0.0, "minweight"), (0.5, "averageweight"), (1.0, "maxweight")),
    "cup": ((0.0, "mincup"), (0.5, "averagecup"), (1.0, "maxcup")),
    "firmness": ((0.0, "minfirmness"), (0.5, "averagefirmness"), (1.0, "maxfirmness")),
    "height": ((0.0, "minheight"), (0.5, ""), (1.0, "maxheight")),
    "proportions": ((0.0, "uncommonproportions"), (0.5, ""), (1.0, "idealproportions")),
}
"""The steps of each macro factor [1]: between two of them both targets are mixed linearly."""

MACROS = (
    ("macrodetails/universal", ("gender", "age", "muscle", "weight")),
    ("macrodetails/height/", ("gender", "age", "muscle", "weight", "height")),
    ("macrodetails/proportions/", ("gender", "age", "muscle", "weight", "proportions")),
    ("breast/", ("gender", "age", "muscle", "weight", "cup", "firmness")),
)
RACES = ("african", "asian", "caucasian")
LIMBS = ("upperarm", "lowerarm", "wrist", "metacarpal", "finger")


@dataclass(frozen=True, eq=False)
class HumanBase:
    """The base mesh in ``folder``: ``rest``, shape (n, 3) [mm], and its quadrangles, shape (m, 4)."""

    folder: Path
    rest: Points
    quads: Indices

    @cached_property
    def targets(self) -> dict[str, tuple[Indices, Points]]:
        """Targets that were read, by path below the folder of targets."""
        return {}

    @cached_property
    def bones(self) -> dict[str, Floats]:
        """Weights of the vertices for each bone, each (n,) [1]; together they are 1."""
        file = self.folder / "rigs" / "standard" / "weights.default.json"
        weights = {}
        for name, rows in json.loads(file.read_text(encoding="utf-8"))["weights"].items():
            weights[name] = np.zeros(len(self.rest))
            index, share = np.array(rows, dtype=float).reshape(-1, 2).T
            weights[name][index.astype(int)] = share
        return weights

    def weight(self, *starts: str) -> Floats:
        """Return the weight of all bones whose names begin with one of ``starts``, shape (n,) [1]."""
        return np.asarray(sum(w for name, w in self.bones.items() if name.startswith(starts)))

    def target(self, name: str) -> tuple[Indices, Points]:
        """Return the rows that a target moves and how far, shape (k, 3) [mm]."""
        if name not in self.targets:
            packed = (self.folder / "targets" / f"{name}.target.gz").read_bytes()
            lines = gzip.decompress(packed).decode("utf-8").splitlines()
            rows = [line.split() for line in lines if line and line[0] != "#"]
            rows = np.array(rows, dtype=float).reshape(-1, 4)
            self.targets[name] = (rows[:, 0].astype(int), _canonical(rows[:, 1:4]))
        return self.targets[name]

    def mixed(self, macros: Mapping[str, float], details: Mapping[str, float]) -> Points:
        """Return the vertices for macro factors (0..1, a little beyond them extrapolates) and details."""
        v = self.rest.copy()
        for name, share in {**_macro_shares(macros), **details}.items():
            rows, move = self.target(name)
            v[rows] += share * move
        return v

    def joint(self, v: Points, name: str) -> Points:
        """Return the middle of a joint's cube, shape (3,) [mm]."""
        return np.asarray(v[self.joints[name]].mean(axis=0))

    @cached_property
    def joints(self) -> dict[str, Indices]:
        """Rows of the vertices of each joint's cube, by name."""
        file = self.folder / "mesh_metadata" / "basemesh_vertex_groups.json"
        groups = json.loads(file.read_text(encoding="utf-8"))
        spans = {name: rows for name, rows in groups.items() if name.startswith("joint-")}
        return {name: np.concatenate([np.arange(a, b + 1) for a, b in rows]) for name, rows in spans.items()}

    def arms_lowered(self, v: Points, degrees: float) -> Points:
        """Turn both arms down about the shoulder joints [degrees], with the rig's own weights."""
        lowered = v.copy()
        for side, sign in (("L", 1.0), ("R", -1.0)):
            bones = [w for name, w in self.bones.items() if name.startswith(LIMBS) and name.endswith(side)]
            share = np.asarray(sum(bones))[:, None]
            at = self.joint(v, f"joint-{side.lower()}-shoulder")
            a = np.radians(degrees) * sign
            turn = np.array([[np.cos(a), 0.0, np.sin(a)], [0.0, 1.0, 0.0], [-np.sin(a), 0.0, np.cos(a)]])
            lowered += share * ((v - at) @ turn.T + at - v)
        return lowered


def read_base(folder: Path) -> HumanBase:
    """Read base.obj in ``folder``/3dobjs: all vertices, and the faces of the body alone."""
    vertices, quads, group = [], [], ""
    for line in (folder / "3dobjs" / "base.obj").read_text(encoding="utf-8").splitlines():
        word, _, rest = line.partition(" ")
        if word == "v":
            vertices.append([float(number) for number in rest.split()])
        elif word == "g":
            group = rest.strip()
        elif word == "f" and group == "body":
            quads.append([int(corner.split("/")[0]) - 1 for corner in rest.split()])
    return HumanBase(folder, _canonical(np.array(vertices)), np.array(quads))


def _canonical(decimetres: Points) -> Points:
    return 100.0 * np.stack([decimetres[:, 0], -decimetres[:, 2], decimetres[:, 1]], axis=1)


def _macro_shares(macros: Mapping[str, float]) -> dict[str, float]:
    shares: dict[str, float] = {}
    races = {race: macros.get(race, 1.0 / 3.0) for race in RACES}
    for race, (gender, a), (age, b) in product(RACES, *(_steps(k, macros) for k in ("gender", "age"))):
        shares[f"macrodetails/{race}-{gender}-{age}"] = races[race] / sum(races.values()) * a * b
    for start, factors in MACROS:
        for steps in product(*(_steps(factor, macros) for factor in factors)):
            names, share = [name for name, _ in steps], float(np.prod([part for _, part in steps]))
            plain = names[-2:] == ["averagecup", "averagefirmness"] or "" in names
            if share and not plain and not (start == "breast/" and names[0] == "male"):
                joined = "-".join(names)
                shares[f"{start}{'' if start.endswith('/') else '-'}{joined}"] = share
    return shares


def _steps(factor: str, macros: Mapping[str, float]) -> list[tuple[str, float]]:
    """Return the two targets between which a factor lies and their shares; beyond the ends they go on."""
    at, ladder = macros.get(factor, 0.5), LADDERS[factor]
    k = int(np.clip(np.searchsorted([step for step, _ in ladder], at) - 1, 0, len(ladder) - 2))
    (low, name), (high, upper) = ladder[k], ladder[k + 1]
    t = (at - low) / (high - low)
    return [(name, 1.0 - t), (upper, t)]


def subdivision(quads: Indices, count: int) -> tuple[sparse.csr_array, Indices]:
    """Return one step of Catmull and Clark (1978): the matrix of the new vertices, and the new quadrangles.

    ``quads``, shape (m, 4), need not be closed; borders become B-spline curves. The first ``count`` new
    vertices are the old ones moved, so rows keep their meaning.
    """
    m = len(quads)
    tails, heads = quads.ravel(), np.roll(quads, -1, axis=1).ravel()
    key = np.minimum(tails, heads) * count + np.maximum(tails, heads)
    edges, edge, uses = np.unique(key, return_inverse=True, return_counts=True)
    a, b, e = edges // count, edges % count, len(edges)
    of_face = sparse.csr_array((np.full(4 * m, 0.25), (np.repeat(np.arange(m), 4), tails)), (m, count))
    ends = sparse.csr_array((np.full(2 * e, 0.5), (np.tile(np.arange(e), 2), np.r_[a, b])), (e, count))
    beside = sparse.csr_array((np.full(4 * m, 0.5), (edge, np.repeat(np.arange(m), 4))), (e, m))
    border = uses == 1
    inner = sparse.diags_array(np.where(border, 0.0, 0.5))
    edge_points = (sparse.diags_array(np.where(border, 1.0, 0.5)) @ ends + inner @ (beside @ of_face)).tocsr()

    on_border = np.zeros(count, dtype=bool)
    on_border[np.r_[a[border], b[border]]] = True
    valence = np.bincount(np.r_[a, b], minlength=count).astype(float)
    faces_of = sparse.csr_array((np.ones(4 * m), (tails, np.repeat(np.arange(m), 4))), (count, m))
    edges_of = sparse.csr_array((np.ones(2 * e), (np.r_[a, b], np.tile(np.arange(e), 2))), (count, e))
    n = np.maximum(valence, 1.0)
    degree = np.maximum(np.bincount(tails, minlength=count), 1.0)
    inside = (valence > 0) & ~on_border
    q = sparse.diags_array(np.where(inside, 1.0 / (n * degree), 0.0)) @ faces_of @ of_face
    r = sparse.diags_array(np.where(inside, 2.0 / n**2, 0.0)) @ edges_of @ ends
    s = sparse.diags_array(np.where(inside, (n - 3.0) / n, 1.0))
    rim = sparse.diags_array(on_border.astype(float)) @ edges_of @ sparse.diags_array(border.astype(float))
    # a vertex of the border: 1/2 of itself and 1/4 of the middles of its two edges there
    rim = 0.25 * (rim @ ends) - sparse.diags_array(np.where(on_border, 0.5, 0.0))
    matrix = sparse.vstack([s + rim + q + r, edge_points, of_face]).tocsr()
    at = count + edge.reshape(m, 4)
    middle = np.repeat(count + e + np.arange(m), 4).reshape(m, 4)
    new = np.stack([quads, at, middle, np.roll(at, 1, axis=1)], axis=2).reshape(-1, 4)
    return matrix, new


def triangles(quads: Indices) -> Faces:
    """Return two triangles for each quadrangle, shape (2 m, 3)."""
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def refined(quads: Indices, count: int, times: int) -> tuple[sparse.csr_array, Faces]:
    """Return the matrix from ``count`` vertices to those after ``times`` subdivisions, and triangles."""
    matrix = sparse.eye_array(count, format="csr")
    for _ in range(times):
        step, quads = subdivision(quads, matrix.shape[0])
        matrix = (step @ matrix).tocsr()
    return matrix, triangles(quads)


def kept(quads: Indices, keep: Flags) -> Indices:
    """Return the quadrangles whose corners are all kept."""
    return np.asarray(quads[keep[quads].all(axis=1)])
