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

    Examples
    --------
    >>> from solvers.primitives import square
    >>> from solvers.surface import SurfacePoint
    >>> middle = SurfacePoint(face=0, barycentric=(0.5, 0.0, 0.5))  # of the side 2-0
    >>> square(n=2, size=2.0).position(middle).tolist()
    [-0.5, -0.5, 0.0]
    """

    face: int
    barycentric: tuple[float, float, float]
