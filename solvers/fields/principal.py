"""The directions of principal curvature, as crosses at edge midpoints."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from solvers.surface.trisurface import TriSurface

LEAST_DIFFERENCE = 0.1
"""Mean of (k1 - k2)^2, in those of k1^2 + k2^2, below which little draws.

Chosen, above the errors of a faceted sphere.
"""


def principal_crosses(surface: TriSurface) -> npt.NDArray[np.complex128]:
    """Return the crosses of principal curvature.

    Parameters
    ----------
    surface : TriSurface
        The surface.

    Returns
    -------
    (ne,) complex array
        Fourth power of the cross at each edge's midpoint, in the direction of the edge, of length
        (k1 - k2)^2, so scaled that its mean square is about 1;
        next to 0 where the curvatures hardly differ anywhere.

    Notes
    -----
    The shape operator from vertex normals, in each triangle (Rusinkiewicz 2004).
    """
    t = surface.triangulation
    normals = surface.vertex_normals[surface.faces]
    # The shape operator: the derivative of the normal, linear in each triangle, in its frame.
    parts = np.stack([np.einsum("mid,md->mi", normals, axis) for axis in surface.face_frames])
    shape = np.einsum("ami,mib->mab", parts, t.hat_gradients)
    deviation = (shape[:, 0, 0] - shape[:, 1, 1]) + 1j * (shape[:, 0, 1] + shape[:, 1, 0])
    along = np.repeat(t.areas * deviation**2, 3) * np.exp(-4j * t.directions)
    edge = surface.face_edges.reshape(-1)
    area = np.bincount(edge, np.repeat(t.areas, 3))
    z = (np.bincount(edge, along.real) + 1j * np.bincount(edge, along.imag)) / area
    mean = np.sqrt(np.average(np.abs(z) ** 2, weights=area))
    # Differences far below the curvature itself, as on a faceted sphere, are errors of the mesh.
    curvature = np.average((shape**2).sum(axis=(1, 2)), weights=t.areas)
    scale = mean + LEAST_DIFFERENCE * curvature
    return np.asarray(z / scale if scale > 0 else z)
