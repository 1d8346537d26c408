"""Separatrices that nearly meet a singularity, and how far they miss it as singularities move.

A separatrix of singularity a passes b where one of b's own crosses it at right angles: in the map
of an isotropic field the way along the first and back along the other leads to b, and its part
across the first is the offset by which b is missed. With f' = exp(-H - i theta) that is

    w = Im int f' ds,    dw = Im int f' d(log f') ds,

and moving a singularity changes log f' by the field of a dipole, one back-substitution for each
direction. Over the triangles around the singularity that moves, where the dipole is strong, the
end of the way moves with it, by what the map beside them makes of the move.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from solvers.algebra.operators import midpoint_offsets
from solvers.fields.merging import potential
from solvers.fields.prepared import PreparedSurface
from solvers.layouts.charts import ComplexArray
from solvers.layouts.connections import way_between
from solvers.layouts.crossings import crossings
from solvers.layouts.gauge import before_winding, chart_by_sides, in_joining_gauge
from solvers.layouts.motorcycles import Stops
from solvers.layouts.nodes import singular_nodes, starts_at
from solvers.layouts.separatrices import as_curves
from solvers.layouts.tracing import trace
from solvers.surface.homology import DualTree
from solvers.surface.triangulation import QUARTER, BoolArray, FloatArray, IntArray

FAR = 1.5
"""Length of the separatrices that are looked at, in square roots of the area in the map. Chosen."""

STEEPEST = 0.5
"""Offset of what counts as passing, in lengths of the separatrix until there. Chosen."""


@dataclass(frozen=True, eq=False)
class Passings:
    """Where separatrices of singularities pass others.

    Parameters
    ----------
    nodes : (p, 2) int array
        The singularity that each leaves, and the one it passes.
    length : (p,) float array
        Of the separatrix until there, in the map.
    offset : (p,) float array
        By how much it misses, in the map: above zero where the other lies to its left.
    chords : (p, 2) int array
        The chords of the two that cross.
    line : (p, 2) int array
        The directions that a line between the two would leave them in: the same both ways.
    """

    nodes: IntArray
    length: FloatArray
    offset: FloatArray
    chords: IntArray
    line: IntArray

    def __getitem__(self, chosen: IntArray | BoolArray) -> Passings:
        return Passings(*(values[chosen] for values in vars(self).values()))

    def __len__(self) -> int:
        return len(self.nodes)

    @property
    def angles(self) -> FloatArray:
        """(p,) by how much they miss, radians."""
        return np.asarray(np.arctan2(np.abs(self.offset), self.length))


class SeparatrixWays:
    """The separatrices of one configuration's isotropic field, and what its moves do to them.

    Parameters
    ----------
    prepared : PreparedSurface
        For the configuration, which is valid.

    Attributes
    ----------
    gauge_free : bool
        Whether nothing fixes the direction of all crosses: they are turned for separatrices to
        join.
    """

    def __init__(self, prepared: PreparedSurface) -> None:
        self._prepared = prepared
        solver = prepared.operators.solver
        self.gauge_free = solver.gauge_free
        self._solver = in_joining_gauge(solver, prepared.singularities)
        field = self._solver.solve(prepared.singularities)
        self.chart = chart_by_sides(field)
        self._nodes = singular_nodes(self.chart, field)
        self._traces = trace(
            self.chart,
            self._nodes,
            starts_at(self.chart, self._nodes),
            0.0,
            FAR * float(self.chart.area) ** 0.5,
        )

    @cached_property
    def passings(self) -> Passings:
        """Where separatrices of singularities pass others, the nearest first on each."""
        traces = self._traces
        kept = before_winding(traces.chords)
        found = crossings(self.chart, traces.chords[kept])
        chord = np.flatnonzero(kept)[np.concatenate([found.chord, found.chord[:, ::-1]])]
        at = np.concatenate([found.at, found.at[:, ::-1]])
        node = traces.starts.node[traces.chords.trace[chord]]
        near = (at[:, 1] < STEEPEST * at[:, 0]) & (at[:, 0] > self.chart.edge_length)
        near &= (node < len(self._prepared.singularities)).all(axis=1)
        order = np.flatnonzero(near)[np.argsort(at[near, 0], kind="stable")]
        axis = traces.chords.axis[chord[order]]
        side = np.where((axis[:, 1] - axis[:, 0]) % 4 == 3, 1, -1)
        node, chord, at = node[order], chord[order], at[order]
        valence = np.array([n.quads for n in self._nodes])[node]
        # The other's own separatrix that crosses is beside the one that would lead back.
        slot = traces.starts.slot[traces.chords.trace[chord]]
        slot[:, 1] -= side
        line = np.sort(valence.max(initial=1) * node + slot % valence, axis=1)
        return Passings(node, at[:, 0], side * at[:, 1], chord, line)

    def trace_of(self, passings: Passings) -> IntArray:
        """Return the separatrix (p,) that each is on."""
        return self._traces.chords.trace[passings.chords[:, 0]]

    def curves(self, passings: Passings) -> tuple[FloatArray, IntArray]:
        """Return the ways from first singularities to second: points (q, 3), offsets (p + 1,).

        Each goes along the separatrix until it passes, and back along the other to what it passes.
        """
        traces, surface = self._traces, self._prepared.surface
        critical = np.ones(len(self._nodes), dtype=bool)
        points, offsets = [np.empty((0, 3))], [0]
        for pair, length, offset in zip(
            traces.chords.trace[passings.chords], passings.length, passings.offset, strict=True
        ):
            kept = np.zeros(len(traces.ends), dtype=bool)
            kept[pair] = True
            at = np.zeros(len(kept))
            at[pair] = length, abs(offset)
            stopped = Stops(kept, at, np.zeros(len(kept), dtype=np.int64))
            both = as_curves(surface, self._nodes, critical, traces, stopped)
            there, back = np.split(both.points, [both.offsets[1]])[
                :: 1 if pair[0] < pair[1] else -1
            ]
            points.append(np.concatenate([there, back[::-1]]))
            offsets.append(offsets[-1] + len(points[-1]))
        return np.concatenate(points), np.array(offsets)

    def gradients(self, passings: Passings, axes: FloatArray) -> FloatArray:
        """Return how offsets change as singularities move.

        Parameters
        ----------
        passings : Passings
            Some of those there are.
        axes : (k, 2, 3) float array
            Two directions in space for each singularity.

        Returns
        -------
        (p, k, 2) float array
        """
        ways = [way_between(self._traces, pair) for pair in passings.chords]
        found = np.zeros((len(ways), *axes.shape[:2]))
        for mover, direction, change in self._changes(axes):
            near = self._near[mover]
            for way, nodes, row in zip(ways, passings.nodes, found, strict=True):
                inside = near[way.halfedge // 3]
                first = int(np.argmin(inside)) if nodes[0] == mover else 0
                last = len(inside)
                last -= int(np.argmin(inside[::-1])) if nodes[1] == mover else 0
                part = slice(first, last)
                across = float((way.factor[part] * change[way.halfedge[part]]).imag.sum())
                for end, at, sign in ((0, first, -1), (1, last - 1, 1)):
                    if nodes[end] == mover:
                        image = self._image(way.halfedge[at] // 3, axes[mover, direction])
                        across += sign * float((way.along[at] * image).imag)
                row[mover, direction] = across
        return found

    def _changes(self, axes: FloatArray) -> Iterator[tuple[int, int, ComplexArray]]:
        """Yield singularity, direction, and how the images (3 m,) of halfedges change."""
        t, d = self.chart.triangulation, self._solver.discretization
        loads = np.concatenate([self._dipoles(j, pair) for j, pair in enumerate(axes)], axis=1)
        h = potential(self._solver, loads)
        tree, images = self._tree, self.chart.images.reshape(-1)
        for column in range(2 * len(axes)):
            values = h[:, column]
            offsets = midpoint_offsets(t, values).reshape(-1)
            steps = offsets[tree.crossing] - offsets[t.twin[tree.crossing]]
            start = -float(offsets[d.reference]) if d.reference >= 0 else 0.0
            theta = np.repeat(tree.accumulate(start, steps), 3) + offsets
            middle = (values[t.tail] + values[t.head]) / 2
            yield column // 2, column % 2, -images * (middle + 1j * theta)

    def _dipoles(self, number: int, axes: FloatArray) -> FloatArray:
        """Return how the right side (n, 2) changes as a singularity moves along axes (2, 3)."""
        t, around = self.chart.triangulation, np.flatnonzero(self._around[number])
        share = t.areas[around] / t.areas[around].sum()
        inside = np.einsum("fid,fdx->fix", t.hat_gradients[around], self._frames[around])
        rates = np.einsum("f,fix,ax->fia", share, inside, axes)
        loads = np.zeros((t.n_vertices, 2))
        np.add.at(loads, t.faces[around].reshape(-1), rates.reshape(-1, 2))
        return -QUARTER * self._prepared.singularities[number].index * loads

    def _image(self, face: int, vector: FloatArray) -> complex:
        """Return what the map makes of a vector in space, in a triangle's frame there."""
        t = self.chart.triangulation
        sides = t.lengths[face] * np.exp(1j * t.directions.reshape(-1, 3)[face])
        x, y = self._frames[face] @ vector
        return complex((self.chart.images[face] / sides).mean() * (x + 1j * y))

    @cached_property
    def _around(self) -> BoolArray:
        """(k, m) the triangles around each singularity."""
        faces = self.chart.triangulation.faces
        singular = self._nodes[: len(self._prepared.singularities)]
        return np.stack([(faces == node.vertex).any(axis=1) for node in singular])

    @cached_property
    def _near(self) -> BoolArray:
        """(k, m) the triangles around each singularity, and those that touch them."""
        faces = self.chart.triangulation.faces
        found = []
        for around in self._around:
            beside = np.zeros(self.chart.triangulation.n_vertices, dtype=bool)
            beside[faces[around]] = True
            found.append(beside[faces].any(axis=1))
        return np.stack(found)

    @cached_property
    def _frames(self) -> FloatArray:
        """(m, 2, 3) the axes of the triangles' frames in space."""
        working, t = self.chart.working, self.chart.triangulation
        middle = working.lift(np.arange(t.n_faces), t.corner_positions.mean(axis=1))
        along, across = (axis[middle.face] for axis in self._prepared.surface.face_frames)
        c, s = np.cos(middle.turn)[:, None], np.sin(middle.turn)[:, None]
        return np.stack([c * along + s * across, c * across - s * along], axis=1)

    @cached_property
    def _tree(self) -> DualTree:
        """Of paths that never leave the surroundings of a singularity again.

        A dipole's curvature is on the vertices beside it: a path between those would miss a part.
        """
        t = self.chart.triangulation
        within = np.asarray(self._near.any(axis=0))
        out = np.repeat(within, 3) & (t.twin >= 0) & ~within[t.twin // 3]
        return DualTree(t, max(self._solver.discretization.reference, 0) // 3, out[None])
