"""Rails: chains of surface edges that vertices of a quad mesh slide along."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from solvers.errors import CrossviewError
from solvers.surface.triangulation import BoolArray, FloatArray, IntArray
from solvers.surface.trisurface import TriSurface

SHARP = np.radians(30.0)
"""Turn of a rail at a vertex, radians, beyond which it has a corner there. Chosen."""


class Rail:
    """A chain of edges of a surface, measured by its length.

    Parameters
    ----------
    surface : TriSurface
        Where.
    chain : (k,) int array
        Its vertices in order; the first again at the end where the chain closes up.

    Raises
    ------
    CrossviewError
        If there are no such vertices, or no edges between them.
    """

    def __init__(self, surface: TriSurface, chain: IntArray) -> None:
        chain = surface.require_vertices(chain)
        self.closed = len(chain) > 1 and bool(chain[0] == chain[-1])
        self._chain = chain
        self._points = surface.vertices[chain]
        self._at = np.concatenate(
            [[0.0], np.cumsum(np.linalg.norm(np.diff(self._points, axis=0), axis=1))]
        )
        t = surface.triangulation
        key = t.tail * surface.n_vertices + t.head
        order = np.argsort(key)
        ahead = chain[:-1] * surface.n_vertices + chain[1:]
        behind = chain[1:] * surface.n_vertices + chain[:-1]
        h = order[np.minimum(np.searchsorted(key, ahead, sorter=order), len(key) - 1)]
        other = order[np.minimum(np.searchsorted(key, behind, sorter=order), len(key) - 1)]
        # An edge of the boundary may be run against its only halfedge.
        self._backwards: BoolArray = key[h] != ahead
        if len(chain) < 2 or (self._backwards & (key[other] != behind)).any():
            raise CrossviewError("a curve must be vertices joined by edges of the surface")
        self._halfedge: IntArray = np.where(self._backwards, other, h)

    @property
    def length(self) -> float:
        """Length of the whole rail."""
        return float(self._at[-1])

    @cached_property
    def corners(self) -> FloatArray:
        """Where the rail turns by more than `SHARP`, and the ends of an open one."""
        along = np.diff(self._points, axis=0) / np.diff(self._at)[:, None]
        before = np.roll(along, 1, axis=0)
        turn = np.arctan2(
            np.linalg.norm(np.cross(before, along), axis=1), (before * along).sum(axis=1)
        )
        if self.closed:
            return np.asarray(self._at[:-1][turn > SHARP])
        return np.concatenate([[0.0], self._at[1:-1][turn[1:] > SHARP], [self.length]])

    def positions(self, s: FloatArray) -> FloatArray:
        """Return the places (j, 3) at lengths s (j,) along the rail."""
        s = self.inside(s)
        return np.stack([np.interp(s, self._at, x) for x in self._points.T], axis=1)

    def points(self, s: FloatArray) -> tuple[IntArray, FloatArray]:
        """Return the triangles (j,) and weights (j, 3) at lengths s (j,) along the rail."""
        s = self.inside(s)
        i = np.clip(np.searchsorted(self._at, s, side="right") - 1, 0, len(self._at) - 2)
        part = np.clip((s - self._at[i]) / (self._at[i + 1] - self._at[i]), 0.0, 1.0)
        part = np.where(self._backwards[i], 1 - part, part)
        h = self._halfedge[i]
        weights = np.zeros((len(s), 3))
        rows = np.arange(len(s))
        weights[rows, h % 3] = 1 - part
        weights[rows, (h + 1) % 3] = part
        return h // 3, weights

    def nearest(self, places: FloatArray) -> FloatArray:
        """Return the lengths (j,) along the rail of its points nearest to places (j, 3)."""
        a, along = self._points[:-1], np.diff(self._points, axis=0)
        squares = (along**2).sum(axis=1)
        part = np.clip((places @ along.T - (a * along).sum(axis=1)) / squares, 0.0, 1.0)
        gap = np.linalg.norm(a + part[..., None] * along - places[:, None], axis=2)
        i = np.argmin(gap, axis=1)
        return np.asarray(self._at[i] + part[np.arange(len(places)), i] * np.sqrt(squares[i]))

    def inside(self, s: FloatArray) -> FloatArray:
        """Return lengths s (j,) within the rail: once around, or held back at its ends."""
        return s % self.length if self.closed else np.clip(s, 0.0, self.length)

    def apart(self, s: FloatArray, other: float) -> FloatArray:
        """Return how far lengths s (j,) lie ahead of another, the short way."""
        gap = s - other
        if self.closed:
            gap = gap - self.length * np.rint(gap / self.length)
        return gap


def boundary_rails(surface: TriSurface) -> list[Rail]:
    """Return a rail along each boundary loop of a surface."""
    return [Rail(surface, np.append(loop, loop[0])) for loop in surface.boundary_loops]
