"""Long thin triangles do no harm: all is solved on a working triangulation."""

import numpy as np
import pytest

from solvers.fields.aligned import aligned_field
from solvers.fields.integrable import anisotropic_field
from solvers.fields.prepared import prepare
from solvers.layouts.layout import quad_layout
from solvers.maps.seamless import seamless_map
from solvers.progress import run
from solvers.quads.filling import fill
from solvers.quads.quantization import quantize
from solvers.quads.smoothing import smooth
from solvers.singularities.budget import Singularity
from tests.solvers.suite import polar_annulus


@pytest.mark.parametrize(("around", "rings"), [(12, 60), (200, 4)])
def test_annuli_of_thin_rings_or_spokes_get_quads(around: int, rings: int) -> None:
    surface = polar_annulus(around, rings)
    rng = np.random.default_rng(1)
    singularities = []
    for pair in range(3):
        for valence, turn in ((3, 0.0), (5, 0.25)):
            angle = 2 * np.pi * (pair + turn) / 3 + rng.uniform(-0.1, 0.1)
            radius = rng.uniform(0.55, 0.85)
            place = [radius * np.cos(angle), radius * np.sin(angle), 0.0]
            singularities.append(Singularity(surface.closest_point(place), valence))
    aligned = aligned_field(prepare(surface, singularities, refine=1))
    t = aligned.integrability.triangulation
    assert t.n_faces > aligned.prepared.surface.n_faces
    integrated = run(anisotropic_field(aligned))
    field = integrated.field
    assert field.energy < 1e-10
    assert np.abs(field.boundary_misalignment).max() < 1e-8
    assert len(seamless_map(integrated).inverted) == 0
    layout = run(quad_layout(integrated))
    # a curve on a flat surface lies in it, and ends on its rim
    radii = np.linalg.norm(layout.separatrices.points, axis=1)
    rim = np.cos(np.pi / around)
    assert radii.min() > 0.4 * rim - 1e-9
    assert radii.max() < 1 + 1e-9
    mesh = smooth(fill(layout, quantize(layout.tmesh, edge_length=0.1).counts))
    mesh.check()
    assert mesh.scaled_jacobian.min() > 0.3
    assert mesh.max_distance_to_surface < 1e-12


def test_what_the_surface_shows_is_the_field_that_was_solved() -> None:
    """Sampled on the triangles of the surface, the crosses are as aligned with the circles."""
    surface = polar_annulus(12, 40)
    integrated = run(anisotropic_field(aligned_field(prepare(surface))))
    field = integrated.field
    assert field.on_working is not None
    assert len(field.solved.theta) > surface.n_faces
    assert field.H.shape == (surface.n_vertices,)
    radial = surface.barycentres / np.linalg.norm(surface.barycentres, axis=1)[:, None]
    along = np.abs((field.u * radial).sum(axis=1))
    assert np.minimum(along, 1 - along).max() < np.sin(np.pi / 12)
    # e^H grows with the radius, but next to the corners of the rims
    radius = np.linalg.norm(surface.vertices, axis=1)
    size = (field.H - np.log(radius))[np.abs(radius - 0.7) < 0.1]
    assert np.ptp(size) < 0.02
