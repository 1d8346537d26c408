"""Quads of layouts: topology, prescription, integers."""

import numpy as np
import pytest

from solvers.quads.filling import fill
from solvers.quads.quadmesh import QuadMesh
from solvers.quads.quantization import quantize_to
from tests.solvers.layouts.fields import FIELDS, layout_of


def filled(name: str, n_quads: int = 1500) -> tuple[QuadMesh, np.ndarray]:
    layout = layout_of(name)
    counts = quantize_to(layout.tmesh, n_quads).counts
    return fill(layout, counts), counts


@pytest.mark.parametrize("name", FIELDS)
def test_quads_tile_the_surface_without_cracks(name: str) -> None:
    mesh, _ = filled(name)
    mesh.check()
    assert mesh.euler_characteristic == mesh.surface.euler_characteristic
    assert mesh.max_distance_to_surface < 1e-12


@pytest.mark.parametrize("name", FIELDS)
def test_irregular_vertices_are_the_prescribed_ones(name: str) -> None:
    mesh, _ = filled(name)
    field = layout_of(name).integrated.field
    prescribed = [s.valence for s in field.singularities]
    assert mesh.irregular == {k: prescribed.count(k) for k in sorted(set(prescribed))}
    corners = [2 - k for k in field.corners.values()]
    assert mesh.corners == {k: corners.count(k) for k in sorted(set(corners))}
    # and they lie where they were imposed
    places = field.surface.positions([s.point for s in field.singularities])
    irregular = mesh.vertices[(mesh.valence != 4) & ~mesh.on_boundary]
    gaps = np.linalg.norm(places[:, None] - irregular[None], axis=2)
    assert gaps.min(axis=1, initial=np.inf).max(initial=0.0) < 1e-9


@pytest.mark.parametrize("name", FIELDS)
def test_every_arc_has_the_number_of_edges_it_was_given(name: str) -> None:
    mesh, counts = filled(name)
    tmesh = layout_of(name).tmesh
    sides = tmesh.side_totals(counts.astype(float))
    np.testing.assert_array_equal(sides[:, :2], sides[:, 2:])
    per_patch = np.bincount(mesh.patch, minlength=tmesh.n_rectangles)
    np.testing.assert_array_equal(per_patch, sides[:, 0] * sides[:, 1])


@pytest.mark.parametrize("name", ["cube sphere", "torus", "annulus", "disk with four", "square"])
def test_quads_are_nearly_rectangles_and_none_is_turned_over(name: str) -> None:
    mesh, _ = filled(name)
    assert mesh.scaled_jacobian.min() > 0.5
    assert mesh.scaled_jacobian.mean() > 0.98


def test_the_boundary_keeps_to_its_loops() -> None:
    mesh, _ = filled("annulus")
    radius = np.linalg.norm(mesh.vertices[:, :2], axis=1)
    for loop, wanted in ((0, 1.0), (1, 0.4)):
        on_loop = mesh.boundary_loop == loop
        assert on_loop.sum() > 8
        np.testing.assert_allclose(radius[on_loop], wanted, rtol=3e-3)
    np.testing.assert_array_equal(mesh.boundary_loop >= 0, mesh.on_boundary)


def test_arcs_without_length_vanish() -> None:
    layout = layout_of("winding sphere")
    counts = quantize_to(layout.tmesh, 300).counts
    assert (counts == 0).any()
    mesh = fill(layout, counts)
    mesh.check()
    assert mesh.irregular == {3: 8}
    sides = layout.tmesh.side_totals(counts.astype(float))
    assert mesh.n_quads == (sides[:, 0] * sides[:, 1]).sum()
