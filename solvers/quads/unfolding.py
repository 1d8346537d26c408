"""Inverted quads unfolded: they and those around them move together, down one energy.

At each corner two sides meet that are wanted as long as the quad's sides are, where these grow by
little from quad to quad, and at a right angle in the surface's tangent plane. What that costs is
finite for inverted corners too, and the steeper the less it is regularised. The tangent planes of a
step are those at its start.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import minimize

from solvers.quads.corners import worth
from solvers.quads.incidence import edge_table, grown, paired_sides
from solvers.quads.sliding import Places, Sliding
from solvers.surface.triangulation import BoolArray, FloatArray, IntArray

GROWTH = 1.5
"""Ratio of wanted sides of neighbouring quads, at most. Chosen: long quads at tips shrink."""

RINGS = 3
"""How many rings of quads around inverted ones move with them. Chosen."""

STEPS, ITERATIONS = 60, 15
"""Steps at most, each of so many iterations at most. Chosen."""

EASE, HARD = 0.85, 0.02
"""Factor of the regularisation from step to step, which begins at 1, and its least. Chosen."""

PATIENCE = 25
"""Steps that each leave as much inverted, after which no more are tried. Chosen."""

ENOUGH = 0.2
"""Least scaled Jacobian at which unfolding ends. Chosen: smoothing does the rest."""

AREA = 0.1
"""What the area of a corner counts beside its shape. Chosen: little."""

REACH = 0.5
"""How far a vertex moves in one step at most, in its shortest side. Chosen."""


def unfold(sliding: Sliding, places: Places, free: IntArray, sides: FloatArray) -> Places:
    """Return places where fewer quads are inverted, or else a worst quad that is less so.

    Parameters
    ----------
    sliding : Sliding
        What holds the vertices.
    places : Places
        Where they are at first.
    free : (k,) int array
        Vertices that may move.
    sides : (2, q) float array
        Lengths wanted of the sides from corner 0 to 1 and from 1 to 2 of each quad.

    Notes
    -----
    The energy is that of foldover-free maps (Garanzha et al. 2021), in tangent planes.
    """
    quads = sliding.mesh.quads
    may_move = np.zeros(sliding.mesh.n_vertices, dtype=bool)
    may_move[free] = True
    wanted = graded(quads, sides)
    quality = sliding.quality(places, quads)
    best, best_worth, since = places, worth(quality), 0
    poor = np.zeros(len(quads), dtype=bool)
    for k in range(STEPS):
        if quality.min(initial=1.0) >= ENOUGH or since == PATIENCE:
            break
        poor |= quality < ENOUGH
        region = grown(quads, poor, RINGS)
        places = _step(sliding, places, may_move, region, wanted, max(EASE**k, HARD))
        quality = sliding.quality(places, quads)
        since += 1
        if worth(quality) > best_worth:
            best, best_worth, since = places, worth(quality), 0
    return best


def graded(quads: IntArray, sides: FloatArray) -> FloatArray:
    """Return sides (2, q) made shorter where those of a neighbour ahead are shorter by `GROWTH`.

    Parameters
    ----------
    quads : (q, 4) int array
    sides : (2, q) float array
        Lengths of the sides from corner 0 to 1 and from 1 to 2.
    """
    pair = paired_sides(edge_table(quads)[1])
    # Whoever crosses a side goes along the other two of the quad.
    first, second = (1 - pair % 2) * len(quads) + pair // 4
    least = sides.reshape(-1).copy()
    while True:
        before = least.copy()
        np.minimum.at(least, first, GROWTH * before[second])
        np.minimum.at(least, second, GROWTH * before[first])
        if np.array_equal(least, before):
            return least.reshape(2, -1)


def _step(
    sliding: Sliding,
    places: Places,
    may_move: BoolArray,
    region: BoolArray,
    wanted: FloatArray,
    ease: float,
) -> Places:
    """Return the places after a step down the energy of the quads of a region."""
    moving = may_move.copy()
    moving[sliding.mesh.quads[~region]] = False
    vertices, quads = np.unique(sliding.mesh.quads[region], return_inverse=True)
    quads = quads.reshape(-1, 4)
    at = np.flatnonzero(moving[vertices])
    if len(at) == 0:
        return places
    energy = _Energy(
        quads,
        sliding.normals(places, sliding.mesh.quads[region]),
        np.tile(wanted[:, region].T, 2),
        ease,
    )
    start = places.vertices[vertices]
    ways = sliding.tangents(places, vertices[at]) * _shortest_sides(start, quads)[at, None, None]

    # Variables without bounds, of which amounts up to REACH are made.
    def moved(amounts: FloatArray) -> FloatArray:
        made = start.copy()
        made[at] += (_within_reach(amounts).reshape(-1, 2, 1) * ways).sum(axis=1)
        return made

    def slope(amounts: FloatArray) -> tuple[float, FloatArray]:
        value, gradient = energy.value(moved(amounts))
        by_amount = (gradient[at, None] * ways).sum(axis=2).reshape(-1)
        return value, by_amount * REACH * (1 + amounts**2) ** -1.5

    found = minimize(
        slope,
        np.zeros(2 * len(at)),
        jac=True,
        method="L-BFGS-B",
        options={"maxiter": ITERATIONS},
    )
    ids = vertices[at]
    return places.put(ids, sliding.moved(places, ids, moved(found.x)[at]))


def _within_reach(amounts: FloatArray) -> FloatArray:
    return REACH * amounts / np.sqrt(1 + amounts**2)


def _shortest_sides(vertices: FloatArray, quads: IntArray) -> FloatArray:
    """Return the length (n,) of the shortest side at each vertex, none of no length."""
    ahead = np.roll(quads, -1, axis=1)
    length = np.linalg.norm(vertices[ahead] - vertices[quads], axis=2)
    length = np.maximum(length, 1e-3 * length.mean())
    least = np.full(len(vertices), np.inf)
    np.minimum.at(least, quads, length)
    np.minimum.at(least, ahead, length)
    return least


class _Energy:
    """What quads cost, by their corners.

    Parameters
    ----------
    quads : (q, 4) int array
    normals : (q, 4, 3) float array
        Of the tangent planes at the corners.
    wanted : (q, 4) float array
        Lengths of the sides, from each corner to the next.
    ease : float
        Regularisation, in the area of a corner.
    """

    def __init__(
        self, quads: IntArray, normals: FloatArray, wanted: FloatArray, ease: float
    ) -> None:
        self._ahead, self._back = np.roll(quads, -1, axis=1), np.roll(quads, 1, axis=1)
        self._quads, self._normals, self._ease = quads, normals, ease
        self._wanted = wanted[..., None], np.roll(wanted, 1, axis=1)[..., None]

    def value(self, vertices: FloatArray) -> tuple[float, FloatArray]:
        """Return the energy and its gradient (n, 3) by the vertices (n, 3)."""
        corner = vertices[self._quads]
        first = (vertices[self._ahead] - corner) / self._wanted[0]
        last = (corner - vertices[self._back]) / self._wanted[1]
        area = (np.cross(last, first) * self._normals).sum(axis=-1, keepdims=True)
        root = np.hypot(area, self._ease)
        below = 0.5 * (area + root)
        above = (first**2 + last**2).sum(axis=-1, keepdims=True) + AREA * (1 + area**2)
        cost = above / below
        by_area = (2 * AREA * area - 0.5 * cost * (1 + area / root)) / below
        by_first = 2 * first / below + by_area * np.cross(self._normals, last)
        by_last = 2 * last / below + by_area * np.cross(first, self._normals)
        by_first, by_last = by_first / self._wanted[0], by_last / self._wanted[1]
        at = np.concatenate([self._quads, self._ahead, self._back]).reshape(-1)
        by = np.concatenate([by_last - by_first, by_first, -by_last]).reshape(-1, 3)
        gradient = [np.bincount(at, x, len(vertices)) for x in by.T]
        return float(cost.sum()), np.stack(gradient, axis=1)
