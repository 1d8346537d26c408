"""The anisotropic stage against one SuperLU factorisation of the same surface's Laplacian."""

import subprocess
import sys
import time
from functools import cache

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from solvers.algebra.factorization import factorized
from solvers.algebra.operators import stiffness
from solvers.fields.aligned import AlignedField, aligned_field
from solvers.fields.anisotropic import MinimumNormNewton, NewtonStep
from solvers.fields.integrable import anisotropic_field
from solvers.fields.prepared import prepare
from solvers.primitives import annulus
from solvers.progress import run
from solvers.singularities.budget import Singularity
from solvers.surface.trisurface import TriSurface

Measured = dict[tuple[str, int], float]

AROUND = {12_000: 190, 100_000: 545}
"""Vertices around an annulus of about so many triangles."""

MEMORY = """
import pathlib, resource, sys
from benchmarks.test_anisotropic import configured
from solvers.fields.integrable import anisotropic_field
from solvers.progress import run
run(anisotropic_field(configured(int(sys.argv[1]))))
status = pathlib.Path("/proc/self/status")
if status.exists():  # what the parent used counts in ru_maxrss on Linux
    print(status.read_text().split("VmHWM:")[1].split()[0])
else:
    print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3)
"""


@cache
def surface(n: int) -> TriSurface:
    return annulus(inner=0.4, n=AROUND[n])


def configured(n: int) -> AlignedField:
    """Four valence 3, and four valence 5 at 19 degrees from the next of them."""
    made = surface(n)
    angles = np.radians(90 * np.arange(4))
    singularities = []
    for radius, turn, valence in ((0.8, 0.0, 3), (0.6, 19.0, 5)):
        for angle in angles + np.radians(turn):
            x = np.array([radius * np.cos(angle), radius * np.sin(angle), 0.0])
            vertex = int(np.linalg.norm(made.vertices - x, axis=1).argmin())
            singularities.append(Singularity(made.point_at_vertex(vertex), valence))
    return aligned_field(prepare(made, singularities, refine=0))


@cache
def aligned(n: int) -> AlignedField:
    return configured(n)


def step_seconds(n: int, accelerated: bool, most: int) -> list[float]:
    """Seconds of each Newton step; those of the first include finding the pattern."""
    start = aligned(n)
    times, last = [], time.perf_counter()
    newton = MinimumNormNewton(start.integrability, accelerated=accelerated)
    for step in newton.solve(start.start):
        assert isinstance(step, NewtonStep)
        now = time.perf_counter()
        times.append(now - last)
        last = now
        if len(times) == most:
            break
    return times


def test_laplacian_factorisation(benchmark: BenchmarkFixture, measured: Measured) -> None:
    n = 100_000
    matrix = stiffness(surface(n).triangulation)[1:, 1:]
    benchmark.pedantic(lambda: factorized(matrix, accelerated=False), rounds=5)
    measured["laplacian", n] = benchmark.stats.stats.min


@pytest.mark.parametrize(("name", "accelerated"), [("newton", True), ("newton-superlu", False)])
def test_newton_step(
    benchmark: BenchmarkFixture, measured: Measured, name: str, accelerated: bool
) -> None:
    n = 100_000
    times = benchmark.pedantic(lambda: step_seconds(n, accelerated, 4), rounds=1)
    measured[name, n] = min(times[1:])


@pytest.mark.parametrize("n", AROUND)
def test_to_the_smoothest_field(benchmark: BenchmarkFixture, measured: Measured, n: int) -> None:
    def everything() -> None:
        field = run(anisotropic_field(configured(n))).field
        assert field.energy < 1e-10

    benchmark.pedantic(everything, rounds=3 if n < 50_000 else 1)
    measured["anisotropic", n] = benchmark.stats.stats.min


def test_peak_memory(measured: Measured) -> None:
    n = 100_000
    command = [sys.executable, "-c", MEMORY, str(n)]
    told = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    measured["anisotropic-memory", n] = float(told) / 1e3
    assert measured["anisotropic-memory", n] < 4000
