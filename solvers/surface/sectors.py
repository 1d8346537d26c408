"""Sectors: what marked edges and the boundary cut the neighbourhoods of vertices into."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from solvers.surface.triangulation import (
    BoolArray,
    IntArray,
    IntrinsicTriangulation,
    next_halfedge,
)


def corner_sectors(triangulation: IntrinsicTriangulation, marked: BoolArray) -> IntArray:
    """Return the sector that each corner of a triangulation lies in.

    Parameters
    ----------
    triangulation : IntrinsicTriangulation
        The triangles.
    marked : (3 m,) bool array
        Which halfedges lie on marked edges, both of each; the boundary is marked anyway.

    Returns
    -------
    (3 m,) int array
        The sector of the corner that each halfedge starts at, numbered from 0.

    Examples
    --------
    Without marked edges each vertex has one sector:

    >>> import numpy as np
    >>> from solvers.primitives import square
    >>> from solvers.surface import corner_sectors
    >>> t = square(n=4).triangulation
    >>> sector = corner_sectors(t, np.zeros(len(t.twin), dtype=bool))
    >>> int(sector.max()) + 1 == t.n_vertices
    True
    """
    t = triangulation
    h = np.flatnonzero(~marked & (t.twin >= 0))
    graph = coo_array(
        (np.ones(len(h), dtype=np.int8), (h, next_halfedge(t.twin[h]))),
        shape=(len(t.twin), len(t.twin)),
    )
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)
