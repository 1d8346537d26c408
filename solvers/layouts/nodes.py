"""Vertices that separatrices leave, and the directions they leave in."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from solvers.fields.aligned import AlignedField
from solvers.fields.crossfield import CrossField
from solvers.layouts.charts import Chart
from solvers.surface.triangulation import QUARTER, FloatArray, IntArray, previous_halfedge


@dataclass(frozen=True, eq=False)
class Node:
    """A vertex that traces leave, and in which directions.

    Parameters
    ----------
    vertex : int
        The vertex.
    quads : int
        Quarter turns around it in the map: the valence inside, the quads that meet at a corner.
    inner : bool
        Whether it lies inside.
    ring : (r,) int array
        Halfedges that leave it, counter-clockwise.
    reach : (r + 1,) float array
        Angle against the cross, radians, from one of its directions (slot 0; the boundary) to
        each of them, and after a full turn.
    """

    vertex: int
    quads: int
    inner: bool
    ring: IntArray
    reach: FloatArray

    @property
    def slots(self) -> IntArray:
        """The directions traces leave in, in quarter turns from the first."""
        return np.arange(0 if self.inner else 1, self.quads)

    def slot_of(self, halfedge: int, angle: float) -> int:
        """Return the direction `angle` beyond a halfedge of the ring, in quarter turns."""
        at = self.reach[np.flatnonzero(self.ring == halfedge)[0]] + angle
        slot = int(np.rint(at / QUARTER))
        return slot % self.quads if self.inner else slot


def node_at(chart: Chart, vertex: int, quads: int) -> Node:
    """Return the directions along the cross around a vertex: exactly one for each quarter turn.

    Parameters
    ----------
    chart : Chart
        The images.
    vertex : int
        The vertex.
    quads : int
        The valence inside, the number of quads that meet there on the boundary.
    """
    ring = chart.ring(vertex)
    inner = bool(chart.triangulation.twin[previous_halfedge(ring[-1])] >= 0)
    z = chart.images.reshape(-1)
    tips = np.angle(-z[previous_halfedge(ring)] / z[ring])
    tips = np.maximum(tips, 1e-3)  # only inverted triangles have none
    reach = np.concatenate([[0.0], np.cumsum(tips)]) * (quads * QUARTER / tips.sum())
    # Against the cross a halfedge lies at its reach plus one angle for all, modulo 90 degrees.
    reach += np.angle(np.exp(4j * (np.angle(z[ring]) - reach[:-1])).mean()) / 4
    if inner and reach[0] > 0:
        reach -= QUARTER
    return Node(vertex, quads, inner, ring, reach)


@dataclass(frozen=True, eq=False)
class Starts:
    """Where traces start: each in a corner of a triangle, along an axis of its image.

    Parameters
    ----------
    node, slot : (k,) int arrays
        The node each leaves and its direction there.
    halfedge : (k,) int array
        The halfedge of the node's ring to the right of the trace.
    axis : (k,) int array
        Its direction in the triangle's image, in quarter turns.
    """

    node: IntArray
    slot: IntArray
    halfedge: IntArray
    axis: IntArray


def starts_at(chart: Chart, nodes: Sequence[Node]) -> Starts:
    """Return the start of every trace that leaves the nodes."""
    rows = []
    z = chart.images.reshape(-1)
    for number, node in enumerate(nodes):
        slots = node.slots
        sector = np.searchsorted(node.reach, slots * QUARTER, side="right") - 1
        sector = np.clip(sector, 0, len(node.ring) - 1)
        h = node.ring[sector]
        beyond = np.angle(z[h]) + slots * QUARTER - node.reach[sector]
        axis = np.rint(beyond / QUARTER).astype(np.int64) % 4
        rows.append(np.stack([np.full(len(slots), number), slots, h, axis]))
    return Starts(*np.concatenate(rows, axis=1) if rows else np.empty((4, 0), dtype=np.int64))


def singular_nodes(chart: Chart, field: CrossField) -> list[Node]:
    """Return the nodes at the singularities of a field and at its corners."""
    inside = [
        node_at(chart, field.surface.nearest_vertex(s.point), s.valence)
        for s in field.singularities
    ]
    return inside + [node_at(chart, v, 2 - k) for v, k in field.corners.items()]


def feature_nodes(chart: Chart, aligned: AlignedField, taken: set[int]) -> list[Node]:
    """Return nodes where feature curves end or do not go straight on, one on each closed curve.

    Parameters
    ----------
    chart : Chart
        The map.
    aligned : AlignedField
        The field that follows them.
    taken : set of int
        Vertices that are nodes already.
    """
    ends = {int(v) for curve in aligned.features.curves for v in curve.vertices[[0, -1]]}
    ends.update(aligned.bent.tolist())
    t = chart.triangulation
    on_boundary = np.zeros(t.n_vertices, dtype=bool)
    on_boundary[t.tail[t.boundary_halfedges]] = True
    return [node_at(chart, v, 2 if on_boundary[v] else 4) for v in sorted(ends - taken)]
