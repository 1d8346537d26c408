"""Natural singularities on 41 000 vertices."""

import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from solvers.fields import NATURAL_METHODS, natural_singularities
from solvers.primitives import disk
from solvers.progress import run

Measured = dict[tuple[str, int], float]


@pytest.mark.parametrize("method", NATURAL_METHODS)
def test_natural(benchmark: BenchmarkFixture, measured: Measured, method: str) -> None:
    surface = disk(edge_length=1 / 117)
    found = benchmark.pedantic(lambda: run(natural_singularities(surface, method)), rounds=1)
    assert sum(s.index for s in found) == 4
    measured[method, 41_000] = benchmark.stats.stats.min
