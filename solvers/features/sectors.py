"""What curves cut the neighbourhoods of vertices into: the sectors between them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solvers.frozen import freeze_arrays
from solvers.surface.sectors import corner_sectors
from solvers.surface.triangulation import (
    FloatArray,
    IntArray,
    IntrinsicTriangulation,
    previous_halfedge,
)


@dataclass(frozen=True, eq=False)
class Sectors:
    """The sectors of all vertices, counter-clockwise from an edge of the network to the next.

    The network is given edges and the boundary; a vertex off it is in one sector that none bounds.

    Parameters
    ----------
    of_corner : (3 m,) int array
        The sector of each halfedge's first corner.
    vertex : (s,) int array
        The vertex of each.
    angle : (s,) float array
        The sum of its corners' angles, radians.
    corners : (s,) int array
        How many corners of triangles it has.
    start, end : (s,) int array
        The given edges that bound it, by their positions; -1 for the boundary, or none.

    Examples
    --------
    A line through the middle of a square cuts half the angle off at vertices on it:

    >>> import numpy as np
    >>> from solvers.features import sectors_between
    >>> from solvers.primitives import square
    >>> t = square(n=4).triangulation  # the vertices 10 to 14 lie on the x axis
    >>> row = np.isin(t.tail, range(10, 14)) & (t.head == t.tail + 1)
    >>> found = sectors_between(t, np.flatnonzero(row))
    >>> np.degrees(found.angle[found.vertex == 12]).round(6).tolist()
    [180.0, 180.0]
    """

    of_corner: IntArray
    vertex: IntArray
    angle: FloatArray
    corners: IntArray
    start: IntArray
    end: IntArray

    def __post_init__(self) -> None:
        freeze_arrays(self)

    def total(self, values: FloatArray) -> FloatArray:
        """Return sums over the corners of each sector.

        Parameters
        ----------
        values : (3 m,) or (m, 3) float array
            A value for each halfedge's first corner.

        Returns
        -------
        (s,) float array
        """
        return np.asarray(np.bincount(self.of_corner, values.reshape(-1), len(self.vertex)))


def sectors_between(triangulation: IntrinsicTriangulation, halfedges: IntArray) -> Sectors:
    """Return the sectors between edges of a triangulation and its boundary.

    Parameters
    ----------
    triangulation : IntrinsicTriangulation
        Where.
    halfedges : (k,) int array
        One of each edge, none on the boundary.

    Returns
    -------
    Sectors
        In no particular order.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers.features import sectors_between
    >>> from solvers.primitives import square
    >>> found = sectors_between(square(n=4).triangulation, np.array([], dtype=int))
    >>> len(found.vertex), np.degrees(found.angle.min()).round(6)  # one a vertex
    (25, np.float64(90.0))
    """
    t = triangulation
    edge = np.full(len(t.twin), -1, dtype=np.int64)
    edge[halfedges] = edge[t.twin[halfedges]] = np.arange(len(halfedges))
    sector = corner_sectors(t, edge >= 0)
    count = int(sector.max(initial=-1)) + 1
    vertex, start, end = np.full((3, count), -1, dtype=np.int64)
    vertex[sector] = t.tail
    # A sector reaches from the halfedge that starts it to the twin of that which ends it.
    last = edge[previous_halfedge(np.arange(len(edge)))]
    start[sector[edge >= 0]] = edge[edge >= 0]
    end[sector[last >= 0]] = last[last >= 0]
    angle = np.asarray(np.bincount(sector, t.angles.reshape(-1), count), dtype=np.float64)
    return Sectors(sector, vertex, angle, np.bincount(sector, minlength=count), start, end)
