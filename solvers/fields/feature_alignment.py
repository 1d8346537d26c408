"""The smallest turn that aligns a field with features and with every boundary.

Along each feature curve the field must be turned by known angles, up to whole quarter turns: one
integer for each curve. Each holonomy condition has one more (another layout). In between, the turn
spreads with the least int |grad|^2 (Crouzeix-Raviart). That energy is a quadratic form of the
integers, whose minimum is sought by rounding one after the other (Babai 1986) and single steps.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import cholesky, solve_triangular
from scipy.sparse import csc_array

from solvers.algebra.factorization import factorized
from solvers.algebra.operators import corner_midpoint_offsets, crouzeix_raviart
from solvers.fields.connection import Discretization
from solvers.fields.holonomy import Holonomy
from solvers.surface.triangulation import QUARTER, FloatArray, IntArray, wrap

RIDGE = 1e-9
"""Added to the energy, relative: turning all of a closed surface's crosses costs nothing.

Chosen, above rounding and below what differs between integers.
"""

MOST_STEPS = 1000
"""Single steps of the integers after rounding at most. Chosen; each lowers the energy."""


@dataclass(frozen=True, eq=False)
class FeatureTurn:
    """What aligns a field with features.

    Parameters
    ----------
    turns : (c,) int array
        Quarter turns to add over each holonomy condition's path.
    turning : (m, 3) float array
        By how much to turn the field, so aligned with the boundaries, at the midpoint of each
        halfedge; single-valued, 0 on the boundary; radians.
    """

    turns: IntArray
    turning: FloatArray


def align_with_features(
    holonomy: Holonomy,
    conjugate: FloatArray,
    defects: FloatArray,
    turns: Sequence[int] | None = None,
) -> FeatureTurn:
    """Return the turn that aligns a field with the features of its discretisation.

    Parameters
    ----------
    holonomy : Holonomy
        On a discretisation of the surface's own triangles, with features.
    conjugate : (m, 3) float array
        Corner values of the function whose conjugate the isotropic field is.
    defects : (c,) float array
        The isotropic field's, radians.
    turns : sequence of int, optional
        Quarter turns over each condition, where they are not to be chosen.

    Returns
    -------
    FeatureTurn
    """
    d = holonomy.discretization
    filling = _Filling(d)
    wanted, by_turn = _wanted(holonomy, conjugate, defects)
    by_curve = QUARTER * np.eye(len(d.features.curves))[d.features.curve_of]
    given = np.zeros(len(defects)) if turns is None else np.asarray(turns, dtype=np.float64)
    wanted = wanted + by_turn @ given
    changes = by_curve if turns is not None else np.column_stack([by_curve, by_turn])
    energy = filling.energy(np.column_stack([wanted, changes]))
    if turns is None and len(defects):
        # The harmonic part of the field turns by quarters less the defects.
        harmonic = np.linalg.inv(holonomy.harmonic_energy)
        energy[-len(defects) :, -len(defects) :] += QUARTER**2 * harmonic
        energy[-len(defects) :, 0] -= QUARTER * harmonic @ defects
    integers = nearest_integers(energy[1:, 1:], energy[1:, 0])
    chosen = given if turns is not None else integers[by_curve.shape[1] :]
    turning = filling.everywhere(wanted + changes @ integers)
    return FeatureTurn(chosen.astype(np.int64), turning)


def nearest_integers(matrix: FloatArray, linear: FloatArray) -> FloatArray:
    """Return whole numbers x with a low x . matrix x + 2 linear . x.

    The largest of the terms is rounded first, the others are solved for anew; then single numbers
    are changed by one as long as that helps.

    Parameters
    ----------
    matrix : (p, p) float array
        Symmetric, positive semi-definite.
    linear : (p,) float array

    Returns
    -------
    (p,) float array
    """
    p = len(linear)
    if p == 0:
        return np.zeros(0)
    order = np.argsort(np.diag(matrix), kind="stable")
    ridged = matrix[np.ix_(order, order)] + RIDGE * np.diag(matrix).max() * np.eye(p)
    upper = cholesky(ridged)
    best = -solve_triangular(upper, linear[order], trans="T")
    rounded = np.zeros(p)
    for i in range(p - 1, -1, -1):
        rounded[i] = np.rint((best[i] - upper[i, i + 1 :] @ rounded[i + 1 :]) / upper[i, i])
    x = np.empty(p)
    x[order] = rounded
    for _ in range(MOST_STEPS):
        slope = 2 * (matrix @ x + linear)
        gain = np.diag(matrix) - np.abs(slope)
        j = int(np.argmin(gain))
        if gain[j] >= -RIDGE * np.diag(matrix).max():
            break
        x[j] -= np.sign(slope[j])
    return x


def _wanted(
    holonomy: Holonomy, conjugate: FloatArray, defects: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return what to turn the field by on features, and that for a quarter turn of each condition.

    (k,) and (k, c), radians, without jumps along each curve.
    """
    d = holonomy.discretization
    cotangents = d.triangulation.cotangents
    offsets = corner_midpoint_offsets(
        cotangents, conjugate + holonomy.harmonic_correction(-defects)
    )
    columns = [d.feature_angles(d.walk(offsets), offsets)]
    h = d.feature_halfedges
    still = d.walk(np.zeros_like(conjugate))
    for turn in QUARTER * np.eye(len(defects)):
        offsets = corner_midpoint_offsets(cotangents, holonomy.harmonic_correction(turn))
        columns.append((d.walk(offsets) - still)[h // 3] + offsets.reshape(-1)[h])
    along = [_without_jumps(-column, d) for column in columns]
    return along[0], np.array(along[1:]).reshape(len(defects), len(h)).T


def _without_jumps(angle: FloatArray, discretization: Discretization) -> FloatArray:
    """Return angles of feature edges, changed by quarter turns so that none jumps on its curve."""
    curves = discretization.features.curves
    order = np.concatenate([curve.members for curve in curves])
    sizes = np.array([len(curve.members) for curve in curves])
    first = np.cumsum(sizes) - sizes
    along = angle[order]
    steps = wrap(np.diff(along, prepend=0.0), QUARTER)
    steps[first] = 0.0
    steps = np.cumsum(steps)
    smooth = np.empty_like(along)
    smooth[order] = steps + np.repeat(along[first] - steps[first], sizes)
    return np.asarray(smooth)


class _Filling:
    """The smoothest Crouzeix-Raviart functions with given values on features, 0 on boundaries."""

    def __init__(self, discretization: Discretization) -> None:
        surface = discretization.surface
        self._edge = surface.face_edges
        stiffness = crouzeix_raviart(
            discretization.triangulation, self._edge.reshape(-1), len(surface.edges)
        )
        self._features = discretization.features.edges
        free = surface.edge_faces[:, 1] >= 0
        free[self._features] = False
        self._free = np.flatnonzero(free)
        self._own = csc_array(stiffness[self._features][:, self._features])
        self._coupling = csc_array(stiffness[self._free][:, self._features])
        self._factor = factorized(stiffness[self._free][:, self._free])

    def energy(self, columns: FloatArray) -> FloatArray:
        """Return the (p, p) products of the gradients of the functions with values (k, p)."""
        filled = self._factor.solve(self._coupling @ columns)
        return np.asarray(columns.T @ (self._own @ columns - self._coupling.T @ filled))

    def everywhere(self, values: FloatArray) -> FloatArray:
        """Return the function with values (k,) on features at all halfedges' midpoints (m, 3)."""
        function = np.zeros(int(self._edge.max()) + 1)
        function[self._features] = values
        function[self._free] = -self._factor.solve(self._coupling @ values)
        return np.asarray(function[self._edge])
