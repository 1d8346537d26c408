"""Places to look at: where sizes are extreme, where quads are worst, where a fault is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from crossview.certificate import Certificate
from solvers.quads import QuadMesh
from solvers.surface import TriSurface

WORST = 5
"""How many of the worst quads are told. Chosen."""

GOOD = 0.9
"""Scaled Jacobian from which a quad is not among the worst. Chosen: angles of 64 degrees."""

POOR = 0.5
"""Scaled Jacobian below which a quad is marked in the scene. Chosen: angles of 30 degrees, which
even a valence 12 has, and smoothing lets no quad fall below for the sake of others.
"""


@dataclass(frozen=True)
class Spot:
    """A place of a surface to look at.

    Parameters
    ----------
    place : tuple of 3 floats
        Where.
    normal : tuple of 3 floats
        The surface's unit normal there.
    """

    place: tuple[float, ...]
    normal: tuple[float, ...]

    @classmethod
    def of_face(cls, surface: TriSurface, face: int) -> Spot:
        """The middle of a triangle."""
        place = surface.vertices[surface.faces[face]].mean(axis=0)
        return cls(tuple(place.tolist()), tuple(surface.face_normals[face].tolist()))

    @classmethod
    def beside(cls, surface: TriSurface, place: npt.ArrayLike) -> Spot:
        """A place near a surface."""
        where = np.asarray(place, dtype=float)
        near = int(((surface.vertices - where) ** 2).sum(axis=1).argmin())
        return cls(tuple(where.tolist()), tuple(surface.vertex_normals[near].tolist()))


@dataclass(frozen=True)
class WorstQuad:
    """A quad that is among the worst.

    Parameters
    ----------
    quality : float
        Scaled Jacobian.
    edge : float
        Its longest side.
    spot : Spot
        Its middle.
    """

    quality: float
    edge: float
    spot: Spot


def worst_quads(mesh: QuadMesh) -> tuple[WorstQuad, ...]:
    """Return some quads of least scaled Jacobian, the worst first; none that are good.

    Parameters
    ----------
    mesh : QuadMesh
    """
    quality = mesh.scaled_jacobian
    order = np.argsort(quality, kind="stable")[:WORST]
    found = []
    for quad in order[quality[order] < GOOD].tolist():
        corners = mesh.vertices[mesh.quads[quad]]
        longest = np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1).max()
        spot = Spot.beside(mesh.surface, corners.mean(axis=0))
        own = np.cross(corners[2] - corners[0], corners[3] - corners[1])
        if own @ spot.normal > 0:  # of a quad that is not turned over, a better view
            spot = Spot(spot.place, tuple((own / np.linalg.norm(own)).tolist()))
        found.append(WorstQuad(float(quality[quad]), float(longest), spot))
    return tuple(found)


def gravest_spot(certificate: Certificate, surface: TriSurface) -> Spot | None:
    """Return where the gravest fault of a certificate is, if it has a place."""
    place = None if certificate.right else certificate.faults[0].place
    return None if place is None else Spot.beside(surface, place)
