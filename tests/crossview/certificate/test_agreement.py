"""What makes quads and what judges them share no code, but agree on what is upright at a crease."""

from __future__ import annotations

import numpy as np
import pytest

from crossview.certificate import Faces
from crossview.certificate.angles import corner_angles
from solvers.quads.corners import TangentPlanes
from solvers.surface import FloatArray, IntArray, TriSurface
from tests.crossview.certificate.meshes import on_roof, roof


def places_of(surface: TriSurface, points: FloatArray) -> tuple[IntArray, FloatArray]:
    """The triangle of each point of the surface, and its weights there."""
    found = [surface.closest_point(point) for point in points]
    return np.array([at.face for at in found]), np.array([at.barycentric for at in found])


@pytest.mark.parametrize("degrees", [30, 45, 60, 75])
def test_a_corner_on_a_crease_that_the_solver_calls_upright_the_certificate_does_too(
    degrees: float,
) -> None:
    wanted = roof(degrees)
    surface = TriSurface(wanted.surface.points, wanted.surface.corners.reshape(-1, 3))
    rng = np.random.default_rng(7)
    turns = np.linspace(0, 2 * np.pi, 4)[:3]
    points = []
    for _ in range(60):
        spread = turns + rng.uniform(-0.6, 0.6, 3)
        others = rng.uniform(0.3, 0.9, (3, 1)) * np.stack([np.cos(spread), np.sin(spread)], axis=1)
        outline = np.concatenate([np.zeros((1, 2)), rng.uniform(-0.3, 0.3, 2) + others])
        away = outline - outline.mean(axis=0)
        points.append(on_roof(degrees, outline[np.argsort(np.arctan2(away[:, 1], away[:, 0]))]))
    corners = np.concatenate(points)
    quads = np.arange(len(corners)).reshape(-1, 4)
    upright = TangentPlanes(surface).quality(*places_of(surface, corners), corners, quads) > 0
    angles = corner_angles(Faces.of_one_size(corners, quads), wanted.triangles, wanted.ground)
    inverted = angles.inverted.reshape(-1, 4).any(axis=1)
    assert upright.any()
    assert not upright.all()
    assert not (upright & inverted).any()
