"""Harder bodies with known landmarks, made of clean ones: other shapes, worse scans, other axes and units.

Run: python benchmarks/make_bodies.py SRC OUT [--seed N] [--rounds K]. SRC holds truth.json and the clean
bodies that it names; OUT gets one file for each of 60 kinds of shape and damage, and 8 things that are no
upper body, in each round (2 rounds: 136 files), and a truth.json of the same form. The kinds are always the
same; which body, how much, and how it stands in its file comes from the seed. ``busk accuracy OUT`` then
tells how well the landmarks are found.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import trimesh

sys.path[:0] = [str(Path(__file__).parent.parent), str(Path(__file__).parent.parent / "tests" / "helpers")]

import altered_bodies as shape  # noqa: E402
import worn_scans as worn  # noqa: E402
from altered_bodies import Alteration, altered  # noqa: E402
from body_truth import KnownBody, true_girths  # noqa: E402
from worn_scans import Scan, Standing  # noqa: E402

from core.geometry.mesh import Mesh, Points  # noqa: E402

Rng = np.random.Generator

FAR = 2000.0
"""A body whose file has its origin further away than this [mm] is of the kind "far"."""

Shape = Callable[[Rng], list[Alteration]]
Damage = Callable[[Scan, Rng, KnownBody], Scan]

SHAPES: dict[str, Shape] = {
    "leanforward": lambda rng: [shape.lean(rng.uniform(4.0, 10.0))],
    "leanback": lambda rng: [shape.lean(-rng.uniform(4.0, 10.0))],
    "pregnant": lambda rng: [shape.belly(rng.uniform(60.0, 110.0)), shape.lean(-rng.uniform(3.0, 7.0))],
    "slimbelly": lambda rng: [shape.trunk_scale(0.85, 0.9), shape.belly(rng.uniform(50.0, 90.0))],
    "bellyforemost": lambda rng: [shape.belly(rng.uniform(70.0, 110.0))],
    "smallcupbelly": lambda rng: [shape.cup(0.7), shape.belly(rng.uniform(50.0, 90.0))],
    "bra": lambda rng: [shape.in_a_bra],
    "norelief": lambda rng: [shape.smooth_nipples],
    "bigcup": lambda rng: [shape.cup(rng.uniform(1.2, 1.6))],
    "smallcup": lambda rng: [shape.cup(rng.uniform(0.6, 0.85))],
    "sag": lambda rng: [shape.sag(rng.uniform(10.0, 24.0))],
    "touching": lambda rng: [shape.touching],
    "missing": lambda rng: [shape.missing(str(rng.choice(["left", "right"])))],
    "asymmetric": lambda rng: [
        shape.cup(rng.uniform(1.1, 1.2), sides=("left",)),
        shape.cup(rng.uniform(0.8, 0.9), sides=("right",)),
    ],
    "plus": lambda rng: [shape.trunk_scale(1.25, 1.25), shape.belly(rng.uniform(10.0, 50.0))],
    "slim": lambda rng: [shape.trunk_scale(0.85, 0.85)],
    "twisted": lambda rng: [shape.twist(rng.choice([-1, 1]) * rng.uniform(5.0, 10.0))],
    "noneck": lambda rng: [shape.no_neck],
    "noarms": lambda rng: [shape.no_arms],
    "short": lambda rng: [shape.short(rng.uniform(95.0, 130.0), rng.uniform(60.0, 110.0))],
}


def _under_a_breast(scan: Scan, rng: Rng, body: KnownBody) -> Scan:
    fold = body.points[f"fold_{rng.choice(body.sides)}"]
    return worn.hole(scan, fold + rng.normal(0.0, 8.0, 3), rng.uniform(15.0, 32.0))


def _in_the_armpit(scan: Scan, rng: Rng, body: KnownBody) -> Scan:
    v, height = scan[0], body.points["front_mid_bust"][2] + rng.uniform(10.0, 70.0)
    half = 0.5 * shape.trunk_width(body.mesh, height - 40.0) + 10.0
    centre = np.array([rng.choice([-1.0, 1.0]) * half, -70.0, height])
    return worn.hole(scan, v[np.argmin(np.linalg.norm(v - centre, axis=1))], rng.uniform(25.0, 50.0))


def _at_the_back(scan: Scan, rng: Rng, body: KnownBody) -> Scan:
    v = scan[0]
    centre = np.array([rng.uniform(-80.0, 80.0), 25.0, body.points["front_mid_underbust"][2]])
    return worn.hole(scan, v[np.argmin(np.linalg.norm(v - centre, axis=1))], rng.uniform(25.0, 50.0))


DAMAGES: dict[str, Damage] = {
    "noise": lambda scan, rng, body: worn.noise(scan, rng, rng.uniform(0.3, 1.2)),
    "noise2": lambda scan, rng, body: worn.noise(scan, rng, rng.uniform(1.5, 2.0)),
    "holes": lambda scan, rng, body: worn.holes_anywhere(scan, rng, 12),
    "holefold": _under_a_breast,
    "holefoldnoise": lambda scan, rng, body: worn.noise(_under_a_breast(scan, rng, body), rng, 0.8),
    "holearmpit": _in_the_armpit,
    "holeback": _at_the_back,
    "specks": lambda scan, rng, body: worn.specks(worn.noise(scan, rng, 0.5), rng, 200),
    "floor": lambda scan, rng, body: worn.floor_plate(scan, rng),
    "soup": lambda scan, rng, body: worn.soup(worn.noise(scan, rng, 0.4)),
    "flipped": lambda scan, rng, body: worn.flipped(scan, rng, 0.3),
    "doubled": lambda scan, rng, body: worn.doubled(scan, rng, 0.2),
    "coarse": lambda scan, rng, body: worn.decimated(scan, int(rng.integers(5000, 20000))),
    "cloud": lambda scan, rng, body: worn.cloud(
        worn.noise(scan, rng, 0.6), rng, int(rng.integers(25000, 60000))
    ),
}


def _solid(kind: str) -> Callable[[KnownBody], Scan]:
    make_it = {
        "box": lambda: trimesh.creation.box((300.0, 200.0, 500.0)).subdivide().subdivide().subdivide(),
        "ball": lambda: trimesh.creation.icosphere(5, 180.0),
        "cylinder": lambda: trimesh.creation.cylinder(130.0, 500.0).subdivide().subdivide(),
    }[kind]
    return lambda body: (np.asarray(make_it().vertices), np.asarray(make_it().faces))


def _piece(keep: Callable[[Points, float], np.ndarray]) -> Callable[[KnownBody], Scan]:
    def cut_out(body: KnownBody) -> Scan:
        bust = body.points["front_mid_bust"][2]
        mesh = shape.part(body, lambda v: keep(v, bust)).mesh
        return mesh.vertices, mesh.faces

    return cut_out


NO_BODIES: dict[str, Callable[[KnownBody], Scan]] = {
    "box": _solid("box"),
    "ball": _solid("ball"),
    "cylinder": _solid("cylinder"),
    "belly": _piece(lambda v, bust: v[:, 2] < bust - 110.0),
    "abovebust": _piece(lambda v, bust: v[:, 2] > bust + 60.0),
    "lefthalf": _piece(lambda v, bust: v[:, 0] > 0.0),
    "backhalf": _piece(lambda v, bust: v[:, 1] > -80.0),
    "arm": _piece(lambda v, bust: (v[:, 0] > 190.0) & (v[:, 2] > bust - 60.0)),
}
"""What holds no bust that could be measured: it has to be refused."""


def plan() -> list[tuple[str, str, bool]]:
    """Return the 60 kinds of a round: names of shape and damage ("" for none), and whether it is tilted."""
    shapes, damages = list(SHAPES), list(DAMAGES)
    alone = [(name, "", False) for name in shapes] + [("", name, False) for name in damages]
    tilted = [("", "", True), ("", "noise", True), ("", "cloud", True), ("", "holes", True)]
    tilted += [(name, "", True) for name in ("pregnant", "bra", "plus", "smallcup")]
    both = [(name, damages[(5 * k + 3) % len(damages)], k % 6 == 5) for k, name in enumerate(shapes[:18])]
    return alone + tilted + both


def standing(rng: Rng, tilted: bool) -> Standing:
    """Return any of the 24 axis orders, any turn, any unit; a few files far from the origin."""
    shift = rng.normal(0.0, 20000.0 if rng.random() < 0.15 else 150.0, 3)
    about = rng.normal(size=3)
    return Standing(
        int(rng.integers(24)),
        float(rng.uniform(-180.0, 180.0)),
        float(rng.uniform(5.0, 45.0)) if tilted else 0.0,
        (float(about[0]), float(about[1]), float(about[2])),
        str(rng.choice(list(worn.UNITS))),
        (float(shift[0]), float(shift[1]), float(shift[2])),
    )


def clean_bodies(folder: Path) -> dict[str, KnownBody]:
    """Read the clean bodies that truth.json of ``folder`` names."""
    truth = json.loads((folder / "truth.json").read_text(encoding="utf-8"))
    bodies = {}
    for name, known in truth["bodies"].items():
        mesh = trimesh.load(folder / known["file"], process=False)
        points = {key: np.array(point) for key, point in known["landmarks"].items()}
        skin = Mesh(np.asarray(mesh.vertices), np.asarray(mesh.faces))
        bodies[name] = KnownBody(skin, points, dict(known.get("flags", {})))
    return bodies


def entry(body: KnownBody, stand: Standing, scan: Scan, about: dict[str, Any]) -> dict[str, Any]:
    """Return what truth.json tells about one file."""
    matrix = stand.matrix
    in_file = {name: matrix[:3, :3] @ point + matrix[:3, 3] for name, point in body.points.items()}
    return {
        **about,
        "landmarks_canonical_mm": {name: point.round(2).tolist() for name, point in body.points.items()},
        "landmarks_file": {name: point.round(6).tolist() for name, point in in_file.items()},
        "canonical_to_file": matrix.tolist(),
        "girths": true_girths(body),
        "flags": body.flags,
        "unit": stand.unit,
        "yaw_deg": stand.yaw,
        "tilt_deg": stand.tilt,
        "up_direction_file": (matrix[:3, 2] * worn.UNITS[stand.unit]).round(4).tolist(),
        "front_direction_file": (-matrix[:3, 1] * worn.UNITS[stand.unit]).round(4).tolist(),
        "n_vertices": len(scan[0]),
        "n_faces": len(scan[1]),
    }


def a_body(
    bodies: dict[str, KnownBody], kind: tuple[str, str, bool], rng: Rng
) -> tuple[Scan, dict[str, Any]]:
    """Return a file's skin and what is known of it: a body of some shape, damage and standing."""
    form, damage, tilted = kind
    name = sorted(bodies)[int(rng.integers(len(bodies)))]
    body = altered(bodies[name], *(SHAPES[form](rng) if form else []))
    scan: Scan = (body.mesh.vertices, body.mesh.faces)
    if damage:
        scan = DAMAGES[damage](scan, rng, body)
    stand = standing(rng, tilted)
    tilt = f"tilt{stand.tilt:.0f}" if tilted else ""
    far = "far" if np.linalg.norm(stand.shift) > FAR else ""
    kinds = [word for word in (form, damage, "tilt" if tilted else "", far) if word]
    label = "_".join(word for word in (name, form, damage, tilt, stand.unit) if word)
    about = {
        "label": label,
        "body": name,
        "note": " + ".join(kinds),
        "kinds": kinds,
        "degraded": bool(damage),
    }
    return _placed(scan, stand), entry(body, stand, scan, about)


def no_body(bodies: dict[str, KnownBody], kind: str, rng: Rng) -> tuple[Scan, dict[str, Any]]:
    """Return the skin of something that has to be refused, and that this is so."""
    scan = NO_BODIES[kind](bodies[sorted(bodies)[int(rng.integers(len(bodies)))]])
    stand = standing(rng, tilted=False)
    about = {"label": f"no_{kind}_{stand.unit}", "refuse": True, "kinds": ["no body", kind]}
    return _placed(scan, stand), {**about, "unit": stand.unit, "canonical_to_file": stand.matrix.tolist()}


def _placed(scan: Scan, stand: Standing) -> Scan:
    return scan[0] @ stand.matrix[:3, :3].T + stand.matrix[:3, 3], scan[1]


def make(source: Path, out: Path, seed: int, rounds: int = 2) -> int:
    """Write the files and their truth; return how many there are."""
    bodies = clean_bodies(source)
    out.mkdir(parents=True, exist_ok=True)
    scans = {}
    for turn in range(rounds):
        works = [partial(a_body, bodies, kind) for kind in plan()]
        works += [partial(no_body, bodies, kind) for kind in NO_BODIES]
        for number, work in enumerate(works):
            scan, known = work(np.random.default_rng([seed, turn, number]))
            label = f"{known.pop('label')}_{turn}"
            soup = "soup" in known["kinds"]
            known["file"] = f"{label}.{'stl' if soup else 'ply'}"
            (out / known["file"]).write_bytes((worn.stl_bytes if soup else worn.ply_bytes)(scan))
            scans[label] = known
    truth = {"frame": "mm, Z up, subject faces -Y, +X = left of subject", "bodies": {}, "scans": scans}
    (out / "truth.json").write_text(json.dumps(truth, indent=1), encoding="utf-8")
    return len(scans)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("source", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--rounds", type=int, default=2)
    options = parser.parse_args()
    print(make(options.source, options.out, options.seed, options.rounds), "files in", options.out)


if __name__ == "__main__":
    main()
