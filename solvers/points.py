"""The one location type: a point of a surface, for picks, singularities and traces."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class SurfacePoint:
    """A point of a triangle surface.

    Parameters
    ----------
    face : int
        The triangle it lies in (any of them, for a point on an edge or a vertex).
    barycentric : tuple of 3 float
        Weights of the triangle's corners, non-negative, with sum 1.
    """

    face: int
    barycentric: tuple[float, float, float]

    def corner(self, tolerance: float = 1e-9) -> int | None:
        """Return the corner (0, 1, 2) the point coincides with, or None.

        Parameters
        ----------
        tolerance : float
            How far the corner's weight may be from 1.
        """
        weight = max(self.barycentric)
        return self.barycentric.index(weight) if weight >= 1.0 - tolerance else None
