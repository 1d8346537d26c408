"""Dashes, cross angles, boundaries and cameras, from arrays alone."""

import numpy as np
import pytest
from numpy.typing import NDArray

from crossview.scene.camera import Camera, Room, camera_for
from crossview.view.field import cross_angle
from crossview.view.geometry import Triangles, dashes, section
from crossview.view.values import Plane
from solvers.errors import CrossviewError
from solvers.primitives import annulus, blob, sphere, square, torus
from solvers.surface.trisurface import TriSurface


def triangles(surface: TriSurface) -> Triangles:
    return Triangles(surface.vertices, surface.faces)


def covered(ends: NDArray[np.floating], segments: NDArray[np.integer]) -> np.ndarray:
    """Intervals drawn along x, joined where they touch."""
    spans = np.sort(ends[segments][:, :, 0], axis=1)
    spans = spans[np.argsort(spans[:, 0])]
    starts = np.flatnonzero(np.r_[True, spans[1:, 0] > spans[:-1, 1] + 1e-9])
    return np.stack([spans[starts, 0], np.maximum.reduceat(spans[:, 1], starts)], axis=1)


class TestDashes:
    def test_run_on_from_edge_to_edge(self) -> None:
        x = np.sort(np.r_[0.0, np.random.default_rng(2).random(40), 1.0])
        points = np.column_stack([x, 0 * x, 0 * x])
        i = np.arange(len(x) - 1)
        ends, segments = dashes(points, np.stack([i, i + 1], 1), 0.06, 0.04)
        starts = np.arange(10) * 0.1
        assert np.allclose(covered(ends, segments), np.stack([starts, starts + 0.06], 1))

    def test_lie_on_a_closed_loop_and_cover_their_share(self) -> None:
        turn = np.linspace(0.0, 2.0 * np.pi, 400, endpoint=False)
        points = np.stack([np.cos(turn), np.sin(turn), 0 * turn], 1)
        i = np.arange(400)
        ends, segments = dashes(points, np.stack([i, np.roll(i, -1)], 1), 0.06, 0.04)
        drawn = np.linalg.norm(ends[segments[:, 1]] - ends[segments[:, 0]], axis=1).sum()
        assert drawn / (2.0 * np.pi) == pytest.approx(0.6, abs=0.02)
        assert np.abs(np.linalg.norm(ends, axis=1) - 1.0).max() < 1e-4

    def test_separate_pieces_are_all_dashed(self) -> None:
        points = np.array([[0, 0, 0], [1, 0, 0], [0, 5, 0], [1, 5, 0]], float)
        ends, _ = dashes(points, np.array([[0, 1], [3, 2]]), 0.3, 0.2)
        assert {0.0, 5.0} == set(ends[:, 1])


class TestTriangles:
    def test_boundary_edges_are_those_of_the_loops(self) -> None:
        ring = annulus(n=24)
        wanted = {
            frozenset(map(int, pair))
            for loop in ring.boundary_loops
            for pair in zip(loop, np.roll(loop, -1), strict=True)
        }
        assert {frozenset(map(int, e)) for e in triangles(ring).boundary_edges} == wanted

    def test_only_planar_surfaces_have_a_plane(self) -> None:
        assert triangles(square(4)).plane_normal == pytest.approx([0.0, 0.0, 1.0])
        assert triangles(torus(n=24)).plane_normal is None

    def test_cross_angle_is_that_of_a_turned_field_up_to_a_quarter_turn(self) -> None:
        plate = square(4)
        for degrees in (0.0, 20.0, 75.0, 110.0, -33.0):
            a = np.radians(degrees)
            u = np.tile([np.cos(a), np.sin(a), 0.0], (plate.n_faces, 1))
            found = np.degrees(cross_angle(triangles(plate), u))
            off = (found - degrees + 45.0) % 90.0 - 45.0
            assert np.abs(off).max() < 1e-9
            assert found.min() >= 0.0
            assert found.max() <= 90.0


ROOM = Room(800, 600, left=20, right=120, top=40, bottom=60)


def pixels(camera: Camera, points: NDArray[np.float64]) -> np.ndarray:
    """Where points fall, in pixels from the bottom left, by VTK's conventions."""
    from vtkmodules.vtkRenderingCore import vtkCamera

    vtk_camera = vtkCamera()
    camera.apply(vtk_camera)
    vtk_camera.SetClippingRange(0.01, 100.0)
    matrix = vtk_camera.GetCompositeProjectionTransformMatrix(ROOM.width / ROOM.height, -1, 1)
    m = np.array([[matrix.GetElement(i, j) for j in range(4)] for i in range(4)])
    clip = np.c_[points, np.ones(len(points))] @ m.T
    return np.asarray((clip[:, :2] / clip[:, 3:] + 1.0) / 2.0 * [ROOM.width, ROOM.height])


class TestCamera:
    @pytest.mark.parametrize("preset", ["auto", "iso", "xy", "xz", "yz"])
    @pytest.mark.parametrize("surface", [torus(n=36), blob(subdivisions=3)])
    def test_a_surface_fills_the_room_and_no_more(self, preset: str, surface: TriSurface) -> None:
        self.check_fit(preset, surface)

    @pytest.mark.parametrize("preset", ["auto", "iso", "xy"])
    def test_so_does_a_plane(self, preset: str) -> None:
        self.check_fit(preset, annulus(n=48))

    @pytest.mark.parametrize("preset", ["iso", "xy"])
    def test_so_does_a_surface_far_from_the_origin(self, preset: str) -> None:
        ball = blob(subdivisions=3)
        self.check_fit(preset, TriSurface(ball.vertices + [3e3, -1e3, 2e3], ball.faces))

    def check_fit(self, preset: str, surface: TriSurface) -> None:
        seen = pixels(camera_for(preset, triangles(surface), ROOM), surface.vertices)
        gaps = np.r_[seen.min(0) - [20, 60], [800 - 120, 600 - 40] - seen.max(0)]
        assert gaps.min() > -0.5
        assert min(gaps[0] + gaps[2], gaps[1] + gaps[3]) < 1.0
        assert abs(gaps[0] - gaps[2]) < 1.0
        assert abs(gaps[1] - gaps[3]) < 1.0

    def test_planar_surfaces_are_seen_from_straight_above(self) -> None:
        camera = camera_for("auto", triangles(annulus(n=48)), ROOM)
        towards = np.subtract(camera.position, camera.focus)
        assert np.allclose(towards / np.linalg.norm(towards), [0.0, 0.0, 1.0])
        assert camera.parallel_scale is not None

    def test_nine_numbers_are_taken_as_they_are(self) -> None:
        camera = camera_for("1,2,3, 0,0,0, 0,0,1", triangles(torus(n=24)), ROOM)
        assert camera.position == (1.0, 2.0, 3.0)
        assert camera.up == (0.0, 0.0, 1.0)

    @pytest.mark.parametrize("text", ["front", "1,2,3", "1,2,3,0,0,0,0,0,nan", "0,0,1,0,0,0,0,0,2"])
    def test_other_words_are_refused_in_one_line(self, text: str) -> None:
        with pytest.raises(CrossviewError) as caught:
            camera_for(text, triangles(torus(n=24)), ROOM)
        assert "\n" not in str(caught.value)


def test_a_plane_meets_a_sphere_in_a_closed_circle() -> None:
    ends = section(triangles(sphere()), Plane((0.0, 0.0, 0.3), (0.0, 0.0, 1.0)))
    np.testing.assert_allclose(ends[:, 2], 0.3, atol=1e-12)
    _, met = np.unique(ends.round(9), axis=0, return_counts=True)
    assert (met == 2).all()
    length = np.linalg.norm(ends[1::2] - ends[::2], axis=1).sum()
    assert length == pytest.approx(2 * np.pi * np.sqrt(1 - 0.3**2), rel=5e-3)
