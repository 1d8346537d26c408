"""Singularities inside the surface, each at a place of its own."""

import numpy as np
import pytest

from solvers.errors import CrossviewError, SingularityError
from solvers.fields.prepared import prepare
from solvers.primitives import disk
from solvers.singularities.budget import Singularity
from solvers.singularities.places import require_places
from solvers.singularities.remedies import MergeTwo, MoveInside
from tests.solvers.suite import SURFACES, random_configuration


@pytest.mark.parametrize("name", SURFACES)
def test_random_places_inside_are_taken(name: str) -> None:
    surface = SURFACES[name]()
    require_places(surface, random_configuration(surface, seed=0))


@pytest.mark.parametrize("share", [0.0, 0.3, 1e-7])
def test_one_on_the_boundary_is_named(share: float) -> None:
    surface = disk(edge_length=0.2)
    start, end = surface.vertices[surface.boundary_loops[0][:2]]
    rim = Singularity(surface.closest_point((1 - share) * start + share * end), 3)
    with pytest.raises(SingularityError, match="singularity 2 lies on the boundary") as refused:
        require_places(surface, [Singularity(surface.point_at_vertex(0), 3), rim])
    assert refused.value.remedies == (MoveInside("move it inside", 1),)


@pytest.mark.parametrize("gap", [0.0, 1e-9])
def test_two_at_one_place_are_named(gap: float) -> None:
    surface = disk(edge_length=0.2)
    places = [(0.31, 0.21, 0), (-0.2, 0, 0), (0.31 + gap, 0.21, 0)]
    three = [Singularity(surface.closest_point(place), 3) for place in places]
    with pytest.raises(SingularityError, match="1 and 3 are at the same place") as refused:
        require_places(surface, three)
    assert refused.value.remedies == (MergeTwo("merge them", 0, 2),)
    require_places(surface, three[:2])


def test_what_refinement_makes_one_vertex_is_one_place() -> None:
    # From either side of an edge and around a vertex: other triangles, the same place.
    surface = disk(edge_length=0.2)
    vertex = surface.nearest_vertex(surface.closest_point([0.3, 0.3, 0]))
    start = surface.vertices[vertex]
    for away in (1e-7, 1e-3):
        near = [
            Singularity(
                surface.closest_point(start + away * np.array([np.cos(a), np.sin(a), 0])), 3
            )
            for a in (0.1, 3.3)
        ]
        count = len(set(prepare(surface, near, refine=0).refinement.vertices.tolist()))
        if count == 2:
            require_places(surface, near)
        else:
            with pytest.raises(SingularityError, match="same place"):
                require_places(surface, near)
    assert count == 2


def test_a_point_of_another_surface_is_refused() -> None:
    one = Singularity(disk(edge_length=0.2).point_at_vertex(0), 3)
    with pytest.raises(CrossviewError, match="another surface"):
        require_places(disk(edge_length=0.25), [one])
