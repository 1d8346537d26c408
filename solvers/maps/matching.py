"""What every seamless map of a field keeps: how its crosses meet over edges and around vertices."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from solvers.fields.integrability import Integrability
from solvers.frozen import freeze_arrays, frozen_property
from solvers.surface.sectors import corner_sectors
from solvers.surface.triangulation import (
    QUARTER,
    BoolArray,
    IntArray,
    IntrinsicTriangulation,
    previous_halfedge,
)
from solvers.surface.working import WorkingTriangulation

FREE = -1
"""Axis of halfedges that no map keeps straight."""


@dataclass(frozen=True, eq=False)
class Matching:
    """The topology of a field on a triangulation.

    Parameters
    ----------
    working : WorkingTriangulation
        The triangles; its marked edges are those that crosses are aligned with.
    period_jumps : (3 m,) int array
        Quarter turns from the cross of each halfedge's triangle to that of its twin's.
    axes : (3 m,) int array
        Direction of each halfedge on an aligned edge or the boundary against the cross of its
        triangle, 0 to 3 quarter turns; `FREE` for the others.
    sector : (3 m,) int array
        As of `corner_sectors`, between aligned edges.
    quads : (s,) int array
        Quads that meet in each sector: the field turns by as many quarter turns.

    Examples
    --------
    Four valences 3 in a disk; at every other vertex, four quads inside and two on the boundary:

    >>> import numpy as np
    >>> from solvers.fields import aligned_field, prepare
    >>> from solvers.maps import Matching
    >>> from solvers.primitives import disk
    >>> from solvers.singularities import Singularity
    >>> surface = disk(edge_length=0.1)
    >>> places = [[0.5, 0, 0], [0, 0.5, 0], [-0.5, 0, 0], [0, -0.5, 0]]
    >>> threes = [Singularity(surface.closest_point(place), 3) for place in places]
    >>> matching = Matching.of(aligned_field(prepare(surface, threes)).integrability)
    >>> np.unique(matching.quads).tolist(), int((matching.quads == 3).sum())
    ([2, 3, 4], 4)
    """

    working: WorkingTriangulation
    period_jumps: IntArray
    axes: IntArray
    sector: IntArray
    quads: IntArray

    def __post_init__(self) -> None:
        freeze_arrays(self)

    @classmethod
    def of(cls, integrability: Integrability) -> Matching:
        """Return that of the initial field of an integrability problem.

        Parameters
        ----------
        integrability : Integrability
            The problem; every field of it has the same.
        """
        i, t = integrability, integrability.triangulation
        offset = i.offsets.reshape(-1)
        aligned = np.zeros(len(t.twin), dtype=bool)
        aligned[t.edge_halfedges[i.aligned_edges]] = True
        aligned |= aligned[t.twin] & (t.twin >= 0)
        angle = t.directions - np.repeat(i.theta, 3) - offset
        axes = np.where(aligned, np.rint(angle / QUARTER).astype(np.int64) % 4, FREE)
        sector = corner_sectors(t, aligned)
        # By how much the crosses turn against each corner's sides, from the first to the second.
        turned = t.angles.reshape(-1) + offset - offset[previous_halfedge(np.arange(len(t.twin)))]
        quads = np.rint(np.bincount(sector, turned) / QUARTER).astype(np.int64)
        working = replace(i.discretization.working, marks=aligned[None].astype(np.int64))
        return cls(working, i.period_jumps, axes, sector, quads)

    @property
    def triangulation(self) -> IntrinsicTriangulation:
        """The triangles."""
        return self.working.triangulation

    @property
    def aligned(self) -> BoolArray:
        """(3 m,) which halfedges lie on aligned edges or the boundary."""
        return np.asarray(self.axes != FREE)

    @frozen_property
    def vertex(self) -> IntArray:
        """(s,) the vertex of each sector."""
        vertex = np.empty(len(self.quads), dtype=np.int64)
        vertex[self.sector] = self.triangulation.tail
        return vertex
