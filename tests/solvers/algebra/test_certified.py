"""No solution is given away that is not certified, whatever an accelerator does."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.sparse import csc_array, diags_array, tril
from scipy.sparse.linalg import splu

from solvers.algebra import factorization
from solvers.algebra.factorization import RESIDUAL_BOUND, Analysis, Factorization, factorized
from solvers.algebra.operators import stiffness
from solvers.errors import SolveError
from solvers.fields.isotropic import IsotropicSolver
from solvers.fields.verdict import judge
from solvers.layouts.layout import quad_layout
from solvers.primitives import BUILTIN
from solvers.progress import run
from solvers.surface.triangulation import FloatArray
from tests.solvers.layouts.fields import at_places, integrated
from tests.solvers.suite import SURFACES

Spoil = Callable[[FloatArray], FloatArray]


class Panic(BaseException):
    """What compiled code raises when it panics: no Exception."""


def wrong_by_a_thousandth(solution: FloatArray) -> FloatArray:
    return solution * (1 + 1e-3 * np.cos(np.arange(solution.size)).reshape(solution.shape))


def wrong_evenly(solution: FloatArray) -> FloatArray:
    return solution * 1.001


def not_finite(solution: FloatArray) -> FloatArray:
    return np.full_like(solution, np.nan)


def of_another_shape(solution: FloatArray) -> FloatArray:
    return solution[:-1]


def refuses(solution: FloatArray) -> FloatArray:
    raise ValueError("rhs dtype does not match the factor dtype")


def panics(solution: FloatArray) -> FloatArray:
    raise Panic("index out of bounds")


SPOILT: list[Spoil] = [
    wrong_by_a_thousandth, wrong_evenly, not_finite, of_another_shape, refuses, panics
]  # fmt: skip


class Accelerator:
    """Solves as rslab does, by SuperLU: right for a while, then spoilt."""

    def __init__(self, spoil: Spoil, right: int) -> None:
        self.spoil, self.right = spoil, right

    def analyze(self, matrix: csc_array, **_: Any) -> "_Symbolic":
        return _Symbolic(self, matrix)


class _Symbolic:
    def __init__(self, owner: Accelerator, pattern: csc_array) -> None:
        self._owner, self._pattern = owner, pattern

    def factor(self, values: Any) -> "_Factor":
        if isinstance(values, np.ndarray):  # of a lower triangle
            p = self._pattern
            lower = csc_array((values, p.indices, p.indptr), shape=p.shape)
            values = csc_array(lower + lower.T - diags_array(lower.diagonal()))
        return _Factor(self._owner, values)


class _Factor:
    def __init__(self, owner: Accelerator, matrix: csc_array) -> None:
        self._owner, self._factor, self._left = owner, splu(csc_array(matrix)), owner.right

    def solve(self, right: FloatArray) -> FloatArray:
        self._left -= 1
        solution = self._factor.solve(right)
        return solution if self._left >= 0 else self._owner.spoil(solution)

    solve_many = solve


@pytest.fixture(params=SPOILT, ids=lambda spoil: spoil.__name__)
def spoilt(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """An accelerator that is right on the probe alone."""
    monkeypatch.setattr(factorization, "rslab", Accelerator(request.param, right=1))


@pytest.mark.usefixtures("spoilt")
@pytest.mark.parametrize("lower", [True, False])
@pytest.mark.parametrize("columns", [(), (3,), (0,)])
def test_every_solution_is_certified(columns: tuple[int, ...], lower: bool) -> None:
    whole = csc_array(stiffness(BUILTIN["disk"](edge_length=0.15).triangulation)[1:, 1:])
    factor = Analysis(lower=lower).factor(csc_array(tril(whole)) if lower else whole)
    for seed in range(3):
        expected = np.random.default_rng(seed).normal(size=(whole.shape[0], *columns))
        solution = factor.solve(whole @ expected)
        assert solution == pytest.approx(expected, abs=1e-9)
        assert factor.residual(solution, whole @ expected) <= RESIDUAL_BOUND


@pytest.mark.usefixtures("spoilt")
def test_columns_are_solved_for_as_one_by_one() -> None:
    matrix = stiffness(BUILTIN["disk"](edge_length=0.15).triangulation)[1:, 1:]
    right = np.random.default_rng(0).normal(size=(matrix.shape[0], 4))
    together, alone = factorized(matrix), factorized(matrix)
    apart = np.stack([alone.solve(column) for column in right.T], axis=1)
    assert together.solve(right) == pytest.approx(apart, rel=1e-9)


def test_what_is_slightly_off_is_refined() -> None:
    matrix = csc_array(stiffness(BUILTIN["disk"](edge_length=0.15).triangulation)[1:, 1:])
    exact = splu(matrix)
    used = []

    def slightly_off(matrix: csc_array) -> Callable[[FloatArray], FloatArray]:
        return lambda right: exact.solve(right) * (1 + 1e-8)

    def other(matrix: csc_array) -> Callable[[FloatArray], FloatArray]:
        used.append(matrix)
        return lambda right: exact.solve(right)

    expected = np.random.default_rng(0).normal(size=matrix.shape[0])
    solution = Factorization(matrix, [slightly_off, other]).solve(matrix @ expected)
    assert solution == pytest.approx(expected, abs=1e-11)
    assert not used


def test_what_no_library_solves_is_refused_in_one_line() -> None:
    matrix = csc_array(diags_array([1.0, 2.0, 4.0]))
    factor = Factorization(matrix, [lambda matrix: np.copy, lambda matrix: np.zeros_like])
    with pytest.raises(SolveError, match=r"could not be solved \(3 unknowns, a residual of 1") as e:
        factor.solve(np.array([3.0, 2.0, 1.0]))
    assert "\n" not in str(e.value)
    assert factor.solve(np.zeros(3)).tolist() == [0, 0, 0]  # the last is kept, and asked again


@pytest.mark.parametrize("wrong", [np.nan, np.inf])
def test_a_right_hand_side_that_is_not_finite_is_refused(wrong: float) -> None:
    factor = factorized(csc_array(diags_array([1.0, 2.0, 4.0])))
    with pytest.raises(SolveError, match="right-hand side is not finite"):
        factor.solve(np.array([1.0, wrong, 0.0]))


def test_interrupting_a_library_is_no_failure_of_it() -> None:
    def interrupted(matrix: csc_array) -> Callable[[FloatArray], FloatArray]:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        Factorization(csc_array(diags_array([1.0, 2.0])), [interrupted, lambda m: np.copy])


@pytest.mark.usefixtures("spoilt")
def test_a_valid_annulus_stays_valid() -> None:
    surface = SURFACES["annulus"]()
    angle = np.radians(45 * np.arange(8) - 45 * (np.arange(8) % 2))
    radius = np.where(np.arange(8) % 2, 0.85, 0.6)
    places = np.stack([radius * np.cos(angle), radius * np.sin(angle), 0 * angle], axis=1)
    field = IsotropicSolver(surface).solve(at_places(surface, places, [3, 5] * 4))
    assert judge(field, 0).status == "valid"


@pytest.mark.usefixtures("spoilt")
@pytest.mark.parametrize("spoilt", [wrong_by_a_thousandth, panics], indirect=True)
def test_anisotropic_fields_and_maps_stay_what_they_are() -> None:
    surface = BUILTIN["annulus"](n=32)
    angle = np.radians(45 * np.arange(8) + [0, 5] * 4)
    radius = np.where(np.arange(8) % 2, 0.85, 0.6)
    places = np.stack([radius * np.cos(angle), radius * np.sin(angle), 0 * angle], axis=1)
    solved = integrated(surface, at_places(surface, places, [3, 5] * 4))
    assert solved.field.energy < 1e-11
    layout = run(quad_layout(solved))
    sides = layout.tmesh.side_totals(layout.tmesh.lengths)
    assert sides[:, :2] == pytest.approx(sides[:, 2:], abs=1e-11)


@pytest.mark.parametrize("lower", [True, False])
@pytest.mark.parametrize("columns", [(), (1,), (5,), (0,)])
def test_the_accelerator_is_enough_where_it_is_right(
    columns: tuple[int, ...], lower: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("rslab")
    monkeypatch.setattr(factorization, "splu", None)  # nothing to fall back to
    whole = csc_array(stiffness(BUILTIN["disk"](edge_length=0.15).triangulation)[1:, 1:])
    factor = Analysis(lower=lower).factor(csc_array(tril(whole)) if lower else whole)
    expected = np.random.default_rng(0).normal(size=(whole.shape[0], *columns))
    for right in (whole @ expected, np.asfortranarray(whole @ expected)):
        assert factor.solve(right) == pytest.approx(expected, abs=1e-9)
