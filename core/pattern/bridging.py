"""Cloth over hollows: where the skin is hollow, a taut cloth leaves it, as between the breasts (ours).

The cloth is a membrane that may leave the skin outward and not enter it: least squares of the slopes of its
places, with one distance from the skin at each, none below 0. Garments pull more across than down. Where it
is off the skin it slides: its places there are spread between those that lie on the skin, as shares of them,
so that it rides on the body as the skin does.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Literal

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import SuperLU, splu

from core.geometry.mesh import (
    Faces,
    Flags,
    Floats,
    Indices,
    Points,
    area_vectors,
    boundary_loops,
    own_vertices,
    unit,
)
from core.pattern.surface_cut import CutSkin

TENSION = (10.0, 1.0)
"""The tension of a cloth across the body and down [1]; ours."""

EDGE, SEAM = 1000.0, 100.0
"""The tension of an edge and a seam, that of so many mm of cloth down the body [mm]; ours."""

LEAST = 0.2
"""Nearer to the skin than this cloth lies on it [mm]; ours."""

_ROUNDS = 60  # of finding out where the cloth lies on the skin; most hollows take ten
_GROWING = 4  # of them, in which it grows faster: that halves them where they are many
_SHORTEST = 0.5  # steps of a cut skin may be shorter, but count as so long [mm]
_MISS = 1.0  # an edge off the skin is in the plane of three places on it within this [mm]
_REACH = 15.0  # of the place within the cloth that an edge is told from [mm]
_SMOOTHED = 30.0  # over which the directions change in which cloth may leave the skin, across it [mm]


def bridged(places: Points, faces: Faces, normals: Points, bridges: Flags | None = None) -> Points:
    """Return the ``places`` (n, 3) [mm] of a cloth on the skin, moved outward where it is taut over hollows.

    ``normals`` (n, 3) of the skin point outward. Only places that ``bridges`` (n,) may leave the skin, all of
    them if it is None.
    """
    may = np.ones(len(places), dtype=bool) if bridges is None else bridges
    loops = boundary_loops(faces)
    weights = _stiffness(places, faces, [(_edges(loops), EDGE)])
    lifted, ways = _taut(weights, places, faces, loops, normals, may)
    return places + lifted[:, None] * ways


def bridged_cut(cut: CutSkin, faces: Faces, wires: Sequence[int] = (), bands: Sequence[int] = ()) -> CutSkin:
    """Return a ``cut`` skin whose ``faces`` (k, 3), those of a garment, are a taut cloth.

    It stays on the skin along the curves with the numbers ``wires``; those of ``bands`` are elastic and span
    only what is hollow along themselves.
    """
    used, own = own_vertices(faces, len(cut.vertices))
    is_used, may = np.zeros(len(cut.vertices), dtype=bool), np.ones(len(cut.vertices), dtype=bool)
    is_used[used] = True
    for curve in wires:
        may[cut.chains[curve]] = False
    places, loops = cut.vertices[used], boundary_loops(own)
    seams, elastics = (_inner_seams(cut, is_used, curves) for curves in (None, bands))
    lines = [(_edges(loops), EDGE), (elastics, EDGE), (seams, SEAM)]
    weights = _stiffness(places, own, lines)
    normals = _normals(cut, is_used)
    lifted, ways = _taut(weights, places, own, loops, normals, may[used])
    off = lifted > LEAST
    if not off.any():
        return cut
    shares = sparse.coo_array(_spread(weights, places, loops, places + lifted[:, None] * ways, off))
    entries = (shares.data, (used[shares.coords[0]], used[shares.coords[1]]))
    spread = sparse.coo_array(entries, (len(is_used),) * 2).tocsr() + sparse.diags_array(~is_used * 1.0)
    mix = sparse.csr_array(spread @ cut.mix)
    return replace(cut, mix=mix, vertices=mix @ cut.skin.vertices)


def _normals(cut: CutSkin, used: Flags) -> Points:
    """Return the normals of the vertices that are ``used`` (w,), also of the skin round them, (n, 3) [1]."""
    faces = cut.faces[used[cut.faces[:, 0]] | used[cut.faces[:, 1]] | used[cut.faces[:, 2]]]
    vectors = np.repeat(area_vectors(cut.vertices, faces), 3, axis=0)
    total = [np.bincount(faces.ravel(), vectors[:, axis], len(used))[used] for axis in range(3)]
    return unit(np.stack(total, axis=1))


def _inner_seams(cut: CutSkin, used: Flags, curves: Sequence[int] | None) -> Indices:
    """Return the steps of ``curves``, of all if None, between vertices that are ``used``, (e, 2) of them."""
    chosen = used[cut.edges].all(axis=1)
    if curves is not None:
        chosen &= np.isin(cut.curve, np.array(curves, dtype=np.int64))
    return np.asarray((np.cumsum(used) - 1)[cut.edges[chosen]])


def _spread(
    weights: sparse.csr_array, places: Points, loops: Sequence[Indices], lifted: Points, off: Flags
) -> sparse.csr_array:
    """Return all places as shares of those that lie on the skin, (n, n).

    Those ``off`` it are at rest in a membrane of stiffness ``weights`` (n, n); edges stay where they were
    ``lifted`` (n, 3) to within the plane of three places on the skin.
    """
    on_edge = np.zeros(len(places), dtype=bool)
    on_edge[np.concatenate(loops)] = True
    off = off.copy()
    edges = list(_edge_shares(loops, lifted, off, ~off & ~on_edge))
    inner, resting = off & ~on_edge, np.flatnonzero(~off)
    told = [(resting, resting, np.ones(len(resting))), *edges]
    rows, columns, values = (np.concatenate(each) for each in zip(*told, strict=True))
    known = sparse.csr_array((values, (rows, columns)), shape=weights.shape)
    if not inner.any():
        return known
    return sparse.csr_array(known + _resting(weights, known, inner))


def _resting(weights: sparse.csr_array, known: sparse.csr_array, inner: Flags) -> sparse.coo_array:
    """Return the places that are ``inner`` (n,) as shares of the others, hollow by hollow, (n, n)."""
    rows = np.flatnonzero(inner)
    count, label = sparse.csgraph.connected_components(weights[rows][:, rows], directed=False)
    order = rows[np.argsort(label, kind="stable")]
    stiff = sparse.csr_array(weights[order][:, order])
    pull = sparse.csr_array(weights[order][:, ~inner] @ known[~inner])
    ends = np.append(0, np.cumsum(np.bincount(label, minlength=count)))
    found = []
    for begin, end in pairwise(ends.tolist()):
        own = pull[begin:end]
        used = np.unique(own.indices)
        shares = -_factor(stiff[begin:end, begin:end]).solve(own[:, used].toarray())
        found.append((shares.ravel(), np.repeat(order[begin:end], len(used)), np.tile(used, end - begin)))
    value, row, column = (np.concatenate(each) for each in zip(*found, strict=True))
    return sparse.coo_array((value, (row, column)), weights.shape)


def _edge_shares(
    loops: Sequence[Indices], lifted: Points, off: Flags, inside: Flags
) -> Iterator[tuple[Indices, Indices, Floats]]:
    """Yield places of an edge that are off the skin, each thrice, those on the skin, and the shares of them.

    These are where the edge leaves the skin, where it comes back, and one ``inside`` the cloth (n,). A place
    that is not in their plane is put on the skin, and no longer ``off``.
    """
    within = np.flatnonzero(inside)
    for loop in loops:
        rests = np.flatnonzero(~off[loop])
        ends = [*rests[1:], rests[:1].sum() + len(loop)]
        runs = [(int(first), int(last)) for first, last in zip(rests, ends, strict=True)]
        while runs:
            first, last = runs.pop()
            if last - first < 2:
                continue
            free = loop[np.arange(first + 1, last) % len(loop)]
            one, two = loop[first % len(loop)], loop[last % len(loop)]
            chord = lifted[two] - lifted[one]
            reach = max(float(np.linalg.norm(chord)), _REACH)
            away = np.linalg.norm(lifted[within] - 0.5 * (lifted[one] + lifted[two]), axis=1)
            third = within[np.abs(away - reach).argmin()]
            frame = np.stack([chord, lifted[third] - lifted[one]], axis=1)
            from_one = (lifted[free] - lifted[one]).T
            shares = np.linalg.lstsq(frame, from_one, rcond=1e-3)[0]
            miss = np.linalg.norm(frame @ shares - from_one, axis=0)
            if miss.max() > _MISS:
                middle = first + 1 + int(miss.argmax())
                off[loop[middle % len(loop)]] = False
                runs += [(first, middle), (middle, last)]
                continue
            b, c = shares
            yield (
                np.tile(free, 3),
                np.repeat([one, two, third], len(free)),
                np.concatenate([1.0 - b - c, b, c]),
            )


def _tension(normals: Points) -> tuple[Points, Floats, Floats]:
    """Return the way across the body at places with these ``normals`` (n, 3), (n, 3), and tensions (n,) [1].

    The first one is in all directions of the cloth, the second one more across. Under the crotch, where the
    skin lies level, the greater tension runs all ways.
    """
    across = unit(np.cross([0.0, 0.0, 1.0], normals) + 1e-12)
    more = (TENSION[0] - TENSION[1]) * normals[:, 2] ** 4
    return across, TENSION[1] + more, TENSION[0] - TENSION[1] - more


def _factor(
    matrix: sparse.csr_array, order: Literal["MMD_AT_PLUS_A", "NATURAL"] = "MMD_AT_PLUS_A"
) -> SuperLU:
    """Return the factors of a symmetric ``matrix``, in its own order where that is good already."""
    return splu(matrix.T, order, diag_pivot_thresh=0.0, options={"SymmetricMode": True})


def _taut(
    weights: sparse.csr_array,
    places: Points,
    faces: Faces,
    loops: Sequence[Indices],
    normals: Points,
    may: Flags,
) -> tuple[Floats, Points]:
    """Return how far a taut cloth is off the skin, (n,) [mm], and in which directions, (n, 3)."""
    ways, order = _smoothed(weights, places, faces, normals)
    stiff = _along(weights, ways)
    force = np.einsum("nx,nx->n", ways, _without_edges(weights @ places, places, loops, normals))
    return _lifted(stiff, force, may, order), ways


def _lifted(stiff: sparse.csr_array, force: Floats, may: Flags, order: Indices) -> Floats:
    """Return the least distances u >= 0 of u.A.u / 2 + b.u, 0 where it ``may`` not leave the skin.

    By the primal-dual active set method (M. Hintermüller, K. Ito, K. Kunisch, SIAM J. Optim. 13, 2002). In
    the first rounds the places off the skin grow by one more row: what is too much goes in the next. In
    the ``order`` (n,) of places factors are small.
    """
    lifted, off = np.zeros(len(force)), may & (force < 0.0)
    for number in range(_ROUNDS):
        lifted[:] = 0.0
        free = order[off[order]]
        if len(free):
            lifted[free] = _factor(stiff[free][:, free], "NATURAL").solve(-force[free])
        contact = stiff @ lifted + force
        before, off = off, may & np.where(off, lifted > 0.0, contact < 0.0)
        if (before == off).all():
            break
        if number < _GROWING:
            off |= may & ~before & (abs(stiff) @ (off & ~before) > 0.0)
    return np.maximum(lifted, 0.0)


def _stiffness(places: Points, faces: Faces, lines: Sequence[tuple[Indices, float]]) -> sparse.csr_array:
    """Return the stiffness of a membrane under ``TENSION``, positive semidefinite, (n, n) [1].

    ``lines`` (e, 2), its edges and seams, are under a tension of their own [mm].
    """
    corners = places[faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    double = np.maximum(np.linalg.norm(normal, axis=1), 1e-12)
    normal /= double[:, None]
    slopes = np.cross(normal[:, None], np.roll(corners, -2, axis=1) - np.roll(corners, -1, axis=1))
    slopes /= double[:, None, None]
    across, within, most = _tension(normal)
    along = np.einsum("mkx,mx->mk", slopes, across)
    values = most[:, None, None] * along[:, :, None] * along[:, None]
    values += within[:, None, None] * (slopes @ slopes.transpose(0, 2, 1))
    values *= 0.5 * double[:, None, None]
    rows, columns, entries = [np.repeat(faces, 3, axis=1)], [np.tile(faces, 3)], [values]
    for line, tension in lines:
        first, second = line.T
        length = np.maximum(np.linalg.norm(places[second] - places[first], axis=1), _SHORTEST)
        rows += [first, second, first, second]
        columns += [second, first, first, second]
        entries += [-tension / length, -tension / length, tension / length, tension / length]
    row, column, value = (np.concatenate([each.ravel() for each in at]) for at in (rows, columns, entries))
    return sparse.csr_array((value, (row, column)), shape=(len(places),) * 2)


def _edges(loops: Sequence[Indices]) -> Indices:
    return np.concatenate([np.stack([at, np.roll(at, -1)], axis=1) for at in loops])


def _without_edges(force: Points, places: Points, loops: Sequence[Indices], normals: Points) -> Points:
    """Return the forces of a membrane, (n, 3), without what draws its edges aside within the skin.

    An edge is held by what it is sewn to: without that the cloth would draw back from it, and off the skin.
    """
    force = force.copy()
    for loop in loops:
        step = unit(np.roll(places[loop], -1, axis=0) - places[loop])
        aside = unit(np.cross(step + np.roll(step, 1, axis=0), normals[loop]))
        force[loop] -= np.einsum("nx,nx->n", force[loop], aside)[:, None] * aside
    return force


def _along(weights: sparse.csr_array, ways: Points) -> sparse.csr_array:
    """Return the stiffness against distances along ``ways`` (n, 3), (n, n)."""
    entries = weights.tocoo()
    row, column = entries.coords
    turned = entries.data * np.einsum("ex,ex->e", ways[row], ways[column])
    return sparse.csr_array((turned, (row, column)), shape=weights.shape)


def _smoothed(
    weights: sparse.csr_array, places: Points, faces: Faces, normals: Points
) -> tuple[Points, Indices]:
    """Return directions that change slowly from place to place, so that they lead out of a cleft, (n, 3).

    Returns also an order of the places, (n,), in which factors are small.
    """
    corner = np.repeat(np.linalg.norm(area_vectors(places, faces), axis=1) / 3.0, 3)
    share = np.bincount(faces.ravel(), corner, len(places)) + 1e-6
    spread = sparse.diags_array(share) + _SMOOTHED**2 / TENSION[0] * weights
    factor = _factor(sparse.csr_array(spread))
    return unit(factor.solve(share[:, None] * normals)), np.argsort(factor.perm_c)
