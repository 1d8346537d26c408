"""Lanczos: a closed form, and the least eigenvalue of a surface by way of its inverse."""

from itertools import islice

import numpy as np
import pytest
from scipy.sparse import csc_array

from solvers.algebra import factorized, ritz_vectors


def test_the_lowest_mode_of_a_string_is_a_sine() -> None:
    n = 200
    matrix = csc_array(2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1))
    solve = factorized(matrix).solve
    vector, residual = list(islice(ritz_vectors(solve, np.ones(n)), 20))[-1]
    assert residual < 1e-10
    sine = np.sin(np.pi * np.arange(1, n + 1) / (n + 1))
    assert abs(vector @ sine) / np.linalg.norm(sine) == pytest.approx(1, abs=1e-12)
    least = 2 - 2 * np.cos(np.pi / (n + 1))
    assert vector @ (matrix @ vector) == pytest.approx(least, rel=1e-10)


def test_it_starts_anew_where_eigenvalues_are_close() -> None:
    sizes = 1 - np.arange(300) / 3000
    start = np.random.default_rng(0).normal(size=300)
    steps = list(islice(ritz_vectors(lambda x: sizes * x, start), 200))
    assert len(steps) == 200
    sought = [float(vector @ (sizes * vector)) for vector, _ in steps]
    assert (np.diff(sought) > -1e-14).all()
    assert sought[-1] == pytest.approx(1, abs=1e-6)


def test_it_ends_at_an_eigenvector() -> None:
    vector, residual = next(ritz_vectors(lambda x: 3 * x, np.array([3.0, 4.0])))
    assert vector.tolist() == [0.6, 0.8]
    assert residual == pytest.approx(0, abs=1e-15)
