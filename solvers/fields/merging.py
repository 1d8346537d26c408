"""Singularities taken together, those first whose merging costs the field the least energy.

A cross-field that is as smooth as its singularities let it be has the energy

    E = 1/2 b . S^+ b + 1/2 r . P^-1 r,    b = K - (pi/2) (corners + k),

of its isotropic part and of the harmonic one that aligns it: k are the indices, r the holonomy
defects. With the Green's functions G = S^+ and H = S^+ b at the singularities, taking the index k_i
to the place of k_j changes the first part by

    (pi/2) k_i (H_i - H_j) + (pi/2)^2 k_i^2 (G_ii + G_jj - 2 G_ij) / 2

and the second by what the holonomy potentials tell: a look-up a pair. A Dirac is as wide as a
triangle, so G_ii holds what the core of a singularity costs.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.sparse import csr_array

from solvers.errors import SingularityError
from solvers.fields.isotropic import IsotropicSolver
from solvers.singularities.budget import Singularity
from solvers.surface.triangulation import QUARTER, BoolArray, FloatArray, IntArray, wrap

LEAST_VALENCE = 2
"""Of what is placed. From theory: quads close around two, not around one."""

LEAST_MERGED = 3
"""Valence of two singularities of equal signs merged, at the least. Chosen: a valence 2,
whose quads have angles of 180 degrees, is worse than two 3.
"""


class Merging:
    """Singularities of one surface whose indices may be taken to each other's places.

    Parameters
    ----------
    solver : IsotropicSolver
        On the surface.
    singularities : sequence of Singularity
        Anywhere on it.
    curvature : (n,) float array, optional
        Of the surface's vertices; by default its own.

    Attributes
    ----------
    index : (k,) float array
        Their indices as they are after what was merged; 0 for what is gone.
    """

    def __init__(
        self,
        solver: IsotropicSolver,
        singularities: Sequence[Singularity],
        curvature: FloatArray | None = None,
    ) -> None:
        d = solver.discretization
        faces, weights = d.place([s.point for s in singularities])
        count, corners = len(singularities), d.triangulation.faces[faces]
        owner = np.repeat(np.arange(count), 3)
        loads = csr_array(
            (weights.reshape(-1), (owner, corners.reshape(-1))),
            shape=(count, d.triangulation.n_vertices),
        )
        self.index = np.array([s.index for s in singularities], dtype=np.float64)
        self._green = np.asarray(loads @ potential(solver, loads.toarray().T))
        right = curvature_to_carry(solver, curvature)
        self._h = loads @ potential(solver, right - QUARTER * (loads.T @ self.index))
        holonomy = solver.holonomy
        self._potentials = np.einsum("ckj,kj->ck", holonomy.corner_values(faces), weights)
        self._defects = holonomy.defects(singularities)
        self._harmonic = np.linalg.inv(holonomy.harmonic_energy)

    def __len__(self) -> int:
        """Return how many are left."""
        return int(np.count_nonzero(self.index))

    def cancel(self, may: BoolArray, *, only_falling: bool = False) -> None:
        """Let opposite indices cancel until there are none.

        Parameters
        ----------
        may : (k, k) bool array
            Which pairs.
        only_falling : bool, optional
            Whether to stop where the energy would rise.
        """
        while True:
            i, j = np.nonzero(may & self._opposite())
            rise = self._rise(i, j)
            if not len(i) or (only_falling and rise.min() >= 0):
                return
            self._take(i, j, rise)

    def reduce(self, may: BoolArray, most: int, most_valence: int) -> bool:
        """Merge opposite and equal ones until no more than some are left.

        Parameters
        ----------
        may : (k, k) bool array
            Which pairs.
        most : int
            How many may be left.
        most_valence : int
            Of what is merged.

        Returns
        -------
        bool
            Whether that few are left; not if no pair can be merged any more.
        """
        while len(self) > most:
            total = self.index[:, None] + self.index
            alike = np.multiply.outer(self.index, self.index) > 0
            np.fill_diagonal(alike, False)
            alike &= (4 - most_valence <= total) & (total <= 4 - LEAST_MERGED)
            i, j = np.nonzero(may & (self._opposite() | alike))
            if not len(i):
                return False
            self._take(i, j, self._rise(i, j))
        return True

    def _opposite(self) -> BoolArray:
        """Return which indices would be taken to larger ones of the other sign."""
        size = np.abs(self.index)
        opposite = np.multiply.outer(self.index, self.index) < 0
        return np.asarray(opposite & (size[:, None] <= size))

    def _rise(self, i: IntArray, j: IntArray) -> FloatArray:
        """Return by how much the energy rises if each index i (p,) goes to the place of j (p,)."""
        k, green = self.index[i], self._green
        gap = green[i, i] + green[j, j] - 2 * green[i, j]
        isotropic = QUARTER * k * (self._h[i] - self._h[j]) + 0.5 * QUARTER**2 * k**2 * gap
        before, after = self._defects, self._defects_after(i, j)
        energies = ((self._harmonic @ after) * after).sum(axis=0)
        return np.asarray(isotropic + 0.5 * (energies - before @ self._harmonic @ before))

    def _take(self, i: IntArray, j: IntArray, rise: FloatArray) -> None:
        """Take one index to the place of another, where the energy rises least."""
        best = int(np.argmin(rise))
        one, other = int(i[best]), int(j[best])
        self._defects = self._defects_after(i[[best]], j[[best]])[:, 0]
        self._h += QUARTER * self.index[one] * (self._green[:, one] - self._green[:, other])
        self.index[other] += self.index[one]
        self.index[one] = 0.0

    def _defects_after(self, i: IntArray, j: IntArray) -> FloatArray:
        turned = QUARTER * self.index[i] * (self._potentials[:, j] - self._potentials[:, i])
        return wrap(self._defects[:, None] + turned, QUARTER)


def potential(solver: IsotropicSolver, loads: FloatArray) -> FloatArray:
    """Return S^+ of loads (n,) or (n, k), what is missing in their sums spread evenly."""
    spread = solver.mass / solver.mass.sum()
    balanced = loads - np.multiply.outer(spread, loads.sum(axis=0))
    h = np.zeros_like(balanced)
    h[1:] = solver.factorization.solve(balanced[1:])
    return np.asarray(h - spread @ h)


def curvature_to_carry(solver: IsotropicSolver, curvature: FloatArray | None) -> FloatArray:
    """Return the curvature of the working triangulation's vertices less that of the corners.

    Parameters
    ----------
    solver : IsotropicSolver
        On a surface of n vertices; further ones of its triangulation are flat.
    curvature : (n,) float array, optional
        Instead of the surface's own.
    """
    own = solver.surface.angle_defects if curvature is None else curvature
    right = np.zeros(solver.discretization.triangulation.n_vertices)
    right[: len(own)] = own
    for vertex, turning in solver.corners.items():
        right[vertex] -= QUARTER * turning
    return right


def fewer_refused(left: int, most: int, most_valence: int) -> SingularityError:
    """Return the refusal of a number of singularities that merging does not come down to."""
    return SingularityError(
        f"no fewer than {left} singularities can be left, {most} are asked for",
        f"merging keeps their indices' sum within each region between features, those locked, and "
        f"valences of equal signs from {LEAST_MERGED} to {most_valence}",
        f"ask for {left}",
    )
