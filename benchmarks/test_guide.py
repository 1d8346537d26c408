"""The validity guide on 110 000 triangles.

To reach: the lines of a condition in less than a back-substitution; a row of defects, and a
point kept on a line, in a small part of one.
"""

import time
from functools import cache

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from solvers.fields.isotropic import IsotropicSolver
from solvers.primitives import BUILTIN
from solvers.singularities.budget import Singularity
from solvers.validity.guide import Guide


@cache
def torus() -> tuple[IsotropicSolver, list[Singularity]]:
    surface = BUILTIN["torus"](n=330)
    places = [[1.4, 0, 0], [0, 1.4, 0.1], [-1.4, 0, 0], [0.2, -1, 0.4]]
    singularities = [
        Singularity(surface.closest_point(x), v) for x, v in zip(places, [3, 3, 5, 5], strict=True)
    ]
    solver = IsotropicSolver(surface)
    guide = Guide(solver.holonomy, singularities, 0)
    guide.kept(0, singularities[1].point)  # what is computed once per surface is there
    return solver, singularities


@pytest.mark.benchmark(group="guide")
def test_lines(benchmark: BenchmarkFixture) -> None:
    solver, singularities = torus()
    surface = solver.surface
    lines = benchmark(
        lambda: [Guide(solver.holonomy, singularities, 0).closing(i).ends(surface) for i in (0, 1)]
    )
    assert min(map(len, lines)) > 100
    assert benchmark.stats["median"] < 2 * back_substitution(solver)


@pytest.mark.benchmark(group="guide")
def test_defects(benchmark: BenchmarkFixture) -> None:
    solver, singularities = torus()
    benchmark(solver.holonomy.defects, singularities)
    assert benchmark.stats["median"] < 0.1 * back_substitution(solver)


@pytest.mark.benchmark(group="guide")
def test_a_point_kept_on_a_line(benchmark: BenchmarkFixture) -> None:
    solver, singularities = torus()
    guide = Guide(solver.holonomy, singularities, 0)
    near = solver.surface.closest_point([1.2, 0.7, 0.2])
    benchmark(guide.kept, 0, near)
    assert benchmark.stats["median"] < 0.5 * back_substitution(solver)


@cache
def back_substitution(solver: IsotropicSolver) -> float:
    """Seconds, the median of some."""
    right = np.random.default_rng(0).normal(size=solver.surface.n_vertices - 1)
    seconds = []
    for _ in range(9):
        start = time.perf_counter()
        solver.factorization.solve(right)
        seconds.append(time.perf_counter() - start)
    return float(np.median(seconds))
