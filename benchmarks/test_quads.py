"""Layouts of fine surfaces, and many quads from a layout."""

import time
from functools import cache

import pytest
from pytest_benchmark.fixture import BenchmarkFixture

import crossview
from crossview.workflow.solution import Solution
from solvers.algebra import factorized, stiffness
from solvers.primitives import disk

Measured = dict[tuple[str, int], float]


@cache
def solution(edge_length: float) -> Solution:
    """Four valence 3 on a disk."""
    surface = disk(edge_length=edge_length)
    places = [[0.55, 0, 0], [0, 0.55, 0], [-0.55, 0, 0], [0, -0.55, 0]]
    placed = [crossview.Singularity(surface.closest_point(x), 3) for x in places]
    return crossview.solve(crossview.Problem(surface, placed))


@pytest.mark.parametrize("n", [50_000, pytest.param(500_000, marks=pytest.mark.large)])
def test_quads(benchmark: BenchmarkFixture, measured: Measured, n: int) -> None:
    layout = crossview.layout(solution(0.04))
    made = benchmark.pedantic(lambda: crossview.quads(layout, n, smooth=False), rounds=3)
    assert made.irregular == {3: 4}
    measured["quads", n] = benchmark.stats.stats.min


@pytest.mark.large
def test_layout(benchmark: BenchmarkFixture, measured: Measured) -> None:
    n = 400_000
    solved = solution(1 / 258)
    matrix = stiffness(solved.surface.triangulation)[1:, 1:]
    start = time.perf_counter()
    factorized(matrix, accelerated=False)
    measured["factor", n] = time.perf_counter() - start
    benchmark.pedantic(lambda: crossview.layout(solved), rounds=3)
    measured["layout", n] = benchmark.stats.stats.min
