"""Factor once, solve often: the only place that knows which sparse solver does it.

The default is rslab's supernodal LDL^T with approximate minimum degree ordering; where it is not
installed or misses the residual bound, SciPy's SuperLU in symmetric mode takes over.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.sparse import csc_array, diags_array
from scipy.sparse.linalg import splu

from solvers.errors import SolveError
from solvers.surface.triangulation import FloatArray, IntArray

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
        Symmetric positive definite, both triangles stored or, if `lower`, only the lower.
    solve : callable
        What the factor does to a right-hand side.
    lower : bool, optional
        Which.
    """

    def __init__(self, matrix: csc_array, solve: Solve, *, lower: bool = False) -> None:
        self.matrix = matrix
        self.solve = solve
        self._lower = lower

    def residual(self, solution: FloatArray, right_hand_side: FloatArray) -> float:
        """Return the largest residual relative to the largest term in the sums."""
        scale = max(
            float(np.abs(right_hand_side).max(initial=0.0)),
            float(np.abs(self.matrix.data).max(initial=0.0) * np.abs(solution).max(initial=0.0)),
            np.finfo(float).tiny,
        )
        product = self.matrix @ solution
        if self._lower:
            product += self.matrix.T @ solution - self.matrix.diagonal() * solution
        return float(np.abs(product - right_hand_side).max(initial=0.0) / scale)


class Analysis:
    """The order of elimination of a sparsity pattern, found once for many matrices.

    Parameters
    ----------
    matrix : (n, n) sparse array
        Symmetric; only its pattern counts.
    accelerated : bool, optional
        Whether to use rslab where it is installed.
    lower : bool, optional
        Whether this and the matrices to factor store only their lower triangles.
    """

    def __init__(self, matrix: csc_array, *, accelerated: bool = True, lower: bool = False) -> None:
        self._lower = lower
        self._libraries: list[Callable[[csc_array], Solve]] = []
        if accelerated and rslab is not None:
            self._libraries.append(_Rslab(matrix, lower))
        self._libraries.append(_SuperLU(lower))

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
                factorization = Factorization(matrix, library(matrix), lower=self._lower)
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

    def __init__(self, matrix: csc_array, lower: bool) -> None:
        self._lower = lower
        self._symbolic = rslab.analyze(matrix, path="ldlt", ordering="amd")

    def __call__(self, matrix: csc_array) -> Solve:
        # The values of a lower triangle are taken as they are.
        solve: Solve = self._symbolic.factor(matrix.data if self._lower else matrix).solve
        return solve


class _SuperLU:
    """SuperLU in symmetric mode; a second matrix reuses the first one's order of elimination."""

    def __init__(self, lower: bool) -> None:
        self._lower = lower
        self._order: IntArray | None = None
        self._source: IntArray
        self._ordered: csc_array

    def __call__(self, matrix: csc_array) -> Solve:
        if self._order is None:
            factor = splu(self._full(matrix), permc_spec="MMD_AT_PLUS_A", **SYMMETRIC_MODE)
            self._order = np.argsort(factor.perm_c)
            return factor.solve
        order = self._order
        factor = splu(self._in_order(matrix, order), permc_spec="NATURAL", **SYMMETRIC_MODE)

        def solve(right_hand_side: FloatArray) -> FloatArray:
            solution = np.empty_like(right_hand_side)
            solution[order] = factor.solve(right_hand_side[order])
            return solution

        return solve

    def _full(self, matrix: csc_array) -> csc_array:
        if not self._lower:
            return matrix
        return (matrix + matrix.T - diags_array(matrix.diagonal())).tocsc()

    def _in_order(self, matrix: csc_array, order: IntArray) -> csc_array:
        """Return the whole matrix in the order of elimination; where each value goes is kept."""
        if not hasattr(self, "_source"):
            numbers = np.arange(1.0, len(matrix.data) + 1)
            numbered = csc_array((numbers, matrix.indices, matrix.indptr), shape=matrix.shape)
            self._ordered = self._full(numbered)[order][:, order].tocsc()
            self._ordered.sort_indices()
            self._source = np.rint(self._ordered.data).astype(np.int64) - 1
        values = matrix.data[self._source]
        pattern = self._ordered
        return csc_array((values, pattern.indices, pattern.indptr), shape=pattern.shape)
