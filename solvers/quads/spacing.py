"""Where the vertices of all arcs are, once those of some arcs are not in equal shares."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array, diags_array
from scipy.sparse.linalg import spsolve

from solvers.layouts.tmesh import TMesh
from solvers.surface.triangulation import FloatArray, IntArray

ALIKE = 100.0
"""How much more shifts of opposite sides are to be alike than those of neighbours on a side.

Measured on annuli where sizes span 30 and more: 11 quads stay inverted with 1, 3 with 10, 0 with
100.
"""

LEAST_STEP = 0.2
"""Least distance of neighbouring vertices of an arc, in equal shares. Chosen."""


@dataclass(frozen=True, eq=False)
class _Links:
    """Pairs of vertices, what signs their shifts have beside each other, and weights."""

    pairs: IntArray
    signs: FloatArray
    weights: FloatArray


def spread(
    tmesh: TMesh, points: Sequence[FloatArray], counts: IntArray, spaced: Mapping[int, FloatArray]
) -> dict[int, FloatArray]:
    """Return the vertices of all arcs that go along with those of some.

    Parameters
    ----------
    tmesh : TMesh
        The rectangles.
    points : sequence of (count + 1, 3) float array
        Of each arc the places on the surface in equal shares.
    counts : (A,) int array
        Number of edges along each arc.
    spaced : mapping from int to (count + 1,) float array
        Where the vertices of some arcs are, from 0 to 1.

    Returns
    -------
    dict from int to (count + 1,) float array
        The same, and for all other arcs with inner vertices likewise.

    Notes
    -----
    The shift of a vertex from its equal share, along its side in the map, is a discrete harmonic
    function with the given values and 0 at nodes, anisotropic so that opposite sides are shifted
    alike: lines of quads across stay straight. Sizes are those on the surface, where a rectangle
    may be much thinner than in the map.

    Examples
    --------
    The side of a square opposite to one with a shifted vertex, which runs the other way, follows:

    >>> import numpy as np
    >>> from solvers.layouts import TMesh
    >>> every, ends = np.ones(4, dtype=bool), np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
    >>> sides = 2 * np.arange(4)
    >>> tmesh = TMesh(ends, np.ones(4), every, np.full(4, 2), every, every, np.arange(5), sides)
    >>> corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    >>> points = [np.stack([a, (a + b) / 2, b]) for a, b in corners[ends]]
    >>> from solvers.quads.spacing import spread
    >>> found = spread(tmesh, points, np.full(4, 2), {0: np.array([0.0, 0.7, 1.0])})
    >>> found[2].round(3).tolist(), found[1].tolist()
    ([0.0, 0.308, 1.0], [0.0, 0.5, 1.0])
    """
    inside = np.maximum(counts - 1, 0)
    first = np.concatenate([[0], np.cumsum(inside)])
    n = int(first[-1])
    shift, known = np.zeros(n + 1), np.zeros(n + 1, dtype=bool)
    known[n] = True  # stands for all nodes
    for arc, places in spaced.items():
        own = slice(first[arc], first[arc + 1])
        equal = np.arange(counts[arc] + 1) / counts[arc]
        shift[own] = (places - equal)[1:-1] * tmesh.lengths[arc]
        known[own] = True
    matrix = _stiffness(_links(tmesh, points, counts, first), n + 1)
    free = np.flatnonzero(~known & (matrix.diagonal() > 0))
    if len(free):
        rows = matrix[free]
        shift[free] = spsolve(rows[:, free].tocsc(), -(rows[:, known] @ shift[known]))
    found = dict(spaced)
    for arc in np.flatnonzero(inside).tolist():
        if arc not in found:
            share = shift[first[arc] : first[arc + 1]] / max(tmesh.lengths[arc], 1e-300)
            found[arc] = _kept_apart(share, int(counts[arc]))
    return found


def _links(tmesh: TMesh, points: Sequence[FloatArray], counts: IntArray, first: IntArray) -> _Links:
    """Return the links across rectangles and along their sides."""
    pairs, signs, weights = [], [], []
    for r in range(tmesh.n_rectangles):
        sides = [_side(tmesh, points, counts, first, tmesh.side(r, j)) for j in range(4)]
        for (low, ahead, here), (high, back, there) in (sides[::2], sides[1::2]):
            if len(low) < 3:
                continue
            steps = [np.linalg.norm(np.diff(p, axis=0), axis=1) for p in (here, there)]
            heights = np.linalg.norm(here - there[::-1], axis=1)
            step = 0.5 * (steps[0] + steps[1][::-1])
            heights = np.maximum(heights, 1e-6 * step.sum())
            pairs.append(np.stack([low, high[::-1]], axis=1))
            signs.append(-ahead * back[::-1])
            beside = np.concatenate([[0.0], step]) + np.concatenate([step, [0.0]])
            weights.append(0.5 * ALIKE * beside / heights)
            height = 0.5 * (heights[1:] + heights[:-1])
            for side, sign, own, far in (
                (low, ahead, steps[0], height),
                (high, back, steps[1], height[::-1]),
            ):
                pairs.append(np.stack([side[:-1], side[1:]], axis=1))
                signs.append(sign[:-1] * sign[1:])
                weights.append(0.5 * far / np.maximum(own, 1e-6 * own.sum()))
    if not pairs:
        return _Links(np.empty((0, 2), dtype=np.int64), np.empty(0), np.empty(0))
    return _Links(np.concatenate(pairs), np.concatenate(signs), np.concatenate(weights))


def _side(
    tmesh: TMesh,
    points: Sequence[FloatArray],
    counts: IntArray,
    first: IntArray,
    halfarcs: IntArray,
) -> tuple[IntArray, FloatArray, FloatArray]:
    """Return the vertices (w + 1,) along a side, nodes as the last number, directions, places."""
    node = first[-1:]
    numbers, signs = [node], [np.ones(1)]
    start = points[halfarcs[0] // 2]
    places = [start[-1:] if halfarcs[0] % 2 else start[:1]]
    for half in halfarcs[counts[halfarcs // 2] > 0].tolist():
        arc, backwards = half // 2, half % 2
        own = np.arange(first[arc], first[arc + 1])
        numbers += [own[::-1] if backwards else own, node]
        signs += [np.full(len(own), 1.0 - 2.0 * backwards), np.ones(1)]
        places.append(points[arc][-2::-1] if backwards else points[arc][1:])
    return np.concatenate(numbers), np.concatenate(signs), np.concatenate(places)


def _stiffness(links: _Links, n: int) -> csr_array:
    """Return the matrix (n, n) of the sum of weights x (shift - sign x shift)^2."""
    a, b = links.pairs.T
    entries = (-links.signs * links.weights, (a, b))
    across = csr_array(entries, shape=(n, n))
    diagonal = np.bincount(links.pairs.reshape(-1), np.repeat(links.weights, 2), minlength=n)
    return csr_array(across + across.T + diags_array(diagonal))


def _kept_apart(shift: FloatArray, count: int) -> FloatArray:
    """Return equal shares (count + 1,) shifted as far as all steps keep their least length."""
    moved = np.concatenate([[0.0], shift, [0.0]])
    least = float(np.diff(moved).min()) * count
    scale = 1.0 if least >= LEAST_STEP - 1 else (1 - LEAST_STEP) / -least
    return np.asarray(np.arange(count + 1) / count + scale * moved)
