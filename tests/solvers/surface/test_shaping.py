"""Poor triangles are refined intrinsically: the metric stays, and so does what is good."""

import numpy as np
import pytest

from solvers.primitives import BUILTIN
from solvers.surface.delaunay import intrinsic_delaunay
from solvers.surface.shaping import ANGLES, parted, shaped
from solvers.surface.trisurface import TriSurface
from solvers.surface.working import WorkingTriangulation
from tests.solvers.suite import SURFACES, polar_annulus


def pulled_torus() -> TriSurface:
    torus = BUILTIN["torus"](n=24)
    return TriSurface(torus.vertices * [1, 1, 12], torus.faces)


def delaunay(surface: TriSurface) -> WorkingTriangulation:
    return intrinsic_delaunay(surface.triangulation)


@pytest.mark.parametrize("name", sorted(set(SURFACES) - {"slivers"}))
def test_good_triangles_stay_as_they_are(name: str) -> None:
    working = delaunay(SURFACES[name]())
    assert shaped(working) is working


@pytest.mark.parametrize(
    "surface",
    [pulled_torus(), polar_annulus(100, 4), polar_annulus(12, 40)],
    ids=["torus", "thin spokes", "thin rings"],
)
def test_angles_are_bounded_and_the_metric_stays(surface: TriSurface) -> None:
    before = delaunay(surface)
    assert before.triangulation.angles.min() < np.radians(8)
    t = shaped(before).triangulation
    assert t.angles.min() > ANGLES[-1] - 1e-6
    assert t.weights[t.twin >= 0].min() > -1e-9
    assert t.areas.sum() == pytest.approx(surface.area, rel=1e-12)
    curvature = np.zeros(t.n_vertices)
    curvature[: surface.n_vertices] = surface.angle_defects
    assert np.abs(t.curvatures - curvature).max() < 1e-9


def test_small_angles_between_fixed_edges_stay_and_refinement_ends() -> None:
    """A wedge of three degrees, and a spike around whose tip there are 20 degrees in all."""
    wedge = TriSurface([[0, 0, 0], [1, 0, 0], [1, np.tan(np.radians(3)), 0]], [[0, 1, 2]])
    t = shaped(delaunay(wedge)).triangulation
    assert np.degrees(t.angles.min()) == pytest.approx(3, abs=1e-9)
    assert t.n_vertices < 50
    angle = 2 * np.pi * np.arange(8) / 8
    ring = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    around = np.arange(8)
    faces = np.stack([0 * around, 1 + around, 1 + (around + 1) % 8], axis=1)
    spike = TriSurface(np.concatenate([[[0, 0, 17.5]], ring]), faces)
    t = shaped(delaunay(spike)).triangulation
    at_tip = t.angles[t.faces == 0]
    assert np.degrees(at_tip.sum()) == pytest.approx(20, abs=1)
    assert t.n_vertices < 500


def test_a_surface_turned_in_space_gets_the_same_vertices() -> None:
    surface = SURFACES["slivers"]()
    turn = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    moved = TriSurface(surface.vertices @ turn.T * np.linalg.det(turn), surface.faces)
    one, other = (shaped(delaunay(each)).triangulation for each in (surface, moved))
    np.testing.assert_array_equal(one.faces, other.faces)
    np.testing.assert_allclose(one.lengths, other.lengths, rtol=1e-9)


def test_no_triangle_keeps_two_edges_to_follow() -> None:
    surface = BUILTIN["square"](n=8)
    own = surface.triangulation
    rng = np.random.default_rng(2)
    marked = own.edge_halfedges[rng.random(len(own.edge_halfedges)) < 0.4]
    marks = np.zeros((1, len(own.twin)), dtype=np.int64)
    marks[0, marked] = np.arange(1, len(marked) + 1)
    working = parted(intrinsic_delaunay(own, marks), 0)
    t, row = working.triangulation, working.marks[0] != 0
    follows = (row | row[t.twin] | (t.twin < 0)).reshape(-1, 3)
    assert follows.sum(axis=1).max() == 1
    assert t.areas.sum() == pytest.approx(surface.area, rel=1e-12)
