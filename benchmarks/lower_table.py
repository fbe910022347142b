"""Errors of the landmarks of the lower trunk on bodies with known ones, clean and degraded.

    python benchmarks/lower_table.py FOLDER [FORM ...]

``FOLDER`` holds NAME.ply and truth.json with ``bodies``: by name ``levels`` and ``landmarks`` [mm]. Forms are
those of FORMS, or ``others:FORM``, which makes other persons of the bodies first.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from lower_forms import coarse, found_anew, reshaped

from core.errors import LandmarkError
from core.geometry.mesh import Mesh
from core.landmarks.detect import find_landmarks
from core.landmarks.lower_trunk.detect import find_lower_landmarks
from core.landmarks.types import CERTAIN
from core.scan.body import Body, read_scan

LIMITS = {"crotch": 1.2, "hip": 3.0, "waist": 12.2, "belly": 3.5, "buttock": 8.0, "gluteal_fold": 15.6}
"""An error beyond this is wrong [mm]: 1.5 times the largest that the prototype had on clean bodies."""

LEVELS = {"crotch": "crotch", "hip": "hip_largest", "waist": "waist_natural", "belly": "belly"}

Truth = dict[str, Any]


def noise(mesh: Mesh, truth: Truth) -> Mesh:
    """Move every vertex by 1 mm (standard deviation) along each axis."""
    return Mesh(mesh.vertices + np.random.default_rng(1).normal(0.0, 1.0, mesh.vertices.shape), mesh.faces)


def without(mesh: Mesh, gone: np.ndarray) -> Mesh:
    """Leave out faces whose corners are all ``gone``, shape (n,)."""
    return Mesh(mesh.vertices, mesh.faces[~gone[mesh.faces].all(axis=1)])


def hole(mesh: Mesh, truth: Truth) -> Mesh:
    """Tear a hole of 35 mm radius between the legs."""
    away = np.linalg.norm(mesh.vertices - truth["landmarks"]["crotch"], axis=1)
    return without(mesh, away < 35.0)


def thigh_holes(mesh: Mesh, truth: Truth) -> Mesh:
    """Tear a strip out of the inside of both thighs, 10 to 90 mm below the crotch."""
    x, _, z = mesh.vertices.T
    down = truth["levels"]["crotch"] - z
    return without(mesh, (np.abs(x) < 25.0) & (down > 10.0) & (down < 90.0))


def mid_thigh(mesh: Mesh, truth: Truth) -> Mesh:
    """Cut the scan 90 mm below the crotch."""
    return without(mesh, mesh.vertices[:, 2] < truth["levels"]["crotch"] - 90.0)


def one_leg(mesh: Mesh, truth: Truth) -> Mesh:
    """Cut the left leg 60 mm below the crotch."""
    x, _, z = mesh.vertices.T
    return without(mesh, (z < truth["levels"]["crotch"] - 60.0) & (x > 0.0))


def closed(mesh: Mesh, truth: Truth) -> Mesh:
    """Move the legs together until the thighs lie 12 mm in one another below the crotch."""
    x, _, z = mesh.vertices.T
    down = truth["levels"]["crotch"] - z
    near = (down > 20.0) & (down < 120.0)
    gap = min(np.abs(x[near & (x > 0.0)]).min(), np.abs(x[near & (x < 0.0)]).min())
    moved = (gap + 6.0) * np.clip(down / 20.0, 0.0, 1.0) * np.sign(x)
    return Mesh(np.stack([x - moved, *mesh.vertices.T[1:]], axis=1), mesh.faces)


def hand(mesh: Mesh, truth: Truth) -> Mesh:
    """Hang a forearm with a hand 15 mm beside the left hip, from the waist to below the crotch."""
    low, high = truth["levels"]["crotch"] - 30.0, truth["levels"]["waist_natural"] - 20.0
    own = mesh.vertices[(mesh.vertices[:, 2] > low) & (mesh.vertices[:, 2] < high)]
    arm = trimesh.creation.capsule(height=high - low - 70.0, radius=35.0)
    place = [own[:, 0].max() + 50.0, own[:, 1].mean(), low + 35.0]
    vertices = np.concatenate([mesh.vertices, arm.vertices + np.array(place)])
    return Mesh(vertices, np.concatenate([mesh.faces, arm.faces + len(mesh.vertices)]))


def grooves(mesh: Mesh, truth: Truth) -> Mesh:
    """Press grooves 2 mm deep where underwear ends: round waist and legs."""
    normals = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False).vertex_normals
    x, _, z = mesh.vertices.T
    levels, legs = truth["levels"], truth["levels"]["crotch"] - 6.0
    rise = np.clip((np.abs(x) - 30.0) / 120.0, 0.0, 1.0) * (levels["hip_joint"] - legs)
    away = np.minimum(np.abs(z - levels["waist_ring"]), np.abs(z - legs - rise))
    deep = 2.0 * np.exp(-0.5 * (away / 4.0) ** 2)
    return Mesh(mesh.vertices - deep[:, None] * normals, mesh.faces)


FORMS: dict[str, Callable[[Mesh, Truth], Mesh]] = {
    "clean": lambda mesh, truth: mesh,
    **{form.__name__: form for form in (noise, hole, thigh_holes, mid_thigh, one_leg, closed, hand, grooves)},
    "coarse": coarse,
}

OTHERS = tuple(f"others:{form}" for form in ("clean", "noise", "coarse"))
"""Forms of other persons made of the bodies, on whom the rules were not tuned; any form can be asked so."""

PERSONS = 3
"""Persons made of each body."""


def errors(body: Body, truth: Truth) -> dict[str, tuple[float, float]]:
    """Return by landmark how far its height is off [mm], and its confidence."""
    found = find_lower_landmarks(body, find_landmarks(body))
    result = {}
    for name, level in LEVELS.items():
        result[name] = found.levels[name] - truth["levels"][level], found.points[name].confidence
    for pair in ("buttock", "gluteal_fold"):
        for name in (f"{pair}_left", f"{pair}_right"):
            mark = found.points[name]
            result[name] = float(mark.position[2] - truth["landmarks"][name][2]), mark.confidence
    return {name: each for name, each in result.items() if not np.isnan(each[0])}  # else no one knows


def main() -> None:
    """Print mean and largest errors by form and landmark, and what is wrong but sure."""
    folder, *forms = sys.argv[1:]
    known = dict(known_bodies(Path(folder)))
    sets = {"": known}
    for form in forms or (*FORMS, *OTHERS):
        who, _, change = form.rpartition(":")
        if who not in sets:
            sets[who] = dict(others(known))
        begin, table, wrong = time.process_time(), {}, []
        for name, (body, truth) in sets[who].items():
            try:
                off = errors(replace(body, mesh=FORMS[change](body.mesh, truth)), truth)
            except LandmarkError as refusal:
                print(f"{form} {name}: {refusal}")
                continue
            for mark, (away, sure) in off.items():
                kind = mark.removesuffix("_left").removesuffix("_right")
                table.setdefault(kind, []).append((abs(away), sure))
                if abs(away) > LIMITS[kind] and sure >= CERTAIN:
                    wrong.append(f"{name} {mark} {away:+.1f}")
        print(f"{form}: {time.process_time() - begin:.1f} s with the bust")
        print_table(table)
        print("  wrong but sure:", "; ".join(wrong) or "none", flush=True)


def print_table(table: dict[str, list[tuple[float, float]]]) -> None:
    """Print the mean and the largest error of each landmark, of all and of those that are sure."""
    for kind, rows in table.items():
        away, sure = np.array(rows).T
        told = away[sure >= CERTAIN]
        print(
            f"  {kind:13} all {away.mean():5.1f} / {away.max():5.1f}"
            f"  sure {len(told)}: {told.mean() if len(told) else 0:5.1f} / {told.max(initial=0):5.1f}"
        )


def known_bodies(folder: Path) -> Iterator[tuple[str, tuple[Body, Truth]]]:
    """Yield the bodies of a folder by name, each with its truth."""
    for name, truth in json.loads((folder / "truth.json").read_text())["bodies"].items():
        yield name, (read_scan(folder / f"{name}.ply", unit="mm", up="+z", front="-y"), truth)


def others(known: dict[str, tuple[Body, Truth]]) -> Iterator[tuple[str, tuple[Body, Truth]]]:
    """Yield other persons made of known bodies, and print how far their rules are off on these."""
    for name, (body, truth) in known.items():
        again = found_anew(body.mesh, truth, lambda points: points)
        off = [f"{each} {again['levels'][each] - truth['levels'][each]:+.1f}" for each in LEVELS.values()]
        back = again["landmarks"]["buttock_left"][2] - truth["landmarks"]["buttock_left"][2]
        print(f"  {name}, truth found anew less truth: {', '.join(off)}, buttock_left {back:+.1f}")
        for seed in range(1, PERSONS + 1):
            mesh, moved = reshaped(seed, body.mesh, truth)
            yield f"{name}-{seed}", (replace(body, mesh=mesh), moved)


if __name__ == "__main__":
    main()
