"""The integer program behind numbers of quads: what is balanced, the nearest whole numbers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import Bounds, LinearConstraint, milp
from scipy.sparse import coo_array, csr_array, hstack

from solvers.layouts.tmesh import TMesh
from solvers.surface.triangulation import FloatArray, IntArray

WINDOWS = (1, 8, 64)
"""How far around the fractional optimum whole numbers are looked for, in quads, in this order.

Measured: on nine layouts of 48 to 1 476 arcs the first holds what no larger one betters.
"""

MOST_NODES = 200
"""Nodes of a branching at most, so that the work is bounded and no clock decides. Chosen."""

GAP = 1e-3
"""Relative excess over the least deviation up to which counts count as nearest. Chosen."""

WHOLE = 1e-6
"""Distance from a whole number up to which an unknown counts as one. The solver's own."""


@dataclass(frozen=True, eq=False)
class Total:
    """A weighted sum of counts that is to lie between two bounds.

    Parameters
    ----------
    weights : (A,) float array
        One for each arc.
    low, high : float
        The bounds.
    """

    weights: FloatArray
    low: float
    high: float


def balances(tmesh: TMesh) -> csr_array:
    """Return the matrix (., A) that takes counts to differences of opposite sides; no zero rows.

    Parameters
    ----------
    tmesh : TMesh
        The rectangles.
    """
    side = np.repeat(np.arange(4 * tmesh.n_rectangles), np.diff(tmesh.side_offsets))
    row = 2 * (side // 4) + side % 2
    sign = np.where(side % 4 < 2, 1, -1)
    shape = (2 * tmesh.n_rectangles, tmesh.n_arcs)
    matrix = csr_array(coo_array((sign, (row, tmesh.side_halfarcs // 2)), shape=shape))
    matrix.eliminate_zeros()
    return matrix[np.flatnonzero(np.diff(matrix.indptr))]


@dataclass(frozen=True, eq=False)
class Program:
    """Counts in balance that are to be nearest to wanted ones.

    Parameters
    ----------
    wanted : (A,) float array
        Where counts are to be near to.
    balance : (b, A) sparse array
        Combinations that vanish.
    least : (A,) int array
        The smallest counts.
    weights : (A,) float array, optional
        Of the distances; 1 each by default.
    total : Total, optional
        A further condition.

    Notes
    -----
    Each count is floor(wanted) + a + b - c with 0 <= a <= 1 and b, c >= 0, put straight into the
    balances, where each arc occurs twice at most: a flow in a bi-directed network (Heistermann,
    Warnett and Bommes 2023). Its fractional optimum is whole but for a few halves; those are
    mended by branching in a window around it.
    """

    wanted: FloatArray
    balance: csr_array
    least: IntArray
    weights: FloatArray | None = None
    total: Total | None = None

    def fractional(self) -> FloatArray | None:
        """Return the nearest counts (A,), whole or not; None if there are none."""
        return self._solved(self.least, np.full(len(self.wanted), np.inf), whole=False)

    def whole(self, near: FloatArray) -> IntArray | None:
        """Return the nearest whole counts (A,) around fractional ones; None if none were found."""
        if (np.abs(near - np.rint(near)) < WHOLE).all():
            return np.rint(near).astype(np.int64)
        for window in WINDOWS:
            low = np.maximum(self.least, np.floor(near + WHOLE) - window)
            found = self._solved(low, np.ceil(near - WHOLE) + window, whole=True)
            if found is not None:
                return np.rint(found).astype(np.int64)
        return None

    def _solved(
        self, low: FloatArray | IntArray, high: FloatArray, *, whole: bool
    ) -> FloatArray | None:
        n, balance, wanted = len(self.wanted), self.balance, self.wanted
        weights = np.ones(n) if self.weights is None else self.weights
        floor = np.clip(np.floor(wanted), low, high)
        one = np.minimum(1.0, high - floor)
        constraints = []
        if balance.shape[0]:
            even = -(balance @ floor)
            constraints.append(LinearConstraint(hstack([balance, balance, -balance]), even, even))
        if self.total is not None:
            row = np.concatenate([self.total.weights, self.total.weights, -self.total.weights])
            fixed = self.total.weights @ floor
            low_, high_ = self.total.low - fixed, self.total.high - fixed
            constraints.append(LinearConstraint(row[None], low_, high_))
        rise = np.abs(floor + 1 - wanted) - np.abs(floor - wanted)
        found = milp(
            np.concatenate([rise, np.ones(2 * n)]) * np.tile(weights, 3),
            integrality=np.full(3 * n, int(whole)),
            bounds=Bounds(0, np.concatenate([one, high - floor - one, floor - low])),
            constraints=constraints,
            options={"node_limit": MOST_NODES, "mip_rel_gap": GAP},
        )
        if found.x is None:
            return None
        more, further, less = found.x.reshape(3, n)
        return np.asarray(floor + more + further - less)
