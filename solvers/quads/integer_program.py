"""The integer program behind numbers of quads: what is balanced, what is measured, the solve."""

from __future__ import annotations

import time

import numpy as np
from scipy.optimize import Bounds, LinearConstraint, milp
from scipy.sparse import coo_array, csr_array, eye_array, hstack

from solvers.layouts.tmesh import TMesh
from solvers.quads.collapse import CuttingPlane
from solvers.surface.triangulation import FloatArray, IntArray

WINDOWS = (8.0, 64.0, np.inf)
"""How far from what is wanted counts are looked for, in quads, one after the other.

Chosen: near ones are found much faster.
"""


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


def arcs_alone(tmesh: TMesh) -> csr_array:
    """Return the matrix (A, A) that takes counts to counts.

    Parameters
    ----------
    tmesh : TMesh
        The rectangles.
    """
    return csr_array(eye_array(tmesh.n_arcs))


def offsets(tmesh: TMesh) -> csr_array:
    """Return the matrix (., A) that takes counts to how far nodes are from facing another.

    A row for each node within a side of a rectangle: from the node of the opposite side that is
    nearest to facing it to the place that it faces.

    Parameters
    ----------
    tmesh : TMesh
        The rectangles.
    """
    rows, row = [], 0
    for r in range(tmesh.n_rectangles):
        for side in range(4):
            near = tmesh.side(r, side) // 2
            far = tmesh.side(r, (side + 2) % 4)[::-1] // 2
            stops = np.concatenate([[0.0], np.cumsum(tmesh.lengths[far])])
            at = np.cumsum(tmesh.lengths[near])[:-1]
            faced = np.argmin(np.abs(stops - at[:, None]), axis=1)
            for k, m in enumerate(faced.tolist()):
                arcs = np.concatenate([near[: k + 1], far[:m]])
                sign = np.where(np.arange(len(arcs)) <= k, 1.0, -1.0)
                rows.append(np.stack([np.full(len(arcs), row), arcs, sign]))
                row += 1
    i, j, sign = np.concatenate([*rows, np.zeros((3, 0))], axis=1)
    return csr_array(coo_array((sign, (i.astype(int), j.astype(int))), shape=(row, tmesh.n_arcs)))


def nearest_counts(
    wanted: FloatArray,
    measured: csr_array,
    balance: csr_array,
    least: IntArray,
    cuts: list[CuttingPlane],
    time_limit: float,
) -> tuple[IntArray | None, bool]:
    """Return counts in balance that are nearest to wanted ones, and whether they surely are.

    Parameters
    ----------
    wanted : (A,) float array
        Where counts are to be near to.
    measured : (k, A) sparse array
        The combinations, with whole coefficients, whose deviations are summed.
    balance : (b, A) sparse array
        Combinations that vanish.
    least : (A,) int array
        The smallest counts.
    cuts : list of CuttingPlane
        Further conditions.
    time_limit : float
        Seconds after which the best counts found are taken.

    Returns
    -------
    counts : (A,) int array or None
        None if none were found in time.
    optimal : bool

    Notes
    -----
    The unknowns are counts n and, for each value measured, how much it is above and below its
    floor: measured n = floor + a + b - c with 0 <= a <= 1 and b, c >= 0. They cost what
    |n - wanted| does at whole numbers, and the program without integrality has whole solutions
    nearly everywhere.
    """
    k, n = measured.shape
    value = measured @ wanted
    floor = np.floor(value)
    one = eye_array(k)
    constraints = [LinearConstraint(hstack([measured, -one, -one, one]), floor, floor)]
    if balance.shape[0]:
        none = csr_array((balance.shape[0], 3 * k))
        constraints.append(LinearConstraint(hstack([balance, none]), 0, 0))
    if cuts:
        column = np.concatenate([cut.arcs for cut in cuts])
        row = np.repeat(np.arange(len(cuts)), [len(cut.arcs) for cut in cuts])
        sums = coo_array((np.ones(len(row)), (row, column)), shape=(len(cuts), n + 3 * k))
        constraints.append(LinearConstraint(csr_array(sums), [cut.least for cut in cuts], np.inf))
    cost = np.concatenate([np.zeros(n), 1 - 2 * (value - floor), np.ones(2 * k)])
    whole = np.concatenate([np.ones(n), np.zeros(3 * k)])
    start, left = time.monotonic(), time_limit
    for window in WINDOWS:
        low = np.maximum(least, np.floor(wanted) - window)
        high = np.maximum(least, np.ceil(wanted)) + window
        found = milp(
            cost,
            integrality=whole,
            bounds=Bounds(
                np.concatenate([low, np.zeros(3 * k)]),
                np.concatenate([high, np.ones(k), np.full(2 * k, np.inf)]),
            ),
            constraints=constraints,
            options={"time_limit": left},
        )
        left = time_limit - (time.monotonic() - start)
        if found.x is not None:
            return np.rint(found.x[:n]).astype(np.int64), found.status == 0
        if left <= 0:
            break
    return None, False
