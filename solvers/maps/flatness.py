"""What makes the metric of images flat with its cones: linear conditions on angles."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array, csc_array, csr_array, diags_array, vstack
from scipy.sparse.csgraph import connected_components, minimum_spanning_tree

from solvers.algebra.factorization import factorized
from solvers.maps.image_lengths import ImageLengths
from solvers.maps.matching import FREE
from solvers.surface.homology import DualTree
from solvers.surface.triangulation import (
    QUARTER,
    FloatArray,
    IntArray,
    IntrinsicTriangulation,
    next_halfedge,
    previous_halfedge,
    wrap,
)

RIDGE = 1e-11
"""Added to the diagonal, relative: on a closed surface one of the conditions follows from others.

Chosen, above rounding.
"""


class Flatness:
    """What makes a metric flat with its cones: linear in angles."""

    def __init__(self, metric: ImageLengths, target: IntrinsicTriangulation) -> None:
        t, self._metric = target, metric
        aligned = np.flatnonzero(metric.axes != FREE)
        self._root = int(aligned[0]) if len(aligned) else -1
        none = np.zeros((1, len(t.twin)), dtype=bool)
        self._tree = DualTree(t, max(self._root, 0) // 3, none)
        self._read = self._read_at(t, aligned)
        n = len(t.twin)
        sectors = csr_array(
            (np.ones(n), (metric.sector, np.arange(n))), shape=(len(metric.quads), n)
        )
        self._rows = csr_array(vstack([sectors, self._loop_rows(t)]))

    def _read_at(self, t: IntrinsicTriangulation, aligned: IntArray) -> IntArray:
        """Return where loops close and alignment is read: inner, then aligned halfedges."""
        crossed = self._tree.crossing[1:]
        left = t.twin > np.arange(len(t.twin))
        left[crossed] = left[t.twin[crossed]] = False
        h = np.flatnonzero(left)
        node = _joined(t.n_vertices, t, t.boundary_halfedges)
        one, other = np.sort(np.stack([node[t.tail[h]], node[t.head[h]]]), axis=0)
        apart = np.flatnonzero(one != other)
        _, first = np.unique(one[apart] * t.n_vertices + other[apart], return_index=True)
        chosen = apart[first]
        shape = (t.n_vertices, t.n_vertices)
        graph = csr_array((chosen + 1.0, (one[chosen], other[chosen])), shape=shape)
        spanning = np.rint(minimum_spanning_tree(graph).data).astype(np.int64) - 1
        loops = np.delete(h, spanning)
        together = _joined(t.n_vertices, t, aligned)[t.tail[aligned]]
        _, one_of_each = np.unique(together, return_index=True)
        others = aligned[one_of_each][together[one_of_each] != together[:1]]
        self._n_loops = len(loops)
        return np.concatenate([loops, others])

    def _loop_rows(self, t: IntrinsicTriangulation) -> csr_array:
        """Return by how much each reading changes with the angles (3 m,)."""
        columns, values, rows = [], [], []
        for row, h in enumerate(self._read):
            paths = [(self._tree.path(int(h) // 3), 1)]
            ends = [(h, 1)]
            if row < self._n_loops:
                paths.append((self._tree.path(int(t.twin[h]) // 3), -1))
                ends.append((t.twin[h], -1))
            else:
                ends.append((self._root, -1))
            crossed = np.concatenate([path for path, _ in paths])
            sign = np.concatenate([np.full(len(path), s) for path, s in paths])
            at = np.concatenate([crossed, t.twin[crossed], [e for e, _ in ends]])
            by = np.concatenate([sign, -sign, [s for _, s in ends]])
            columns.append(at)
            values.append(by)
            rows.append(np.full(len(at), row))
        n = len(t.twin)
        if not rows:
            return csr_array((0, n))
        by_direction = coo_array(
            (
                np.concatenate(values).astype(np.float64),
                (np.concatenate(rows), np.concatenate(columns)),
            ),
            shape=(len(self._read), n),
        ).tocsr()
        # Directions in a triangle: 0, then a half turn less its second angle or more its first.
        first = 3 * np.arange(t.n_faces)
        turning = coo_array(
            (
                np.concatenate([-np.ones(t.n_faces), np.ones(t.n_faces)]),
                (np.concatenate([first + 1, first + 2]), np.concatenate([first + 1, first])),
            ),
            shape=(n, n),
        ).tocsr()
        return csr_array(by_direction @ turning)

    def _directions(self, t: IntrinsicTriangulation) -> FloatArray:
        """Return the direction of each halfedge's image against the cross carried to it."""
        crossing, jumps = self._tree.crossing, self._metric.turns
        entered = t.twin[crossing]
        steps = t.directions[crossing] - t.directions[entered] + np.pi + QUARTER * jumps[crossing]
        root = self._root
        at_root = QUARTER * self._metric.axes[root] - t.directions[root] if root >= 0 else 0.0
        turn = self._tree.accumulate(float(at_root), steps)
        return np.asarray(t.directions + np.repeat(turn, 3))

    def off(self, t: IntrinsicTriangulation) -> FloatArray:
        """Return by how much sectors and loops are off, radians."""
        metric, direction = self._metric, self._directions(t)
        angles = np.bincount(metric.sector, t.angles.reshape(-1), len(metric.quads))
        h = self._read
        loops, ends = h[: self._n_loops], h[self._n_loops :]
        beyond = direction[t.twin[loops]] - np.pi - QUARTER * metric.turns[loops]
        gaps = [direction[loops] - beyond, direction[ends] - QUARTER * metric.axes[ends]]
        return np.concatenate(
            [angles - QUARTER * metric.quads, wrap(np.concatenate(gaps), 2 * np.pi)]
        )

    def change(self, t: IntrinsicTriangulation, off: FloatArray) -> FloatArray:
        """Return the least change of the lengths' logarithms (3 m,) that takes it away."""
        n, cotangents = len(t.twin), t.cotangents.reshape(-1)
        h = np.arange(n)
        edge = np.empty(n, dtype=np.int64)
        edge[t.edge_halfedges] = np.arange(len(t.edge_halfedges))
        inner = t.edge_halfedges[t.twin[t.edge_halfedges] >= 0]
        edge[t.twin[inner]] = edge[inner]
        ahead, behind = next_halfedge(h), previous_halfedge(h)
        one, other = cotangents[ahead], cotangents[behind]
        # An angle grows with the side opposite, and falls with the two beside it.
        by_length = coo_array(
            (
                np.concatenate([one + other, -one, -other]),
                (np.tile(h, 3), np.concatenate([edge[ahead], edge[h], edge[behind]])),
            ),
            shape=(n, len(t.edge_halfedges)),
        ).tocsr()
        derivative = csc_array(self._rows @ by_length)
        normal = csc_array(derivative @ derivative.T)
        normal = csc_array(normal + diags_array(RIDGE * normal.diagonal()))
        return np.asarray((derivative.T @ factorized(normal).solve(-off))[edge])

    def images(self, t: IntrinsicTriangulation) -> FloatArray:
        """Return the images of halfedges (m, 3, 2) in the frames of the crosses."""
        direction = self._directions(t)
        if self._root < 0:
            apart = self._metric.wanted_directions() - direction
            weight = t.lengths.reshape(-1) ** 2
            direction = direction + np.angle(weight @ np.exp(1j * apart))
        images = t.lengths.reshape(-1, 1) * np.stack([np.cos(direction), np.sin(direction)], axis=1)
        return np.asarray(images.reshape(-1, 3, 2))


def _joined(n: int, t: IntrinsicTriangulation, h: IntArray) -> IntArray:
    """Return the component of each vertex in the graph of halfedges."""
    graph = coo_array((np.ones(len(h)), (t.tail[h], t.head[h])), shape=(n, n))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)
