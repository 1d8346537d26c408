"""The T-mesh that traces and boundary loops cut a surface into.

Traces that come to an end are kept whole. The others, limit cycles, stop where they first meet one
that was there before them, at right angles: all of them grow at one speed, as the motorcycles of
Eppstein et al. 2008.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from solvers.crossings import Crossings
from solvers.errors import CrossviewError
from solvers.surface import TriSurface
from solvers.tmesh import TMesh
from solvers.tracing import (
    BORDER,
    LENGTH,
    NODE,
    QUARTER,
    Chart,
    Chords,
    Node,
    Traces,
)
from solvers.triangulation import BoolArray, FloatArray, IntArray, next_halfedge


class LayoutError(CrossviewError):
    """No layout can be made of a field.

    Parameters
    ----------
    what, where, remedy : str
        As in `CrossviewError`.
    faces : (k,) int array, optional
        Triangles of the field's surface that are to blame.
    """

    def __init__(
        self, what: str, where: str = "", remedy: str = "", faces: IntArray | None = None
    ) -> None:
        super().__init__(what, where, remedy)
        self.faces = np.zeros(0, dtype=np.int64) if faces is None else faces


@dataclass(frozen=True, eq=False)
class Stops:
    """How far each trace is kept.

    Parameters
    ----------
    kept : (k,) bool array
        False for those that another runs along the other way.
    at : (k,) float array
        Length in the map up to which each is kept; infinite if nothing stops it.
    limit_cycle : (k,) bool array
        Whether it stops at a T-junction.
    """

    kept: BoolArray
    at: FloatArray
    limit_cycle: BoolArray


def stops(traces: Traces, crossings: Crossings, longest: float = np.inf) -> Stops:
    """Return how far each trace is kept.

    Parameters
    ----------
    traces, crossings
        The traces and where they cross.
    longest : float, optional
        Traces that are longer, in the map, stop at others even if they come to an end.
    """
    kept = ~_doubled(traces)
    endless = ((traces.ends == LENGTH) | (traces.lengths > longest)) & kept
    at = np.where(endless, np.inf, traces.lengths)
    limit_cycle = np.zeros(len(kept), dtype=bool)
    events = crossings[kept[crossings.trace].all(axis=1) & endless[crossings.trace].any(axis=1)]
    when = np.where(endless[events.trace], events.at, -1.0)
    for i in np.argsort(when.max(axis=1), kind="stable"):
        pair, reached = events.trace[i], events.at[i]
        if (reached > at[pair]).any():
            continue
        later = int(np.lexsort((pair, when[i]))[-1])
        at[pair[later]] = reached[later]
        limit_cycle[pair[later]] = True
    unstopped = endless & ~limit_cycle & (traces.ends != LENGTH)
    at[unstopped] = traces.lengths[unstopped]
    return Stops(kept, at, limit_cycle)


def left_of(crossings: Crossings, stopped: Stops) -> Crossings:
    """Return the crossings of what is kept of traces."""
    left = stopped.kept[crossings.trace].all(axis=1)
    reached = (crossings.at <= stopped.at[crossings.trace]).all(axis=1)
    return crossings[np.flatnonzero(left & reached)]


def _doubled(traces: Traces) -> BoolArray:
    """Return which traces run along another between two nodes, the other way."""
    starts = traces.starts
    number = {key: i for i, key in enumerate(zip(starts.node, starts.slot, strict=True))}
    doubled = np.zeros(len(traces.ends), dtype=bool)
    for i in np.flatnonzero(traces.ends == NODE):
        other = number.get((traces.end_node[i], traces.end_slot[i]), -1)
        if not doubled[i] and other >= 0 and other != i:
            doubled[other] = True
    return doubled


@dataclass(frozen=True, eq=False)
class Curves:
    """Traces and boundary loops alike, as chords.

    Parameters
    ----------
    chart : Chart
        The images.
    chords : Chords
        Curve by curve.
    offsets : (c + 1,) int array
        The chords of curve i are ``offsets[i]`` to ``offsets[i + 1]``.
    """

    chart: Chart
    chords: Chords
    offsets: IntArray

    def chords_at(self, curve: int, at: FloatArray) -> tuple[IntArray, FloatArray]:
        """Return the chords at lengths along a curve, and how far along them, 0 to 1."""
        low, high = self.offsets[curve], self.offsets[curve + 1]
        start, end = self.chords.start[low:high], self.chords.end[low:high]
        at = np.where(at > end[-1], at - end[-1], at)  # arcs of loops may run over their seam
        chord = np.clip(np.searchsorted(start, at, side="right") - 1, 0, high - low - 1)
        length = np.maximum(end[chord] - start[chord], 1e-300)
        return low + chord, np.clip((at - start[chord]) / length, 0.0, 1.0)


def with_loops(traces: Traces, loops: Sequence[IntArray]) -> Curves:
    """Return the traces followed by boundary loops, given as halfedges in order."""
    chart, chords = traces.chart, [traces.chords]
    offsets = list(traces.offsets)
    for number, loop in enumerate(loops, start=len(traces.ends)):
        z = chart.images.reshape(-1)[loop]
        length = np.concatenate([[0.0], np.cumsum(np.abs(z))])
        zero, corner = np.zeros(len(loop)), np.ones(len(loop), dtype=bool)
        axis = np.rint(np.angle(z) / QUARTER).astype(np.int64) % 4
        curve = np.full(len(loop), number)
        sides = loop % 3, next_halfedge(loop) % 3
        ends = length[:-1], length[1:]
        chords.append(
            Chords(curve, loop // 3, axis, sides[0], zero, corner, sides[1], zero, corner, *ends)
        )
        offsets.append(offsets[-1] + len(loop))
    columns = zip(*(vars(c).values() for c in chords), strict=True)
    return Curves(chart, Chords(*(np.concatenate(c) for c in columns)), np.array(offsets))


@dataclass(frozen=True, eq=False)
class Arrangement:
    """A T-mesh and where its arcs lie.

    Parameters
    ----------
    tmesh : TMesh
        The rectangles.
    curves : Curves
        What the arcs are parts of.
    n_traces : int
        How many of the curves are traces; the others are boundary loops.
    arc_curve : (A,) int array
        The curve each arc is part of.
    arc_span : (A, 2) float array
        From where to where along it, in the map.
    node_curve : (N,) int array
        A curve through each node.
    node_at : (N,) float array
        Where along it.
    node_vertex : (N,) int array
        The vertex of the surface at a node that traces start from; -1 for others.
    t_junctions : (t,) int array
        Nodes where a limit cycle was cut.
    """

    tmesh: TMesh
    curves: Curves
    n_traces: int
    arc_curve: IntArray
    arc_span: FloatArray
    node_curve: IntArray
    node_at: FloatArray
    node_vertex: IntArray
    t_junctions: IntArray


def boundary_halfedges(surface: TriSurface) -> tuple[IntArray, ...]:
    """Return the halfedges of each boundary loop, in the order of `TriSurface.boundary_loops`."""
    t = surface.triangulation
    from_vertex = np.full(surface.n_vertices, -1, dtype=np.int64)
    from_vertex[t.tail[t.boundary_halfedges]] = t.boundary_halfedges
    return tuple(from_vertex[loop] for loop in surface.boundary_loops)


def bare_loops(
    loops: Sequence[IntArray], nodes: Sequence[Node], traces: Traces, stopped: Stops
) -> IntArray:
    """Return the numbers of the loops that no trace reaches or leaves."""
    t = traces.chart.triangulation
    last = traces.chords[traces.offsets[1:] - 1]
    hit = (3 * last.face + last.side_out)[stopped.kept & (traces.ends == BORDER)]
    touched = {int(n.vertex) for n in nodes if not n.inner} | set(t.tail[hit].tolist())
    return np.array(
        [i for i, loop in enumerate(loops) if touched.isdisjoint(t.tail[loop].tolist())],
        dtype=np.int64,
    )


class _Builder:
    """Nodes with their slots, and arcs between them, while they are put together."""

    def __init__(self) -> None:
        self.quads: list[int] = []
        self.inner: list[bool] = []
        self.curve: list[int] = []
        self.at: list[float] = []
        self.arcs: list[tuple[int, int, int, int]] = []  # node and slot at both ends
        self.arc_curve: list[int] = []
        self.span: list[tuple[float, float]] = []

    def node(self, quads: int, inner: bool, curve: int, at: float) -> int:
        self.quads.append(quads)
        self.inner.append(inner)
        self.curve.append(curve)
        self.at.append(at)
        return len(self.quads) - 1

    def chain(self, curve: int, stations: list[tuple[float, int, int, int]]) -> None:
        """Add arcs between stations: length, node, slot of the way back and of the way on."""
        for (start, one, _, onwards), (end, other, back, _) in pairwise(stations):
            self.arcs.append((one, onwards, other, back))
            self.arc_curve.append(curve)
            self.span.append((start, end))


def arrange(
    surface: TriSurface,
    nodes: Sequence[Node],
    critical: BoolArray,
    traces: Traces,
    crossings: Crossings,
    stopped: Stops,
) -> Arrangement:
    """Cut a surface along traces and its boundary.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    nodes : sequence of Node
        Where the traces start.
    critical : (N,) bool array
        Which of them are singularities or corners.
    traces, crossings, stopped
        The traces, where they cross and how far they are kept.

    Raises
    ------
    LayoutError
        If a piece is not a rectangle.
    """
    loops = boundary_halfedges(surface)
    curves = with_loops(traces, loops)
    build = _Builder()
    for node in nodes:
        build.node(node.quads, node.inner, -1, 0.0)
    n_traces = len(traces.ends)
    stations: list[list[tuple[float, int, int, int]]] = [[] for _ in curves.offsets[1:]]
    for i in np.flatnonzero(stopped.kept):
        start = int(traces.starts.node[i])
        stations[i].append((0.0, start, -1, int(traces.starts.slot[i])))
        build.curve[start], build.at[start] = int(i), 0.0
    t_junctions = _add_crossings(build, stations, traces, crossings, stopped)
    _add_ends(build, stations, curves, traces, stopped, n_traces, loops)
    _add_corners(build, stations, curves, nodes, n_traces, loops)
    for curve, on_curve in enumerate(stations):
        on_curve.sort(key=lambda station: station[0])
        if curve >= n_traces and on_curve:
            first, length = on_curve[0], curves.chords.end[curves.offsets[curve + 1] - 1]
            on_curve = [*on_curve, (first[0] + length, *first[1:])]
        build.chain(curve, on_curve)
    return _finished(build, curves, nodes, critical, n_traces, t_junctions)


def _add_crossings(
    build: _Builder,
    stations: list[list[tuple[float, int, int, int]]],
    traces: Traces,
    crossings: Crossings,
    stopped: Stops,
) -> IntArray:
    """Add a node for each crossing that is left; return those at which a limit cycle ends."""
    left = left_of(crossings, stopped)
    ending = []
    for pair, chord, at in zip(left.trace, left.chord, left.at, strict=True):
        node = build.node(4, True, int(pair[0]), float(at[0]))
        for i, c, length in zip(pair, chord, at, strict=True):
            axis = int(traces.chords.axis[c])
            stations[i].append((float(length), node, (axis + 2) % 4, axis))
            if stopped.limit_cycle[i] and length == stopped.at[i]:
                ending.append(node)
    return np.array(ending, dtype=np.int64)


def _add_ends(
    build: _Builder,
    stations: list[list[tuple[float, int, int, int]]],
    curves: Curves,
    traces: Traces,
    stopped: Stops,
    n_traces: int,
    loops: Sequence[IntArray],
) -> None:
    """Add where traces end at nodes, or a node where they end at the boundary."""
    on_loop = {
        h: (curve, int(curves.offsets[curve]) + position)
        for curve, loop in enumerate(loops, start=n_traces)
        for position, h in enumerate(loop.tolist())
    }
    chords = curves.chords
    for i in np.flatnonzero(stopped.kept & ~stopped.limit_cycle):
        last = traces.offsets[i + 1] - 1
        length = float(chords.end[last])
        if traces.ends[i] == NODE:
            node, back = int(traces.end_node[i]), int(traces.end_slot[i])
            stations[i].append((length, node, back, -1))
            build.curve[node], build.at[node] = int(i), length
            continue
        h = int(3 * chords.face[last] + chords.side_out[last])
        curve, chord = on_loop[h]
        size = chords.end[chord] - chords.start[chord]
        at = float(chords.start[chord] + chords.t_out[last] * size)
        node = build.node(2, False, curve, at)
        stations[i].append((length, node, 1, -1))
        stations[curve].append((at, node, 2, 0))


def _add_corners(
    build: _Builder,
    stations: list[list[tuple[float, int, int, int]]],
    curves: Curves,
    nodes: Sequence[Node],
    n_traces: int,
    loops: Sequence[IntArray],
) -> None:
    """Add the nodes that lie on the boundary to their loops."""
    number = {node.vertex: i for i, node in enumerate(nodes) if not node.inner}
    tail = curves.chart.triangulation.tail
    for curve, loop in enumerate(loops, start=n_traces):
        start = curves.chords.start[curves.offsets[curve] : curves.offsets[curve + 1]]
        for vertex, at in zip(tail[loop].tolist(), start.tolist(), strict=True):
            if vertex in number:
                i = number[vertex]
                stations[curve].append((at, i, nodes[i].quads, 0))
                build.curve[i], build.at[i] = curve, at


def _finished(
    build: _Builder,
    curves: Curves,
    nodes: Sequence[Node],
    critical: BoolArray,
    n_traces: int,
    t_junctions: IntArray,
) -> Arrangement:
    arcs = np.array(build.arcs, dtype=np.int64).reshape(-1, 4)
    curve = np.array(build.arc_curve, dtype=np.int64)
    span = np.array(build.span, dtype=np.float64).reshape(-1, 2)
    inner = np.array(build.inner, dtype=bool)
    n = len(inner)
    cycles = _cycles(arcs, curve >= n_traces, np.array(build.quads), inner)
    offsets, halfarcs = _as_sides(cycles, curves, curve, span)
    tmesh = TMesh(
        arcs[:, [0, 2]],
        span[:, 1] - span[:, 0],
        curve >= n_traces,
        np.bincount(arcs[:, [0, 2]].reshape(-1), minlength=n),
        np.concatenate([critical, np.zeros(n - len(nodes), dtype=bool)]),
        ~inner,
        offsets,
        halfarcs,
    )
    vertex = np.concatenate([[node.vertex for node in nodes], np.full(n - len(nodes), -1)])
    return Arrangement(
        tmesh,
        curves,
        n_traces,
        curve,
        span,
        np.array(build.curve, dtype=np.int64),
        np.array(build.at),
        vertex.astype(np.int64),
        t_junctions,
    )


def _cycles(
    arcs: IntArray, on_boundary: BoolArray, quads: IntArray, inner: BoolArray
) -> list[list[tuple[int, bool]]]:
    """Return the half-arcs around each piece, with whether it turns by 90 degrees after each."""
    leaving = {}
    for arc, (one, onwards, other, back) in enumerate(arcs.tolist()):
        leaving[one, onwards], leaving[other, back] = 2 * arc, 2 * arc + 1
    following: dict[int, tuple[int, bool]] = {}
    for arc, (one, onwards, other, back) in enumerate(arcs.tolist()):
        for half, node, slot in ((2 * arc, other, back), (2 * arc + 1, one, onwards)):
            if half % 2 and on_boundary[arc]:
                continue  # the surface lies on the other side
            for turn in range(1, quads[node] + 1):
                at = (slot - turn) % quads[node] if inner[node] else slot - turn
                if (node, at) in leaving:
                    break
            if turn > 2 or (node, at) not in leaving:
                raise LayoutError("the separatrices do not cut the surface into rectangles")
            following[half] = leaving[node, at], turn == 1
    cycles = []
    while following:
        half = min(following)
        cycle = []
        while half in following:
            after, corner = following.pop(half)
            cycle.append((half, corner))
            half = after
        cycles.append(cycle)
    return cycles


def _as_sides(
    cycles: list[list[tuple[int, bool]]], curves: Curves, curve: IntArray, span: FloatArray
) -> tuple[IntArray, IntArray]:
    """Return the sides of the pieces, which must be rectangles."""
    offsets, halfarcs = [0], []
    for cycle in cycles:
        corners = [i for i, (_, corner) in enumerate(cycle) if corner]
        if len(corners) != 4:
            faces = curves.chords.face[
                [curves.chords_at(int(curve[h // 2]), span[h // 2])[0][0] for h, _ in cycle]
            ]
            raise LayoutError(
                f"a piece between the separatrices has {len(corners)} corners instead of four",
                faces=faces,
            )
        first = corners[-1] + 1
        for half, corner in cycle[first:] + cycle[:first]:
            halfarcs.append(half)
            if corner:
                offsets.append(len(halfarcs))
    return np.array(offsets, dtype=np.int64), np.array(halfarcs, dtype=np.int64)
