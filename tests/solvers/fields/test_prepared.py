"""A prepared surface cannot lead to a field that does not close or misses a boundary."""

from dataclasses import replace

import numpy as np
import pytest

from solvers.errors import SingularityError
from solvers.fields.aligned import aligned_field
from solvers.fields.integrable import anisotropic_field
from solvers.fields.isotropic import IsotropicSolver
from solvers.fields.prepared import prepare
from solvers.primitives import annulus, cube_sphere
from solvers.progress import run
from solvers.singularities.budget import Singularity
from solvers.surface.trisurface import TriSurface


def pair(surface: TriSurface, stretch: float = 1.0) -> list[Singularity]:
    """The README's valence 3 and valence 5, inside triangles."""
    places = ([0.8 * stretch, 0, 0], 3), ([-0.6 * stretch, 0, 0], 5)
    return [Singularity(surface.closest_point(place), valence) for place, valence in places]


def stretched(by: float) -> TriSurface:
    surface = annulus(inner=0.4, n=48)
    return TriSurface(surface.vertices * [by, 1, 1], surface.faces)


@pytest.mark.parametrize("refine", [0, 3])
@pytest.mark.parametrize("stretch", [1.0, 3.0])
def test_fields_on_any_triangles_with_singularities_anywhere_close_and_are_aligned(
    stretch: float, refine: int
) -> None:
    surface = annulus(inner=0.4, n=96) if stretch == 1 else stretched(stretch)
    configuration = pair(surface, stretch)
    obtuse = IsotropicSolver(surface).discretization.working.n_flips
    assert (obtuse > 100) == (stretch > 1)
    aligned = aligned_field(prepare(surface, configuration, refine=refine))
    assert np.degrees(np.abs(aligned.isotropic.defects).max()) > 30
    field = run(anisotropic_field(aligned)).field
    assert field.energy < 1e-10
    assert field.max_closing_error < 1e-8
    assert np.abs(field.boundary_misalignment).max() < 1e-8


def test_singularities_are_vertices_and_stay_where_they_are() -> None:
    surface = annulus(inner=0.4, n=48)
    configuration = pair(surface)
    prepared = prepare(surface, configuration)
    assert all(max(s.point.barycentric) == 1.0 for s in prepared.singularities)
    here, there = (
        on.positions([s.point for s in singular])
        for on, singular in ((prepared.surface, prepared.singularities), (surface, configuration))
    )
    np.testing.assert_allclose(here, there, atol=1e-4)


def test_other_valences_keep_the_factors_and_other_places_are_refused() -> None:
    surface = annulus(inner=0.4, n=48)
    one, other = pair(surface)
    prepared = prepare(surface, [one, other])
    swapped = prepared.with_valences([replace(one, valence=5), replace(other, valence=3)])
    assert [s.valence for s in swapped.singularities] == [5, 3]
    assert swapped.operators.solver is prepared.operators.solver
    with pytest.raises(SingularityError, match="elsewhere"):
        prepared.with_valences([one, replace(other, point=one.point)])
    with pytest.raises(SingularityError, match="elsewhere"):
        prepared.with_valences([one])


def test_a_singularity_inside_a_triangle_is_no_part_of_a_prepared_surface() -> None:
    surface = annulus(inner=0.4, n=48)
    prepared = prepare(surface, pair(surface))
    inside = Singularity(prepared.surface.closest_point([0.7, 0.013, 0]), 3)
    with pytest.raises(SingularityError, match="singularity 2 is not at a vertex"):
        replace(prepared, singularities=(prepared.singularities[0], inside))


def test_where_nothing_fixes_the_crosses_they_turn_to_those_of_another_field() -> None:
    surface = cube_sphere(n=8)
    corners = np.stack(np.meshgrid(*[[-1, 1]] * 3), axis=-1).reshape(-1, 3)
    configuration = [Singularity(surface.closest_point(c), 3) for c in corners / np.sqrt(3)]
    prepared = prepare(surface, configuration, refine=1)
    like = prepared.operators.solver.in_gauge(0.3).solve(prepared.singularities)
    aligned = aligned_field(prepared, like=like)
    assert abs(aligned.isotropic.turn_to(like)) < 1e-9
    assert abs(aligned_field(prepared).isotropic.turn_to(like)) > 0.05
