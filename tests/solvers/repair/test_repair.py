"""Repair: what it mends, what it says of it, and what it refuses."""

import numpy as np
import pytest
from numpy.typing import ArrayLike, NDArray

from solvers.errors import SurfaceError
from solvers.primitives import annulus, sphere, torus
from solvers.repair.soup import repair, repair_each
from solvers.surface.trisurface import TriSurface


@pytest.fixture
def ball() -> TriSurface:
    return sphere(2)


def soup(surface: TriSurface) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Each triangle with three vertices of its own, as STL stores them."""
    return soup_of(surface.vertices, surface.faces)


def soup_of(
    vertices: NDArray[np.float64], faces: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    return vertices[faces].reshape(-1, 3), np.arange(faces.size).reshape(-1, 3)


def beside(
    first: TriSurface, second: TriSurface, shift: float
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Two surfaces as one pair of arrays, the second moved along x."""
    moved = second.vertices + np.array([shift, 0, 0])
    return (
        np.concatenate([first.vertices, moved]),
        np.concatenate([first.faces, second.faces + first.n_vertices]),
    )


def moebius(n: int = 24) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """A strip of 2 n triangles around a circle, half a turn per round."""
    angle = np.arange(n) * 2 * np.pi / n
    sides = []
    for side in (-0.3, 0.3):
        r = 1 + side * np.cos(angle / 2)
        sides.append(np.stack([r * np.cos(angle), r * np.sin(angle), side * np.sin(angle / 2)], 1))
    i = np.arange(n)
    j = (i + 1) % n
    low, high = j + n * (j == 0), j + n * (j != 0)
    faces = np.concatenate([np.stack([i, low, high], 1), np.stack([i, high, i + n], 1)])
    return np.concatenate(sides), faces


def test_a_good_surface_stays_as_it_is(ball: TriSurface) -> None:
    repaired = repair(ball.vertices, ball.faces, merge=True, cut_apart=True, component="largest")
    assert repaired.notes == ()
    assert np.array_equal(repaired.surface.faces, ball.faces)
    assert np.array_equal(repaired.surface.vertices, ball.vertices)


def test_unused_vertices_are_dropped_whatever_they_hold(ball: TriSurface) -> None:
    vertices = np.concatenate([[[np.nan, 0, 0]], ball.vertices, [[9, 9, 9]]])
    repaired = repair(vertices, ball.faces + 1)
    assert repaired.notes == ("dropped 2 unused vertices",)
    assert np.array_equal(repaired.surface.vertices, ball.vertices)
    assert np.array_equal(repaired.surface.faces, ball.faces)


def test_elements_keep_the_callers_numbers_beside_unused_vertices() -> None:
    book = np.array([[4, 5, 6], [5, 4, 7], [4, 5, 8]])
    corners = np.zeros((9, 3))
    corners[4:] = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1]]
    with pytest.raises(SurfaceError) as caught:
        repair(corners, book)
    assert caught.value.elements.tolist() == [[4, 5]]


def test_coincident_vertices_are_merged_in_order(ball: TriSurface) -> None:
    repaired = repair(*soup(ball), merge=True)
    merged = 3 * ball.n_faces - ball.n_vertices
    assert repaired.notes == (f"merged {merged} coincident vertices",)
    assert repaired.surface.euler_characteristic == 2
    assert np.array_equal(
        repaired.surface.vertices[repaired.surface.faces], ball.vertices[ball.faces]
    )


def test_vertices_merge_despite_single_precision(ball: TriSurface) -> None:
    vertices, faces = soup(ball)
    noise = np.random.default_rng(1).uniform(-1, 1, vertices.shape) * 1e-7
    assert repair(vertices + noise, faces, merge=True).surface.n_vertices == ball.n_vertices


def test_triangles_that_vanish_by_merging_are_dropped_with_a_note(ball: TriSurface) -> None:
    vertices, faces = soup(ball)
    point = np.repeat(vertices[:1], 3, axis=0)
    faces = np.concatenate([faces, np.arange(3)[None] + len(vertices)])
    repaired = repair(np.concatenate([vertices, point]), faces, merge=True)
    assert "dropped 1 triangle that vanished" in repaired.notes[0]
    assert repaired.surface.euler_characteristic == 2


def test_triangles_are_turned_to_agree_the_fewest_in_the_plane() -> None:
    flat = annulus(n=12)
    faces = flat.faces.copy()
    faces[[3, 8, 20]] = faces[[3, 8, 20], ::-1]
    repaired = repair(flat.vertices, faces)
    assert repaired.notes == ("turned 3 triangles to agree with the others",)
    assert np.all(repaired.surface.face_normals[:, 2] > 0)


def test_a_closed_surface_that_is_turned_faces_outwards(ball: TriSurface) -> None:
    faces = ball.faces[:, ::-1].copy()
    faces[:3] = ball.faces[:3]
    surface = repair(ball.vertices, faces).surface
    assert np.all(np.einsum("ij,ij->i", surface.face_normals, surface.barycentres) > 0)


def test_a_consistent_orientation_is_the_callers_choice(ball: TriSurface) -> None:
    surface = repair(ball.vertices, ball.faces[:, ::-1]).surface
    assert np.all(np.einsum("ij,ij->i", surface.face_normals, surface.barycentres) < 0)


@pytest.mark.parametrize("cut_apart", [False, True])
def test_a_moebius_strip_is_refused(cut_apart: bool) -> None:
    vertices, faces = moebius()
    with pytest.raises(SurfaceError, match="one-sided") as caught:
        repair(vertices, faces, cut_apart=cut_apart)
    assert caught.value.elements.tolist() == list(range(len(faces)))


def test_several_components_are_named_with_their_sizes(ball: TriSurface) -> None:
    vertices, faces = beside(torus(n=12), ball, 5)
    with pytest.raises(SurfaceError, match=rf"2 separate.*{ball.n_faces}, .*largest"):
        repair(vertices, faces)


@pytest.mark.parametrize(("component", "genus"), [("largest", 0), (0, 0), (1, 1)])
def test_one_component_is_kept_when_asked(
    ball: TriSurface, component: int | str, genus: int
) -> None:
    vertices, faces = beside(torus(n=12), ball, 5)
    repaired = repair(vertices, faces, component=component)
    assert repaired.surface.genus == genus
    assert "2 components" in repaired.notes[0]


@pytest.mark.parametrize("component", [2, -1, "biggest"])
def test_a_component_that_is_not_there(ball: TriSurface, component: int | str) -> None:
    with pytest.raises(SurfaceError, match="no component"):
        repair(*beside(ball, ball, 5), component=component)


def test_duplicate_triangles_are_dropped_with_a_note(ball: TriSurface) -> None:
    faces = np.concatenate([ball.faces, ball.faces[[5, 7]][:, [1, 2, 0]]])
    repaired = repair(ball.vertices, faces)
    assert repaired.notes == ("dropped 2 duplicate triangles",)
    assert np.array_equal(repaired.surface.faces, ball.faces)


def test_a_triangle_flat_along_its_neighbours_edge_is_flipped_away() -> None:
    # corner 4 lies on the edge 1-2: the square's lower right half is split by a flat triangle
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0.5, 0.5, 0]])
    faces = [[0, 1, 4], [0, 4, 2], [4, 1, 2], [1, 3, 2]]
    repaired = repair(vertices, faces)
    assert repaired.notes == ("mended 1 triangle without area",)
    assert repaired.surface.n_faces == 4
    assert repaired.surface.area == pytest.approx(1)
    assert len(repaired.surface.boundary_loops) == 1


def test_a_flat_triangle_on_the_boundary_is_dropped() -> None:
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.5, 0.5, 0]])
    faces = [[0, 1, 3], [0, 3, 2], [3, 1, 2]]
    surface = repair(vertices, faces).surface
    assert surface.n_faces == 2
    assert surface.area == pytest.approx(0.5)


def test_a_needle_is_collapsed_without_opening_the_surface(ball: TriSurface) -> None:
    # split the vertices of an edge's triangles: vertex 0 is doubled across one of its edges
    a, b, c = ball.faces[0]
    vertices = np.concatenate([ball.vertices, [ball.vertices[a] * (1 + 1e-13)]])
    new = ball.n_vertices
    left = next(f for f in ball.faces.tolist() if b in f and a in f and c not in f)
    d = next(v for v in left if v not in (a, b))
    faces = [f for f in ball.faces.tolist() if sorted(f) != sorted((a, b, c)) and f != left]
    # vertex a becomes the short edge a-new: two needles lie between the sheets
    faces += [[new, b, c], [new, d, b], [a, new, c], [new, a, d]]
    repaired = repair(vertices, faces)
    assert repaired.surface.euler_characteristic == 2
    assert repaired.surface.n_faces == ball.n_faces


def test_a_book_of_three_pages_is_cut_apart() -> None:
    vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1]]
    faces = [[0, 1, 2], [1, 0, 3], [0, 1, 4]]
    with pytest.raises(SurfaceError, match="non-manifold") as caught:
        repair(vertices, faces)
    assert caught.value.elements.tolist() == [[0, 1]]
    repaired = repair(vertices, faces, cut_apart=True, component="largest")
    assert "1 non-manifold edge" in repaired.notes[0]
    assert repaired.surface.n_faces == 1


def test_spheres_that_touch_in_a_vertex_are_cut_apart(ball: TriSurface) -> None:
    vertices, faces = beside(ball, ball, 9)
    left, right = 0, ball.n_vertices
    faces[faces == right] = left
    with pytest.raises(SurfaceError, match="non-manifold vert") as caught:
        repair(vertices, faces)
    assert caught.value.elements.tolist() == [left]
    repaired = repair(vertices, faces, cut_apart=True, component="largest")
    assert "cut apart at 1 vertex" in repaired.notes
    assert repaired.surface.euler_characteristic == 2


@pytest.mark.parametrize(
    ("vertices", "faces", "words"),
    [
        ([], [], "empty|columns"),
        (np.zeros((3, 3)), np.empty((0, 3), int), "empty"),
        ([[0, 0, 0], [1, 0, 0], [0, np.inf, 0]], [[0, 1, 2]], "not finite"),
        ([[0, 0, 0], [1, 0, 0], [0, 1e200, 0]], [[0, 1, 2]], "not finite numbers below 1e"),
        ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 3]], "outside 0..2"),
        ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, -1]], "outside 0..2"),
        ([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]], "without area"),
    ],
)
def test_what_cannot_be_repaired_is_said_in_one_line(
    vertices: ArrayLike, faces: ArrayLike, words: str
) -> None:
    with pytest.raises(SurfaceError, match=words) as caught:
        repair(vertices, faces)
    assert "\n" not in str(caught.value)


def test_a_soup_that_shrinks_to_nothing_is_empty() -> None:
    """One stray corner so far away that all others count as the same place."""
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1e30, 0, 0]])
    faces = [[0, 1, 2], [1, 2, 3]]
    for make in (repair, repair_each):
        with pytest.raises(SurfaceError, match="empty"):
            make(vertices, faces, merge=True)
    with pytest.raises(SurfaceError, match="empty"):
        repair(vertices, faces, merge=True, component="largest")


def test_each_component_becomes_a_surface_the_largest_first(ball: TriSurface) -> None:
    vertices, faces = beside(ball, torus(n=24), 5)
    pieces = repair_each(*soup_of(vertices, faces), merge=True)
    assert [piece.surface.genus for piece in pieces] == [1, 0]
    assert sum(piece.surface.n_faces for piece in pieces) == len(faces)
    assert all("merged" in piece.notes[0] for piece in pieces)
