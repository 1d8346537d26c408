"""What a mesh is checked against: a surface, its features, and what else was wanted."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from crossview.certificate.faces import Faces, Floats, Ints
from crossview.certificate.samples import Ground, area
from solvers.errors import CrossviewError


@dataclass(frozen=True)
class Irregular:
    """Vertices where another number of faces meets than elsewhere.

    Attributes
    ----------
    positions : (k, 3) float array
    meeting : (k,) int array
        How many faces meet there.
    """

    positions: Floats
    meeting: Ints


@dataclass(frozen=True)
class Sizes:
    """The sizes that faces were to have, up to one factor for all.

    Attributes
    ----------
    triangles : (t, 3, 3) float array
    logarithms : (t, 3) float array
        H at their corners: a quad's edge is proportional to e^H there.
    """

    triangles: Floats
    logarithms: Floats


@dataclass(frozen=True)
class Reference:
    """What a mesh is checked against; what is None is not checked.

    Parameters
    ----------
    surface : Faces
        Triangles, oriented.
    features : (k, 2, 3) float array, optional
        Segments that edges are to run along.
    singularities : Irregular, optional
        Inside the surface: all where not four faces are to meet.
    corners : Irregular, optional
        On the boundary: all where not two faces are to meet.
    faces : int, optional
        How many faces were wanted.
    sizes : Sizes, optional
        How large they were to be.

    Raises
    ------
    CrossviewError
        The surface has other faces than triangles, or no area.
    """

    surface: Faces
    features: Floats | None = None
    singularities: Irregular | None = None
    corners: Irregular | None = None
    faces: int | None = None
    sizes: Sizes | None = None

    def __post_init__(self) -> None:
        if (self.surface.sizes != 3).any():
            raise CrossviewError("the surface to check against must be of triangles")
        if not self.area > 0:
            raise CrossviewError("the surface to check against has no area")

    @cached_property
    def triangles(self) -> Floats:
        """(t, 3, 3) the surface's triangles."""
        return self.surface.points[self.surface.corners.reshape(-1, 3)]

    @cached_property
    def area(self) -> float:
        """The surface's."""
        return area(self.triangles)

    @cached_property
    def ground(self) -> Ground:
        """The surface as what places are put on."""
        return Ground(self.triangles)
