"""Arms of crosses: along u and v, as long as exp(H) says, on the surface."""

import numpy as np
import pytest
from numpy.typing import NDArray

from crossview.scene.crosses import CrossGlyphs
from crossview.view.geometry import Triangles
from solvers.primitives import square


def field(triangles: Triangles, degrees: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """A unit cross at an angle against x or, on sides along x, y."""
    n = triangles.normals
    first = np.where(np.abs(n[:, :1]) > 0.5, [[0.0, 1.0, 0.0]], [[1.0, 0.0, 0.0]])
    second = np.cross(n, first)
    a = np.radians(degrees)
    u = np.cos(a) * first + np.sin(a) * second
    return u, np.cross(n, u)


def cube(n: int) -> Triangles:
    """The unit cube about the origin as six grids that do not share vertices within 1e-12."""
    plate = square(n)
    side = plate.vertices + [0.0, 0.0, 0.5]
    turns = [np.eye(3), np.diag([1.0, -1.0, -1.0])]
    for axis in (0, 1):
        for sign in (1.0, -1.0):
            i, j = [k for k in range(3) if k != axis]
            turn = np.eye(3)
            turn[[i, j]] = np.eye(3)[[j, i]] * [[sign], [-sign]]
            turns.append(turn)
    points = np.vstack([side @ turn.T for turn in turns])
    faces = np.vstack([plate.faces + k * len(side) for k in range(6)])
    _, first, numbers = np.unique(points.round(9), axis=0, return_index=True, return_inverse=True)
    return Triangles(points[first], numbers.reshape(-1)[faces])


def test_arms_follow_the_field_and_the_size() -> None:
    plate = Triangles(square(24).vertices, square(24).faces)
    u, v = field(plate, 30.0)
    h = plate.points[:, 0]
    glyphs = CrossGlyphs(plate, 0.3)
    ends = glyphs.ends(u, v, h, 1.0, False).reshape(-1, 4, 3)
    arm = 0.5 * (ends[:, 1] - ends[:, 0])
    length = np.linalg.norm(arm, axis=1)
    assert np.allclose(arm / length[:, None], [np.cos(np.pi / 6), 0.5, 0.0])
    assert np.allclose(ends.mean(axis=1), glyphs.sites.positions)
    inside = glyphs.sites.free > glyphs.sites.spacing
    log_size = np.log(length[inside]) - glyphs.sites.positions[inside, 0]
    assert np.ptp(log_size) < 1e-9
    half = np.full((len(plate.faces), 3), 0.2)
    two = glyphs.ends(u, v, 0.0 * h, 0.5, False, half).reshape(-1, 4, 3)
    along, across = two[:, 1] - two[:, 0], two[:, 3] - two[:, 2]
    ratio = np.linalg.norm(across, axis=1) / np.linalg.norm(along, axis=1)
    assert np.allclose(ratio[inside], np.exp(0.4))
    uniform = glyphs.ends(u, v, h, 2.0, True).reshape(-1, 4, 3)[inside]
    assert np.ptp(np.linalg.norm(uniform[:, 1] - uniform[:, 0], axis=1)) < 1e-12


@pytest.mark.parametrize("degrees", [0.0, 45.0])
def test_no_arm_leaves_a_cube(degrees: float) -> None:
    box = cube(16)
    assert len(box.boundary_edges) == 0
    assert len(box.sharp_edges(50.0)) == 12 * 16
    ends = CrossGlyphs(box, 0.5).ends(*field(box, degrees), None, 1.0, True)
    assert np.abs(ends).max() < 0.5 + 0.002
