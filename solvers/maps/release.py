"""Which feature curves to give up first where a field has no map that is injective.

Features cut the surface into pieces. What is wrong with a map, or with a field that has none, shows
in which pieces it fails. Curves beside these come first, those of least value first.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from solvers.fields.aligned import IntegratedField
from solvers.fields.feature_values import curve_values, edge_values
from solvers.fields.integrability import Integrability
from solvers.fields.sector_quads import chained
from solvers.maps.closed_images import SeamlessMap
from solvers.maps.matching import Matching
from solvers.surface.triangulation import BoolArray, FloatArray, IntArray, IntrinsicTriangulation

MUCH = 0.5
"""Part of the largest error of a triangle from which on it is one of the worst. Chosen."""


def by_release(
    integrated: IntegratedField, map_: SeamlessMap | None = None
) -> tuple[IntArray, ...]:
    """Return the curves that a field follows in the order in which to release them.

    They are cut where they turn sharply, at junctions and at singularities, so that of a curve that
    is too long an end may go. First come those beside pieces of the surface, between features, in
    which the map has an inverted triangle or a vertex that it winds wrongly around; without a map,
    in which the error is largest. Among both the first are those of least value, as of
    `curve_values`.

    Parameters
    ----------
    integrated : IntegratedField
        The field.
    map_ : SeamlessMap, optional
        Of the field, where it has one.

    Returns
    -------
    tuple of (k,) int arrays
        The edges of the surface solved on in each.

    Examples
    --------
    Three curves across a square, and nothing wrong; the shortest goes first:

    >>> import numpy as np
    >>> from solvers.features import Features
    >>> from solvers.fields import IntegratedField, aligned_field, prepare
    >>> from solvers.maps import by_release
    >>> from solvers.primitives import square
    >>> surface = square(n=4)
    >>> y = surface.vertices[surface.edges][:, :, 1]
    >>> on = np.flatnonzero((np.abs(y) < 0.3).all(axis=1) & (y[:, 0] == y[:, 1]))
    >>> aligned = aligned_field(prepare(surface, features=Features(surface, on[1:])))
    >>> [len(edges) for edges in by_release(IntegratedField(aligned, aligned.start))]
    [3, 4, 4]
    """
    aligned = integrated.aligned
    i, d = aligned.integrability, aligned.integrability.discretization
    whole = np.rint(aligned.sector_quads).astype(np.int64)
    chains = chained(aligned.sectors, whole)[0]
    value = curve_values(chains, aligned.sectors, edge_values(d))
    if map_ is None:
        matching, faulty = Matching.of(i), _most_in_error(i, integrated.x)
    else:
        matching = map_.matching
        wound = np.isin(matching.triangulation.faces, map_.wrong_windings)
        faulty = np.asarray(wound.any(axis=1))
        faulty[map_.inverted] = True
    beside = _edges_beside(matching, faulty)
    far = np.ones(chains.count, dtype=bool)
    far[chains.number[np.isin(_ends(i.triangulation, i.features), beside)]] = False
    edges = d.features.edges[d.feature_edge]
    return tuple(np.unique(edges[chains.number == c]) for c in np.lexsort((value, far)))


def _most_in_error(i: Integrability, x: FloatArray) -> BoolArray:
    """Return the triangles (m,) that contribute most to the error of a field."""
    error = (i.residual(x).values ** 2).sum(axis=1)
    return np.asarray(error >= MUCH * error.max())


def _edges_beside(matching: Matching, faces: BoolArray) -> IntArray:
    """Return the ends of aligned edges beside the pieces that some triangles are in."""
    t, aligned = matching.triangulation, matching.aligned
    h = np.flatnonzero(~aligned)
    across = (np.ones(len(h), dtype=np.int8), (h // 3, t.twin[h] // 3))
    graph = coo_array(across, shape=(t.n_faces, t.n_faces))
    piece = connected_components(graph, directed=False)[1]
    faulty = np.isin(piece, piece[faces])
    return np.unique(_ends(t, np.flatnonzero(aligned & np.repeat(faulty, 3))))


def _ends(t: IntrinsicTriangulation, h: IntArray) -> IntArray:
    """Return a number (k,) for the pair of vertices that halfedges join: flips leave vertices."""
    first, last = np.sort(np.stack([t.tail[h], t.head[h]]), axis=0)
    return np.asarray(first * t.n_vertices + last)
