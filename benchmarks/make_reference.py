"""Reference cases: displacements of a bust by an independent finite-element model of soft tissue.

Make:  python benchmarks/make_reference.py BODY.ply --case no-weight sling=95% --shear 0.5 --out DIR
Check: python benchmarks/make_reference.py --check FILE... --bodies DIR

BODY is a clean, upright body in mm. A case is a state of gravity (no-weight, supine, lean=30,
gravity=X,Y,Z), lines with their common ratio (mid-bust=95%, sling=95%, strap=95%), cups of both breasts,
rigid (cup=COVERAGE,lift:25,forward:5,gather:15 [mm]) or of cloth (sewn=COVERAGE,across:0.95,upright:0.92,
cloth:300 [N/m]), with wires if a width is given (wire:1.0), or several joined by "+".
In place of the shear modulus [kPa], ``--rise`` chooses the one with which the bust rises so far [mm] when
its weight is removed. A check solves the definition stored in a file anew, also on a mesh with 1.7 times
the unknowns. Model and files: resources/reference/README.md. Needs benchmarks/reference-requirements.txt.
"""

from __future__ import annotations

import argparse
import sys
import time
from dataclasses import replace
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parents[1])]

from reference.cases import Case, model_of, solved, write_case  # noqa: E402
from reference.compare import compare, disc_rise  # noqa: E402
from reference.garments import bare_case, file_label, named_case  # noqa: E402
from reference.model import COUNT, BustModel  # noqa: E402
from reference.newton import NoBalanceError  # noqa: E402

from core.geometry.mesh import Points  # noqa: E402

FIRST_SHEAR = 0.5
"""Shear modulus [kPa] with which the search for a rise begins."""


def main() -> None:
    """Make or check the cases of the command line."""
    arguments = parsed()
    if arguments.check:
        for path in arguments.check:
            print(path.name, *compare(path, arguments.bodies).lines(), sep="\n  ", flush=True)
    else:
        make(arguments.body, arguments.case, arguments.shear, arguments.rise, arguments.out)


def parsed() -> argparse.Namespace:
    """Return the arguments of the command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("body", nargs="?", type=Path, metavar="BODY", help="file of a body")
    parser.add_argument("--case", nargs="+", default=["no-weight"], help="states to solve")
    parser.add_argument("--shear", type=float, default=FIRST_SHEAR, help="shear modulus [kPa]")
    parser.add_argument("--rise", type=float, help="rise without weight [mm] that sets the shear modulus")
    parser.add_argument("--out", type=Path, default=Path(), help="folder for the files")
    parser.add_argument("--check", nargs="+", type=Path, metavar="FILE", help="stored cases to solve")
    parser.add_argument("--bodies", type=Path, default=Path("resources/samples"), help="their bodies")
    arguments = parser.parse_args()
    if (arguments.body is None) == (arguments.check is None):
        parser.error("give a BODY, or files to --check")
    return arguments


def make(body: Path, names: list[str], shear_kpa: float, rise: float | None, out: Path) -> None:
    """Solve and write the cases ``names`` of ``body``; a case without a balance is reported and left out."""
    bare, stages = bare_case(body, shear_kpa)
    cases = [named_case(name, bare, stages) for name in names]  # faults in names show before the work begins
    model = model_of(bare, body.parent, COUNT)
    if rise is not None:
        bare, model = softened(bare, model, body.parent, rise)
    cases = [replace(case, shear_kpa=bare.shear_kpa) for case in cases]
    out.mkdir(parents=True, exist_ok=True)
    for name, case in zip(names, cases, strict=True):
        start = time.perf_counter()
        try:
            moved, info = solved(case, model)
        except NoBalanceError as problem:
            print(f"{body.stem} {name}: {problem}; no file is written", flush=True)
            continue
        write_case(out / f"{body.stem}_{file_label(name)}.npz", case, model, moved, info)
        rises = [f"{each:.2f}" for each in skin_rises(bare, model, moved)]
        print(body.stem, name, "rise", *rises, info, f"{time.perf_counter() - start:.0f} s", flush=True)


def skin_rises(case: Case, model: BustModel, moved: Points) -> list[float]:
    """Return the mean rise of the skin around the left and the right bust point at nodes ``moved`` [mm]."""
    picked, _ = model.skin_nodes()
    return [disc_rise(picked @ model.nodes, picked @ (moved - model.nodes), bust) for bust in case.busts]


def softened(bare: Case, model: BustModel, bodies: Path, rise: float) -> tuple[Case, BustModel]:
    """Return case and model whose rise without weight is about ``rise`` [mm]: the modulus is rounded."""
    for _ in range(3):
        reached = sum(skin_rises(bare, model, model.loaded_body.unloaded)) / 2.0
        shear = round(bare.shear_kpa * reached / rise, 2)
        print(f"{bare.body}: shear modulus {bare.shear_kpa:.2f} kPa, rise without weight {reached:.2f} mm")
        if shear == bare.shear_kpa:
            break
        bare = replace(bare, shear_kpa=shear)
        model = model_of(bare, bodies, COUNT)
    return bare, model


if __name__ == "__main__":
    main()
