"""Regions: what features cut a surface into."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from solvers.features.edges import Features
from solvers.surface.points import SurfacePoint
from solvers.surface.triangulation import BoolArray, IntArray


def face_regions(features: Features) -> IntArray:
    """Return the region that each triangle is in.

    Parameters
    ----------
    features : Features
        Of a surface of m triangles.

    Returns
    -------
    (m,) int array
        Numbered from 0; triangles beside each other across no feature share theirs.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers.features import Features, face_regions
    >>> from solvers.primitives import square
    >>> surface = square(n=4, size=2.0)
    >>> on_axis = (surface.vertices[surface.edges][:, :, 1] == 0).all(axis=1)
    >>> features = Features(surface, np.flatnonzero(on_axis))
    >>> upper = surface.barycentres[:, 1] > 0
    >>> len(set(face_regions(features)[upper])), len(set(face_regions(features)))
    (1, 2)
    """
    surface = features.surface
    uncrossed = surface.edge_faces[:, 1] >= 0
    uncrossed[features.edges] = False
    one, other = surface.edge_faces[uncrossed].T
    m = surface.n_faces
    joins = coo_array((np.ones(len(one), dtype=np.int8), (one, other)), shape=(m, m))
    return np.asarray(connected_components(joins, directed=False)[1], dtype=np.int64)


def in_one_region(features: Features, points: Sequence[SurfacePoint]) -> BoolArray:
    """Return which points lie in the same region.

    Parameters
    ----------
    features : Features
        Of a surface.
    points : sequence of SurfacePoint
        On it.

    Returns
    -------
    (k, k) bool array
        False for points on features.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers.features import Features, in_one_region
    >>> from solvers.primitives import square
    >>> surface = square(n=4, size=2.0)
    >>> on_axis = (surface.vertices[surface.edges][:, :, 1] == 0).all(axis=1)
    >>> features = Features(surface, np.flatnonzero(on_axis))
    >>> points = [surface.closest_point([0.1, y, 0.0]) for y in (0.0, 0.1, 0.9, -0.1)]
    >>> in_one_region(features, points).sum(axis=1).tolist()
    [0, 2, 2, 1]
    """
    surface = features.surface
    face = np.array([point.face for point in points], dtype=np.int64)
    weights = np.array([point.barycentric for point in points]).reshape(-1, 3)
    on_feature = np.zeros(surface.n_vertices, dtype=bool)
    on_feature[features.ends] = True
    at_vertex = (weights == 1) & on_feature[surface.faces[face]]
    # The side from corner c to c + 1 is where the weight of c + 2 is 0.
    along = np.isin(surface.face_edges[face], features.edges)
    on_side = (weights[:, [2, 0, 1]] == 0) & along
    free = ~(at_vertex | on_side).any(axis=1)
    region = face_regions(features)[face]
    return np.asarray((region[:, None] == region) & free[:, None] & free)
