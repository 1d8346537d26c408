"""The factor solves, whichever library makes it, and says so when it cannot."""

import numpy as np
import pytest
from scipy.sparse import csc_array, diags_array, tril

from solvers.algebra.factorization import Analysis, factorized
from solvers.algebra.operators import stiffness
from solvers.errors import SolveError
from tests.solvers.suite import SURFACES


@pytest.mark.parametrize("accelerated", [True, False])
@pytest.mark.parametrize("name", ["sphere", "plate", "slivers"])
def test_both_libraries_solve_the_stiffness_system(name: str, accelerated: bool) -> None:
    matrix = stiffness(SURFACES[name]().triangulation)[1:, 1:]
    factorization = factorized(matrix, accelerated=accelerated)
    expected = np.random.default_rng(0).normal(size=matrix.shape[0])
    solution = factorization.solve(matrix @ expected)
    assert np.abs(solution - expected).max() < 1e-7
    assert factorization.residual(solution, matrix @ expected) < 1e-14


@pytest.mark.parametrize("accelerated", [True, False])
@pytest.mark.parametrize("lower", [True, False])
def test_one_analysis_serves_many_matrices(accelerated: bool, lower: bool) -> None:
    whole = stiffness(SURFACES["plate"]().triangulation)[1:, 1:]
    expected = np.random.default_rng(0).normal(size=whole.shape[0])
    stored = csc_array(tril(whole)) if lower else csc_array(whole)
    analysis = Analysis(accelerated=accelerated, lower=lower)
    for factor in (1.0, 2.0, 3.0, 4.0):
        factorization = analysis.factor(factor * stored)
        solution = factorization.solve(factor * (whole @ expected))
        assert np.abs(solution - expected).max() < 1e-9
        assert factorization.residual(solution, factor * (whole @ expected)) < 1e-14


def test_a_singular_system_is_the_projects_own_error() -> None:
    with pytest.raises(SolveError, match="singular"):
        factorized(csc_array(diags_array([1.0, 0.0, 2.0])))


def test_the_residual_measures_a_wrong_solution() -> None:
    matrix = csc_array(diags_array([1.0, 2.0, 4.0]))
    factorization = factorized(matrix)
    assert factorization.residual(np.array([1.0, 1.0, 1.0]), np.array([1.0, 2.0, 2.0])) == 0.5
