"""Cups in the file of a case: arrays that tell what the program is asked, and what the model solves."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from core.geometry.mesh import Mesh
from reference.contact import Cup
from reference.sewn import Cloth
from reference.underwire import Wire


def cup_arrays(cup: Cup) -> dict[str, Any]:
    """Return the arrays of ``cup``."""
    arrays: dict[str, Any] = {
        "cup": np.array([cup.lift, cup.forward, cup.gather]),
        "cup_kind": np.array("moulded" if cup.cloth is None else "sewn"),
        "cup_coverage": np.array(cup.coverage),
        "cup_rest": cup.rest.vertices.astype(np.float32),
        "cup_points": cup.target.astype(np.float32),
        "cup_triangles": cup.rest.faces.astype(np.int32),
        "cup_side": cup.side.astype(np.int8),
    }
    if cup.cloth is not None:
        arrays |= {
            "cup_sewn": np.array([cup.cloth.across, cup.cloth.upright, cup.cloth.cloth_n_m]),
            "cloth_strips": cup.cloth.strips.astype(np.int32),
            "cloth_across": cup.cloth.level,
        }
    if cup.wire is not None:
        arrays |= {
            "cup_wire": np.array(cup.wire.width),
            "wire_points": cup.wire.points.astype(np.int32),
            "wire_side": cup.wire.side.astype(np.int8),
            "wire_shape": cup.wire.shape,
            "wire_n_mm": np.array(cup.wire.hardness),
        }
    return arrays


def read_cup(stored: Mapping[str, Any]) -> Cup:
    """Return the cup of arrays ``stored``: a moulded one without wire unless they tell more."""
    rest = Mesh(stored["cup_rest"].astype(np.float64), stored["cup_triangles"].astype(np.int64))
    target = stored["cup_points"].astype(np.float64)
    cloth = wire = None
    if "cup_sewn" in stored:
        strips = stored["cloth_strips"].astype(np.int64)
        cloth = Cloth(*stored["cup_sewn"].tolist(), strips, stored["cloth_across"])
    if "cup_wire" in stored:
        points, side = (stored[f"wire_{each}"].astype(np.int64) for each in ("points", "side"))
        wire = Wire(float(stored["cup_wire"]), points, side, stored["wire_shape"], float(stored["wire_n_mm"]))
    ways, coverage = stored["cup"].tolist(), str(stored["cup_coverage"])
    return Cup(*ways, coverage, rest, target, stored["cup_side"], cloth, wire)
