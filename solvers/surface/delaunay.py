"""Intrinsic Delaunay triangulation by edge flips, many at a time.

A flip replaces the diagonal of the flat quadrilateral formed by two triangles; vertices, and the
metric of the surface, stay as they are. The P1 operator on the result obeys the maximum principle,
whatever the shape of the input triangles (Bobenko and Springborn 2007).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from solvers.errors import SolveError
from solvers.surface.triangulation import (
    FloatArray,
    IntArray,
    IntrinsicTriangulation,
    heron,
    laid_out,
    next_halfedge,
)

TOLERANCE = 1e-10
"""How negative a cotangent weight, a pure number, must be to be worth a flip.

Chosen, well above rounding: with 0, cocircular points would flip back and forth.
"""

MAX_ROUNDS = 10_000
"""Rounds of flips after which they are said not to end. Chosen; surfaces take some tens."""


@dataclass(frozen=True)
class Flips:
    """One round of flips in disjoint pairs of triangles.

    Parameters
    ----------
    left, right : (k,) int array
        The two faces of each pair; they keep their numbers.
    corners : (k, 4, 2) float array
        Corners a, b (the old diagonal), c (left apex), d (right apex) in the plane, in the old
        frame of the left face.
    old_frames, new_frames : (k, 4, 2) float array
        Origin and x direction of the left face's frame, then of the right face's, in that plane.
    """

    left: IntArray
    right: IntArray
    corners: FloatArray
    old_frames: FloatArray
    new_frames: FloatArray


@dataclass(frozen=True)
class Located:
    """Points of a flipped triangulation.

    Parameters
    ----------
    face : (k,) int array
        The triangle of each.
    place : (k, 2) float array
        Coordinates in that triangle's frame.
    turn : (k,) float array
        Angle, in that frame, of a direction that was at angle zero in the frame of the original
        triangle, radians.

    Examples
    --------
    The kite of `DelaunayTriangulation`, whose vertex 0 is the last corner of the new triangle 0:

    >>> import numpy as np
    >>> from solvers.surface import DelaunayTriangulation, TriSurface
    >>> kite = TriSurface(
    ...     [[-2, 0, 0], [0, -1, 0], [2, 0, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]]
    ... ).triangulation
    >>> delaunay = DelaunayTriangulation(kite, np.zeros((1, 6), dtype=bool))
    >>> corner = delaunay.triangulation.corner_positions[0, 2]
    >>> where = delaunay.locate(np.array([0]), np.array([[0.0, 0.0]]))
    >>> bool(np.allclose(where.place, corner))
    True
    """

    face: IntArray
    place: FloatArray
    turn: FloatArray


class DelaunayTriangulation:
    """The intrinsic Delaunay triangulation of a surface.

    Parameters
    ----------
    original : IntrinsicTriangulation
        What to flip.
    fixed : (r, 3 m) bool array
        Halfedges whose edge must stay, in any number of rows.
    chain : (r, 3 m) int array, optional
        Numbers on halfedges of fixed or boundary edges; carried along.

    Attributes
    ----------
    triangulation : IntrinsicTriangulation
        The result (the original itself where nothing had to be flipped).
    chain : (r, 3 m) int array
        The numbers on the result.
    n_flips : int
        Number of flips made.

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

    >>> import numpy as np
    >>> from solvers.surface import DelaunayTriangulation, TriSurface
    >>> kite = TriSurface(
    ...     [[-2, 0, 0], [0, -1, 0], [2, 0, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]]
    ... ).triangulation
    >>> delaunay = DelaunayTriangulation(kite, np.zeros((1, 6), dtype=bool))
    >>> lengths = kite.lengths.max(), delaunay.triangulation.lengths.min()
    >>> delaunay.n_flips, *(round(float(length), 9) for length in lengths)
    (1, 4.0, 2.0)
    >>> bool(kite.weights.min() < 0 <= delaunay.triangulation.weights.min())
    True
    """

    def __init__(
        self,
        original: IntrinsicTriangulation,
        fixed: npt.NDArray[np.bool_],
        chain: IntArray | None = None,
    ) -> None:
        n = len(original.twin)
        self.chain = np.zeros((0, n), dtype=np.int64) if chain is None else chain.copy()
        self.rounds: list[Flips] = []
        self.triangulation = original
        h = np.flatnonzero((original.weights < -TOLERANCE) & (np.arange(n) < original.twin))
        self._fixed: npt.NDArray[np.bool_] = np.atleast_1d(np.any(fixed, axis=0))
        if not self._fixed[h].all():
            self._run(h)
        self.n_flips = sum(len(flips.left) for flips in self.rounds)

    def _run(self, suspects: IntArray) -> None:
        original = self.triangulation
        self._faces = original.faces.copy()
        self._twin = original.twin.copy()
        self._lengths = original.lengths.copy()
        self._best = np.full(original.n_faces, len(original.twin), dtype=np.int64)
        while len(suspects):
            if len(self.rounds) == MAX_ROUNDS:
                raise SolveError(
                    "the intrinsic Delaunay flips do not end",
                    f"after {MAX_ROUNDS} rounds",
                    "repair the surface: it has triangles next to degenerate",
                )
            chosen, waiting = self._choose(suspects)
            touched = self._flip(chosen)
            suspects = np.unique(np.concatenate([waiting, touched]))
        self.triangulation = IntrinsicTriangulation(
            original.n_vertices, self._faces, self._twin, self._lengths
        )

    def _choose(self, h: IntArray) -> tuple[IntArray, IntArray]:
        """Return the edges to flip now, no two in the same triangle, and those to flip later."""
        h = np.unique(np.where(self._twin[h] > h, h, self._twin[h]))
        h = h[(h >= 0) & ~self._fixed[h] & (h // 3 != self._twin[h] // 3)]
        weight = self._half_weight(h) + self._half_weight(self._twin[h])
        h, weight = h[weight < -TOLERANCE], weight[weight < -TOLERANCE]
        # The worst edge of both its triangles goes first; ties are broken by number.
        rank = np.empty(len(h), dtype=np.int64)
        rank[np.argsort(weight, kind="stable")] = np.arange(len(h))
        left, right = h // 3, self._twin[h] // 3
        np.minimum.at(self._best, left, rank)
        np.minimum.at(self._best, right, rank)
        now = (self._best[left] == rank) & (self._best[right] == rank)
        self._best[left] = self._best[right] = len(self._twin)
        return h[now], h[~now]

    def _half_weight(self, h: IntArray) -> FloatArray:
        """Return half the cotangent of the angle opposite each halfedge."""
        sides = self._lengths[h // 3]
        own = self._lengths[h // 3, h % 3]
        area = np.maximum(heron(sides), np.finfo(float).tiny)
        return np.asarray(((sides**2).sum(axis=1) - 2 * own**2) / (8 * area))

    def _flip(self, h: IntArray) -> IntArray:
        """Flip edges of disjoint pairs of triangles; return the halfedges to look at again."""
        g = self._twin[h]
        left, right = h // 3, g // 3
        bc, ca = next_halfedge(h), next_halfedge(next_halfedge(h))
        ad, db = next_halfedge(g), next_halfedge(next_halfedge(g))
        corners, old_frames, new_frames = self._layout(h, g)
        self.rounds.append(Flips(left, right, corners, old_frames, new_frames))
        # The new left face is (c, d, b), the new right face (d, c, a).
        target = np.concatenate([3 * left + 1, 3 * left + 2, 3 * right + 1, 3 * right + 2])
        source = np.concatenate([db, bc, ca, ad])
        faces, lengths = self._faces.reshape(-1), self._lengths.reshape(-1)
        a, b, c, d = faces[h], faces[g], faces[ca], faces[db]
        outer = self._twin[source]
        by_source = np.argsort(source)
        place = np.searchsorted(source, outer, sorter=by_source) % len(source)
        inside = source[by_source[place]] == outer
        outer = np.where(inside, target[by_source[place]], outer)
        self._faces[left] = np.stack([c, d, b], axis=1)
        self._faces[right] = np.stack([d, c, a], axis=1)
        lengths[target] = lengths[source]
        diagonal = np.linalg.norm(corners[:, 3] - corners[:, 2], axis=1)
        lengths[3 * left] = lengths[3 * right] = diagonal
        self._twin[target] = outer
        self._twin[outer[outer >= 0]] = target[outer >= 0]
        self._twin[3 * left], self._twin[3 * right] = 3 * right, 3 * left
        for carried in (self._fixed, *self.chain):
            carried[target] = carried[source]
            carried[3 * left] = carried[3 * right] = 0
        return target

    def _layout(self, h: IntArray, g: IntArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Lay the pairs out in the plane, in the frames of the left faces."""
        left, i, right, j = h // 3, h % 3, g // 3, g % 3
        p, q = laid_out(self._lengths[left]), laid_out(self._lengths[right])
        every = np.arange(len(h))
        a, b, c = p[every, i], p[every, (i + 1) % 3], p[every, (i + 2) % 3]
        along = (b - a) / np.linalg.norm(b - a, axis=1)[:, None]
        # From a to b in the right face's frame, where j runs from b to a.
        there = q[every, j] - q[every, (j + 1) % 3]
        there /= np.linalg.norm(there, axis=1)[:, None]
        # The rotation that takes the right frame to the left one, as a complex number.
        cosine = (along * there).sum(axis=1)
        sine = along[:, 1] * there[:, 0] - along[:, 0] * there[:, 1]
        frame = np.stack([cosine, sine], axis=1)
        origin = a - _rotate(frame, q[every, (j + 1) % 3])
        d = origin + _rotate(frame, q[every, (j + 2) % 3])
        new_x = (d - c) / np.linalg.norm(d - c, axis=1)[:, None]
        identity = np.broadcast_to([1.0, 0.0], frame.shape)
        old = np.stack([np.zeros_like(a), identity, origin, frame], axis=1)
        new = np.stack([c, new_x, d, -new_x], axis=1)
        return np.stack([a, b, c, d], axis=1), old, new

    def locate(self, face: IntArray, place: FloatArray) -> Located:
        """Follow points of the original triangulation through the flips.

        Parameters
        ----------
        face : (k,) int array
            Original triangle of each point.
        place : (k, 2) float array
            Coordinates in that triangle's frame.

        Returns
        -------
        Located
        """
        face, place, turn = face.copy(), place.copy(), np.zeros(len(face))
        pair = np.empty(self.triangulation.n_faces, dtype=np.int64)
        for flips in self.rounds:
            pair[:] = -1
            pair[flips.left] = pair[flips.right] = np.arange(len(flips.left))
            who = np.flatnonzero(pair[face] >= 0)
            k = pair[face[who]]
            was_right = (face[who] == flips.right[k]).astype(np.int64)
            old = flips.old_frames[k]
            every = np.arange(len(who))
            origin, frame = old[every, 2 * was_right], old[every, 2 * was_right + 1]
            flat = origin + _rotate(frame, place[who])
            angle = turn[who] + np.arctan2(frame[:, 1], frame[:, 0])
            c, d = flips.corners[k, 2], flips.corners[k, 3]
            side = (d - c)[:, 0] * (flat - c)[:, 1] - (d - c)[:, 1] * (flat - c)[:, 0]
            is_right = (side < 0).astype(np.int64)
            new = flips.new_frames[k]
            origin, frame = new[every, 2 * is_right], new[every, 2 * is_right + 1]
            conjugate = frame * [1.0, -1.0]
            place[who] = _rotate(conjugate, flat - origin)
            turn[who] = angle - np.arctan2(frame[:, 1], frame[:, 0])
            face[who] = np.where(is_right == 1, flips.right[k], flips.left[k])
        return Located(face, place, turn)


def _rotate(frame: FloatArray, vector: FloatArray) -> FloatArray:
    """Return vectors (k, 2) turned by the directions (k, 2)."""
    return np.stack(
        [
            frame[:, 0] * vector[:, 0] - frame[:, 1] * vector[:, 1],
            frame[:, 1] * vector[:, 0] + frame[:, 0] * vector[:, 1],
        ],
        axis=1,
    )
