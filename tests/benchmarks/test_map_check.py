"""The check of maps finds what is wrong with them, each fault by the theory it breaks."""

import numpy as np
import pytest

from benchmarks.map_check import Connectivity, Findings, check, corner_angles
from solvers.primitives import disk, square
from solvers.surface import TriSurface

RIGHT = Findings(inverted=0, open=0, torn=0, astray=0, windings=0, empty=0)


def connectivity_of(surface: TriSurface, followed: np.ndarray | None = None) -> Connectivity:
    t = surface.triangulation
    marked = t.twin < 0 if followed is None else (t.twin < 0) | followed
    return Connectivity(t.faces.reshape(-1), t.twin, marked)


def flat_images(surface: TriSurface, power: float = 1.0) -> np.ndarray:
    """Of a flat surface under z^power, halfedges by their ends' differences, continued around 0."""
    corners = surface.vertices[surface.faces] @ np.array([1, 1j, 0])
    middle = corners.mean(axis=1, keepdims=True)
    turned = np.abs(corners) ** power * np.exp(
        1j * power * (np.angle(corners / middle) + np.angle(middle))
    )
    sides = np.roll(turned, -1, axis=1) - turned
    return np.stack([sides.real, sides.imag], axis=2).reshape(-1, 2)


def square_quads(surface: TriSurface) -> np.ndarray:
    quads = np.where(surface.boundary_vertices, 2, 4)
    ends = np.abs(surface.vertices[:, :2] - surface.vertices[:, :2].mean(axis=0))
    quads[np.isclose(ends, ends.max(axis=0)).all(axis=1)] = 1
    return quads


def test_a_square_is_its_own_map() -> None:
    surface = square(n=6)
    assert check(connectivity_of(surface), flat_images(surface), square_quads(surface)) == RIGHT


def test_frames_may_differ_by_quarter_turns_and_no_others() -> None:
    surface = square(n=6)
    for angle, torn in ((np.pi / 2, 0), (np.pi / 4, 3)):
        images = flat_images(surface)
        inner = int(np.flatnonzero((surface.triangulation.twin.reshape(-1, 3) >= 0).all(axis=1))[0])
        c, s = np.cos(angle), np.sin(angle)
        images[3 * inner : 3 * inner + 3] = images[3 * inner : 3 * inner + 3] @ [[c, s], [-s, c]]
        found = check(connectivity_of(surface), images, square_quads(surface))
        assert (found.torn, found.inverted, found.windings) == (torn, 0, 0)


def test_mirrored_all_triangles_are_inverted() -> None:
    surface = square(n=6)
    images = flat_images(surface) * [-1, 1]
    found = check(connectivity_of(surface), images, square_quads(surface))
    assert found.inverted == surface.n_faces
    assert found.windings == surface.n_vertices


@pytest.mark.parametrize("valence", [3, 5, 8])
def test_a_power_has_the_valence_of_its_power(valence: int) -> None:
    surface = disk(edge_length=0.1)
    centre = int(np.linalg.norm(surface.vertices, axis=1).argmin())
    images = flat_images(surface, valence / 4)
    angles = np.bincount(surface.faces.reshape(-1), corner_angles(images))
    assert np.isclose(angles[centre], valence * np.pi / 2)
    wanted = np.full(surface.n_vertices, 4)
    wanted[centre] = valence
    boundary = int(surface.boundary_vertices.sum())  # no whole number of quads meets there
    assert check(connectivity_of(surface), images, wanted).windings == boundary
    wanted[centre] += 1
    assert check(connectivity_of(surface), images, wanted).windings == boundary + 1


def test_a_gap_in_one_triangle_is_open() -> None:
    surface = square(n=6)
    images = flat_images(surface)
    images[0] *= 1.1
    assert check(connectivity_of(surface), images, square_quads(surface)).open == 1


def test_a_diagonal_into_a_corner_that_is_followed_leaves_two_sectors_without_a_quad() -> None:
    surface = square(n=4)
    t, quads = surface.triangulation, square_quads(surface)
    images = flat_images(surface)
    slanted = np.abs(images).min(axis=1) > 1e-9
    h = int(np.flatnonzero(slanted & (quads[t.faces.reshape(-1)] == 1))[0])
    followed = np.zeros(len(t.twin), dtype=bool)
    followed[[h, t.twin[h]]] = True
    found = check(connectivity_of(surface, followed), images, quads)
    assert found == Findings(inverted=0, open=0, torn=0, astray=2, windings=0, empty=2)
