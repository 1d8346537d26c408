"""Configurations mirrored and turned, on surfaces that are about symmetrical."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from solvers.errors import SingularityError
from solvers.number_checks import real_number, whole_number
from solvers.singularities.budget import Singularity, checked_singularities
from solvers.surface.points import SurfacePoint
from solvers.surface.triangulation import FloatArray
from solvers.surface.trisurface import TriSurface

FARTHEST = 0.02
"""How far from the surface a singularity may be carried, in diagonals of the bounding box. Chosen.
"""

AXES = "xyz"
"""Names of the axes, in messages."""


def mirrored(
    surface: TriSurface, singularities: Iterable[Singularity], axis: int
) -> tuple[Singularity, ...]:
    """Return the configuration's mirror image on the same surface.

    The plane goes through the middle of the bounding box, across one of its axes; where the
    surface is not symmetrical about it, through the centroid across a principal axis.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    singularities : iterable of Singularity
        The configuration.
    axis : {0, 1, 2}
        The normal of the plane: x, y or z, or the principal axis nearest to it.

    Returns
    -------
    tuple of Singularity
        In the same order.

    Raises
    ------
    SingularityError
        The surface is not symmetrical enough, or a singularity that would move is locked.

    Examples
    --------
    >>> from solvers.primitives import disk
    >>> from solvers.singularities import Singularity, mirrored
    >>> surface = disk(edge_length=0.1)
    >>> one = Singularity(surface.closest_point([0.3, 0.2, 0.0]), 5)
    >>> (image,) = mirrored(surface, [one], axis=0)
    >>> surface.position(image.point).round(6).tolist()
    [-0.3, 0.2, 0.0]
    """
    axis, matrix = whole_number("the axis", axis, 0, 2), np.eye(3)
    matrix[axis, axis] = -1
    return _carried(surface, singularities, matrix, f"mirrored across {AXES[axis]}")


def rotated(
    surface: TriSurface, singularities: Iterable[Singularity], axis: int, angle: float
) -> tuple[Singularity, ...]:
    """Return the configuration turned on the same surface.

    About an axis through the middle of the bounding box; where the surface is not symmetrical
    about it, about a principal axis through the centroid.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    singularities : iterable of Singularity
        The configuration.
    axis : {0, 1, 2}
        x, y or z, or the principal axis nearest to it.
    angle : float
        Radians.

    Returns
    -------
    tuple of Singularity
        In the same order.

    Raises
    ------
    SingularityError
        As of `mirrored`.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers.primitives import disk
    >>> from solvers.singularities import Singularity, rotated
    >>> surface = disk(edge_length=0.1)
    >>> one = Singularity(surface.closest_point([0.3, 0.0, 0.0]), 5)
    >>> (image,) = rotated(surface, [one], axis=2, angle=np.pi / 2)
    >>> surface.position(image.point).round(6).tolist()
    [0.0, 0.3, 0.0]
    """
    matrix = np.eye(3)
    axis, angle = whole_number("the axis", axis, 0, 2), real_number("the angle", angle)
    u, v = (axis + 1) % 3, (axis + 2) % 3
    cosine, sine = np.cos(angle), np.sin(angle)
    matrix[[u, u, v, v], [u, v, u, v]] = cosine, -sine, sine, cosine
    what = f"turned by {np.degrees(angle):.4g} degrees about {AXES[axis]}"
    return _carried(surface, singularities, matrix, what)


def _carried(
    surface: TriSurface, singularities: Iterable[Singularity], matrix: FloatArray, what: str
) -> tuple[Singularity, ...]:
    singularities = checked_singularities(singularities)
    x = surface.positions(s.point for s in singularities)
    tried = []
    for centre, axes in _frames(surface):
        image = (x - centre) @ axes.T @ matrix.T @ axes + centre
        points = [surface.closest_point(place) for place in image]
        apart = np.linalg.norm(surface.positions(points) - image, axis=1)
        if apart.max(initial=0.0) <= FARTHEST * surface.diagonal:
            return _placed(surface, singularities, points)
        tried.append(float(apart.max()))
    raise SingularityError(
        "the surface is not symmetrical enough",
        f"{what}, a singularity would be {min(tried):.3g} away from it",
        "choose another axis",
    )


def _placed(
    surface: TriSurface,
    singularities: Sequence[Singularity],
    points: list[SurfacePoint],
) -> tuple[Singularity, ...]:
    x = surface.positions([s.point for s in singularities])
    away = np.linalg.norm(surface.positions(points) - x, axis=1) > 1e-9 * surface.diagonal
    held = [i for i, s in enumerate(singularities) if s.locked and away[i]]
    if held:
        raise SingularityError(f"#{held[0] + 1} is locked", advice="unlock it")
    return tuple(
        replace(s, point=point) if moves else s
        for s, point, moves in zip(singularities, points, away, strict=True)
    )


def _frames(surface: TriSurface) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Yield centres (3,) and axes (3, 3; rows): of the bounding box, then the principal ones."""
    low, high = surface.vertices.min(axis=0), surface.vertices.max(axis=0)
    yield 0.5 * (low + high), np.eye(3)
    areas, centres = surface.face_areas, surface.barycentres
    centroid = areas @ centres / surface.area
    spread = centres - centroid
    axes = np.linalg.eigh((spread * areas[:, None]).T @ spread)[1].T
    # Each in the place, and with the sign, of the coordinate axis that it is nearest to.
    order = np.argsort(np.argmax(np.abs(axes), axis=1), kind="stable")
    axes = axes[order]
    yield centroid, axes * np.where(np.diagonal(axes) < 0, -1.0, 1.0)[:, None]
