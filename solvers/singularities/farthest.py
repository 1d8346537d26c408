"""Places on a surface that are far from what is there."""

from __future__ import annotations

from collections.abc import Generator, Sequence

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from solvers.number_checks import whole_number
from solvers.progress import Progress
from solvers.singularities.budget import Singularity, checked_singularities
from solvers.surface.points import SurfacePoint
from solvers.surface.trisurface import TriSurface


def far_points(
    surface: TriSurface, singularities: Sequence[Singularity], count: int
) -> Generator[Progress, None, tuple[SurfacePoint, ...]]:
    """Place points far from the boundary, from singularities and from each other.

    Each is the vertex farthest, along edges, from all that came before (Gonzalez 1985); on a closed
    surface without singularities the first is the vertex farthest from the centroid.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    singularities : sequence of Singularity
        What is there.
    count : int
        How many points.

    Returns
    -------
    tuple of SurfacePoint
        At vertices; the result of the computation, for `solvers.run`.

    Raises
    ------
    CrossviewError
        If a singularity is something else or of another surface, or the count no whole number.

    Examples
    --------
    >>> from solvers import run
    >>> from solvers.primitives import disk
    >>> from solvers.singularities import far_points
    >>> surface = disk(edge_length=0.1)
    >>> (middle,) = run(far_points(surface, [], count=1))
    >>> surface.position(middle).tolist()
    [0.0, 0.0, 0.0]
    """
    count = whole_number("the number of points", count, 0)
    graph = _edge_graph(surface)
    used = [surface.nearest_vertex(s.point) for s in checked_singularities(singularities)]
    sources = np.concatenate([*surface.boundary_loops, np.asarray(used, dtype=np.int64)])
    if sources.size:
        distance = dijkstra(graph, indices=np.unique(sources).astype(np.int64), min_only=True)
    else:
        distance = np.linalg.norm(surface.vertices - surface.vertices.mean(axis=0), axis=1)
    chosen: list[int] = []
    for k in range(count):
        yield Progress("placing singularities", k / count)
        chosen.append(int(np.argmax(distance)))
        from_new = dijkstra(graph, indices=chosen[-1])
        distance = np.minimum(distance, from_new) if chosen[1:] or sources.size else from_new
    return tuple(surface.point_at_vertex(vertex) for vertex in chosen)


def _edge_graph(surface: TriSurface) -> csr_array:
    start, end = surface.edges[:, 0], surface.edges[:, 1]
    length = np.linalg.norm(surface.vertices[end] - surface.vertices[start], axis=1)
    n = surface.n_vertices
    both = (np.concatenate([start, end]), np.concatenate([end, start]))
    return csr_array((np.concatenate([length, length]), both), shape=(n, n))
