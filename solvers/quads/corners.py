"""The corners of quads, measured in the tangent planes of their surface.

A surface that bends sharply over an edge has two tangent planes there, one on each side, and a
corner of a quad lies in that of its own side.
"""

from __future__ import annotations

import numpy as np

from solvers.features.dihedral import dihedral_angles
from solvers.quads.incidence import CornersAround
from solvers.surface.sectors import corner_sectors
from solvers.surface.triangulation import BoolArray, FloatArray, IntArray
from solvers.surface.trisurface import TriSurface, closest_barycentric

CREASE = np.radians(30.0)
"""Angle between the normals beside an edge, radians, beyond which it has two tangent planes.

Chosen: smooth surfaces that are finely triangulated bend less.
"""

ON_EDGE = 1e-9
"""Weight of a corner, from 0 to 1, below which a place is on the edge across. Chosen, well above
rounding.
"""

NO_LENGTH = 1e-9
"""Length of a side that counts as none, in that of the quad's longest. Chosen, above rounding."""

FAR = 1e4
"""How long triangles are made that stand for angles at a place, beside a unit vector. Chosen."""


class TangentPlanes:
    """The tangent planes of a surface, one on each side of its creases.

    Normals are those of the surface's vertices, between creases, interpolated over triangles.

    Parameters
    ----------
    surface : TriSurface
        Where.

    Examples
    --------
    Two squares at a right angle; at the middle of the edge between them, the normal of a corner is
    that of the square which its quad lies on:

    >>> import numpy as np
    >>> from solvers import TriSurface
    >>> from solvers.quads.corners import TangentPlanes
    >>> corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [0, 1, 1]]
    >>> surface = TriSurface(corners, [[0, 1, 2], [0, 2, 3], [4, 0, 3], [4, 3, 5]])
    >>> planes = TangentPlanes(surface)
    >>> face, weights = np.array([1, 1]), np.array([[0.5, 0.0, 0.5], [0.5, 0.0, 0.5]])
    >>> planes.normals(face, weights, np.array([[1.0, 0, 0.1], [0.1, 0, 1.0]])).tolist()
    [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]
    """

    def __init__(self, surface: TriSurface) -> None:
        self._surface = surface
        t = surface.triangulation
        sharp = t.edge_halfedges[dihedral_angles(surface) > CREASE]
        self._crease: BoolArray = np.zeros(len(t.twin), dtype=bool)
        self._crease[sharp] = self._crease[t.twin[sharp]] = True
        sector = corner_sectors(t, self._crease)
        around = [np.bincount(sector, np.repeat(x, 3)) for x in surface.area_vectors.T]
        self._normals: FloatArray = unit(np.stack(around, axis=1))[sector].reshape(-1, 3, 3)
        per_vertex = np.unique(np.stack([surface.faces.reshape(-1), sector]), axis=1)[0]
        self._split: BoolArray = np.bincount(per_vertex, minlength=surface.n_vertices) > 1
        self._around = CornersAround(surface.faces, surface.n_vertices)

    def normals(self, faces: IntArray, weights: FloatArray, towards: FloatArray) -> FloatArray:
        """Return the unit normals (k, 3) at places, on the sides that vectors point to.

        Parameters
        ----------
        faces : (k,) int array
            Triangles of the places.
        weights : (k, 3) float array
            Their barycentric weights.
        towards : (k, 3) float array
            Vectors of any length but 0.
        """
        faces, weights = self._beside(faces, weights, towards)
        found = (weights[:, :, None] * self._normals[faces]).sum(axis=1)
        return unit(found)

    def corner_normals(
        self, faces: IntArray, weights: FloatArray, places: FloatArray, quads: IntArray
    ) -> FloatArray:
        """Return the unit normals (..., 4, 3) at the corners of quads, each on its quad's side.

        Parameters
        ----------
        faces : (n,) int array
            Triangles of the vertices.
        weights : (n, 3) float array
            Their barycentric weights.
        places : (n, 3) float array
            Their coordinates.
        quads : (..., 4) int array
            Their corner vertices.
        """
        corners = places[quads]
        towards = corners.mean(axis=-2, keepdims=True) - corners
        at = quads.reshape(-1)
        return self.normals(faces[at], weights[at], towards.reshape(-1, 3)).reshape(corners.shape)

    def _beside(
        self, faces: IntArray, weights: FloatArray, towards: FloatArray
    ) -> tuple[IntArray, FloatArray]:
        """Return the same places in the triangles that vectors point into, where it matters."""
        inner = weights > ON_EDGE
        n_inner = inner.sum(axis=1)
        i = np.argmin(inner, axis=1)  # the corner across, of places on an edge
        edge = 3 * faces + (i + 1) % 3
        on_edge = np.flatnonzero((n_inner == 2) & self._crease[edge])
        i = np.argmax(inner, axis=1)
        vertex = self._surface.faces[faces, i]
        at_vertex = np.flatnonzero((n_inner == 1) & self._split[vertex])
        if len(on_edge) + len(at_vertex) == 0:
            return faces, weights
        h, twin = edge[on_edge], self._surface.triangulation.twin[edge[on_edge]]
        at, star = self._around.pairs(vertex[at_vertex])
        place = np.concatenate([np.tile(on_edge, 4), at_vertex[at]])
        # Angles between two ways from a place, as the corners that the ways lead to: of a vertex
        # one in each triangle, of an edge two on each side, parted by the corner across.
        ends = [[1, 2], [2, 0]]
        triangle = np.concatenate([h // 3, h // 3, twin // 3, twin // 3, star // 3])
        first = np.concatenate([(x + a) % 3 for x in (h, twin) for a, _ in ends] + [(star + 1) % 3])
        last = np.concatenate([(x + b) % 3 for x in (h, twin) for _, b in ends] + [(star + 2) % 3])
        return self._nearest_angle(faces, weights, towards, place, triangle, first, last)

    def _nearest_angle(
        self,
        faces: IntArray,
        weights: FloatArray,
        towards: FloatArray,
        place: IntArray,
        triangle: IntArray,
        first: IntArray,
        last: IntArray,
    ) -> tuple[IntArray, FloatArray]:
        """Return places moved to the triangle of the angle that their vector is nearest to."""
        corners = self._surface.vertices[self._surface.faces]
        here = (weights[place][:, :, None] * corners[faces[place]]).sum(axis=1)
        ways = [unit(corners[triangle, end] - here) for end in (first, last)]
        shape = np.stack([np.zeros_like(here), FAR * ways[0], FAR * ways[1]], axis=1)
        vector = unit(towards[place])
        near = closest_barycentric(shape, vector)
        gap = np.linalg.norm((near[:, :, None] * shape).sum(axis=1) - vector, axis=1)
        order = np.lexsort((triangle, gap, place))
        best = order[np.r_[True, np.diff(place[order]) > 0]]
        faces, weights = faces.copy(), weights.copy()
        at, was = place[best], self._surface.faces[faces[place[best]]]
        same = self._surface.faces[triangle[best]][:, :, None] == was[:, None]
        weights[at] = (same * weights[at][:, None]).sum(axis=2)
        faces[at] = triangle[best]
        return faces, weights


def corner_sines(corners: FloatArray, normals: FloatArray) -> FloatArray:
    """Return the sines of the angles at the corners of quads, in their tangent planes.

    Parameters
    ----------
    corners : (..., 4, 3) float array
        Counter-clockwise seen from outside.
    normals : (..., 4, 3) float array
        Unit normals of the tangent planes.

    Returns
    -------
    (..., 4) float array
        1 for a right angle in its tangent plane, less where the sides leave the plane, 0 or less
        from 180 degrees on; -1 where a side has no length.
    """
    ahead = np.roll(corners, -1, axis=-2) - corners
    length = np.linalg.norm(ahead, axis=-1)
    ahead /= np.maximum(length, 1e-300)[..., None]
    before = np.roll(ahead, 1, axis=-2)  # runs towards the corner
    sines = (np.cross(before, ahead) * normals).sum(axis=-1)
    none = length <= NO_LENGTH * length.max(axis=-1, keepdims=True)
    return np.asarray(np.where(none | np.roll(none, 1, axis=-1), -1.0, sines))


def scaled_jacobian(corners: FloatArray, normals: FloatArray) -> FloatArray:
    """Return the quality of quads: the least sine of their corners, in the tangent planes there.

    Parameters
    ----------
    corners : (..., 4, 3) float array
        Counter-clockwise seen from outside.
    normals : (..., 4, 3) float array
        Unit normals of the surface at the corners.

    Returns
    -------
    (...) float array
        1 for a rectangle, 0 or less for a quad that is folded or inverted, -1 for one that has a
        side without length.

    Notes
    -----
    The scaled Jacobian of Knupp 2000, with the surface's normals.

    Examples
    --------
    A rhombus with angles of 60 and 120 degrees, seen from above and from below:

    >>> import numpy as np
    >>> from solvers.quads import scaled_jacobian
    >>> height = np.sqrt(3) / 2
    >>> rhombus = np.array([[0, 0, 0], [1, 0, 0], [1.5, height, 0], [0.5, height, 0]])
    >>> for up in (1.0, -1.0):
    ...     print(round(float(scaled_jacobian(rhombus, np.tile([0, 0, up], (4, 1)))), 6))
    0.866025
    -0.866025
    """
    return np.asarray(corner_sines(corners, normals).min(axis=-1))


def worth(quality: FloatArray) -> tuple[int, float]:
    """Return what to compare meshes by: how few quads are inverted, then the least quality."""
    return -int((quality <= 0).sum()), float(quality.min(initial=1.0))


def unit(vectors: FloatArray) -> FloatArray:
    """Return vectors (..., 3) of length 1 in the same directions; 0 stays 0."""
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=-1), 1e-300)[..., None])
