"""Whole numbers for feature curves: every sector gets a quad, and the field stays smooth.

A small integer program: the energy is a quadratic form of the numbers, and the quads of each sector
are linear in them. That there are such numbers at all, or which sectors contradict each other, is
decided exactly (HiGHS). The energy's minimum is sought by rounding one number after the other
(Babai 1986), then the nearest numbers that leave no sector empty, then steps of one or two numbers.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError, cholesky, solve_triangular
from scipy.optimize import Bounds, LinearConstraint, milp
from scipy.sparse import bmat, csr_array, eye_array, hstack
from scipy.sparse.csgraph import connected_components

from solvers.fields.sector_quads import SectorQuads
from solvers.frozen import freeze_arrays
from solvers.surface.triangulation import BoolArray, FloatArray, IntArray

RIDGE = 1e-9
"""Added to the energy, relative: turning all of a closed surface's crosses costs nothing.

Chosen, above rounding and below what differs between integers.
"""

MOST_STEPS = 1000
"""Steps of one or two numbers after rounding at most. Chosen; each lowers the energy."""

PRICES = 4.0 ** np.arange(-2, 4)
"""Of a quad that is missing, one after the other, against the largest term of the energy. Chosen.
"""

FARTHEST = 1000
"""Largest number that is looked for, quarter turns. Chosen, above what any curve turns."""

NODES = 2000
"""Nodes of the search for whole numbers at most.

Chosen; differences of two numbers need one node, conditions a few.
"""


@dataclass(frozen=True, eq=False)
class Rows:
    """Bounds on whole numbers x: lower <= matrix x <= upper.

    Parameters
    ----------
    matrix : (r, p) sparse array
        Whole.
    lower, upper : (r,) float array
        Whole.
    """

    matrix: csr_array
    lower: FloatArray
    upper: FloatArray

    def __post_init__(self) -> None:
        freeze_arrays(self)

    def met(self, x: FloatArray) -> bool:
        """Whether x (p,) is within."""
        value = self.matrix @ x
        return bool((value > self.lower - 0.5).all() and (value < self.upper + 0.5).all())

    def some(self, which: IntArray) -> Rows:
        """Return some of the rows, for the numbers that they bound."""
        matrix = self.matrix[which]
        bound = np.unique(matrix.indices)
        return Rows(csr_array(matrix[:, bound]), self.lower[which], self.upper[which])


def sector_rows(quads: SectorQuads) -> tuple[IntArray, Rows]:
    """Return which sectors bound the numbers, and how: a quad each, and no corner of 180 degrees.

    Of sectors that no number changes only those without a quad.

    Parameters
    ----------
    quads : SectorQuads
        Of the features.
    """
    constant = quads.constant[quads.beside]
    chosen = (np.diff(quads.matrix.indptr)[quads.beside] > 0) | (constant < 1)
    of, constant = quads.beside[chosen], constant[chosen]
    least = 1.0 - constant
    most = np.maximum(2.0 * quads.sectors.corners[of] - 1 - constant, least)
    return of, Rows(csr_array(quads.matrix[of]), least, most)


def contradictions(rows: Rows) -> list[IntArray]:
    """Return sets of rows that no whole numbers meet together, though they do without any one row.

    Rows may give way, for a price; one set is sought among those that share numbers with a row that
    does, with others that do, and so on.

    Parameters
    ----------
    rows : Rows
        Any.

    Returns
    -------
    list of (k,) int array
        None if whole numbers meet all rows.
    """
    r = len(rows.lower)
    given = _given_way(rows, np.zeros(r, dtype=bool))
    if given is None or not given.any():
        return []
    shared = bmat([[None, rows.matrix], [rows.matrix.T, None]])
    label = connected_components(shared, directed=False)[1][:r]
    sets = [np.flatnonzero(label == each) for each in np.unique(label[given])]
    return [each[_irreducible(rows.some(each))] for each in sets]


def _irreducible(rows: Rows) -> IntArray:
    """Return rows that contradict each other, each needed for that, of some that do.

    Those that give way are made firm until they contradict; then those not needed are left out
    (Chinneck and Dravnieks 1991).
    """
    firm = np.zeros(len(rows.lower), dtype=bool)
    while (given := _given_way(rows, firm)) is not None:
        firm |= given
    kept = np.flatnonzero(firm)
    for each in kept.tolist():
        fewer = kept[kept != each]
        given = _given_way(rows.some(fewer), np.ones(len(fewer), dtype=bool))
        if given is None:
            kept = fewer
    return kept


def _given_way(rows: Rows, firm: BoolArray) -> BoolArray | None:
    """Return which rows give way if as little as can be does; None if the firm ones contradict."""
    r, p = rows.matrix.shape
    elastic = np.flatnonzero(~firm)
    give = csr_array(eye_array(r))[:, elastic]
    found = _solved(
        np.concatenate([np.zeros(p), np.ones(2 * len(elastic))]),
        Rows(csr_array(hstack([rows.matrix, give, -give])), rows.lower, rows.upper),
        np.concatenate([np.full(p, -FARTHEST), np.zeros(2 * len(elastic))]),
    )
    if found is None:
        return None
    given = np.zeros(r, dtype=bool)
    given[elastic] = found[p:].reshape(2, -1).any(axis=0)
    return given


def nearest_within(rows: Rows, x: FloatArray, weight: FloatArray) -> FloatArray | None:
    """Return the whole numbers within rows that are nearest to given ones, or None.

    Parameters
    ----------
    rows : Rows
        Bounds.
    x : (p,) float array
        Whole numbers.
    weight : (p,) float array
        Of the distance of each.
    """
    p = len(x)
    both = Rows(
        csr_array(hstack([rows.matrix, -rows.matrix])),
        rows.lower - rows.matrix @ x,
        rows.upper - rows.matrix @ x,
    )
    found = _solved(np.concatenate([weight, weight]), both, np.zeros(2 * p))
    return None if found is None else x + found[:p] - found[p:]


def _solved(cost: FloatArray, rows: Rows, least: FloatArray) -> FloatArray | None:
    """Return the whole numbers of least cost within rows and bounds; None if there are none."""
    if rows.matrix.shape[0] == 0:
        return np.maximum(least, 0.0)
    if not len(cost):
        return least if rows.met(least) else None
    found = milp(
        cost,
        integrality=np.ones(len(cost)),
        bounds=Bounds(least, np.full(len(cost), FARTHEST)),
        constraints=LinearConstraint(rows.matrix, rows.lower, rows.upper),
        options={"node_limit": NODES},
    )
    return None if found.x is None else np.asarray(np.rint(found.x))


def nearest_integers(
    matrix: FloatArray, linear: FloatArray, rows: Rows | None = None
) -> FloatArray:
    """Return whole numbers x within rows with a low x . matrix x + 2 linear . x.

    Parameters
    ----------
    matrix : (p, p) float array
        Symmetric, positive semi-definite.
    linear : (p,) float array
        The slope at 0.
    rows : Rows, optional
        Which some whole numbers meet; by default none.

    Returns
    -------
    (p,) float array
    """
    x = _rounded(matrix, linear)
    if rows is None:
        rows = Rows(csr_array((0, len(x))), np.zeros(0), np.zeros(0))
    largest = float(np.diag(matrix).max(initial=0.0))
    for price in largest * PRICES:
        if rows.met(x):
            break
        x = _descended(matrix, linear, rows, x, price)
    if not rows.met(x):
        within = nearest_within(rows, x, np.diag(matrix) + RIDGE * largest)
        x = x if within is None else within
    return _descended(matrix, linear, rows, x, largest / RIDGE) if largest > 0 else x


def _rounded(matrix: FloatArray, linear: FloatArray) -> FloatArray:
    """Round one number after the other, the largest of the terms first, the others solved anew."""
    p = len(linear)
    x = np.zeros(p)
    order = np.argsort(np.diag(matrix), kind="stable")
    ridge = RIDGE * np.diag(matrix).max(initial=0.0) * np.eye(p)
    try:
        upper = cholesky(matrix[np.ix_(order, order)] + ridge)
    except LinAlgError:  # there is nothing in it but rounding: all numbers are as good as 0
        return x
    best = -solve_triangular(upper, linear[order], trans="T")
    rounded = np.zeros(p)
    for i in range(p - 1, -1, -1):
        rounded[i] = np.rint((best[i] - upper[i, i + 1 :] @ rounded[i + 1 :]) / upper[i, i])
    x[order] = rounded
    return x


def _descended(
    matrix: FloatArray, linear: FloatArray, rows: Rows, x: FloatArray, price: float
) -> FloatArray:
    """Change one number, or two, by one as long as the energy and the price of what is off fall."""
    enough = -RIDGE * np.diag(matrix).max(initial=0.0)
    for _ in range(MOST_STEPS):
        slope = 2 * (matrix @ x + linear)
        alone = _gains(matrix, slope, rows, x, price)
        step, gain = _lowest(alone)
        if gain >= enough:
            step, gain = _pair(matrix, slope, rows, x, price, alone)
        if gain >= enough:
            break
        x = x + step
    return x


def _gains(
    matrix: FloatArray, slope: FloatArray, rows: Rows, x: FloatArray, price: float
) -> FloatArray:
    """Return what one more (2, p), and one less, of each number adds to energy and price."""
    row = np.repeat(np.arange(len(rows.lower)), np.diff(rows.matrix.indptr))
    value = (rows.matrix @ x)[row]
    lower, upper = rows.lower[row], rows.upper[row]

    def off(value: FloatArray) -> FloatArray:
        return np.maximum(lower - value, 0.0) + np.maximum(value - upper, 0.0)

    more, less = (
        np.bincount(rows.matrix.indices, off(value + way * rows.matrix.data) - off(value), len(x))
        for way in (1, -1)
    )
    diagonal = np.diag(matrix)
    return np.stack([diagonal + slope + price * more, diagonal - slope + price * less])


def _lowest(gains: FloatArray) -> tuple[FloatArray, float]:
    """Return the step of lowest gain, and the gain."""
    step = np.zeros(gains.shape[1])
    if not len(step):
        return step, 0.0
    way, i = np.unravel_index(np.argmin(gains), gains.shape)
    step[i] = 1 - 2 * way
    return step, float(gains[way, i])


def _pair(
    matrix: FloatArray,
    slope: FloatArray,
    rows: Rows,
    x: FloatArray,
    price: float,
    alone: FloatArray,
) -> tuple[FloatArray, float]:
    """Return the step of two numbers of lowest gain, and the gain."""
    best, lowest = np.zeros(len(x)), 0.0
    for way, i in np.ndindex(alone.shape):
        first = np.zeros(len(x))
        first[i] = 1 - 2 * way
        then = _gains(matrix, slope + 2 * first[i] * matrix[i], rows, x + first, price)
        second, gain = _lowest(then)
        if alone[way, i] + gain < lowest:
            best, lowest = first + second, float(alone[way, i] + gain)
    return best, lowest
