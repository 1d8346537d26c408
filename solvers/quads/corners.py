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
from solvers.surface.trisurface import TriSurface

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
        corners = surface.vertices[surface.faces]
        ways = unit(np.roll(corners, -1, axis=1) - corners)
        self._ways: FloatArray = ways.reshape(-1, 3)
        self._whole: FloatArray = _by_angles(surface)

    def quality(
        self, faces: IntArray, weights: FloatArray, places: FloatArray, quads: IntArray
    ) -> FloatArray:
        """Return the scaled Jacobians (...) of quads on the surface.

        A corner on a crease that has 180 degrees or more seen along the mean of the normals all
        around it, on both sides, counts as inverted, too: what lies on one side never has.

        Parameters
        ----------
        faces, weights, places, quads
            As of `corner_normals`.
        """
        corners = places[quads].reshape(-1, 4, 3)
        normals = self.corner_normals(faces, weights, places, quads).reshape(-1, 4, 3)
        sines = corner_sines(corners, normals)
        at = quads.reshape(-1)
        on, across = self._on_creases(faces[at], weights[at])
        if len(on):
            some = np.unique(on // 4)
            normals = normals.copy()
            normals.reshape(-1, 3)[on] = across
            whole = corner_sines(corners[some], normals[some])
            sines[some] = np.where(whole <= 0, np.minimum(whole, sines[some]), sines[some])
        return np.asarray(sines.min(axis=1).reshape(quads.shape[:-1]))

    def _on_creases(self, faces: IntArray, weights: FloatArray) -> tuple[IntArray, FloatArray]:
        """Return which places (k,) are on creases, and the mean normals (k, 3) all around them."""
        inner = weights > ON_EDGE
        n_inner = inner.sum(axis=1)
        edge = 3 * faces + (np.argmin(inner, axis=1) + 1) % 3
        vertex = self._surface.faces[faces, np.argmax(inner, axis=1)]
        on_edge = np.flatnonzero((n_inner == 2) & self._crease[edge])
        at_vertex = np.flatnonzero((n_inner == 1) & self._split[vertex])
        normals = self._surface.face_normals
        h = edge[on_edge]
        beside = normals[h // 3] + normals[self._surface.triangulation.twin[h] // 3]
        found = unit(np.concatenate([beside, self._whole[vertex[at_vertex]]]))
        return np.concatenate([on_edge, at_vertex]), found

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
        place, triangle = self._nearest_sides(on_edge, edge[on_edge], towards)
        found = self._nearest_corners(at_vertex, vertex[at_vertex], towards)
        place, triangle = (np.concatenate(x) for x in zip((place, triangle), found, strict=True))
        faces, weights = faces.copy(), weights.copy()
        was = self._surface.faces[faces[place]]
        same = self._surface.faces[triangle][:, :, None] == was[:, None]
        weights[place] = (same * weights[place][:, None]).sum(axis=2)
        faces[place] = triangle
        return faces, weights

    def _nearest_sides(
        self, places: IntArray, edges: IntArray, towards: FloatArray
    ) -> tuple[IntArray, IntArray]:
        """Return places on edges, and which triangle beside it the vector of each is nearest to."""
        vector = unit(towards[places])
        both = np.stack([edges, self._surface.triangulation.twin[edges]])
        both.sort(axis=0)
        normal, along = self._surface.face_normals[both // 3], self._ways[both]
        inside = (vector * np.cross(normal, along)).sum(axis=-1) >= 0
        off = np.where(
            inside,
            np.abs((vector * normal).sum(axis=-1)),
            np.linalg.norm(np.cross(vector, along), axis=-1),
        )
        return places, np.where(off[0] <= off[1], both[0], both[1]) // 3

    def _nearest_corners(
        self, places: IntArray, vertices: IntArray, towards: FloatArray
    ) -> tuple[IntArray, IntArray]:
        """Return places at vertices, and which triangle there the vector of each is nearest to."""
        at, corner = self._around.pairs(vertices)
        vector = unit(towards[places])[at]
        normal = self._surface.face_normals[corner // 3]
        first, last = self._ways[corner], -self._ways[corner - corner % 3 + (corner + 2) % 3]
        inside = ((np.cross(first, vector) * normal).sum(axis=1) >= 0) & (
            (np.cross(vector, last) * normal).sum(axis=1) >= 0
        )
        cosine = np.clip((vector * np.stack([first, last])).sum(axis=-1).max(axis=0), 0.0, 1.0)
        off = np.where(inside, np.abs((vector * normal).sum(axis=1)), np.sqrt(1 - cosine**2))
        start = np.flatnonzero(np.r_[True, np.diff(at) > 0]) if len(at) else at
        nearest = np.flatnonzero(off <= np.minimum.reduceat(off, start)[at]) if len(at) else at
        first_of = np.unique(at[nearest], return_index=True)[1]
        return places, corner[nearest[first_of]] // 3


def _by_angles(surface: TriSurface) -> FloatArray:
    """Return the sums (n, 3) of the unit normals around vertices, weighted by angles."""
    corners = surface.vertices[surface.faces]
    ahead = unit(np.roll(corners, -1, axis=1) - corners)
    back = unit(np.roll(corners, 1, axis=1) - corners)
    angle = np.arctan2(
        np.linalg.norm(np.cross(ahead, back), axis=2), (ahead * back).sum(axis=2)
    ).reshape(-1)
    at, normals = surface.faces.reshape(-1), np.repeat(surface.face_normals, 3, axis=0)
    return np.stack([np.bincount(at, angle * x, surface.n_vertices) for x in normals.T], axis=1)


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
