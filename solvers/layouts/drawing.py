"""The traces that are to become the arcs of a layout."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np
from scipy.sparse import csr_array

from solvers.layouts.arrangement import Arrangement, arrange
from solvers.layouts.connections import beside, conditions, ending, passing
from solvers.layouts.crossings import crossings
from solvers.layouts.curves import bare_loops, boundary_halfedges
from solvers.layouts.joined_map import JoinedMap
from solvers.layouts.meetings import meeting_traces
from solvers.layouts.motorcycles import Stops, left_of, stops
from solvers.layouts.nodes import Node, node_at
from solvers.layouts.rims import with_rims
from solvers.layouts.separatrices import Separatrices, as_curves
from solvers.layouts.tracing import BORDER, LENGTH

LONGEST = 4.0
"""Length at which a trace counts as winding on and on, in diameters of the map. Chosen."""

AT_FIRST = 5e5
"""Crossings, about twice as many as are expected, up to which traces are followed at first: many
are given up before they wind. Chosen: some hundred bytes each.
"""

LENGTHS = LONGEST * 0.5 ** np.arange(8)
"""The same, and to what it is reduced where the layout would become too fine. Chosen."""

CROSSINGS = 2
"""Crossings for each trace, beside a hundred for all, that make a layout too fine. Chosen."""


class Drawing:
    """Traces from nodes, in a map as it was when they were traced.

    Parameters
    ----------
    map_ : JoinedMap
        The map.
    singular, featured, seeds : sequence of Node
        Singularities and corners, the ends of feature curves, and where else traces start.
    longest : float
        Length at which traces are given up, in diameters of the map.
    """

    def __init__(
        self,
        map_: JoinedMap,
        singular: Sequence[Node],
        featured: Sequence[Node],
        longest: float,
        seeds: Sequence[Node] = (),
    ) -> None:
        self._map = map_
        self._singular, self._featured, self._seeds = singular, featured, seeds
        self._nodes = nodes = [*singular, *featured, *seeds]
        self._longest = longest
        chart = map_.chart
        far = longest * chart.diameter
        reach = np.sqrt(AT_FIRST * chart.area) / max(sum(len(n.slots) for n in nodes), 1)
        while True:
            self.traces = meeting_traces(chart, nodes, min(reach, far))
            self.crossings = crossings(chart, self.traces.chords)
            if reach >= far or longest < LONGEST or not self._dangling:
                break
            reach *= 2

    @property
    def _dangling(self) -> bool:
        """Whether a trace was given up before it met another."""
        stopped = stops(self.traces, self.crossings)
        given_up = stopped.kept & (self.traces.ends == LENGTH)
        return bool((given_up & ~stopped.cut).any())

    @cached_property
    def _stops(self) -> Stops:
        """How far the traces are kept: as far as the layout does not become too fine."""
        uncut = np.inf
        for longest in self.traces.chart.diameter * LENGTHS:
            if uncut <= longest:
                continue  # cuts none of them either
            stopped = stops(self.traces, self.crossings, longest)
            if len(left_of(self.crossings, stopped)) <= 100 + CROSSINGS * len(stopped.kept):
                break
            at_border = stopped.kept & (self.traces.ends == BORDER) & ~stopped.cut
            uncut = self.traces.lengths[at_border].max(initial=0.0)
        return stopped

    def offsets(self) -> csr_array:
        """Return how far nodes that traces pass too closely are off them, as rows of the map."""
        loops = boundary_halfedges(self._map.chart, self._map.surface)
        rimmed = with_rims(self.traces, self._nodes, loops)
        same = rimmed is self.traces
        crossed = self.crossings if same else crossings(rimmed.chart, rimmed.chords)
        found = passing(rimmed, crossed, len(self._nodes))
        return conditions(rimmed, found)

    def loose_ends(self) -> csr_array:
        """Return how far nodes where traces end are off them, where it is more than rounding."""
        return ending(self.traces, beside(self.traces))

    def again(self, longest: float | None = None) -> Drawing:
        """Return the same in the map as it is now, perhaps with longer traces."""
        singular, featured, seeds = (
            [node_at(self._map.chart, n.vertex, n.quads) for n in nodes]
            for nodes in (self._singular, self._featured, self._seeds)
        )
        return Drawing(self._map, singular, featured, longest or self._longest, seeds)

    def seeded(self, vertex: int, quads: int) -> Drawing:
        """Return the same with traces from one more vertex."""
        seeds = [*self._seeds, node_at(self._map.chart, vertex, quads)]
        return Drawing(self._map, self._singular, self._featured, self._longest, seeds)

    def missing(self) -> tuple[int, int] | None:
        """Return where traces are missing, and the number of quads that meet there."""
        loops = boundary_halfedges(self._map.chart, self._map.surface)
        if not loops and not self._nodes:
            return 0, 4  # a torus without singularities
        bare = bare_loops(loops, self._nodes, self.traces, self._stops)
        if not len(bare):
            return None
        return int(self._map.surface.boundary_loops[bare[0]][0]), 2

    def arrangement(self) -> Arrangement:
        """Return the rectangles between the traces."""
        n_critical = len(self._singular) + len(self._featured)
        critical = np.arange(len(self._nodes)) < n_critical
        return arrange(
            self._map.surface, self._nodes, critical, self.traces, self.crossings, self._stops
        )

    def separatrices(self) -> Separatrices:
        """Return the traces as curves on the surface."""
        own = np.arange(len(self._nodes)) < len(self._singular)
        return as_curves(self._map.surface, self._nodes, own, self.traces, self._stops)
