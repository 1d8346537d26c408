"""Places on triangles and segments, no further apart than asked, and how far others are away."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from crossview.certificate.faces import Faces, Floats, Ints

NEAREST = 8
"""Number of nearest samples whose segments are measured exactly. Chosen: two segments meet at a
vertex of a curve, and each is sampled at both ends."""

NO_AREA = 1e-12
"""Area of a triangle that counts as none, in the square of its longest side. Chosen, above
rounding."""


def fans(faces: Faces) -> tuple[Floats, Ints]:
    """The mesh as triangles: each face a fan about the mean of its corners.

    Returns
    -------
    (t, 3, 3) float array
        One triangle for each side, in the faces' order: its ends and the mean.
    (t,) int array
        Face of each.
    """
    corners = [faces.points[faces.corners], faces.points[faces.sides[:, 1]]]
    return np.stack([*corners, faces.middles[faces.owner]], axis=1), faces.owner


def doubled(triangles: Floats) -> Floats:
    """(t, 3) normals of triangles (t, 3, 3), as long as twice their areas."""
    return np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])


def area(triangles: Floats) -> float:
    """Sum of the areas of triangles (t, 3, 3)."""
    return float(np.linalg.norm(doubled(triangles), axis=1).sum() / 2)


def spread(triangles: Floats, spacing: float) -> Floats:
    """Places (k, 3) within spacing / sqrt(3) of every place of triangles (t, 3, 3).

    The corners, and the middles of longest sides that are halved until none is longer than the
    spacing.
    """
    places = [triangles.reshape(-1, 3)]
    while len(triangles):
        across = np.roll(triangles, -1, axis=1) - np.roll(triangles, -2, axis=1)
        opposite = np.linalg.norm(across, axis=2)
        long = opposite.max(axis=1) > spacing
        triangles, apex = triangles[long], opposite[long].argmax(axis=1)
        order = (apex[:, None] + np.arange(3)) % 3
        a, b, c = np.moveaxis(np.take_along_axis(triangles, order[..., None], axis=1), 1, 0)
        middle = (b + c) / 2
        places.append(middle)
        triangles = np.concatenate(
            [np.stack([a, b, middle], axis=1), np.stack([a, middle, c], axis=1)]
        )
    return np.unique(np.concatenate(places), axis=0)


class Ground:
    """Triangles that places are put on.

    Parameters
    ----------
    triangles : (t, 3, 3) float array
        Those without area are left out.
    """

    def __init__(self, triangles: Floats) -> None:
        import pyvista as pv  # it takes a while

        sides = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2)
        height = np.linalg.norm(doubled(triangles), axis=1)
        self._solid = np.flatnonzero(height > NO_AREA * sides.max(axis=1) ** 2)
        solid = triangles[self._solid]
        # so that the library's own tolerances mean the same for every unit of length
        self._low = solid.min(axis=(0, 1))
        self._scale = float(np.linalg.norm(solid.max(axis=(0, 1)) - self._low))
        corners = ((solid - self._low) / self._scale).reshape(-1, 3)
        self._mesh = pv.PolyData.from_regular_faces(
            corners, np.arange(3 * len(solid)).reshape(-1, 3)
        )

    def under(self, places: Floats) -> Ints:
        """(k,) the triangle nearest to each of the places (k, 3)."""
        if not len(places):
            return np.empty(0, dtype=np.int64)
        found = self._mesh.find_closest_cell((places - self._low) / self._scale)
        return np.asarray(self._solid[found])

    def distance(self, places: Floats) -> Floats:
        """(k,) distance of the places (k, 3) from the nearest triangle."""
        from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
        from vtkmodules.vtkCommonCore import vtkDoubleArray
        from vtkmodules.vtkFiltersCore import vtkImplicitPolyDataDistance

        measure, found = vtkImplicitPolyDataDistance(), vtkDoubleArray()
        measure.SetInput(self._mesh)
        here = np.ascontiguousarray((places - self._low) / self._scale)
        measure.EvaluateFunction(numpy_to_vtk(here), found)
        return np.asarray(np.abs(vtk_to_numpy(found)) * self._scale)


def along(segments: Floats, spacing: float) -> tuple[Floats, Ints]:
    """Places (k, 3) on segments (s, 2, 3), no further apart than a spacing, and whose they are."""
    length = np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1)
    parts = np.ceil(length / spacing).astype(np.int64).clip(1)
    whose = np.repeat(np.arange(len(segments)), parts + 1)
    step = np.arange(len(whose)) - np.repeat(np.cumsum(parts + 1) - parts - 1, parts + 1)
    t = (step / parts[whose])[:, None]
    return segments[whose, 0] * (1 - t) + segments[whose, 1] * t, whose


def to_segments(places: Floats, segments: Floats, spacing: float) -> Floats:
    """(k,) distance of places (k, 3) from segments (s, 2, 3).

    Exact among those of the nearest samples: never too small, and at most half a spacing too
    large.
    """
    samples, whose = along(segments, spacing)
    tree = cKDTree(samples)
    n = min(NEAREST, tree.n)
    near = whose[tree.query(places, k=n)[1].reshape(len(places), n)]
    squared = np.full(len(places), np.inf)
    for column in range(n):
        chosen = segments[near[:, column]]
        squared = np.minimum(squared, _squared(places, chosen[:, 0], chosen[:, 1]))
    return np.asarray(np.sqrt(squared))


def _squared(places: Floats, start: Floats, end: Floats) -> Floats:
    """(k,) squared distance of each place from its own segment."""
    ahead = end - start
    size = np.einsum("ij,ij->i", ahead, ahead)
    t = np.einsum("ij,ij->i", places - start, ahead) / np.where(size > 0, size, 1)
    off = places - start - np.clip(t, 0, 1)[:, None] * ahead
    return np.asarray(np.einsum("ij,ij->i", off, off))
