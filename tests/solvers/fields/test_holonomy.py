"""Holonomy defects: closed forms, and look-ups against re-solved fields."""

import numpy as np
import pytest

from solvers.fields.isotropic import IsotropicSolver
from solvers.primitives import BUILTIN
from solvers.singularities.budget import Singularity
from solvers.surface.points import SurfacePoint
from solvers.surface.triangulation import QUARTER, wrap
from tests.solvers.suite import SURFACES, at_vertices, random_configuration

WITH_CONDITIONS = [name for name in SURFACES if name not in ("sphere", "disk", "square", "l_shape")]


@pytest.mark.parametrize("name", WITH_CONDITIONS)
def test_the_look_up_predicts_the_defects_of_the_solved_field(name: str) -> None:
    surface = SURFACES[name]()
    solver = IsotropicSolver(surface)
    assert len(solver.holonomy.conditions) == 2 * surface.genus + max(
        len(surface.boundary_loops) - 1, 0
    )
    rng = np.random.default_rng(5)
    for seed in range(3):
        configuration = random_configuration(surface, seed)
        faces = rng.choice(surface.n_faces, len(configuration), replace=False)
        inside = [
            Singularity(SurfacePoint(int(f), tuple(rng.dirichlet([2, 2, 2]))), s.valence)
            for f, s in zip(faces, configuration, strict=True)
        ]
        for singularities in (configuration, inside):
            solved = solver.solve(singularities).defects
            looked_up = solver.holonomy.defects(singularities)
            assert np.abs(wrap(solved - looked_up, QUARTER)).max() < 1e-9


@pytest.mark.parametrize("name", ["sphere", "disk", "l_shape"])
def test_no_condition_on_simple_surfaces(name: str) -> None:
    assert IsotropicSolver(SURFACES[name]()).holonomy.conditions == ()


def on_annulus(polar: list[tuple[float, int]], valences: list[int]) -> np.ndarray:
    """The defect of singularities at polar angles (degrees) and numbers of rings from inside."""
    surface = BUILTIN["annulus"](inner=0.4, outer=1.0, n=96)
    radius = np.linalg.norm(surface.vertices, axis=1)
    rings = np.unique(radius.round(9))
    vertices = []
    for degrees, ring in polar:
        target = rings[ring] * np.array(
            [np.cos(np.radians(degrees)), np.sin(np.radians(degrees)), 0]
        )
        near = int(np.argmin(np.linalg.norm(surface.vertices - target, axis=1)))
        vertices.append(near)
    singularities = at_vertices(surface, vertices, valences)
    x, y, _ = surface.vertices[vertices].T
    angles = np.arctan2(y, x)
    closed_form = wrap(np.array((4 - np.array(valences)) @ angles / 4), QUARTER)
    solver = IsotropicSolver(surface)
    return np.array([solver.solve(singularities).defects[0], float(closed_form)])


@pytest.mark.parametrize("seed", range(4))
def test_annulus_defects_equal_the_closed_form(seed: int) -> None:
    """r = wrap(sum k phi / 4), whatever the radii (Abel-Jacobi on the annulus)."""
    rng = np.random.default_rng(seed)
    degrees = rng.choice(96, 8, replace=False) * 3.75
    rings = rng.integers(2, 6, 8)
    polar = [(float(d), int(r)) for d, r in zip(degrees, rings, strict=True)]
    solved, closed_form = on_annulus(polar, [3, 3, 3, 3, 5, 5, 5, 5])
    assert abs(wrap(solved - closed_form, QUARTER)) < 1e-9


def test_alternating_singularities_on_the_annulus_are_as_wrong_as_can_be() -> None:
    polar = [(45.0 * i, 4) for i in range(8)]
    solved, _ = on_annulus(polar, [3, 5] * 4)
    assert abs(abs(solved) - np.pi / 4) < 1e-9


def test_opposite_singularities_on_the_same_rays_are_valid() -> None:
    polar = [(90.0 * i, ring) for i in range(4) for ring in (2, 6)]
    solved, _ = on_annulus(polar, [3, 5] * 4)
    assert abs(solved) < 1e-9


def test_a_valence_3_and_a_valence_5_on_a_torus_are_never_valid() -> None:
    """Izmestiev et al. 2013: there is no quadrangulation of the torus with just 3 and 5."""
    surface = BUILTIN["torus"](n=36)
    solver = IsotropicSolver(surface)
    rng = np.random.default_rng(0)
    worst = []
    for _ in range(200):
        pair = rng.choice(surface.n_vertices, 2, replace=False)
        defects = solver.holonomy.defects(at_vertices(surface, pair.tolist(), [3, 5]))
        worst.append(np.abs(defects).max())
    assert min(worst) > np.radians(0.5)


def test_the_torus_without_singularities_is_valid() -> None:
    solver = IsotropicSolver(BUILTIN["torus"](n=36))
    assert np.abs(solver.solve([]).defects).max() < 1e-9
    assert np.abs(solver.holonomy.defects([])).max() < 1e-9
