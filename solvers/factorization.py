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
from solvers.triangulation import FloatArray

try:
    import rslab
except ImportError:  # an optional accelerator: SuperLU answers the same
    rslab = None

RESIDUAL_BOUND = 1e-8
"""Relative residual above which a factor is not trusted."""

Solve = Callable[[FloatArray], FloatArray]


class Factorization:
    """A factored symmetric positive definite matrix.

    Parameters
    ----------
    matrix : (n, n) sparse array
        Symmetric positive definite, both triangles stored.
    accelerated : bool, optional
        Whether to use rslab where it is installed.

    Raises
    ------
    SolveError
        If the matrix is singular.
    """

    def __init__(self, matrix: csc_array, *, accelerated: bool = True) -> None:
        self.matrix = csc_array(matrix)
        self._solve = self._trusted_solver(accelerated and rslab is not None)

    def solve(self, right_hand_side: FloatArray) -> FloatArray:
        """Return the solution for one right-hand side (n,)."""
        return self._solve(right_hand_side)

    def residual(self, solution: FloatArray, right_hand_side: FloatArray) -> float:
        """Return the largest residual relative to the largest term in the sums."""
        scale = max(
            float(np.abs(right_hand_side).max(initial=0.0)),
            float(abs(self.matrix).max() * np.abs(solution).max(initial=0.0)),
            np.finfo(float).tiny,
        )
        return float(np.abs(self.matrix @ solution - right_hand_side).max(initial=0.0) / scale)

    def _trusted_solver(self, accelerated: bool) -> Solve:
        probe = np.cos(np.arange(self.matrix.shape[0], dtype=np.float64))
        for factor in (_rslab, _superlu) if accelerated else (_superlu,):
            try:
                solve = factor(self.matrix)
            except RuntimeError:
                continue
            if self.residual(solve(probe), probe) <= RESIDUAL_BOUND:
                return solve
        raise SolveError(
            "the linear system is singular",
            f"{self.matrix.shape[0]} unknowns",
            "look for triangles without area",
        )


def _rslab(matrix: csc_array) -> Solve:
    solve: Solve = rslab.ldlt(matrix, ordering="amd").solve
    return solve


def _superlu(matrix: csc_array) -> Solve:
    factor = splu(
        matrix,
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    return factor.solve
