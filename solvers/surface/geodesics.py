"""Straight lines on a triangulated surface."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from solvers.number_checks import real_numbers
from solvers.surface.points import SurfacePoint
from solvers.surface.triangulation import BoolArray, FloatArray
from solvers.surface.trisurface import TriSurface


@dataclass(frozen=True)
class Walk:
    """The end of a straight walk on a surface.

    Parameters
    ----------
    end : SurfacePoint
        In the triangle that the walk came to.
    turn : float
        What a vector's angle in the frame of that triangle is larger than in that of the first, if
        it is carried along the walk, radians.

    Examples
    --------
    The first triangle's first axis, carried along:

    >>> import numpy as np
    >>> from solvers.primitives import square
    >>> from solvers.surface import SurfacePoint, straightest
    >>> surface = square(n=2, size=2.0)
    >>> walk = straightest(surface, SurfacePoint(0, (1.0, 0.0, 0.0)), [1.5, 0.5])
    >>> along, across = surface.face_frames
    >>> there = np.array([along[walk.end.face], across[walk.end.face]])
    >>> cos, sin = np.cos(walk.turn), np.sin(walk.turn)
    >>> bool(np.allclose([cos, sin] @ there, along[0]))  # in the plane it stays what it is
    True
    """

    end: SurfacePoint
    turn: float


def straightest(
    surface: TriSurface,
    start: SurfacePoint,
    vector: npt.ArrayLike,
    walls: BoolArray | None = None,
) -> Walk:
    """Return where a straight walk on the surface ends.

    The walk goes straight on through triangles unfolded into one plane; at the boundary it ends,
    and at walls.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    start : SurfacePoint
        Where the walk starts.
    vector : (2,) array_like
        Its direction and length, in the frame of the start's triangle.
    walls : (ne,) bool array, optional
        Which edges of the surface it does not cross.

    Returns
    -------
    Walk
        Where it ends, and how vectors carried along turn.

    Raises
    ------
    CrossviewError
        If the start is a point of another surface, or the vector is not two finite numbers.

    Notes
    -----
    The straightest geodesic of Polthier and Schmies 1998, for walks that meet no vertex; the vector
    is carried over edges by the Levi-Civita transport.

    Examples
    --------
    In the plane a straight walk adds its vector:

    >>> import numpy as np
    >>> from solvers.primitives import square
    >>> from solvers.surface import SurfacePoint, straightest
    >>> surface = square(n=2, size=2.0)  # triangle 0 has its first edge along x
    >>> walk = straightest(surface, SurfacePoint(0, (1.0, 0.0, 0.0)), np.array([1.5, 0.5]))
    >>> surface.position(walk.end).round(6).tolist()
    [0.5, -0.5, 0.0]
    """
    surface.require_own([start])
    vector = real_numbers("the vector", vector, (2,), finite=True)
    t = surface.triangulation
    face, weights = start.face, np.array(start.barycentric)
    place, left = weights @ t.corner_positions[face], vector
    entered, turned = -1, 0.0
    for _ in range(4 * t.n_faces):
        corners = t.corner_positions[face]
        sides = corners[[1, 2, 0]] - corners
        # The walk leaves over the first side it crosses outwards.
        outwards = left[0] * sides[:, 1] - left[1] * sides[:, 0]
        gap = (corners - place) @ [[0.0, -1.0], [1.0, 0.0]]
        reach = np.full(3, np.inf)
        crossed = outwards > 1e-14 * np.abs(sides).max() * np.abs(left).max()
        reach[crossed] = -np.einsum("ij,ij->i", gap, sides)[crossed] / outwards[crossed]
        if entered >= 0:
            reach[entered] = np.inf
        side = int(np.argmin(reach))
        step = max(float(reach[side]), 0.0)
        if step >= 1:
            return Walk(_point(surface, face, place + left), turned)
        place = place + step * left
        h = 3 * face + side
        g = int(t.twin[h])
        if g < 0 or (walls is not None and walls[surface.face_edges[face, side]]):
            return Walk(_point(surface, face, place), turned)
        left = (1 - step) * left
        along = np.linalg.norm(place - corners[side]) / np.linalg.norm(sides[side])
        angle = float(t.transport[h])
        turned += angle
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        left = turn @ left
        face, entered = g // 3, g % 3
        there = t.corner_positions[face]
        place = there[(entered + 1) % 3] + along * (there[entered] - there[(entered + 1) % 3])
    return Walk(_point(surface, face, place), turned)


def _point(surface: TriSurface, face: int, place: FloatArray) -> SurfacePoint:
    corners = surface.triangulation.corner_positions[face]
    third = place[1] / corners[2, 1]
    second = (place[0] - third * corners[2, 0]) / corners[1, 0]
    weights = np.maximum([1 - second - third, second, third], 0.0)
    weights /= weights.sum()
    return surface.point(face, weights.tolist())
