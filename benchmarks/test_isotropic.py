"""The isotropic stage against one SuperLU factorisation and back-substitution, in one run."""

import subprocess
import sys
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture
from scipy.spatial import ConvexHull

from solvers.algebra.factorization import Factorization, factorized
from solvers.algebra.operators import stiffness
from solvers.fields.isotropic import IsotropicSolver
from solvers.singularities.budget import Singularity
from solvers.surface.trisurface import TriSurface

SIZES = (10_000, 100_000, pytest.param(1_000_000, marks=pytest.mark.large))
Measured = dict[tuple[str, int], float]

MEMORY = """
import pathlib, resource, sys
import numpy as np
from benchmarks.test_isotropic import configuration
from solvers.fields.isotropic import IsotropicSolver
from solvers.surface.trisurface import TriSurface
arrays = np.load(sys.argv[1])
surface = TriSurface(arrays["vertices"], arrays["faces"])
IsotropicSolver(surface).solve(configuration(surface))
status = pathlib.Path("/proc/self/status")
if status.exists():  # what the parent used counts in ru_maxrss on Linux
    print(status.read_text().split("VmHWM:")[1].split()[0])
else:
    print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3)
"""


@dataclass(frozen=True)
class Arrays:
    vertices: np.ndarray
    faces: np.ndarray


@cache
def irregular_sphere(n: int) -> Arrays:
    """A sphere with n vertices on a jittered Fibonacci spiral, joined by their convex hull."""
    i = np.arange(n) + 0.5
    polar, azimuth = np.arccos(1 - 2 * i / n), np.pi * (1 + np.sqrt(5)) * i
    x = np.stack(
        [np.cos(azimuth) * np.sin(polar), np.sin(azimuth) * np.sin(polar), np.cos(polar)], axis=1
    )
    x += np.random.default_rng(0).normal(scale=0.2 / np.sqrt(n), size=x.shape)
    x /= np.linalg.norm(x, axis=1)[:, None]
    faces = ConvexHull(x).simplices.astype(np.int64)
    a, b, c = (x[faces[:, k]] for k in range(3))
    inwards = np.einsum("ij,ij->i", np.cross(b - a, c - a), a) < 0
    faces[inwards] = faces[inwards][:, ::-1]
    return Arrays(x, faces)


@cache
def solver(n: int) -> IsotropicSolver:
    arrays = irregular_sphere(n)
    return IsotropicSolver(TriSurface(arrays.vertices, arrays.faces))


@cache
def fallback(n: int) -> Factorization:
    matrix = stiffness(solver(n).discretization.triangulation)
    return factorized(matrix[1:, 1:], accelerated=False)


def configuration(surface: TriSurface, seed: int = 0) -> list[Singularity]:
    vertices = np.random.default_rng(seed).choice(surface.n_vertices, 8, replace=False)
    return [Singularity(surface.point_at_vertex(int(v)), 3) for v in vertices]


def rounds(n: int) -> int:
    return max(1, min(7, 400_000 // n))


@pytest.mark.parametrize("n", SIZES)
def test_superlu_factorisation(benchmark: BenchmarkFixture, measured: Measured, n: int) -> None:
    matrix = stiffness(solver(n).discretization.triangulation)[1:, 1:]
    benchmark.pedantic(lambda: factorized(matrix, accelerated=False), rounds=rounds(n))
    measured["factor", n] = benchmark.stats.stats.min


@pytest.mark.parametrize("n", SIZES)
def test_superlu_back_substitution(benchmark: BenchmarkFixture, measured: Measured, n: int) -> None:
    right = np.random.default_rng(0).normal(size=n - 1)
    factorization = fallback(n)
    benchmark.pedantic(lambda: factorization.solve(right), rounds=7, warmup_rounds=1)
    measured["solve", n] = benchmark.stats.stats.median


@pytest.mark.parametrize("n", SIZES)
def test_arrays_to_field(benchmark: BenchmarkFixture, measured: Measured, n: int) -> None:
    arrays = irregular_sphere(n)

    def everything() -> None:
        surface = TriSurface(arrays.vertices, arrays.faces)
        field = IsotropicSolver(surface).solve(configuration(surface))
        assert field.max_closing_error < 1e-8

    benchmark.pedantic(everything, rounds=rounds(n))
    measured["total", n] = benchmark.stats.stats.min


@pytest.mark.parametrize("n", SIZES)
def test_edit(benchmark: BenchmarkFixture, measured: Measured, n: int) -> None:
    kept = solver(n)
    configurations = iter([configuration(kept.surface, seed) for seed in range(9)])
    benchmark.pedantic(lambda: kept.solve(next(configurations)), rounds=7, warmup_rounds=1)
    measured["edit", n] = benchmark.stats.stats.median


@pytest.mark.parametrize("n", SIZES)
def test_peak_memory(measured: Measured, tmp_path: Path, n: int) -> None:
    arrays = irregular_sphere(n)
    file = tmp_path / "sphere.npz"
    np.savez(file, vertices=arrays.vertices, faces=arrays.faces)
    command = [sys.executable, "-c", MEMORY, str(file)]
    told = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    measured["memory", n] = float(told) / 1e3
    assert measured["memory", n] < 4000
