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
