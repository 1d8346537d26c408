"""Moves of a working triangulation keep the metric, and are followed there and back."""

import numpy as np
import pytest

from solvers.surface.delaunay import flip_to_delaunay, intrinsic_delaunay
from solvers.surface.triangulation import QUARTER, FloatArray, IntArray, wrap
from solvers.surface.trisurface import TriSurface
from solvers.surface.working import Edit, WorkingTriangulation
from tests.solvers.suite import SURFACES


def split_at_random(edit: Edit, seed: int) -> None:
    """Split edges and triangles here and there, and flip to Delaunay after each round."""
    rng = np.random.default_rng(seed)
    for _ in range(4):
        h = rng.choice(len(edit.twin), len(edit.twin) // 9, replace=False)
        across = np.where(edit.twin[h] >= 0, edit.twin[h] // 3, -1)
        h = h[edit.disjoint(rng.random(len(h)), h // 3, across)]
        edit.split_edges(h, rng.uniform(0.2, 0.8, len(h)))
        flip_to_delaunay(edit, np.arange(len(edit.twin)))
        face = rng.choice(len(edit.faces), len(edit.faces) // 9, replace=False)
        corners = edit.done().triangulation.corner_positions[face]
        edit.split_faces(
            face, np.einsum("ki,kij->kj", rng.dirichlet([2, 2, 2], len(face)), corners)
        )
        flip_to_delaunay(edit, np.arange(len(edit.twin)))


def changed(surface: TriSurface, seed: int = 0) -> WorkingTriangulation:
    edit = WorkingTriangulation.of(surface.triangulation).edit()
    split_at_random(edit, seed)
    return edit.done()


def random_places(working: WorkingTriangulation, seed: int) -> tuple[IntArray, FloatArray]:
    rng = np.random.default_rng(seed)
    face = rng.integers(working.triangulation.n_faces, size=500)
    corners = working.triangulation.corner_positions[face]
    return face, np.einsum("ki,kij->kj", rng.dirichlet([1, 1, 1], len(face)), corners)


def positions(surface: TriSurface, face: IntArray, place: FloatArray) -> FloatArray:
    along, across = (frame[face] for frame in surface.face_frames)
    origin = surface.vertices[surface.faces[face, 0]]
    return np.asarray(origin + place[:, :1] * along + place[:, 1:] * across)


@pytest.mark.parametrize("name", SURFACES)
def test_moves_keep_the_metric(name: str) -> None:
    surface = SURFACES[name]()
    t = changed(surface).triangulation
    assert t.n_faces > 2 * surface.n_faces
    assert t.areas.sum() == pytest.approx(surface.area, rel=1e-12)
    curvature = np.zeros(t.n_vertices)
    curvature[: surface.n_vertices] = surface.angle_defects
    assert np.abs(t.curvatures - curvature).max() < 1e-8  # new vertices are flat
    h = np.flatnonzero(t.twin >= 0)
    assert (t.twin[t.twin[h]] == h).all()
    assert (t.tail[h] == t.head[t.twin[h]]).all()
    assert (t.lengths.reshape(-1)[h] == t.lengths.reshape(-1)[t.twin[h]]).all()


@pytest.mark.parametrize("name", SURFACES)
def test_points_and_directions_go_there_and_back(name: str) -> None:
    surface = SURFACES[name]()
    working = changed(surface)
    face, place = random_places(working, seed=1)
    lifted = working.lift(face, place)
    back = working.locate(lifted.face, lifted.place)
    same = back.face == face
    assert same.mean() > 0.99  # but for points on edges
    assert np.abs(back.place[same] - place[same]).max() < 1e-12 * surface.diagonal
    assert np.abs(wrap(back.turn + lifted.turn, 2 * np.pi)[same]).max() < 1e-7
    inside = surface.triangulation.corner_positions[lifted.face]
    assert (lifted.place[:, 1] > -1e-12 * surface.diagonal).all()
    assert (lifted.place[:, 1] < inside[:, 2, 1] + 1e-12 * surface.diagonal).all()


@pytest.mark.parametrize("name", SURFACES)
def test_lines_become_unbroken_lines_of_the_same_length(name: str) -> None:
    surface = SURFACES[name]()
    working = changed(surface)
    corners = working.triangulation.corner_positions
    face, start = random_places(working, seed=2)
    end = corners[face].mean(axis=1)
    pieces = working.lift_segments(face, start, end)
    first, last = (positions(surface, pieces.face, pieces.ends[:, i]) for i in (0, 1))
    lengths = np.linalg.norm(last - first, axis=1)
    whole = np.linalg.norm(end - start, axis=1)
    tiny = 1e-11 * surface.diagonal
    assert np.abs(np.bincount(pieces.line, lengths) - whole).max() < tiny
    follows = np.flatnonzero(np.diff(pieces.line) == 0)
    assert np.abs(last[follows] - first[follows + 1]).max() < tiny
    assert np.abs(np.diff(pieces.part)[:, 0] * whole[pieces.line] - lengths).max() < tiny
    own = surface.triangulation.corner_positions[pieces.face]
    assert (pieces.ends[..., 1] > -tiny).all()
    assert (pieces.ends[..., 1] < own[:, None, 2, 1] + tiny).all()


def test_each_vertex_is_lifted_to_itself() -> None:
    surface = SURFACES["slivers"]()
    working = changed(surface)
    t = working.triangulation
    face, corner = np.nonzero(t.faces < surface.n_vertices)
    lifted = working.lift(face, t.corner_positions[face, corner])
    where = positions(surface, lifted.face, lifted.place)
    assert np.abs(where - surface.vertices[t.faces[face, corner]]).max() < 1e-12 * 10


def test_crosses_and_their_matching_go_along() -> None:
    """A parallel field on a rolled-up sheet stays parallel, whatever branch a triangle takes."""
    surface = SURFACES["cylinder"]()
    own = surface.triangulation
    rng = np.random.default_rng(3)
    along = np.array([0.0, 0.0, 1.0])
    x, y = surface.face_frames
    branch = rng.integers(-2, 3, surface.n_faces)
    angles = np.arctan2(y @ along, x @ along) + QUARTER * branch
    turns = np.where(
        own.twin >= 0, branch[np.arange(len(own.twin)) // 3] - branch[own.twin // 3], 0
    )
    edit = WorkingTriangulation.of(own).edit(turns=turns, angles=angles)
    split_at_random(edit, seed=4)
    t = edit.done().triangulation
    h = np.flatnonzero(t.twin >= 0)
    g = t.twin[h]
    assert (edit.turns[h] == -edit.turns[g]).all()
    assert not edit.turns[t.twin < 0].any()
    off = edit.angles[h // 3] + t.transport[h] - edit.angles[g // 3] - QUARTER * edit.turns[h]
    assert np.abs(wrap(off, 2 * np.pi)).max() < 1e-7


def test_both_halves_of_a_marked_edge_keep_its_number() -> None:
    surface = SURFACES["slivers"]()
    own = surface.triangulation
    h = own.edge_halfedges[::7]
    marks = np.zeros((1, len(own.twin)), dtype=np.int64)
    marks[0, h] = np.arange(1, len(h) + 1)
    edit = intrinsic_delaunay(own, marks).edit()
    split_at_random(edit, seed=5)
    working = edit.done()
    marked = np.flatnonzero(working.marks[0])
    number = working.marks[0, marked] - 1
    lengths = np.bincount(number, working.triangulation.lengths.reshape(-1)[marked])
    assert np.abs(lengths - own.lengths.reshape(-1)[h]).max() < 1e-12 * surface.diagonal
    assert len(marked) > len(h)
