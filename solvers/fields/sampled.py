"""What a field on a working triangulation is on the triangles of its surface."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solvers.fields.connection import Discretization
from solvers.fields.crossfield import WorkingField
from solvers.surface.triangulation import QUARTER, FloatArray, IntArray

BESIDE = 1e-6
"""How far inside a triangle, in parts of it, what holds at its corners is read off. Chosen."""


@dataclass(frozen=True, eq=False)
class Sampled:
    """A field on the triangles of a surface, its arrays as those of `CrossField`.

    Parameters
    ----------
    H : (n,) float array
        At the surface's vertices.
    theta : (m,) float array
        In its triangles.
    half_log_aspect : (m, 3) float array
        At their corners.
    error_density : (m,) float array
        At their barycentres, in a scale that keeps its integral.
    """

    H: FloatArray
    theta: FloatArray
    half_log_aspect: FloatArray
    error_density: FloatArray


def sampled(d: Discretization, field: WorkingField, spin: FloatArray) -> Sampled:
    """Sample a field on the surface's own triangles; where they are the working ones, it is itself.

    Parameters
    ----------
    d : Discretization
        Of the surface.
    field : WorkingField
        On its triangulation.
    spin : (m, 2) float array
        Gradient of theta in each of its triangles.
    """
    if d.working.unchanged:
        return Sampled(field.H, field.theta, field.half_log_aspect, field.error_density)
    faces = np.arange(d.surface.n_faces)
    at = d.barycentres
    theta = _theta(d, field, spin, at.face, at.place) - at.turn
    aspect = np.zeros((len(faces), 3))
    if field.half_log_aspect.any():
        for corner in range(3):
            weights = np.full((len(faces), 3), BESIDE)
            weights[:, corner] = 1 - 2 * BESIDE
            near = d.working.locate(faces, d.surface.triangulation.places(faces, weights))
            there = d.triangulation.weights_at(near.face, near.place)
            value = (there * field.half_log_aspect[near.face]).sum(axis=1)
            beyond = _theta(d, field, spin, near.face, near.place) - near.turn
            # Over odd quarter turns u and v change places.
            odd = np.rint((beyond - theta) / QUARTER) % 2 == 1
            aspect[:, corner] = np.where(odd, -value, value)
    density = field.error_density[at.face]
    total = float(d.surface.face_areas @ density)
    if total > 0:
        density = density * (float(d.triangulation.areas @ field.error_density) / total)
    return Sampled(field.H[: d.surface.n_vertices], theta, aspect, density)


def _theta(
    d: Discretization, field: WorkingField, spin: FloatArray, face: IntArray, place: FloatArray
) -> FloatArray:
    """Return theta at places in the triangulation, in the frames of its triangles."""
    off = place - d.triangulation.corner_positions[face].mean(axis=1)
    return np.asarray(field.theta[face] + (spin[face] * off).sum(axis=1))
