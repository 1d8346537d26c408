"""What is under the mouse, by rays of our own."""

from collections.abc import Iterator

import numpy as np
import pytest
import pyvista as pv

from crossview.gui.picking import Picker
from crossview.scene import Scene, SceneView, ensure_rendering
from solvers.primitives import disk, sphere
from solvers.surface import TriSurface

BALL = sphere(3)


@pytest.fixture
def plotter() -> Iterator[pv.Plotter]:
    ensure_rendering()
    made = pv.Plotter(off_screen=True, window_size=(400, 400))
    scene = Scene(made)
    scene.show(SceneView(BALL.vertices, BALL.faces))
    scene.fit("0.4,0.3,4,0,0,0,0,1,0")
    made.screenshot(return_img=True)
    yield made
    made.close()


def test_the_far_side_is_not_picked(plotter: pv.Plotter) -> None:
    picker = Picker(plotter.renderer)
    picker.aim(BALL)
    for z, wanted in ((1.0, 0), (-1.0, None)):
        place = np.array([[0.05, 0.08, z * np.sqrt(1.0 - 0.05**2 - 0.08**2)]])
        at = picker._display(place[0])
        assert picker.nearest(at, place, 0.02, 7.0) == wanted


def test_a_ray_that_slips_between_triangles_does_not_hide_what_is_before(
    plotter: pv.Plotter,
) -> None:
    vertex = int(np.argmax(BALL.vertices[:, 2]))
    place = BALL.vertices[vertex][None]
    faces = BALL.faces[(BALL.faces != vertex).all(axis=1)]
    used, numbers = np.unique(faces, return_inverse=True)
    picker = Picker(plotter.renderer)
    picker.aim(TriSurface(BALL.vertices[used], numbers.reshape(-1, 3)))
    at = picker._display(place[0])
    assert np.linalg.norm(picker.pick(at).position - place[0]) > 1.5
    assert picker.nearest(at, place, 0.02, 7.0) == 0


def test_a_ray_through_a_vertex_meets_the_surface(plotter: pv.Plotter) -> None:
    surface = disk()
    picker = Picker(plotter.renderer)
    picker.aim(surface)
    inner = np.setdiff1d(np.arange(surface.n_vertices), np.concatenate(surface.boundary_loops))
    for vertex in surface.vertices[inner]:
        pick = picker.pick(picker._display(vertex))
        assert pick is not None
        np.testing.assert_allclose(pick.position, vertex, atol=1e-9)
