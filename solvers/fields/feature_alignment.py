"""The smallest turn that aligns a field with features and with every boundary.

Along each feature curve the field must be turned by known angles, up to whole quarter turns: one
integer for each curve. Each holonomy condition has one more (another layout). In between, the turn
spreads with the least int |grad|^2 (Crouzeix-Raviart). The integers are those of a low energy that
leave a quad in every sector between curves; where there are none, curves are released.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array

from solvers.algebra.factorization import factorized
from solvers.algebra.operators import corner_midpoint_offsets, crouzeix_raviart
from solvers.features.edges import Features
from solvers.fields.connection import Discretization
from solvers.fields.feature_integers import contradictions, nearest_integers, sector_rows
from solvers.fields.feature_values import curve_values, edge_values
from solvers.fields.holonomy import Holonomy
from solvers.fields.sector_quads import SectorQuads, sector_quads, turned_over_corners
from solvers.surface.triangulation import QUARTER, BoolArray, FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class FeatureTurn:
    """What aligns a field with features.

    Parameters
    ----------
    discretization : Discretization
        With the features that are kept.
    released : Features
        Those that were to be, and are not: no whole numbers leave a quad beside each of these and
        the kept ones.
    turns : (c,) int array
        Quarter turns to add over each holonomy condition's path.
    turning : (m, 3) float array
        By how much to turn the field, so aligned with the boundaries, at the midpoint of each
        halfedge; single-valued, 0 on the boundary; radians.
    """

    discretization: Discretization
    released: Features
    turns: IntArray
    turning: FloatArray


def align_with_features(
    holonomy: Holonomy,
    conjugate: FloatArray,
    defects: FloatArray,
    turns: Sequence[int] | None,
    without: IntArray,
) -> FeatureTurn:
    """Return the turn that aligns a field with the features of its discretisation.

    Parameters
    ----------
    holonomy : Holonomy
        On a discretisation with features.
    conjugate : (m, 3) float array
        Corner values of the function whose conjugate the isotropic field is.
    defects : (c,) float array
        The isotropic field's, radians.
    turns : sequence of int, or None
        Quarter turns over each condition; None: to be chosen.
    without : (k,) int array
        Edges of the surface that are not followed although they are features.

    Returns
    -------
    FeatureTurn
    """
    every = holonomy.discretization
    angles, corners = _turned(holonomy, conjugate, defects)
    if turns is not None:
        given = np.concatenate([[1.0], turns])[:, None]
        angles, corners = angles @ given, corners @ given
    edges = every.features.edges[every.feature_edge]
    asked = ~np.isin(edges, without)
    kept, quads = _kept(every, asked, angles, corners)
    d = every.with_features(kept)
    released = Features(every.surface, edges[asked & ~kept])
    if not kept.any():
        chosen = np.zeros(len(defects)) if turns is None else np.asarray(turns)
        still = np.zeros_like(conjugate)
        return FeatureTurn(d, released, chosen.astype(np.int64), still)
    filling = _Filling(d)
    wanted, changes = quads.turning[:, 0], quads.by_number
    energy = filling.energy(np.column_stack([wanted, changes]))
    if turns is None and len(defects):
        # The harmonic part of the field turns by quarters less the defects.
        harmonic = np.linalg.inv(holonomy.harmonic_energy)
        energy[-len(defects) :, -len(defects) :] += QUARTER**2 * harmonic
        energy[-len(defects) :, 0] -= QUARTER * harmonic @ defects
    integers = nearest_integers(energy[1:, 1:], energy[1:, 0], sector_rows(quads)[1])
    chosen = integers[quads.chains.count :] if turns is None else np.asarray(turns)
    turning = filling.everywhere(wanted + changes @ integers)
    return FeatureTurn(d, released, chosen.astype(np.int64), turning)


def _turned(
    holonomy: Holonomy, conjugate: FloatArray, defects: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return angles (k, 1 + c) and turns over corners (m, 3, 1 + c), as `sector_quads` takes them.

    Of the field that is aligned with boundaries, and how they grow with the conditions' turns.
    """
    d = holonomy.discretization
    t, h = d.triangulation, d.feature_halfedges
    offsets = corner_midpoint_offsets(
        t.cotangents, conjugate + holonomy.harmonic_correction(-defects)
    )
    angles = [d.feature_angles(d.walk(offsets), offsets)]
    corners = [t.angles - turned_over_corners(offsets)]
    still = d.walk(np.zeros_like(conjugate))
    for turn in QUARTER * np.eye(len(defects)):
        offsets = corner_midpoint_offsets(t.cotangents, holonomy.harmonic_correction(turn))
        angles.append((d.walk(offsets) - still)[h // 3] + offsets.reshape(-1)[h])
        corners.append(-turned_over_corners(offsets))
    return np.stack(angles, axis=1), np.stack(corners, axis=2)


def _kept(
    discretization: Discretization, kept: BoolArray, angles: FloatArray, corners: FloatArray
) -> tuple[BoolArray, SectorQuads]:
    """Return which features of some to keep so that every sector may have a quad, and their quads.

    Of the curves beside sectors that contradict each other the one of least worth goes.
    """
    t, h = discretization.triangulation, discretization.feature_halfedges
    worth = edge_values(discretization)
    kept = kept.copy()
    while True:
        among = np.flatnonzero(kept)
        quads = sector_quads(t, h[among], angles[among], corners)
        of, rows = sector_rows(quads)
        found = contradictions(rows)
        if not found:
            return kept, quads
        value, number = curve_values(quads.chains, quads.sectors, worth[among]), quads.chains.number
        for sectors in (of[each] for each in found):
            beside = np.concatenate([quads.sectors.start[sectors], quads.sectors.end[sectors]])
            concerned = np.unique(number[beside[beside >= 0]])
            kept[among[number == concerned[np.argmin(value[concerned])]]] = False


class _Filling:
    """The smoothest Crouzeix-Raviart functions with given values on features, 0 on boundaries."""

    def __init__(self, discretization: Discretization) -> None:
        t = discretization.triangulation
        self._edge = t.face_edges
        h = t.edge_halfedges
        stiffness = crouzeix_raviart(t, self._edge.reshape(-1), len(h))
        self._features = self._edge.reshape(-1)[discretization.feature_halfedges]
        free = t.twin[h] >= 0
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
