"""Filling the rectangles of a layout with quads."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from solvers.errors import CrossviewError
from solvers.layouts.arrangement import Arrangement
from solvers.layouts.charts import AXES, ComplexArray
from solvers.layouts.layout import QuadLayout
from solvers.layouts.patches import grid_quads
from solvers.layouts.straight import barycentric_in, walk
from solvers.layouts.tmesh import TMesh
from solvers.number_checks import whole_numbers
from solvers.quads.quadmesh import QuadMesh
from solvers.surface.triangulation import BoolArray, FloatArray, IntArray


def fill(
    layout: QuadLayout, counts: IntArray, spacing: Mapping[int, FloatArray] | None = None
) -> QuadMesh:
    """Fill every rectangle with a grid of quads.

    Parameters
    ----------
    layout : QuadLayout
        The rectangles.
    counts : (A,) int array
        Number of quads along each arc, the same on opposite sides of every rectangle. Where it is
        0, the rectangle vanishes and its other two sides become one.
    spacing : mapping from int to (count + 1,) float array, optional
        Where along an arc its vertices are, from 0 to 1; in equal shares of those without.

    Returns
    -------
    QuadMesh
        Vertices as the seamless map has them, lying in the triangles of the layout's surface.

    Raises
    ------
    CrossviewError
        If there is not one whole number from 0 for each arc, or opposite sides differ.

    Notes
    -----
    Inside a rectangle places are blended between its four sides (Coons 1967).

    Examples
    --------
    >>> from solvers import run
    >>> from solvers.fields import IntegratedField, aligned_field, prepare
    >>> from solvers.layouts import quad_layout
    >>> from solvers.primitives import square
    >>> from solvers.quads import fill, quantize
    >>> aligned = aligned_field(prepare(square(n=4)))
    >>> layout = run(quad_layout(IntegratedField(aligned, aligned.start)))
    >>> mesh = fill(layout, quantize(layout.tmesh, edge_length=1 / 3).counts)
    >>> mesh.n_quads, round(float(mesh.scaled_jacobian.min()), 9)
    (9, 1.0)
    """
    points = _Points(layout.arrangement, _checked(layout.tmesh, counts), spacing or {})
    grids = [_grid(points, r) for r in range(layout.patches)]
    face, weights = points.located()
    n = layout.tmesh.n_nodes
    fixed = np.zeros(len(face), dtype=bool)
    fixed[:n] = layout.tmesh.critical
    loop = points.loops()
    number, kept = _merged(np.concatenate(points.doubles), fixed, loop)
    quads = [number[grid_quads(grid)] for grid in grids]
    surface = layout.surface
    corners = surface.vertices[surface.faces[face[kept]]]
    return QuadMesh(
        surface,
        np.einsum("kc,kcd->kd", weights[kept], corners),
        np.concatenate(quads),
        np.repeat(np.arange(len(quads)), [len(q) for q in quads]),
        face[kept],
        weights[kept],
        fixed[kept],
        loop[kept],
    )


def _checked(tmesh: TMesh, counts: IntArray) -> IntArray:
    """Return counts that grids can be made of."""
    found = whole_numbers("the counts of arcs", counts, (tmesh.n_arcs,))
    if (found < 0).any():
        raise CrossviewError(f"the counts of arcs must be at least 0, not {found.min()}")
    sides = tmesh.side_totals(found.astype(np.float64))
    unequal = np.flatnonzero((sides[:, :2] != sides[:, 2:]).any(axis=1))
    if len(unequal):
        raise CrossviewError(
            "opposite sides of a rectangle have different counts",
            f"rectangle {unequal[0]}",
            "take counts that quantize finds",
        )
    return found


class _Points:
    """The vertices, while they are numbered: nodes, those inside arcs, those inside rectangles.

    Attributes
    ----------
    doubles : list of (d, 2) int array
        Vertices that are one.
    """

    def __init__(
        self, arrangement: Arrangement, counts: IntArray, spacing: Mapping[int, FloatArray]
    ) -> None:
        self.arrangement = arrangement
        self.counts = counts
        self._spacing = spacing
        tmesh = arrangement.tmesh
        inside = np.maximum(counts - 1, 0)
        self._first = tmesh.n_nodes + np.concatenate([[0], np.cumsum(inside)])
        self.doubles = [tmesh.arcs[counts == 0]]
        # Each vertex lies on a curve, or a way leads to it from one: sign of the curve's
        # direction along the rectangle, and the way.
        arc = np.repeat(np.arange(tmesh.n_arcs), inside)
        step = np.arange(len(arc)) + 1 - (self._first[arc] - tmesh.n_nodes)
        self._curve = [arrangement.node_curve, arrangement.arc_curve[arc]]
        self._at = [arrangement.node_at, self.along(arc, step)]
        self._way = [np.zeros(len(arc) + tmesh.n_nodes, dtype=complex)]
        self._n = int(self._first[-1])

    def along(self, arc: IntArray, step: IntArray) -> FloatArray:
        """Return the lengths along its curve of vertices of arcs."""
        start, end = self.arrangement.arc_span[arc].T
        share = step / np.maximum(self.counts[arc], 1)
        for spaced in np.intersect1d(arc, list(self._spacing)).astype(np.int64).tolist():
            on = arc == spaced
            share[on] = self._spacing[spaced][step[on]]
        return np.asarray(start + (end - start) * share)

    def side(self, halfarcs: IntArray) -> _Side:
        """Return the vertices along a side of a rectangle."""
        tmesh, counts = self.arrangement.tmesh, self.counts
        number = [tmesh.arcs[halfarcs[:1] // 2, halfarcs[:1] % 2]]
        arcs, signs = [halfarcs[:1] // 2], [1 - 2 * (halfarcs[:1] % 2)]
        steps, places, length = [halfarcs[:1] % 2 * counts[halfarcs[:1] // 2]], [np.zeros(1)], 0.0
        for half in halfarcs.tolist():
            arc, backwards, n = half // 2, half % 2, int(counts[half // 2])
            if n:
                inner = self._first[arc] + np.arange(n - 1)
                end = tmesh.arcs[arc, [1 - backwards]]
                number += [inner[::-1] if backwards else inner, end]
                step = np.arange(1, n + 1)
                steps.append(n - step if backwards else step)
                share = self._spacing.get(arc, np.arange(n + 1) / n)
                share = (1 - share[::-1] if backwards else share)[1:]
                arcs.append(np.full(n, arc))
                signs.append(np.full(n, 1 - 2 * backwards))
                places.append(length + tmesh.lengths[arc] * share)
            length += float(tmesh.lengths[arc])
        arc = np.concatenate(arcs)
        return _Side(
            np.concatenate(number),
            np.concatenate(places),
            self.arrangement.arc_curve[arc],
            self.along(arc, np.concatenate(steps)),
            np.concatenate(signs),
        )

    def add_inside(self, side: _Side, ways: ComplexArray) -> IntArray:
        """Number vertices (w - 1, h - 1) that ways lead to from the inner vertices of a side."""
        shape = ways.shape
        number = self._n + np.arange(ways.size).reshape(shape)
        self._n += ways.size
        self._curve.append(np.repeat(side.curve[1:-1], shape[1]))
        self._at.append(np.repeat(side.at[1:-1], shape[1]))
        self._way.append((side.sign[1:-1, None] * ways).reshape(-1))
        return number

    def located(self) -> tuple[IntArray, FloatArray]:
        """Return the surface's triangle (k,) and the weights (k, 3) there of every vertex."""
        curves = self.arrangement.curves
        chart = curves.chart
        curve, at = np.concatenate(self._curve), np.concatenate(self._at)
        face, place, chord = curves.faces_at(curve, at)
        way = np.concatenate(self._way)
        led = way != 0
        along = AXES[curves.chords.axis[chord[led]]]
        face[led], place[led] = walk(chart, face[led], place[led], way[led] * along)
        return chart.working.lift_points(face, barycentric_in(chart, face, place))

    def loops(self) -> IntArray:
        """Return the number of the boundary loop each vertex lies on, or -1."""
        arrangement = self.arrangement
        tmesh = arrangement.tmesh
        n_traces = arrangement.n_traces
        inside = np.maximum(self.counts - 1, 0)
        of_arcs = np.where(tmesh.arc_on_boundary, arrangement.arc_curve - n_traces, -1)
        of_nodes = np.where(tmesh.node_on_boundary, arrangement.node_curve - n_traces, -1)
        loop = np.full(self._n, -1, dtype=np.int64)
        loop[: self._first[-1]] = np.concatenate([of_nodes, np.repeat(of_arcs, inside)])
        return loop


@dataclass(frozen=True, eq=False)
class _Side:
    """The vertices along one side of a rectangle, w + 1 of them.

    Their numbers, places along the side, and for each a curve, the length along it, and whether
    the side runs along it (1) or against it (-1).
    """

    number: IntArray
    places: FloatArray
    curve: IntArray
    at: FloatArray
    sign: IntArray


def _grid(points: _Points, rectangle: int) -> IntArray:
    """Return the numbers (w + 1, h + 1) of a rectangle's vertices, new ones inside.

    Inside, places in the map are blended between the four sides (Coons).
    """
    tmesh = points.arrangement.tmesh
    low, right, high, left = (points.side(tmesh.side(rectangle, j)) for j in range(4))
    w, h = len(low.number) - 1, len(right.number) - 1
    top, first = high.number[::-1], left.number[::-1]
    if w == 0 or h == 0:
        points.doubles += [np.stack([low.number, top], axis=1)] if h == 0 else []
        points.doubles += [np.stack([first, right.number], axis=1)] if w == 0 else []
        return np.zeros((w, h), dtype=np.int64)
    across, up = np.arange(1, w)[:, None] / w, np.arange(1, h)[None] / h
    width, height = low.places[-1], right.places[-1]
    below, above = low.places[1:-1, None], width - high.places[::-1][1:-1, None]
    x = (1 - up) * below + up * above
    y = (1 - across) * (height - left.places[::-1][None, 1:-1]) + across * right.places[None, 1:-1]
    number = np.empty((w + 1, h + 1), dtype=np.int64)
    number[1:-1, 1:-1] = points.add_inside(low, x - below + 1j * y)
    number[:, 0], number[:, -1] = low.number, top
    number[0], number[-1] = first, right.number
    return number


def _merged(doubles: IntArray, fixed: BoolArray, loop: IntArray) -> tuple[IntArray, IntArray]:
    """Return the new number of each vertex, and which vertices are kept, in their new order.

    Of vertices that are one, a fixed one is kept, else one on the boundary, else the first.
    """
    n = len(fixed)
    graph = coo_array((np.ones(len(doubles)), (doubles[:, 0], doubles[:, 1])), shape=(n, n))
    group = connected_components(graph, directed=False)[1]
    rank = np.where(fixed, 0, np.where(loop >= 0, 1, 2))
    order = np.lexsort((np.arange(n), rank, group))
    kept = order[np.unique(group[order], return_index=True)[1]]
    return group.astype(np.int64), kept
