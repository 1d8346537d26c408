"""The combinatorics of a mesh of polygons: edges, orientation, loops, what is no surface."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from solvers.errors import CrossviewError

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]
Bools = npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Faces:
    """A mesh of polygons as it stands in a file.

    Parameters
    ----------
    points : (n, 3) float array
    sizes : (m,) int array
        Number of corners of each face.
    corners : (sum of sizes,) int array
        Points of the faces' corners, one face after another.

    Raises
    ------
    CrossviewError
        A coordinate is not finite, a corner names no point, a face has fewer than three corners,
        or there is no face.
    """

    points: Floats
    sizes: Ints
    corners: Ints

    def __post_init__(self) -> None:
        if not len(self.sizes):
            raise CrossviewError("a mesh without faces cannot be checked")
        if not np.isfinite(self.points).all():
            raise CrossviewError("coordinates are not all finite numbers", "", "mend the file")
        if self.corners.min() < 0 or self.corners.max() >= len(self.points):
            raise CrossviewError(
                f"faces name vertices outside 0..{len(self.points) - 1}", "", "mend the file"
            )
        if self.sizes.min() < 3:
            raise CrossviewError("a face has fewer than three corners", "", "mend the file")

    @classmethod
    def of_one_size(cls, points: npt.ArrayLike, faces: npt.ArrayLike) -> Faces:
        """The same of faces (m, s) that have s corners each."""
        table = np.asarray(faces, dtype=np.int64)
        sizes = np.full(len(table), table.shape[1])
        return cls(np.asarray(points, dtype=np.float64), sizes, table.reshape(-1))

    @cached_property
    def starts(self) -> Ints:
        """(m,) where the corners of each face begin."""
        return np.cumsum(self.sizes) - self.sizes

    @cached_property
    def owner(self) -> Ints:
        """Face of each corner."""
        return np.repeat(np.arange(len(self.sizes)), self.sizes)

    @cached_property
    def following(self) -> Ints:
        """Number of the next corner around the face, of each corner."""
        following = np.arange(len(self.corners)) + 1
        following[self.starts + self.sizes - 1] = self.starts
        return following

    @cached_property
    def middles(self) -> Floats:
        """(m, 3) the mean of each face's corners."""
        sums = np.add.reduceat(self.points[self.corners], self.starts)
        return np.asarray(sums / self.sizes[:, None])

    @cached_property
    def before(self) -> Ints:
        """Number of the corner before around the face, of each corner."""
        before = np.empty_like(self.following)
        before[self.following] = np.arange(len(before))
        return before

    @cached_property
    def lengths(self) -> Floats:
        """Length of the side from each corner to the next."""
        ends = self.points[self.sides]
        return np.asarray(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1))

    @cached_property
    def whole(self) -> Bools:
        """(m,) whether the corners of a face are different vertices."""
        keys = self.owner * len(self.points) + self.corners
        distinct = np.unique(keys) // len(self.points)
        return np.asarray(np.bincount(distinct, minlength=len(self.sizes)) == self.sizes)

    @cached_property
    def sides(self) -> Ints:
        """(c, 2) vertices of the directed side from each corner to the next."""
        return np.stack([self.corners, self.corners[self.following]], axis=1)

    @cached_property
    def _joined(self) -> tuple[Ints, Ints, Ints]:
        """The edges (e, 2), the edge of each side, and the number of sides of each edge."""
        edges, of_side, count = np.unique(
            np.sort(self.sides, axis=1), axis=0, return_inverse=True, return_counts=True
        )
        return edges, of_side.reshape(-1), count

    @property
    def edges(self) -> Ints:
        """(e, 2) undirected edges."""
        return self._joined[0]

    @cached_property
    def rim(self) -> Ints:
        """(k, 2) edges of one face only."""
        edges, _, count = self._joined
        return np.asarray(edges[count == 1])

    @cached_property
    def crowded(self) -> Ints:
        """(k, 2) edges of three and more faces."""
        edges, _, count = self._joined
        return np.asarray(edges[count > 2])

    @cached_property
    def neighbours(self) -> Ints:
        """(k, 2) pairs of sides that are one edge; consecutive ones where there are more."""
        _, of_side, _ = self._joined
        order = np.argsort(of_side, kind="stable")
        same = of_side[order[1:]] == of_side[order[:-1]]
        return np.stack([order[:-1][same], order[1:][same]], axis=1)

    @cached_property
    def used(self) -> Ints:
        """Vertices that a face has, in order."""
        return np.unique(self.corners)

    @cached_property
    def on_rim(self) -> Bools:
        """(n,) whether a vertex is on the boundary."""
        found = np.zeros(len(self.points), dtype=bool)
        found[self.rim] = True
        return found

    @cached_property
    def meeting(self) -> Ints:
        """(n,) number of faces that meet at each vertex."""
        return np.bincount(self.corners, minlength=len(self.points))

    @cached_property
    def pinched(self) -> Ints:
        """Vertices whose faces do not hang together around them."""
        one, other = self.neighbours.T
        after_one, after_other = self.following[one], self.following[other]
        along = self.corners[one] == self.corners[other]
        # the corner of each side at the edge's two ends
        a = np.concatenate([one, after_one])
        b = np.concatenate(
            [np.where(along, other, after_other), np.where(along, after_other, other)]
        )
        _, label = _components(a, b, len(self.corners))
        fans = np.unique(np.stack([self.corners, label], axis=1), axis=0)[:, 0]
        return np.flatnonzero(np.bincount(fans, minlength=len(self.points)) > 1)

    @cached_property
    def pieces(self) -> tuple[int, Ints]:
        """Number of pieces that hang together by edges, and that of each face."""
        one, other = self.owner[self.neighbours].T
        return _components(one, other, len(self.sizes))

    @cached_property
    def turned(self) -> tuple[Bools, bool]:
        """(m,) the faces to be turned over for all of a piece to agree, and whether they can.

        Each face has two sides; sides of neighbours that agree are joined. A piece whose two
        sides are one is one-sided. Otherwise the fewer faces count as turned.
        """
        n = len(self.sizes)
        first, second = self.neighbours.T
        f, g = self.owner[first], self.owner[second]
        against = self.corners[first] == self.corners[second]
        a = np.concatenate([f, f + n])
        b = np.concatenate([np.where(against, g + n, g), np.where(against, g, g + n)])
        _, label = _components(a, b, 2 * n)
        here, there = label[:n], label[n:]
        lower = here < there
        share = np.bincount(self.pieces[1], lower) / np.bincount(self.pieces[1])
        minority = np.where(share > 0.5, False, True)[self.pieces[1]]
        return lower == minority, bool((here != there).all())

    @property
    def euler(self) -> int:
        """V - E + F of the vertices that a face has."""
        return len(self.used) - len(self.edges) + len(self.sizes)

    @cached_property
    def loops(self) -> int:
        """Number of connected boundaries."""
        if not len(self.rim):
            return 0
        ends, numbered = np.unique(self.rim, return_inverse=True)
        one, other = numbered.reshape(-1, 2).T
        return _components(one, other, len(ends))[0]


def _components(one: Ints, other: Ints, n: int) -> tuple[int, Ints]:
    """Number of connected parts of a graph on n nodes, and the part of each node."""
    graph = coo_array((np.ones(len(one), dtype=np.int8), (one, other)), shape=(n, n))
    count, label = connected_components(graph, directed=False)
    return int(count), np.asarray(label, dtype=np.int64)
