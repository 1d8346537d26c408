"""Sharp edges: where a surface bends by more than an angle."""

from __future__ import annotations

import numpy as np

from solvers.features.edges import no_features
from solvers.features.strays import without_spurs, without_strays
from solvers.number_checks import real_number
from solvers.surface.triangulation import FloatArray, IntArray
from solvers.surface.trisurface import TriSurface

FLAT = np.radians(160)
"""Largest angle of a triangle that is next to flat, radians. Chosen."""


def dihedral_angles(surface: TriSurface) -> FloatArray:
    """Return by how much the surface bends over each edge.

    Parameters
    ----------
    surface : TriSurface
        The surface.

    Returns
    -------
    (ne,) float array
        Angle between the normals of both triangles, radians; 0 on the boundary.

    Examples
    --------
    A regular tetrahedron bends by the angle whose cosine is -1/3 over each edge:

    >>> import numpy as np
    >>> from solvers.features import dihedral_angles
    >>> from solvers.surface import TriSurface
    >>> corners = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
    >>> tetrahedron = TriSurface(corners, [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])
    >>> np.cos(dihedral_angles(tetrahedron)).round(6).tolist()
    [-0.333333, -0.333333, -0.333333, -0.333333, -0.333333, -0.333333]
    """
    left, right = surface.edge_faces.T
    one, other = surface.face_normals[left], surface.face_normals[right]
    sine = np.linalg.norm(np.cross(one, other), axis=1)
    angle = np.arctan2(sine, (one * other).sum(axis=1))
    return np.where(right >= 0, angle, 0.0)


def sharp_edges(surface: TriSurface, degrees: float) -> IntArray:
    """Return the edges over which the surface bends by more than an angle.

    The normal of a next to flat triangle means little: where its longest edge is sharp, the two
    others are not. Curves of sharp edges that leave a longer one at too sharp an angle are left
    out, as `without_spurs`, and those that the triangles make, as `without_strays`.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    degrees : float
        The angle.

    Returns
    -------
    (k,) int array
        Among the surface's edges.

    Examples
    --------
    A square sheet folded by 90 degrees along the y axis:

    >>> import numpy as np
    >>> from solvers.features import dihedral_angles, sharp_edges
    >>> from solvers.primitives import square
    >>> from solvers.surface import TriSurface
    >>> flat = square(n=4)
    >>> x, y, _ = flat.vertices.T
    >>> roof = TriSurface(np.stack([x, y, -np.abs(x)], axis=1), flat.faces)
    >>> edges = sharp_edges(roof, degrees=40)
    >>> np.degrees(dihedral_angles(roof)[edges]).round(6).tolist()
    [90.0, 90.0, 90.0, 90.0]
    >>> bool((roof.vertices[roof.edges[edges], 0] == 0).all())
    True
    """
    degrees = real_number("the dihedral angle of sharp edges", degrees, 0, 180)
    bends = dihedral_angles(surface)
    sharp = bends > np.radians(degrees)
    angles = surface.triangulation.angles
    flat = np.flatnonzero(angles.max(axis=1) > FLAT)
    longest = (np.argmax(angles[flat], axis=1) + 1) % 3
    edges = surface.face_edges[flat]
    along = edges[np.arange(len(flat)), longest]
    over = edges[sharp[along]].reshape(-1)
    sharp[np.setdiff1d(over, along)] = False
    least = np.radians(degrees)
    found = without_spurs(no_features(surface).united(np.flatnonzero(sharp)), bends, least)
    return without_strays(found, bends, least).edges
