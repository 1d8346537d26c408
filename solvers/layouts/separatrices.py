"""Separatrices: the curves along the cross that leave its singularities and corners."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from solvers.fields.crossfield import CrossField
from solvers.frozen import freeze_arrays
from solvers.layouts.charts import AXES, Chart
from solvers.layouts.crossings import crossings
from solvers.layouts.motorcycles import Stops, stops
from solvers.layouts.nodes import Node, singular_nodes, starts_at
from solvers.layouts.tracing import BORDER, LENGTH, Traces, trace
from solvers.number_checks import real_number
from solvers.surface.triangulation import (
    BoolArray,
    FloatArray,
    IntArray,
    IntrinsicTriangulation,
)
from solvers.surface.trisurface import TriSurface
from solvers.surface.working import weights_inside

SINGULARITY, BOUNDARY, T_JUNCTION, OPEN = range(4)
"""Where a separatrix ends; `OPEN`: nowhere, it was cut for its length."""

LONGEST = 6.0
"""Length at which a curve along a field is given up, in square roots of the area in the map.

Chosen.
"""


@dataclass(frozen=True, eq=False)
class Separatrices:
    """Curves on a surface.

    Parameters
    ----------
    surface : TriSurface
        Where they lie.
    points : (p, 3) float array
        Of all curves, one after the other.
    offsets : (n + 1,) int array
        Curve i is ``points[offsets[i]:offsets[i + 1]]``.
    valences : (n,) int array
        Valence of the singularity each leaves; 0 for a corner, -1 for a seed.
    ends : (n,) int array
        `SINGULARITY` (or a corner), `BOUNDARY`, `T_JUNCTION` (it would wind on, and is cut at its
        first orthogonal crossing) or `OPEN`.

    Examples
    --------
    As many leave a singularity as its valence says; here one of each four three goes outwards:

    >>> from solvers.fields import IsotropicSolver
    >>> from solvers.layouts import field_separatrices
    >>> from solvers.primitives import disk
    >>> from solvers.singularities import Singularity
    >>> surface = disk(edge_length=0.1)
    >>> places = [[0.5, 0, 0], [0, 0.5, 0], [-0.5, 0, 0], [0, -0.5, 0]]
    >>> threes = [Singularity(surface.closest_point(place), 3) for place in places]
    >>> curves = field_separatrices(IsotropicSolver(surface).solve(threes))
    >>> curves.leaving, len(curves.ends), len(curves.t_junctions)
    (12, 8, 0)
    """

    surface: TriSurface
    points: FloatArray
    offsets: IntArray
    valences: IntArray
    ends: IntArray

    def __post_init__(self) -> None:
        freeze_arrays(self)

    @property
    def t_junctions(self) -> FloatArray:
        """(k, 3) where curves that would wind on are cut."""
        return np.asarray(self.points[self.offsets[1:][self.ends == T_JUNCTION] - 1])

    @property
    def leaving(self) -> int:
        """Number of ends at singularities and corners.

        Each curve counts once, or twice if it joins two; those that start from a seed do not.
        """
        own = self.valences >= 0
        return int(np.count_nonzero(own) + np.count_nonzero(self.ends[own] == SINGULARITY))


def as_curves(
    surface: TriSurface, nodes: Sequence[Node], critical: BoolArray, traces: Traces, stopped: Stops
) -> Separatrices:
    """Return traces as curves on the surface they run on.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    nodes : sequence of Node
        Where the traces start.
    critical : (N,) bool array
        Which of them are singularities or corners; the others are seeds.
    traces : Traces
        Any.
    stopped : Stops
        Which of them are kept, and how far.
    """
    chords = traces.chords
    number = np.cumsum(stopped.kept) - 1
    chosen = stopped.kept[chords.trace] & (chords.start < stopped.at[chords.trace])
    chosen[traces.offsets[:-1][stopped.kept]] = True
    left = chords[chosen]
    curve = number[left.trace]
    # A curve cut at a crossing ends inside its last triangle.
    size = np.maximum(left.end - left.start, 1e-300)
    cut = np.clip((stopped.at[left.trace] - left.start) / size, 0.0, 1.0)
    start, end = (
        _places(traces.chart.triangulation, left.face, side, t)
        for side, t in ((left.side_in, left.t_in), (left.side_out, left.t_out))
    )
    working = traces.chart.working
    pieces = working.lift_segments(left.face, start, start + cut[:, None] * (end - start))
    start, end = (_positions(surface, pieces.face, pieces.ends[:, i]) for i in (0, 1))
    curve = curve[pieces.line]
    last = np.flatnonzero(np.diff(curve, append=-1))
    count = np.bincount(curve, minlength=int(stopped.kept.sum())) + 1
    points = np.insert(start, last + 1, end[last], axis=0)
    source = traces.starts.node[stopped.kept]
    valence = np.array([n.quads if n.inner else 0 for n in nodes], dtype=np.int64)
    valence[~np.asarray(critical, dtype=bool)] = -1
    ends = np.array([SINGULARITY, BOUNDARY, OPEN])[traces.ends]
    ends[stopped.cut] = T_JUNCTION
    offsets = np.concatenate([[0], np.cumsum(count)])
    return Separatrices(surface, points, offsets, valence[source], ends[stopped.kept])


def _places(
    triangulation: IntrinsicTriangulation, face: IntArray, side: IntArray, t: FloatArray
) -> FloatArray:
    """Return places (c, 2) on sides of triangles, in their frames."""
    tail = triangulation.corner_positions[face, side]
    head = triangulation.corner_positions[face, (side + 1) % 3]
    return np.asarray(tail + t[:, None] * (head - tail))


def _positions(surface: TriSurface, face: IntArray, place: FloatArray) -> FloatArray:
    """Return places (c, 3) given in the frames of triangles."""
    weights = weights_inside(surface.triangulation, face, place)
    return np.asarray(np.einsum("ki,kij->kj", weights, surface.vertices[surface.faces[face]]))


def field_separatrices(field: CrossField, longest: float = LONGEST) -> Separatrices:
    """Return the separatrices of any cross-field, traced along the crosses of its triangles.

    Fast, and good for pictures: a curve that comes to the triangles around a singularity is taken
    to meet it, and one that comes to the boundary along it, not across, to wind for ever.

    Parameters
    ----------
    field : CrossField
        Integrable or not, aligned or not.
    longest : float, optional
        Length at which a curve is given up, in square roots of the area, in the field's own sizes.

    Returns
    -------
    Separatrices
        On the field's surface.

    Raises
    ------
    CrossviewError
        Unless the length is a positive number.

    Examples
    --------
    From a corner of 90 degrees no curve leaves but the boundary, from one of 270 two do:

    >>> from solvers.fields import IsotropicSolver
    >>> from solvers.layouts import field_separatrices
    >>> from solvers.primitives import l_shape, square
    >>> field_separatrices(IsotropicSolver(square(n=4)).solve([])).leaving
    0
    >>> field_separatrices(IsotropicSolver(l_shape(edge_length=0.5)).solve([])).leaving
    2
    """
    chart = Chart.of_field(field)
    nodes = singular_nodes(chart, field)
    reach = real_number("the length of separatrices", longest, above=0) * np.sqrt(chart.area)
    traces = trace(chart, nodes, starts_at(chart, nodes), chart.edge_length, reach)
    traces = replace(traces, ends=np.where(_along_boundary(traces), LENGTH, traces.ends))
    stopped = stops(traces, crossings(chart, traces.chords))
    curves = as_curves(field.surface, nodes, np.ones(len(nodes), dtype=bool), traces, stopped)
    # A singularity inside a triangle was taken to be at the nearest vertex.
    place = field.surface.vertices[[node.vertex for node in nodes]]
    place[: len(field.singularities)] = field.surface.positions(
        [s.point for s in field.singularities]
    )
    kept, points = stopped.kept, curves.points.copy()
    points[curves.offsets[:-1]] = place[traces.starts.node[kept]]
    met = curves.ends == SINGULARITY
    points[curves.offsets[1:][met] - 1] = place[traces.end_node[kept][met]]
    return replace(curves, points=points)


def _along_boundary(traces: Traces) -> BoolArray:
    """Return which traces (k,) end at the boundary at less than half a right angle to it."""
    last = traces.chords[traces.offsets[1:] - 1]
    side = traces.chart.images[last.face, last.side_out]
    slope = np.abs((AXES[last.axis] / side).real) > np.sqrt(0.5) / np.abs(side)
    return np.asarray((traces.ends == BORDER) & ~last.corner_out & slope)
