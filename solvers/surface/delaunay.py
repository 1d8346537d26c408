"""Intrinsic Delaunay triangulation by edge flips, many at a time.

A flip replaces the diagonal of the flat quadrilateral formed by two triangles; vertices, and the
metric of the surface, stay as they are. The P1 operator on the result obeys the maximum principle,
whatever the shape of the input triangles (Bobenko and Springborn 2007).
"""

from __future__ import annotations

import numpy as np

from solvers.errors import SolveError
from solvers.surface.triangulation import (
    FloatArray,
    IntArray,
    IntrinsicTriangulation,
    heron,
)
from solvers.surface.working import Edit, WorkingTriangulation

TOLERANCE = 1e-10
"""How negative a cotangent weight, a pure number, must be to be worth a flip.

Chosen, well above rounding: with 0, cocircular points would flip back and forth.
"""

MAX_ROUNDS = 10_000
"""Rounds of flips after which they are said not to end. Chosen; surfaces take some tens."""


def intrinsic_delaunay(
    triangulation: IntrinsicTriangulation, marks: IntArray | None = None
) -> WorkingTriangulation:
    """Return the intrinsic Delaunay triangulation of a surface.

    Parameters
    ----------
    triangulation : IntrinsicTriangulation
        What to flip.
    marks : (r, 3 m) int array, optional
        Numbers on halfedges of edges that must stay, as of `WorkingTriangulation`.

    Returns
    -------
    WorkingTriangulation
        With the original triangles where nothing had to be flipped.

    Raises
    ------
    SolveError
        If the flips do not end, which only rounding on next to degenerate triangles can cause.

    Notes
    -----
    Fisher, Springborn, Schroeder and Bobenko 2007; a flip is worth it where the cotangent weight
    of the edge is negative, and all that share no triangle are made at once.

    Examples
    --------
    A flat kite, its diagonal of length 4 flipped to the one of length 2:

    >>> from solvers.surface import TriSurface, intrinsic_delaunay
    >>> kite = TriSurface(
    ...     [[-2, 0, 0], [0, -1, 0], [2, 0, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]]
    ... ).triangulation
    >>> delaunay = intrinsic_delaunay(kite)
    >>> lengths = kite.lengths.max(), delaunay.triangulation.lengths.min()
    >>> delaunay.n_flips, *(round(float(length), 9) for length in lengths)
    (1, 4.0, 2.0)
    >>> bool(kite.weights.min() < 0 <= delaunay.triangulation.weights.min())
    True
    """
    working = WorkingTriangulation.of(triangulation, marks)
    n = len(triangulation.twin)
    obtuse = (triangulation.weights < -TOLERANCE) & (np.arange(n) < triangulation.twin)
    suspects = np.flatnonzero(obtuse)
    if not len(suspects):
        return working
    edit = working.edit()
    flip_to_delaunay(edit, suspects)
    return working if edit.unchanged else edit.done()


def flip_to_delaunay(edit: Edit, suspects: IntArray) -> None:
    """Flip edges until none of those that can be flipped has a negative weight.

    Parameters
    ----------
    edit : Edit
        Where.
    suspects : (k,) int array
        Halfedges of edges that may have one; all others must not.

    Raises
    ------
    SolveError
        As `intrinsic_delaunay`.
    """
    for _ in range(MAX_ROUNDS):
        if not len(suspects):
            return
        twin = edit.twin[suspects]
        h = np.unique(np.where(twin > suspects, suspects, twin))
        h = h[h >= 0]
        h = h[~edit.fixed(h) & (h // 3 != edit.twin[h] // 3)]
        weight = _half_weight(edit, h) + _half_weight(edit, edit.twin[h])
        h, weight = h[weight < -TOLERANCE], weight[weight < -TOLERANCE]
        # The worst edge of both its triangles goes first.
        now = edit.disjoint(weight, h // 3, edit.twin[h] // 3)
        touched = edit.flip(h[now]) if now.any() else h[:0]
        suspects = np.concatenate([h[~now], touched])
    raise SolveError(
        "the intrinsic Delaunay flips do not end",
        f"after {MAX_ROUNDS} rounds",
        "repair the surface: it has triangles next to degenerate",
    )


def _half_weight(edit: Edit, h: IntArray) -> FloatArray:
    """Return half the cotangent of the angle opposite each halfedge."""
    sides = edit.lengths[h // 3]
    own = edit.lengths[h // 3, h % 3]
    area = np.maximum(heron(sides), np.finfo(float).tiny)
    return np.asarray(((sides**2).sum(axis=1) - 2 * own**2) / (8 * area))
