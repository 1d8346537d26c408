"""Factor once, solve often: the only place that knows which sparse solver does it.

The default is rslab's supernodal LDL^T with approximate minimum degree ordering; where it is not
installed or misses the residual bound, SciPy's SuperLU in symmetric mode takes over.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu

from solvers.errors import SolveError
from solvers.triangulation import FloatArray, IntArray

try:
    import rslab
except ImportError:  # an optional accelerator: SuperLU answers the same
    rslab = None

RESIDUAL_BOUND = 1e-8
"""Relative residual above which a factor is not trusted."""

SYMMETRIC_MODE = {"diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}

Solve = Callable[[FloatArray], FloatArray]


class Factorization:
    """A factored symmetric positive definite matrix.

    Parameters
    ----------
    matrix : (n, n) sparse array
        Symmetric positive definite, both triangles stored.
    solve : callable
        What the factor does to a right-hand side.
    """

    def __init__(self, matrix: csc_array, solve: Solve) -> None:
        self.matrix = matrix
        self.solve = solve

    def residual(self, solution: FloatArray, right_hand_side: FloatArray) -> float:
        """Return the largest residual relative to the largest term in the sums."""
        scale = max(
            float(np.abs(right_hand_side).max(initial=0.0)),
            float(abs(self.matrix).max() * np.abs(solution).max(initial=0.0)),
            np.finfo(float).tiny,
        )
        return float(np.abs(self.matrix @ solution - right_hand_side).max(initial=0.0) / scale)


class Analysis:
    """The order of elimination of a sparsity pattern, found once for many matrices.

    Parameters
    ----------
    matrix : (n, n) sparse array
        Symmetric, both triangles stored; only its pattern counts.
    accelerated : bool, optional
        Whether to use rslab where it is installed.
    """

    def __init__(self, matrix: csc_array, *, accelerated: bool = True) -> None:
        self._libraries: list[Callable[[csc_array], Solve]] = []
        if accelerated and rslab is not None:
            self._libraries.append(_Rslab(matrix))
        self._libraries.append(_SuperLU())

    def factor(self, matrix: csc_array) -> Factorization:
        """Return the factorization of a matrix with the analysed pattern.

        Raises
        ------
        SolveError
            If the matrix is singular.
        """
        probe = np.cos(np.arange(matrix.shape[0], dtype=np.float64))
        for library in self._libraries:
            try:
                factorization = Factorization(matrix, library(matrix))
            except RuntimeError:
                continue
            if factorization.residual(factorization.solve(probe), probe) <= RESIDUAL_BOUND:
                return factorization
        raise SolveError(
            "the linear system is singular",
            f"{matrix.shape[0]} unknowns",
            "look for triangles without area",
        )


def factorized(matrix: csc_array, *, accelerated: bool = True) -> Factorization:
    """Return the factorization of one symmetric positive definite matrix.

    Parameters
    ----------
    matrix, accelerated
        As in `Analysis`.

    Raises
    ------
    SolveError
        If the matrix is singular.
    """
    matrix = csc_array(matrix)
    return Analysis(matrix, accelerated=accelerated).factor(matrix)


class _Rslab:
    """Supernodal LDL^T."""

    def __init__(self, matrix: csc_array) -> None:
        self._symbolic = rslab.analyze(matrix, path="ldlt", ordering="amd")

    def __call__(self, matrix: csc_array) -> Solve:
        solve: Solve = self._symbolic.factor(matrix).solve
        return solve


class _SuperLU:
    """SuperLU in symmetric mode; a second matrix reuses the first one's order of elimination."""

    def __init__(self) -> None:
        self._order: IntArray | None = None

    def __call__(self, matrix: csc_array) -> Solve:
        if self._order is None:
            factor = splu(matrix, permc_spec="MMD_AT_PLUS_A", **SYMMETRIC_MODE)
            self._order = np.argsort(factor.perm_c)
            return factor.solve
        order = self._order
        factor = splu(matrix[order][:, order].tocsc(), permc_spec="NATURAL", **SYMMETRIC_MODE)

        def solve(right_hand_side: FloatArray) -> FloatArray:
            solution = np.empty_like(right_hand_side)
            solution[order] = factor.solve(right_hand_side[order])
            return solution

        return solve
