"""The quad layout of a field: separatrices in its seamless map, and the T-mesh between them."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import coo_array, csc_array, vstack
from scipy.sparse.csgraph import dijkstra

from solvers.aligned import IntegratedField
from solvers.arrangement import (
    Arrangement,
    LayoutError,
    Stops,
    arrange,
    bare_loops,
    boundary_halfedges,
    left_of,
    stops,
)
from solvers.connections import best_turn, conditions, passing
from solvers.crossings import crossings
from solvers.patches import PatchMesh, sampled
from solvers.progress import Progress
from solvers.seamless import SeamlessFit
from solvers.separatrices import Separatrices, as_curves, singular_nodes
from solvers.surface import TriSurface
from solvers.tmesh import TMesh
from solvers.tracing import Chart, Node, node_at, starts_at, trace
from solvers.triangulation import BoolArray, FloatArray, IntArray

EXACT = 1e-6
"""How far beside a node a trace meets it, in typical edges of the map."""

LONGEST, SHORTEST = 4.0, 0.06
"""Length at which a trace counts as a limit cycle, in diameters of the map, and the least to which
it is reduced where the layout would become too fine."""

SHORT = 1.5
"""Length of traces, in diameters, while the map is turned and joined."""

CROSSINGS = 5
"""Crossings for each trace, beside a hundred for all, that make a layout too fine."""

JOININGS = 4
"""How often the map is fitted again so that separatrices meet the nodes they nearly meet."""

SPOILT = 0.03
"""Distance of a map from what the field asks for beyond which separatrices are not joined."""

MISALIGNED = 1e-4
"""Angle between the cross and the boundary, radians, beyond which there is no layout."""

NOT_INTEGRABLE = 0.01
"""E beyond which there is no layout."""


@dataclass(frozen=True, eq=False)
class QuadLayout:
    """A surface cut into rectangles along the separatrices of its field.

    Parameters
    ----------
    integrated : IntegratedField
        The field.
    arrangement : Arrangement
        The rectangles and where their arcs lie.
    separatrices : Separatrices
        As curves on the surface, seeds included.
    flips : int
        Triangles turned over in the map.
    mended : int
        Triangles made stiffer so that they are not.
    turned : float
        Angle by which all crosses were turned, radians; 0 where the boundary fixes them.
    """

    integrated: IntegratedField
    arrangement: Arrangement
    separatrices: Separatrices
    flips: int
    mended: int
    turned: float

    @property
    def surface(self) -> TriSurface:
        """What is cut."""
        return self.separatrices.surface

    @property
    def tmesh(self) -> TMesh:
        """The rectangles."""
        return self.arrangement.tmesh

    @property
    def patches(self) -> int:
        """Number of rectangles."""
        return self.tmesh.n_rectangles

    @property
    def t_junctions(self) -> FloatArray:
        """(t, 3) places where a limit cycle was cut."""
        return self.separatrices.t_junctions

    @property
    def limit_cycles(self) -> int:
        """Number of separatrices that are limit cycles."""
        return self.separatrices.limit_cycles

    @cached_property
    def patch_mesh(self) -> PatchMesh:
        """The rectangles, sampled for pictures."""
        return sampled(self.surface, self.arrangement)

    @property
    def conforming(self) -> bool:
        """Whether there is no T-junction."""
        return self.limit_cycles == 0


def quad_layout(integrated: IntegratedField) -> Generator[Progress, None, QuadLayout]:
    """Cut a surface into rectangles along the separatrices of a field.

    Boundaries that no separatrix reaches, and surfaces without any, get further curves.

    Parameters
    ----------
    integrated : IntegratedField
        Aligned with the boundary and integrable.

    Returns
    -------
    QuadLayout

    Raises
    ------
    LayoutError
        The field is not aligned or not integrable, or its map has triangles turned over.
    """
    _require_integrable(integrated)
    yield Progress("fitting the seamless map", 0.0)
    map_ = _Map(integrated)
    yield Progress("tracing separatrices", 0.4)
    drawing = _Drawing(map_, singular_nodes(map_.chart, integrated.field), SHORT)
    if map_.may_turn:
        map_.turn(best_turn(drawing.traces, drawing.crossings))
        drawing = drawing.again()
    for _ in range(JOININGS):
        found = drawing.passing
        yield Progress("joining separatrices", 0.6)
        if not len(found) or not map_.join(conditions(drawing.traces, found, map_.turned)):
            break
        drawing = drawing.again()
    map_.require_upright()
    yield Progress("cutting into rectangles", 0.8)
    drawing = drawing.again(LONGEST)
    while (seed := drawing.missing()) is not None:
        drawing = drawing.seeded(*seed)
    return drawing.layout()


def _require_integrable(integrated: IntegratedField) -> None:
    field = integrated.field
    worst = float(np.abs(field.boundary_misalignment).max(initial=0.0))
    if worst > MISALIGNED:
        raise LayoutError(
            f"the field misses a boundary by {np.degrees(worst):.3g} degrees",
            remedy="make the configuration valid, or solve the anisotropic field",
        )
    if field.energy > NOT_INTEGRABLE:
        raise LayoutError(
            f"the field is not integrable, E = {field.energy:.2g}",
            remedy="make the configuration valid, or solve the anisotropic field",
        )


class _Map:
    """The seamless map of a field while it is turned and joined."""

    def __init__(self, integrated: IntegratedField) -> None:
        self.integrated = integrated
        self._integrability = integrated.aligned.integrability
        self._fit = SeamlessFit(self._integrability, integrated.x)
        self._rows: csc_array | None = None
        self.turned = 0.0
        self.chart = self._chart()

    @property
    def surface(self) -> TriSurface:
        return self.integrated.field.surface

    @property
    def may_turn(self) -> bool:
        """Whether nothing fixes the direction of the crosses, and turned ones are as good."""
        aspect = self.integrated.field.half_log_aspect
        return not self.surface.boundary_loops and not aspect.any()

    @property
    def mended(self) -> int:
        return self._fit.mended

    @property
    def flipped(self) -> IntArray:
        return self._fit.map.flipped

    def turn(self, angle: float) -> None:
        """Turn all crosses."""
        self.turned = angle
        self.chart = self._chart()

    def join(self, rows: csc_array) -> bool:
        """Fit the map again so that also combinations of images vanish: of the first as many rows
        as do not spoil it. Return whether it was.
        """
        before = self._fit
        allowed = max(SPOILT, 2 * before.map.distance)
        count = rows.shape[0]
        while count:
            more = rows[:count]
            joined = more if self._rows is None else csc_array(vstack([self._rows, more]))
            fit = before.joined(joined)
            if len(fit.map.flipped) <= len(before.map.flipped) and fit.map.distance < allowed:
                self._rows, self._fit = joined, fit
                self.chart = self._chart()
                return True
            count //= 2
        return False

    def _chart(self) -> Chart:
        images = self._fit.map.images @ np.array([1, 1j]) * np.exp(-1j * self.turned)
        return Chart(self.surface.triangulation, images, self._integrability.quarter_turns)

    def require_upright(self) -> None:
        """Raise `LayoutError` if triangles are turned over."""
        over = self.flipped
        if len(over) == 0:
            return
        field = self.integrated.field
        places = field.surface.positions([s.point for s in field.singularities])
        where = ""
        if len(places):
            gaps = np.linalg.norm(field.surface.barycentres[over][:, None] - places, axis=2)
            near = np.unique(gaps.argmin(axis=1)) + 1
            where = "near " + ", ".join(f"singularity {n}" for n in near[:4])
        which = "1 triangle is" if len(over) == 1 else f"{len(over)} triangles are"
        raise LayoutError(
            f"{which} turned over in the seamless map",
            where,
            "move these singularities apart or refine more around them",
            faces=over,
        )


class _Drawing:
    """Traces from nodes in a map as it was."""

    def __init__(self, map_: _Map, nodes: Sequence[Node], longest: float, n_seeds: int = 0) -> None:
        self._map = map_
        self._nodes = list(nodes)
        self._longest = longest
        self._n_seeds = n_seeds
        chart = map_.chart
        self._diameter = _diameter(chart)
        starts = starts_at(chart, nodes)
        length = longest * self._diameter
        self.traces = trace(chart, nodes, starts, EXACT * chart.edge_length, length)
        self.crossings = crossings(chart, self.traces.chords)

    @cached_property
    def _stops(self) -> Stops:
        """How far the traces are kept: as far as the layout does not become too fine."""
        longest = LONGEST
        while True:
            stopped = stops(self.traces, self.crossings, longest * self._diameter)
            count = len(left_of(self.crossings, stopped))
            if longest < SHORTEST or count <= 100 + CROSSINGS * len(stopped.kept):
                return stopped
            longest /= 2

    @property
    def passing(self) -> IntArray:
        """Which traces pass nodes too closely, as `connections.passing`."""
        return passing(self.traces, self.crossings, len(self._nodes))

    @property
    def _critical(self) -> BoolArray:
        return np.arange(len(self._nodes)) < len(self._nodes) - self._n_seeds

    def again(self, longest: float | None = None) -> _Drawing:
        """Return the same in the map as it is now, perhaps with longer traces."""
        nodes = [node_at(self._map.chart, n.vertex, n.quads) for n in self._nodes]
        return _Drawing(self._map, nodes, longest or self._longest, self._n_seeds)

    def seeded(self, vertex: int, quads: int) -> _Drawing:
        """Return the same with traces from one more vertex."""
        nodes = [*self._nodes, node_at(self._map.chart, vertex, quads)]
        return _Drawing(self._map, nodes, self._longest, self._n_seeds + 1)

    def missing(self) -> tuple[int, int] | None:
        """Return where traces are missing, and the number of quads that meet there."""
        loops = boundary_halfedges(self._map.surface)
        if not loops and not self._nodes:
            return 0, 4  # a torus without singularities
        bare = bare_loops(loops, self._nodes, self.traces, self._stops)
        if not len(bare):
            return None
        return int(self._map.surface.boundary_loops[bare[0]][0]), 2

    def layout(self) -> QuadLayout:
        """Return the rectangles between the traces."""
        surface = self._map.surface
        arrangement = arrange(
            surface, self._nodes, self._critical, self.traces, self.crossings, self._stops
        )
        curves = as_curves(surface, self._nodes, self._critical, self.traces, self._stops)
        return QuadLayout(
            self._map.integrated,
            arrangement,
            curves,
            len(self._map.flipped),
            self._map.mended,
            self._map.turned,
        )


def _diameter(chart: Chart) -> float:
    """Return about the largest distance between vertices in a map."""
    t = chart.triangulation
    h = t.edge_halfedges
    length = np.abs(chart.images.reshape(-1)[h])
    graph = coo_array((length, (t.tail[h], t.head[h])), shape=(t.n_vertices, t.n_vertices))
    far = dijkstra(graph.tocsr(), directed=False, indices=0).argmax()
    return float(dijkstra(graph.tocsr(), directed=False, indices=far).max())
