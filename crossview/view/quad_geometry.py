"""Geometry of a drawn quad mesh: its edges, the borders of its patches and their colours."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from crossview.view.colors import PATCHES, bytes_of
from crossview.view.values import FloatArray, IntArray, Quads

_SAME = 1e-7
"""Points nearer than this, in diagonals, are one: patches are sampled each for itself. Chosen."""


@dataclass(frozen=True, eq=False)
class QuadGeometry:
    """What is drawn of a mesh of quadrilaterals besides itself."""

    mesh: Quads

    @cached_property
    def merged(self) -> tuple[FloatArray, IntArray]:
        """Points and quads with points in the same place made one."""
        if not self.mesh.apart:
            return self.mesh.points, self.mesh.quads
        points = np.asarray(self.mesh.points, float)
        cell = _SAME * (float(np.linalg.norm(np.ptp(points, axis=0))) or 1.0)
        keys = np.round((points - points.min(axis=0)) / cell).astype(np.int64)
        _, first, numbers = np.unique(keys, axis=0, return_index=True, return_inverse=True)
        return points[first], numbers.reshape(-1)[self.mesh.quads]

    @cached_property
    def edges(self) -> IntArray:
        """(e, 2): every edge once, in the mesh's own numbers."""
        return self._sides[0]

    @cached_property
    def borders(self) -> IntArray:
        """(b, 2): edges between two patches, and edges of one quad only.

        A patch that is sampled for itself has its border even where it meets itself.
        """
        edges, first, last, counts = self._sides
        patch = self.mesh.patch
        return np.asarray(edges[(counts == 1) | (patch[first] != patch[last])])

    @cached_property
    def patch_colors(self) -> npt.NDArray[np.uint8]:
        """(q, 3): the colour of each quad's patch, never that of a patch next to it."""
        numbers, patch = np.unique(self.mesh.patch, return_inverse=True)
        _, quads = self.merged
        _, first, last, _ = _sides(quads)
        pairs = np.stack([patch[first], patch[last]], axis=1)
        pairs = np.unique(np.sort(pairs[pairs[:, 0] != pairs[:, 1]], axis=1), axis=0)
        chosen = spread_colors(len(numbers), pairs, len(PATCHES))
        palette: npt.NDArray[np.uint8] = bytes_of(list(PATCHES)).astype(np.uint8)
        return palette[chosen[patch]]

    @cached_property
    def _sides(self) -> tuple[IntArray, IntArray, IntArray, IntArray]:
        return _sides(self.mesh.quads)


def _sides(quads: IntArray) -> tuple[IntArray, IntArray, IntArray, IntArray]:
    """Return edges (e, 2), a first and a last quad of each, and how many there are."""
    sides = np.sort(quads[:, [0, 1, 1, 2, 2, 3, 3, 0]].reshape(-1, 2), axis=1)
    keys = sides[:, 0].astype(np.int64) * (int(quads.max(initial=0)) + 1) + sides[:, 1]
    order = np.argsort(keys, kind="stable")
    starts = np.flatnonzero(np.diff(keys[order], prepend=-1))
    counts = np.diff(starts, append=len(keys))
    first, last = order[starts], order[starts + counts - 1]
    return sides[first], first // 4, last // 4, counts


def spread_colors(count: int, pairs: IntArray, colors: int) -> IntArray:
    """Give each of `count` patches a colour that no neighbour has, all used about as often.

    Parameters
    ----------
    count : int
    pairs : (k, 2) int
        Neighbours.
    colors : int
        How many there are to choose from; with more neighbours than that some repeat.

    Returns
    -------
    (count,) int
    """
    around: list[list[int]] = [[] for _ in range(count)]
    for a, b in pairs.tolist():
        around[a].append(b)
        around[b].append(a)
    chosen = np.full(count, -1)
    used = np.zeros(colors, int)
    for patch in _fewest_neighbours_last(around):  # patches are few
        near = chosen[around[patch]]
        taken = np.bincount(near[near >= 0], minlength=colors)
        chosen[patch] = np.lexsort((used, taken > 0))[0]
        used[chosen[patch]] += 1
    return chosen


def _fewest_neighbours_last(around: list[list[int]]) -> list[int]:
    """Order nodes so that each has few neighbours before it: in the plane at most five.

    The smallest-last order of Matula and Beck (1983).
    """
    left, order = np.array([len(near) for near in around], int), []
    for _ in around:
        node = int(np.argmin(left))
        order.append(node)
        left[node] = np.iinfo(int).max // 2
        left[around[node]] -= 1
    return order[::-1]
