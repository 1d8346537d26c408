"""Points know their surface: one of another is refused, never taken for a place elsewhere."""

import pickle
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from solvers.errors import CrossviewError
from solvers.fields.isotropic import IsotropicSolver
from solvers.fields.prepared import prepare
from solvers.primitives import BUILTIN
from solvers.singularities.budget import Singularity
from solvers.singularities.pairs import pair_at
from solvers.surface.geodesics import straightest
from solvers.surface.points import SurfacePoint
from solvers.surface.refinement import Refinement, refine_at, refine_everywhere
from solvers.surface.trisurface import TriSurface

COARSE = BUILTIN["sphere"](subdivisions=2)
REFINEMENT = refine_everywhere(COARSE)
FINE = REFINEMENT.surface
ON_COARSE = COARSE.closest_point([0.3, 0.5, 0.8])
ON_FINE = FINE.closest_point([0.3, 0.5, 0.8])
TOO_HIGH = SurfacePoint(FINE.n_faces, (1.0, 0.0, 0.0))

MIXED_UP: dict[str, Callable[[SurfacePoint], object]] = {
    "position": COARSE.position,
    "positions": lambda point: COARSE.positions([ON_COARSE, point]),
    "nearest vertex": COARSE.nearest_vertex,
    "a straight walk": lambda point: straightest(COARSE, point, np.array([0.1, 0.0])),
    "refinement": lambda point: refine_at(COARSE, [point]),
    "preparing": lambda point: prepare(COARSE, [Singularity(point, 3)]),
    "a pair": lambda point: pair_at(COARSE, [], point),
    "operators": lambda point: IsotropicSolver(COARSE).holonomy.defects([Singularity(point, 3)]),
    "gradients": lambda point: IsotropicSolver(COARSE).holonomy.gradients([point]),
}


@pytest.mark.parametrize("take", MIXED_UP.values(), ids=MIXED_UP)
@pytest.mark.parametrize("point", [ON_FINE, TOO_HIGH], ids=["of a finer surface", "by hand"])
def test_points_of_another_surface_are_refused(
    take: Callable[[SurfacePoint], object], point: SurfacePoint
) -> None:
    with pytest.raises(CrossviewError, match="a point of another surface is given") as refused:
        take(point)
    assert "\n" not in str(refused.value)


def test_points_are_lifted_from_the_finer_surface_alone() -> None:
    lifted = REFINEMENT.lift(ON_FINE)
    assert lifted.mark == COARSE.mark != ON_FINE.mark
    assert COARSE.position(lifted) == pytest.approx(FINE.position(ON_FINE), abs=1e-12)
    with pytest.raises(CrossviewError, match="another surface"):
        REFINEMENT.lift(lifted)


def test_points_go_to_the_refined_surface_and_back() -> None:
    rng = np.random.default_rng(0)
    given = [
        COARSE.point(int(face), rng.dirichlet([1, 1, 1]).tolist())
        for face in rng.integers(0, COARSE.n_faces, 30)
    ]
    for refinement in (REFINEMENT, refine_at(COARSE, given[:3], 3), Refinement.none(COARSE)):
        for point in given:
            there = refinement.locate(point)
            refinement.surface.require_own([there])
            back = refinement.lift(there)
            for found in (refinement.surface.position(there), COARSE.position(back)):
                assert found == pytest.approx(COARSE.position(point), abs=1e-9)


def test_points_that_were_inserted_are_located_at_their_vertices() -> None:
    at_vertex = COARSE.point_at_vertex(7)
    next_to_it = COARSE.point(
        at_vertex.face, np.clip(at_vertex.barycentric, 1e-7, 1 - 2e-7).tolist()
    )
    inside = COARSE.point(11, (0.2, 0.3, 0.5))
    refinement = refine_at(COARSE, [next_to_it, inside], 2)
    for point, vertex in zip((next_to_it, inside), refinement.vertices.tolist(), strict=True):
        assert refinement.locate(point) == refinement.surface.point_at_vertex(vertex)


def test_points_of_another_surface_are_not_located() -> None:
    for refinement in (REFINEMENT, Refinement.none(COARSE)):
        with pytest.raises(CrossviewError, match="another surface"):
            refinement.locate(ON_FINE)


def test_every_point_that_a_surface_makes_is_its_own() -> None:
    made = [
        COARSE.point_at_vertex(3),
        COARSE.point(3, [0.2, 0.3, 0.5]),
        straightest(COARSE, ON_COARSE, np.array([0.4, 0.2])).end,
        *(s.point for s in pair_at(COARSE, [], ON_COARSE)),
    ]
    COARSE.require_own(made)
    assert {point.mark for point in made} == {COARSE.mark}
    with pytest.raises(CrossviewError, match="another surface"):
        COARSE.point(COARSE.n_faces, (1.0, 0.0, 0.0))


def test_the_same_triangles_are_the_same_surface_wherever_their_vertices_are() -> None:
    scaled = TriSurface(2 * COARSE.vertices, COARSE.faces)
    assert scaled.position(ON_COARSE) == pytest.approx(2 * COARSE.position(ON_COARSE))


def test_points_made_by_hand_count_for_any_surface_and_equal_those_it_makes() -> None:
    by_hand = SurfacePoint(ON_COARSE.face, ON_COARSE.barycentric)
    assert by_hand == ON_COARSE
    assert hash(by_hand) == hash(ON_COARSE)
    assert (COARSE.position(by_hand) == COARSE.position(ON_COARSE)).all()


def test_points_keep_their_surface_when_copied_and_pickled() -> None:
    singularity = replace(Singularity(ON_COARSE, 3), locked=True)
    copied = pickle.loads(pickle.dumps(singularity))
    assert copied.point.mark == COARSE.mark
