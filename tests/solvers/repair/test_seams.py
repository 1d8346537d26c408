"""Seams: boundary edges that lie on each other become one, and only where that makes a surface."""

import numpy as np
import pytest
from numpy.typing import NDArray

from solvers.primitives import annulus, sphere, torus
from solvers.repair.seams import share_vertices
from solvers.repair.soup import repair, repair_each
from solvers.surface.trisurface import TriSurface

Arrays = tuple[NDArray[np.float64], NDArray[np.int64]]


def cut(surface: TriSurface, n_pieces: int) -> Arrays:
    """The surface in pieces by angle around the z-axis, none sharing a vertex with another."""
    middle = surface.vertices[surface.faces].mean(axis=1)
    angle = np.arctan2(middle[:, 1], middle[:, 0]) / (2 * np.pi) + 0.5
    piece = np.minimum((angle * n_pieces).astype(int), n_pieces - 1)
    corner = surface.faces.reshape(-1)
    label = corner + surface.n_vertices * np.repeat(piece, 3)
    used, faces = np.unique(label, return_inverse=True)
    return surface.vertices[used % surface.n_vertices], faces.reshape(-1, 3)


@pytest.mark.parametrize("surface", [sphere(3), torus(), annulus()])
@pytest.mark.parametrize("n_pieces", [2, 5])
def test_a_surface_cut_into_pieces_is_whole_again(surface: TriSurface, n_pieces: int) -> None:
    whole = repair(*cut(surface, n_pieces))
    assert "joined" in whole.notes[0]
    assert whole.surface.n_vertices == surface.n_vertices
    assert whole.surface.euler_characteristic == surface.euler_characteristic
    assert len(whole.surface.boundary_loops) == len(surface.boundary_loops)
    corners = whole.surface.vertices[whole.surface.faces]
    assert np.array_equal(corners, surface.vertices[surface.faces])


def test_an_open_slit_stays_open() -> None:
    surface = annulus()
    vertices, faces = cut(surface, 2)
    upper = vertices[faces].mean(axis=1)[:, 1] > 0
    vertices[np.unique(faces[upper])] += [0, 1e-3, 0]
    pieces = repair_each(vertices, faces)
    assert [piece.notes for piece in pieces] == [(), ()]


def test_what_joining_would_make_one_sided_stays_apart_and_is_told() -> None:
    n = 24
    angle = np.linspace(0, 2 * np.pi, n + 1)
    sides = []
    for side in (-0.3, 0.3):
        r = 1 + side * np.cos(angle / 2)
        z = side * np.sin(angle / 2)
        sides.append(np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=1))
    i = np.arange(n)
    low = np.stack([i, i + 1, i + n + 2], 1)
    high = np.stack([i, i + n + 2, i + n + 1], 1)
    strip = repair(np.concatenate(sides), np.concatenate([low, high]))
    assert strip.surface.euler_characteristic == 1
    assert "left 1 pair of boundary edges apart" in strip.notes[0]


def test_two_sheets_on_each_other_are_no_seam() -> None:
    square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    points = np.concatenate([square, square])
    turned = np.concatenate([faces, faces[:, ::-1] + 4])
    assert share_vertices(points, turned, merge=False)[1].tolist() == turned.tolist()
