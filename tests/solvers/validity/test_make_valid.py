"""Straight walks, and singularities moved to where every condition holds."""

from collections.abc import Callable, Sequence

import numpy as np
import pytest

from crossview.cases.model import Case
from crossview.workflow.problem import Problem
from solvers.errors import SingularityError
from solvers.fields.isotropic import IsotropicSolver
from solvers.primitives import BUILTIN
from solvers.progress import Progress, run
from solvers.remedies import ANISOTROPIC, UseMethod
from solvers.singularities.budget import Singularity, default_corners
from solvers.singularities.farthest import far_points
from solvers.surface.geodesics import straightest
from solvers.surface.points import SurfacePoint
from solvers.surface.refinement import refine_at
from solvers.surface.trisurface import TriSurface
from solvers.validity import Moved, PlaceAnew, ValidityError, make_valid
from tests.real_surfaces import PATHS
from tests.solvers.suite import SURFACES, at_vertices, separated


def toward(surface: TriSurface, point: SurfacePoint, displacement: np.ndarray) -> np.ndarray:
    """A displacement in space, in the frame of the point's triangle."""
    along, across = surface.face_frames
    return np.array([displacement @ along[point.face], displacement @ across[point.face]])


def test_straight_walks_on_a_square_are_straight() -> None:
    surface = SURFACES["square"]()
    rng = np.random.default_rng(0)
    for face in rng.integers(surface.n_faces, size=30):
        start = SurfacePoint(int(face), tuple(rng.dirichlet([1, 1, 1])))
        target = np.append(rng.uniform(-0.49, 0.49, 2), 0)
        way = toward(surface, start, target - surface.position(start))
        assert np.abs(surface.position(straightest(surface, start, way).end) - target).max() < 1e-12


def test_a_walk_ends_at_the_boundary() -> None:
    surface = SURFACES["square"]()
    start = surface.closest_point([0.1, 0.2, 0])
    end = surface.position(
        straightest(surface, start, toward(surface, start, np.array([3, 0, 0]))).end
    )
    assert end == pytest.approx([0.5, 0.2, 0])


def test_a_walk_around_the_sphere_comes_home() -> None:
    surface = BUILTIN["sphere"](subdivisions=5)
    start = SurfacePoint(7, (0.3, 0.3, 0.4))
    for angle in (0.3, 2.0):
        for length, cosine in ((np.pi / 2, 0), (np.pi, -1), (2 * np.pi, 1)):
            way = length * np.array([np.cos(angle), np.sin(angle)])
            end = surface.position(straightest(surface, start, way).end)
            assert end @ surface.position(start) == pytest.approx(cosine, abs=0.01)


CASES: dict[str, tuple[Callable[[], TriSurface], list[int], float]] = {
    "annulus": (lambda: BUILTIN["annulus"](n=64), [3, 5] * 3, 0.15),
    "plate": (lambda: BUILTIN["plate_with_holes"](holes=3, edge_length=0.15), [3, 3, 5, 5], 0.25),
    "torus": (lambda: BUILTIN["torus"](n=48), [3, 3, 5, 5], 0.2),
    "double_torus": (lambda: BUILTIN["genus"](handles=2, subdivisions=2), [3, 5], 0.2),
}


def configuration(name: str, seed: int) -> tuple[TriSurface, list[Singularity]]:
    make, valences, gap = CASES[name]
    surface = make()
    missing = 4 * surface.euler_characteristic - sum(default_corners(surface).values())
    missing -= sum(4 - v for v in valences)
    return surface, separated(
        surface, seed, valences + [3 if missing > 0 else 5] * abs(missing), gap
    )


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("seed", [2, 4])
def test_a_configuration_made_valid_is_valid_when_solved_anew(name: str, seed: int) -> None:
    surface, singularities = configuration(name, seed)
    before = IsotropicSolver(surface).solve(singularities).defects
    end = run(make_valid(surface, singularities))
    refinement = refine_at(surface, [s.point for s in end.singularities])
    fine = refinement.surface
    valences = [s.valence for s in end.singularities]
    field = IsotropicSolver(fine).solve(at_vertices(fine, refinement.vertices.tolist(), valences))
    assert np.degrees(np.abs(before).max()) > 0.1
    assert np.degrees(np.abs(field.defects).max()) < 1e-6
    assert valences == [s.valence for s in singularities]


def test_nearly_every_random_annulus_and_plate_can_be_made_valid() -> None:
    failures = []
    for name in ("annulus", "plate"):
        for seed in range(10, 20):
            try:
                run(make_valid(*configuration(name, seed)))
            except SingularityError as error:
                failures.append(str(error))
    assert len(failures) <= 1, failures


def fresh(surface: TriSurface, singularities: Sequence[Singularity]) -> float:
    """The largest defect, degrees, of a field solved anew with the singularities as vertices."""
    refinement = refine_at(surface, [s.point for s in singularities])
    valences = [s.valence for s in singularities]
    placed = at_vertices(refinement.surface, refinement.vertices.tolist(), valences)
    solved = IsotropicSolver(refinement.surface).solve(placed)
    return float(np.degrees(np.abs(solved.defects).max()))


@pytest.mark.parametrize("seed", range(6))
def test_handles_chosen_anew_on_the_refined_surface_lead_nowhere_else(seed: int) -> None:
    """The nearest layout is reached, in a few corrections: those of one set of loops."""
    surface, singularities = configuration("double_torus", seed)
    shown: list[Progress] = []
    end = run(make_valid(surface, singularities), shown.append)
    assert end.turns == (0, 0, 0, 0)
    assert end.aim == ""
    assert sum(step.stage == "verifying" for step in shown) < 12


def test_corrections_that_go_to_and_fro_over_a_jump_find_a_way_out() -> None:
    """On vertices at symmetrical places every move changes how the surface is refined."""
    torus = Problem.from_case(Case(str(PATHS["torus.obj"]))).surface
    start = [
        Singularity(p, v) for p, v in zip(run(far_points(torus, (), 4)), [3, 5, 3, 5], strict=True)
    ]
    end = run(make_valid(torus, start))
    assert end.turns == (0, 0)
    assert fresh(torus, end.singularities) < 1e-6


def test_what_helps_is_offered_and_was_tried() -> None:
    torus = BUILTIN["torus"](n=36)
    annulus, start = configuration("annulus", 3)
    locked = [Singularity(s.point, s.valence, locked=True) for s in start]
    for surface, singularities, kinds in (
        (torus, at_vertices(torus, [10, 400], [3, 5]), [PlaceAnew]),
        (annulus, locked, [PlaceAnew, UseMethod]),
    ):
        with pytest.raises(ValidityError) as raised:
            run(make_valid(surface, singularities))
        error = raised.value
        assert [type(remedy) for remedy in error.remedies] == kinds
        pair = error.remedies[0]
        assert isinstance(pair, PlaceAnew)
        assert pair.label.startswith("Add a pair of 3 and 5 near (")
        assert pair.words in str(error)
        assert len(pair.singularities) == len(singularities) + 2
        assert fresh(surface, pair.singularities) < 1e-6
    assert error.condition == 0
    assert error.remedies[1] == ANISOTROPIC
    assert isinstance(pair, PlaceAnew)
    assert list(pair.singularities[:-2]) == locked


def test_locked_singularities_stay_and_the_way_is_shown() -> None:
    surface, singularities = configuration("annulus", 3)
    singularities = [
        Singularity(s.point, s.valence, locked=i < 3) for i, s in enumerate(singularities)
    ]
    shown: list[Progress] = []
    end = run(make_valid(surface, singularities), shown.append)
    assert [s.point for s in end.singularities[:3]] == [s.point for s in singularities[:3]]
    worst = [np.abs(step.defects).max() for step in shown if isinstance(step, Moved)]
    assert len(worst) == len(shown)
    assert worst[-1] < 1e-7 < worst[0]


def test_a_valid_configuration_stays_where_it_is() -> None:
    surface = SURFACES["disk"]()
    singularities = separated(surface, 0, [3] * 4, 0.4)
    end = run(make_valid(surface, singularities))
    assert [s.point for s in end.singularities] == [s.point for s in singularities]


def test_what_cannot_be_made_valid_is_refused_with_the_reason() -> None:
    torus = BUILTIN["torus"](n=36)
    with pytest.raises(SingularityError, match=r"never valid.*Izmestiev"):
        run(make_valid(torus, at_vertices(torus, [10, 400], [3, 5])))
    surface, singularities = configuration("annulus", 3)
    locked = [Singularity(s.point, s.valence, locked=True) for s in singularities]
    with pytest.raises(SingularityError, match=r"too few singularities may move.*degrees off"):
        run(make_valid(surface, locked))
