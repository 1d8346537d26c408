"""The one location type: a point of a surface, for picks, singularities and traces.

A point knows the triangles it is a point of. What takes points of one surface refuses those of
another, such as of a refined one, whose triangles have other numbers: they would lie elsewhere.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from solvers.errors import CrossviewError
from solvers.number_checks import real_numbers, whole_number

ROUNDING = 1e-9
"""By how much weights may be negative, or miss 1 in sum. Chosen, far above what arithmetic leaves.
"""


@dataclass(frozen=True)
class SurfacePoint:
    """A point of a triangle surface.

    Parameters
    ----------
    face : int
        The triangle it lies in (any of them, for a point on an edge or a vertex).
    barycentric : tuple of 3 float
        Weights of the triangle's corners, non-negative, with sum 1.
    mark : int, optional
        That of the surface, `TriSurface.mark`. Points that surfaces make have it; one made by hand
        counts as a point of whatever surface it is given to. Points are equal whatever it is.

    Raises
    ------
    CrossviewError
        Unless the triangle is a whole number from 0 and the weights are such numbers.

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
    mark: int | None = field(default=None, compare=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "face", whole_number("the triangle of a point", self.face, 0))
        a, b, c = real_numbers(
            "the barycentric weights of a point", self.barycentric, (3,)
        ).tolist()
        if not (min(a, b, c) >= -ROUNDING and abs(a + b + c - 1) <= ROUNDING):
            raise CrossviewError(
                "the barycentric weights of a point must be at least 0 with sum 1, "
                f"not {a:g}, {b:g}, {c:g}"
            )
        object.__setattr__(self, "barycentric", (a, b, c))
