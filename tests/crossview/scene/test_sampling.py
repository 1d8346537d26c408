"""Crosses stand apart, leave no hole, and stay where they are when something else changes."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from crossview.view.geometry import Triangles
from crossview.view.sampling import spread_sites
from solvers.primitives import annulus, blob, rectangle, torus
from solvers.surface.refinement import refine_at
from solvers.surface.trisurface import TriSurface


def triangles(surface: TriSurface) -> Triangles:
    return Triangles(surface.vertices, surface.faces)


@pytest.mark.parametrize("surface", [torus(n=120), blob(subdivisions=5), annulus(n=200)])
def test_about_as_many_as_asked_apart_and_without_holes(surface: TriSurface) -> None:
    asked = 800
    sites = spread_sites(triangles(surface), asked)
    assert 0.75 * asked < len(sites.faces) < 1.2 * asked
    tree = cKDTree(sites.positions)
    nearest = tree.query(sites.positions, k=2)[0][:, 1]
    assert nearest.min() > 0.6 * sites.spacing
    hole = tree.query(surface.barycentres)[0].max()
    assert hole < 1.6 * sites.spacing


def test_the_same_whatever_the_numbers_of_faces_and_vertices() -> None:
    surface, rng = torus(n=60), np.random.default_rng(5)
    order, new = rng.permutation(surface.n_faces), rng.permutation(surface.n_vertices)
    vertices = np.empty_like(surface.vertices)
    vertices[new] = surface.vertices
    renumbered = Triangles(vertices, new[surface.faces][order])
    a = spread_sites(triangles(surface), 500).positions
    b = spread_sites(renumbered, 500).positions
    assert np.allclose(a[np.lexsort(a.round(9).T)], b[np.lexsort(b.round(9).T)], atol=1e-12)


def test_refining_in_one_place_changes_nothing_far_from_it() -> None:
    surface = torus(n=90)
    fine = refine_at(surface, [surface.closest_point(np.array([1.4, 0.0, 0.0]))], 3).surface
    before, after = (spread_sites(triangles(s), 700).positions for s in (surface, fine))
    far = before[before[:, 0] < 0.0]
    assert len(far) > 200
    assert np.mean(cKDTree(after).query(far)[0] < 1e-9) > 0.99


def test_large_triangles_hold_several_and_small_ones_thin_out() -> None:
    corners = np.array([[0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0]], float)
    coarse = Triangles(corners, np.array([[0, 1, 2], [0, 2, 3]]))
    for surface in (coarse, triangles(rectangle(2.0, 1.0, 200, 100))):
        sites = spread_sites(surface, 300)
        assert 200 < len(sites.faces) < 360
        inside = np.einsum("kc,kcx->kx", sites.weights, surface.points[surface.faces[sites.faces]])
        assert np.allclose(inside, sites.positions)
        assert (sites.weights >= 0.0).all()


def test_nothing_reaches_over_the_boundary() -> None:
    sites = spread_sites(triangles(annulus(n=96)), 900)
    radius = np.linalg.norm(sites.positions, axis=1)
    exact = np.minimum(radius - 0.4, 1.0 - radius)
    near = sites.free < sites.spacing
    assert near.sum() > 50
    assert sites.free.min() > 0.25 * sites.spacing
    assert np.abs(sites.free - exact)[near].max() < 0.2 * sites.spacing
