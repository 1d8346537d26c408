"""Shortest paths over surfaces, against what geometry says of them."""

import math

import numpy as np
import numpy.typing as npt
import pytest

from solvers.primitives import annulus, blob, cylinder, disk, sphere, torus
from solvers.surface import EdgePaths, FloatArray, TriSurface, shortest_path


def length(path: FloatArray) -> float:
    return float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())


def between(surface: TriSurface, one: npt.ArrayLike, other: npt.ArrayLike) -> FloatArray:
    return shortest_path(surface, surface.closest_point(one), surface.closest_point(other))


def test_in_a_convex_plane_figure_they_are_straight() -> None:
    surface, draw = disk(), np.random.default_rng(1)
    for one, other in draw.uniform(-0.7, 0.7, (20, 2, 2)):
        path = between(surface, [*one, 0.0], [*other, 0.0])
        np.testing.assert_allclose(path[[0, -1], :2], [one, other], atol=1e-12)
        assert length(path) == pytest.approx(math.dist(one, other), rel=1e-12)


def test_round_a_hole_they_are_two_tangents_and_an_arc() -> None:
    surface = annulus()
    rims = [surface.vertices[loop] for loop in surface.boundary_loops]
    inner = min(float(np.linalg.norm(rim, axis=1).mean()) for rim in rims)
    outer = max(float(np.linalg.norm(rim, axis=1).mean()) for rim in rims)
    far = 0.9 * outer
    path = between(surface, [far, 0.0, 0.0], [-far, 0.0, 0.0])
    tangent = math.sqrt(far**2 - inner**2)
    exact = 2 * tangent + inner * (math.pi - 2 * math.acos(inner / far))
    # the hole is a polygon inside its circle
    assert exact * 0.99 < length(path) <= exact * (1 + 1e-12)


def test_a_cylinder_is_as_its_plane() -> None:
    surface = cylinder()
    radius = float(np.linalg.norm(surface.vertices[0, :2]))
    heights = surface.vertices[:, 2]
    low, high = heights.min(), heights.max()
    ring = np.flatnonzero(np.isclose(heights, low))
    turn = np.arctan2(surface.vertices[ring, 1], surface.vertices[ring, 0])
    one, other = ring[np.argsort(turn)[[0, len(ring) // 3]]]
    half = math.pi / len(ring)
    across = 2 * radius * math.sin(half) * (len(ring) // 3)
    bands = len(np.unique(heights.round(9))) - 1  # of triangles that lean inwards by turns
    up = bands * math.hypot((high - low) / bands, radius * (1 - math.cos(half)))
    above = surface.vertices[other] + [0.0, 0.0, high - low]
    path = between(surface, surface.vertices[one], above)
    assert length(path) == pytest.approx(math.hypot(across, up), rel=1e-12)


@pytest.mark.parametrize("subdivisions", [2, 3, 4])
def test_on_a_sphere_they_come_to_great_circles(subdivisions: int) -> None:
    surface, draw = sphere(subdivisions), np.random.default_rng(2)
    for one, other in draw.normal(size=(10, 2, 3)):
        one, other = one / np.linalg.norm(one), other / np.linalg.norm(other)
        angle = math.acos(float(np.clip(one @ other, -1.0, 1.0)))
        assert length(between(surface, one, other)) == pytest.approx(
            angle, rel=0.5 / 4**subdivisions
        )


@pytest.mark.parametrize("surface", [torus(), blob()], ids=["torus", "blob"])
def test_they_are_as_long_back_on_the_surface_and_shorter_than_along_edges(
    surface: TriSurface,
) -> None:
    draw = np.random.default_rng(3)
    edges = EdgePaths(surface)
    lengths = np.linalg.norm(np.diff(surface.vertices[surface.edges], axis=1)[:, 0], axis=1)
    for one, other in draw.choice(surface.n_vertices, (10, 2), replace=False):
        start, end = surface.point_at_vertex(int(one)), surface.point_at_vertex(int(other))
        path = shortest_path(surface, start, end)
        assert length(path) <= lengths[edges.through(np.array([one, other]))].sum() * (1 + 1e-12)
        assert length(path) >= math.dist(surface.vertices[one], surface.vertices[other])
        middles = (path[1:] + path[:-1]) / 2
        for place in middles[:: max(len(middles) // 5, 1)]:
            near = surface.position(surface.closest_point(place))
            np.testing.assert_allclose(near, place, atol=1e-9)
        # a part of it is a shortest path, too
        part = between(surface, path[len(path) // 3], path[2 * len(path) // 3])
        assert length(part) <= length(path[len(path) // 3 : 2 * len(path) // 3 + 1]) + 1e-9


def test_in_one_triangle_and_to_itself() -> None:
    surface = disk()
    middle = surface.point(5, (0.2, 0.3, 0.5))
    assert length(shortest_path(surface, middle, middle)) == 0.0
    corner = surface.point(5, (1.0, 0.0, 0.0))
    straight = np.linalg.norm(surface.position(corner) - surface.position(middle))
    assert length(shortest_path(surface, middle, corner)) == pytest.approx(float(straight))
