"""Whole numbers within bounds: feasibility against graph theory, energy against trying all."""

import numpy as np
import pytest
from scipy.sparse import csr_array
from scipy.sparse.csgraph import NegativeCycleError, bellman_ford

from solvers.fields.feature_integers import Rows, contradictions, nearest_integers
from solvers.surface.triangulation import FloatArray, IntArray


def differences(one: IntArray, other: IntArray, least: FloatArray, p: int) -> Rows:
    """x[one] - x[other] >= least."""
    row = np.arange(len(one))
    values = np.concatenate([np.ones(len(one)), -np.ones(len(one))])
    entries = (np.concatenate([row, row]), np.concatenate([one, other]))
    matrix = csr_array((values, entries), shape=(len(one), p))
    return Rows(matrix, least, np.full(len(one), np.inf))


def have_solution(one: IntArray, other: IntArray, least: FloatArray, p: int) -> bool:
    """Differences are possible exactly if no cycle asks for a number larger than itself."""
    graph = np.full((p + 1, p + 1), np.inf)
    graph[p, :p] = 0.0
    for i, j, d in zip(one, other, least, strict=True):  # x[j] <= x[i] - d
        graph[i, j] = min(graph[i, j], -d)
    try:
        bellman_ford(np.ma.masked_invalid(graph), indices=p)
    except NegativeCycleError:
        return False
    return True


@pytest.mark.parametrize("seed", range(12))
def test_contradictions_are_the_cycles_that_ask_for_more_than_there_is(seed: int) -> None:
    rng = np.random.default_rng(seed)
    p, r = 6, 14
    one = rng.integers(p, size=r)
    other = (one + rng.integers(1, p, size=r)) % p
    least = rng.integers(-4, 3, size=r).astype(float)
    every = contradictions(differences(one, other, least, p))
    assert (len(every) == 0) == have_solution(one, other, least, p)
    for found in every:
        assert not have_solution(one[found], other[found], least[found], p)
        # in a least contradiction each number is met once from either side: a cycle
        assert sorted(one[found]) == sorted(other[found])
        assert len(set(one[found].tolist())) == len(found)


@pytest.mark.parametrize("seed", range(8))
def test_the_numbers_are_within_bounds_and_no_pair_of_steps_is_better(seed: int) -> None:
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(4, 4))
    matrix, linear = root @ root.T + 0.1 * np.eye(4), rng.normal(size=4) * 3
    one = np.arange(4)
    rows = differences(one, (one + 1) % 4, np.array([1.0, 1.0, -3.0, 0.0]), 4)
    found = nearest_integers(matrix, linear, rows)
    assert (found == np.rint(found)).all()
    assert rows.met(found)

    def energy(x: FloatArray) -> float:
        return float(x @ matrix @ x + 2 * linear @ x)

    steps = np.stack(np.meshgrid(*[[-1.0, 0.0, 1.0]] * 4), axis=-1).reshape(-1, 4)
    for step in steps[np.abs(steps).sum(axis=1) <= 2]:
        assert not rows.met(found + step) or energy(found + step) >= energy(found) - 1e-6


@pytest.mark.parametrize("matrix", [np.zeros((2, 2)), -1e-18 * np.eye(2), np.ones((2, 2))])
def test_what_costs_nothing_does_no_harm(matrix: FloatArray) -> None:
    linear = -3.2 * matrix @ [1.0, 0.0]
    found = nearest_integers(matrix, linear)
    assert np.abs(found).max() < 10
    assert found @ matrix @ found + 2 * linear @ found <= 1e-9


def test_a_row_that_no_number_changes_contradicts_by_itself() -> None:
    rows = Rows(csr_array((2, 0)), np.array([1.0, -1.0]), np.full(2, np.inf))
    (alone,) = contradictions(rows)
    assert alone.tolist() == [0]
