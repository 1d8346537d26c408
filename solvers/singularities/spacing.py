"""How far singularities keep from each other, from the boundary and from features."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from solvers.singularities.budget import Singularity
from solvers.surface.triangulation import BoolArray, FloatArray, IntArray
from solvers.surface.trisurface import TriSurface

CLOSEST = 0.02
"""How near singularities may come to each other, in square roots of the surface's area. Chosen:
half the distance of a new pair.
"""

PITCH = 0.25
"""Distance of the points that stand for the boundary, in least distances.

Chosen: an error below 1 %.
"""

SLACK = 1.2
"""How much farther than need be those go apart that would come too near, a factor. Chosen."""


class Spacing:
    """The least distances of one configuration, as equations for its moves.

    What is nearer than `CLOSEST` from the start may halve its distance.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    singularities : sequence of Singularity
        Where they start.
    free : (k,) bool array
        Which of them move; the distances of the others among themselves do not count.
    walls : (ne,) bool array
        Edges of the surface from which they keep as from the boundary.
    """

    def __init__(
        self,
        surface: TriSurface,
        singularities: Sequence[Singularity],
        free: BoolArray,
        walls: BoolArray,
    ) -> None:
        self._surface = surface
        self._free = free
        closest = CLOSEST * np.sqrt(surface.area)
        rim = _along(surface, walls | (surface.edge_faces[:, 1] < 0), PITCH * closest)
        self._rim = cKDTree(rim) if len(rim) else None
        x = surface.positions([s.point for s in singularities])
        self._pair_limit = np.minimum(closest, 0.5 * _gaps(x))
        self._pair_limit[~(free[:, None] | free)] = 0.0
        self._rim_limit = np.minimum(closest, 0.5 * self._to_rim(x)[0]) * free

    @property
    def none(self) -> tuple[FloatArray, FloatArray]:
        """No equations."""
        return np.empty((0, 2 * len(self._free))), np.empty(0)

    def too_near(self, singularities: Sequence[Singularity]) -> IntArray:
        """Return (p, 2) pairs that are too near; -1 in the place of the second is the rim."""
        x = self._surface.positions([s.point for s in singularities])
        pairs = np.argwhere(np.triu(_gaps(x) < self._pair_limit, 1))
        rim = np.flatnonzero(self._to_rim(x)[0] < self._rim_limit)
        return np.concatenate([pairs, np.stack([rim, np.full_like(rim, -1)], axis=1)])

    def equations(
        self, singularities: Sequence[Singularity], near: IntArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return equations that take pairs apart.

        Parameters
        ----------
        singularities : sequence of Singularity
            Where the moves start.
        near : (p, 2) int array
            As of `too_near`.

        Returns
        -------
        rows : (p, 2 k) float array
            How the distances change with moves in the triangles' frames.
        gaps : (p,) float array
            By how much they are to change.
        """
        x = self._surface.positions([s.point for s in singularities])
        first, second = near.T
        foot = self._to_rim(x)[1]
        other = np.where(second[:, None] < 0, foot[first], x[second])
        limit = np.where(
            second < 0, self._rim_limit[first], self._pair_limit[first, np.maximum(second, 0)]
        )
        apart = x[first] - other
        distance = np.linalg.norm(apart, axis=1)
        apart /= np.maximum(distance, 1e-300)[:, None]
        rows = np.zeros((len(near), len(x), 2))
        frames = np.stack(self._surface.face_frames, axis=1)[[s.point.face for s in singularities]]
        at = np.arange(len(near))
        rows[at, first] = np.einsum("pij,pj->pi", frames[first], apart)
        inner = second >= 0
        rows[at[inner], second[inner]] = -np.einsum(
            "pij,pj->pi", frames[second[inner]], apart[inner]
        )
        rows *= self._free[:, None]
        return rows.reshape(len(near), -1), SLACK * limit - distance

    def _to_rim(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the distances (k,) to the nearest points of the boundary, and those (k, 3)."""
        if self._rim is None or not len(x):
            return np.full(len(x), np.inf), np.zeros((len(x), 3))
        distance, nearest = self._rim.query(x)
        return np.asarray(distance), np.asarray(self._rim.data[nearest])


def _along(surface: TriSurface, edges: BoolArray, pitch: float) -> FloatArray:
    """Return points (p, 3) along edges, next to each other no farther than `pitch`."""
    tail, head = surface.vertices[surface.edges[edges]].transpose(1, 0, 2)
    count = np.ceil(np.linalg.norm(head - tail, axis=1) / pitch).astype(np.int64)
    edge = np.repeat(np.arange(len(count)), count)
    part = (np.arange(len(edge)) - (np.cumsum(count) - count)[edge]) / count[edge]
    return np.asarray(tail[edge] + part[:, None] * (head - tail)[edge])


def _gaps(x: FloatArray) -> FloatArray:
    gaps = np.linalg.norm(x[:, None] - x[None], axis=2)
    np.fill_diagonal(gaps, np.inf)
    return np.asarray(gaps)
