"""Factor once, solve often: the only place that knows which sparse solver does it.

The default is rslab's supernodal LDL^T with approximate minimum degree ordering; where it fails in
any way or misses the bound on the residual, SciPy's SuperLU in symmetric mode takes over. Every
solution is certified: refined once if it misses the bound, else solved for by SuperLU, else
refused.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, TypeVar

import numpy as np
import rslab
from scipy.sparse import csc_array, diags_array
from scipy.sparse.linalg import splu

from solvers.errors import SolveError
from solvers.interruption import Interrupted, interruption
from solvers.surface.triangulation import FloatArray, IntArray

RESIDUAL_BOUND = 1e-12
"""Residual, relative, beyond which no solution is given away.

Chosen; measured: libraries leave some 1e-16.
"""

SYMMETRIC_MODE = {"diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
"""Options with which SuperLU pivots on the diagonal, right for positive definite matrices."""

POOR = "look for triangles without area"
"""What to do about systems that cannot be solved."""

Solve = Callable[[FloatArray], FloatArray]
"""From right-hand sides, (n,) or (n, k), to solutions of the same shape."""

Library = Callable[[csc_array], Solve]
"""From a matrix to what its factor does."""

T = TypeVar("T")


class Factorization:
    """A factored symmetric positive definite matrix, whose solutions are certified.

    Parameters
    ----------
    matrix : (n, n) sparse array
        Symmetric positive definite, both triangles stored or, if `lower`, only the lower.
    libraries : sequence of callable
        What factors it: each when the one before it has failed or missed the bound.
    lower : bool, optional
        Which.

    Raises
    ------
    SolveError
        If no library factors it.
    Interrupted
        If the `Interruption` that the thread obeys was asked for meanwhile.

    Examples
    --------
    Several right-hand sides are solved for at once, and each solve tells its residual:

    >>> import numpy as np
    >>> from scipy.sparse import csc_array
    >>> from solvers.algebra import factorized
    >>> matrix = csc_array(np.array([[2.0, -1.0], [-1.0, 2.0]]))
    >>> solutions, residual = factorized(matrix).certified(np.array([[1.0, 0.0], [1.0, 3.0]]))
    >>> solutions.round(9).tolist(), residual < 1e-12
    ([[1.0, 1.0], [1.0, 2.0]], True)
    """

    def __init__(
        self, matrix: csc_array, libraries: Sequence[Library], *, lower: bool = False
    ) -> None:
        self.matrix = matrix
        self._lower = lower
        self._diagonal = matrix.diagonal()
        sizes = abs(matrix)
        sums = sizes.sum(axis=1)
        if lower:
            sums = sums + sizes.sum(axis=0) - np.abs(self._diagonal)
        self._by_row = 1 / np.maximum(sums, np.finfo(float).tiny)
        self._libraries = tuple(libraries)
        self._solve: Solve
        self._advance("")

    def solve(self, right_hand_side: FloatArray) -> FloatArray:
        """Return the solutions of one right-hand side or of several at once.

        Parameters
        ----------
        right_hand_side : (n,) or (n, k) float array
            One, or one in each column.

        Returns
        -------
        (n,) or (n, k) float array
            Whose `residual` is at most `RESIDUAL_BOUND`.

        Raises
        ------
        SolveError
            If no library comes to that, or the right-hand side is not finite.
        """
        return self.certified(right_hand_side)[0]

    def certified(self, right_hand_side: FloatArray) -> tuple[FloatArray, float]:
        """Return what `solve` does, and its residual.

        Parameters
        ----------
        right_hand_side : (n,) or (n, k) float array
            As of `solve`.

        Raises
        ------
        SolveError
            As of `solve`.
        """
        right = np.asarray(right_hand_side, dtype=np.float64)
        if right.size == 0:
            return right, 0.0  # of no columns libraries make errors
        if not np.isfinite(right).all():
            raise SolveError("the right-hand side is not finite", self._where, POOR)
        while True:
            try:
                solution, residual = _guarded(partial(self._refined, right))
                failure = f"a residual of {residual:.1e}"
            except _LibraryError as error:
                residual, failure = np.inf, str(error)
            # not so if it is NaN
            if residual <= RESIDUAL_BOUND:
                return solution, residual
            self._advance(failure)

    def residual(self, solution: FloatArray, right_hand_side: FloatArray) -> float:
        """Return the largest residual of a row of A x = b, relative to ``sum_j |A_ij| max |x|``.

        A factor that errs by rounding alone leaves some 1e-16, whatever the matrix's condition.

        Parameters
        ----------
        solution, right_hand_side : (n,) or (n, k) float array
            x and b.
        """
        return self._relative(self._off(solution, right_hand_side), solution)

    @property
    def _where(self) -> str:
        return f"{self.matrix.shape[0]} unknowns"

    def _refined(self, right: FloatArray) -> tuple[FloatArray, float]:
        """Return solutions, refined once if they miss the bound, and their residual."""
        solution = self._solve(right)
        if solution.shape != right.shape:
            raise _LibraryError("a solution of the wrong shape")
        off = self._off(solution, right)
        residual = self._relative(off, solution)
        if not residual <= RESIDUAL_BOUND:
            solution = solution + self._solve(off)
            residual = self.residual(solution, right)
        return solution, residual

    def _off(self, solution: FloatArray, right: FloatArray) -> FloatArray:
        product = self.matrix @ solution
        if self._lower:
            product += self.matrix.T @ solution - (self._diagonal * solution.T).T
        return np.asarray(right - product)

    def _relative(self, off: FloatArray, solution: FloatArray) -> float:
        largest = np.abs(solution).max(axis=0, initial=0.0)
        by_row = self._by_row if off.ndim == 1 else self._by_row[:, None]
        share = (np.abs(off) * by_row).max(axis=0, initial=0.0)
        return float((share / np.maximum(largest, np.finfo(float).tiny)).max(initial=0.0))

    def _advance(self, failure: str) -> None:
        """Factor by the next library that can, or refuse."""
        while self._libraries:
            library, *rest = self._libraries
            self._libraries = tuple(rest)
            try:
                self._solve = _guarded(partial(library, self.matrix))
                return
            except _LibraryError as error:
                failure = str(error)
        where = ", ".join(filter(None, [self._where, failure]))
        raise SolveError("the linear system could not be solved", where, POOR)


class _LibraryError(Exception):
    """A library failed; why is its message."""


def _guarded(call: Callable[[], T]) -> T:
    """Return what a library does; whatever it raises is a `_LibraryError`."""
    try:
        return call()
    except (KeyboardInterrupt, SystemExit, Interrupted):
        raise
    except BaseException as error:  # a panic of compiled code is no Exception
        raise _LibraryError(f"{type(error).__name__}: {error}") from error


class Analysis:
    """The order of elimination of one sparsity pattern, found with the first of many matrices.

    Parameters
    ----------
    accelerated : bool, optional
        Whether rslab is tried before SuperLU.
    lower : bool, optional
        Whether the matrices store only their lower triangles.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers.algebra import Analysis, stiffness
    >>> from solvers.primitives import disk
    >>> matrix = stiffness(disk(edge_length=0.25).triangulation)[1:, 1:]
    >>> analysis = Analysis()
    >>> ones = np.ones(matrix.shape[0])
    >>> once, twice = (analysis.factor(scale * matrix).solve(ones) for scale in (1.0, 2.0))
    >>> bool(np.allclose(once, 2 * twice))
    True
    """

    def __init__(self, *, accelerated: bool = True, lower: bool = False) -> None:
        self._lower = lower
        self._libraries: list[Library] = []
        if accelerated:
            self._libraries.append(_Rslab(lower))
        self._libraries.append(_SuperLU(lower))

    def factor(self, matrix: csc_array) -> Factorization:
        """Return the factorization of a symmetric matrix with the pattern of the others.

        Parameters
        ----------
        matrix : (n, n) sparse array
            Both triangles stored, or only the lower, as all.

        Raises
        ------
        SolveError
            If the matrix is singular.
        """
        factorization = Factorization(matrix, self._libraries, lower=self._lower)
        factorization.solve(np.cos(np.arange(matrix.shape[0], dtype=np.float64)))
        return factorization


def factorized(matrix: csc_array, *, accelerated: bool = True) -> Factorization:
    """Return the factorization of one symmetric positive definite matrix.

    Parameters
    ----------
    matrix : (n, n) sparse array
        Both triangles stored.
    accelerated : bool, optional
        As in `Analysis`.

    Returns
    -------
    Factorization
        For any number of solves.

    Raises
    ------
    SolveError
        If the matrix is singular.

    Examples
    --------
    The stiffness matrix of a surface is singular until one value is given:

    >>> from solvers.algebra import factorized, stiffness
    >>> from solvers.primitives import disk
    >>> surface = disk(edge_length=0.25)
    >>> matrix = stiffness(surface.triangulation)
    >>> inner = ~surface.boundary_vertices
    >>> x = surface.vertices[:, 0]  # harmonic: given on the boundary, it comes out inside
    >>> right = -matrix[inner][:, ~inner] @ x[~inner]
    >>> solution = factorized(matrix[inner][:, inner]).solve(right)
    >>> bool(abs(solution - x[inner]).max() < 1e-12)
    True
    """
    return Analysis(accelerated=accelerated).factor(csc_array(matrix))


class _Rslab:
    """Supernodal LDL^T; a second matrix reuses the first one's analysis."""

    def __init__(self, lower: bool) -> None:
        self._lower = lower
        self._symbolic: Any = None

    def __call__(self, matrix: csc_array) -> Solve:
        if self._symbolic is None:
            self._symbolic = rslab.analyze(matrix, path="ldlt", ordering="amd")
        # The values of a lower triangle are taken as they are.
        values = matrix.data if self._lower else matrix
        flag = rslab.Interrupt()
        with interruption().telling(flag.cancel):
            try:
                factor = self._symbolic.factor(values, interrupt=flag)
            except RuntimeError:
                if not flag.is_set:
                    raise
        if flag.is_set:
            raise Interrupted

        def solve(right: FloatArray) -> FloatArray:
            return np.asarray(factor.solve(right) if right.ndim == 1 else factor.solve_many(right))

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
            first: Solve = factor.solve
            return first
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
