"""Polygons become n - 2 triangles that cover them, or are refused by number; none is lost."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from crossview.io.polygons import Polygons
from solvers.errors import SurfaceError
from solvers.surface import FloatArray, IntArray


def triangles(*polygons: FloatArray) -> tuple[FloatArray, IntArray]:
    """Points and triangles of polygons, each with corners of its own."""
    points = np.concatenate(polygons)
    sizes = np.array([len(polygon) for polygon in polygons])
    faces, _ = Polygons(points, sizes, np.arange(len(points))).triangles()
    return points, faces


def vector_areas(points: FloatArray, faces: IntArray) -> FloatArray:
    a, b, c = (points[faces[:, i]] for i in range(3))
    return np.asarray(np.cross(b - a, c - a) / 2)


def vector_area(polygon: FloatArray) -> FloatArray:
    """Of any closed polygon, by the sum over its sides."""
    return np.asarray(np.cross(polygon, np.roll(polygon, -1, axis=0)).sum(axis=0) / 2)


@given(st.integers(4, 30), st.integers(0, 10**6))
def test_star_shaped_polygons_are_covered_once(size: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    angles = 2 * np.pi * (np.arange(size) + rng.uniform(-0.3, 0.3, size)) / size
    flat = rng.uniform(0.2, 1, size)[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    polygon = np.pad(flat, ((0, 0), (0, 1))) @ Rotation.random(random_state=seed).as_matrix().T
    points, faces = triangles(polygon + 7)
    assert len(faces) == size - 2
    areas = vector_areas(points, faces)
    normal = vector_area(polygon)
    assert (areas @ normal >= -1e-12).all()
    assert areas.sum(axis=0) == pytest.approx(normal, abs=1e-12)


def test_a_hole_that_a_double_edge_leads_to_stays_open() -> None:
    outer = [(0, 0), (4, 0), (4, 4), (0, 4), (0, 0)]
    inner = [(1, 1), (1, 2), (2, 2), (2, 1), (1, 1)]
    polygon = np.pad(np.array(outer + inner, dtype=float), ((0, 0), (0, 1)))
    points, faces = triangles(polygon)
    areas = np.linalg.norm(vector_areas(points, faces), axis=1)
    assert len(faces) == len(polygon) - 2
    assert areas.sum() == pytest.approx(16 - 1)
    centres = points[faces].mean(axis=1)[areas > 0]
    assert not ((centres[:, :2] > 1) & (centres[:, :2] < 2)).all(axis=1).any()


def test_polygons_that_are_not_flat_keep_every_corner() -> None:
    angles = 2 * np.pi * np.arange(6) / 6
    wavy = np.stack([np.cos(angles), np.sin(angles), 0.3 * np.cos(3 * angles)], axis=1)
    points, faces = triangles(wavy)
    assert len(faces) == 4
    assert np.unique(faces).tolist() == list(range(6))
    assert vector_areas(points, faces).sum(axis=0) == pytest.approx(vector_area(wavy))


def test_polygons_that_cross_themselves_are_refused_by_number() -> None:
    square = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], dtype=float)
    with pytest.raises(SurfaceError, match="cross themselves") as caught:
        triangles(square, square[[0, 2, 1, 3]], square, square[[1, 3, 0, 2]])
    assert (caught.value.elements.tolist(), caught.value.kind) == ([1, 3], "faces")


def test_a_corner_that_follows_itself_is_left_out() -> None:
    points = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], dtype=float)
    faces, notes = Polygons(points, np.array([5]), np.array([0, 1, 1, 2, 3])).triangles()
    assert len(faces) == 2
    assert "left out 1 corner that follow themselves" in notes
