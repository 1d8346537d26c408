"""How far singularities keep from the boundary, whatever its edges."""

from __future__ import annotations

import numpy as np
import pytest

from solvers.singularities import Singularity
from solvers.singularities.spacing import CLOSEST, Spacing
from solvers.surface import TriSurface


@pytest.mark.parametrize("along", [-0.4, 0.0, 0.3])
@pytest.mark.parametrize("away", [0.5, 0.9, 1.1])
def test_the_boundary_is_near_also_far_from_its_vertices(along: float, away: float) -> None:
    """A square of one edge a side: its vertices are 0.7 from the middles of their edges."""
    corners = [
        [-0.5, -0.5, 0.0],
        [0.5, -0.5, 0.0],
        [0.5, 0.5, 0.0],
        [-0.5, 0.5, 0.0],
        [0.0, 0.0, 0.0],
    ]
    square = TriSurface(corners, [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
    start = [Singularity(square.closest_point([0.0, 0.1, 0.0]), 3)]
    spacing = Spacing(square, start, np.array([True]), np.zeros(len(square.edges), dtype=bool))
    height = -0.5 + away * CLOSEST  # of a square root of the area 1
    moved = [Singularity(square.closest_point([along, height, 0.0]), 3)]
    near = spacing.too_near(moved)
    assert (len(near) > 0) == (away < 1)
    if len(near):
        rows, gaps = spacing.equations(moved, near)
        assert gaps[0] > 0
        up = square.face_frames[0][moved[0].point.face], square.face_frames[1][moved[0].point.face]
        direction = rows[0, 0] * up[0] + rows[0, 1] * up[1]
        assert direction[1] > 0.9  # away from the edge, not from a corner
