"""Where the indices of a cross-field go: spread where they are too many, cancelled where they may.

A cross-field that is as smooth as its singularities let it be has the energy

    E = 1/2 b . S^+ b + 1/2 r . P^-1 r,    b = K - (pi/2) (corners + k),

of its isotropic part and of the harmonic one that aligns it: k are the indices, r the holonomy
defects. With the Green's functions G = S^+ and H = S^+ b at the places of indices, taking the index
k_i to the place of k_j changes the first part by

    (pi/2) k_i (H_i - H_j) + (pi/2)^2 k_i^2 (G_ii + G_jj - 2 G_ij) / 2

and the second by what the holonomy potentials tell: a look-up a pair. A Dirac is as wide as a
triangle, so G_ii holds what the core of a singularity costs.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from solvers.algebra.operators import lumped_mass
from solvers.errors import SingularityError
from solvers.features.edges import Features
from solvers.fields.holonomy import Holonomy
from solvers.fields.isotropic import IsotropicSolver
from solvers.singularities.budget import Singularity
from solvers.surface.triangulation import QUARTER, BoolArray, FloatArray, IntArray, wrap
from solvers.surface.trisurface import TriSurface

RINGS = 2
"""Within how many rings of triangles two indices are near: there opposite ones may cancel, and
what is spread keeps out of it where there is room. Chosen.
"""

LEAST_VALENCE = 2
"""Of what is placed. From theory: quads close around two, not around one."""

MOST_VALENCE = 8
"""Of what is placed, if nothing else is said. Chosen: the most that the paper shows."""


def placed_singularities(
    surface: TriSurface,
    index: IntArray,
    features: Features,
    lacking: IntArray,
    *,
    most_valence: int = MOST_VALENCE,
    fewest: bool = False,
) -> tuple[Singularity, ...]:
    """Return singularities for indices as they were found, their sum kept.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    index : (n + m,) int array
        Of the vertices, less that of the default corners, and of the triangles.
    features : Features
        Of the surface; no index is placed on them, and none taken across.
    lacking : (n,) int array
        How many more quads each vertex needs for its sectors between features.
    most_valence : int, optional
        Of a singularity.
    fewest : bool, optional
        Whether indices of opposite signs are to cancel wherever they are, those first whose
        cancelling lets the energy rise least; else only near ones that let it fall, and none where
        there are features, which hold what this energy does not know of.

    Returns
    -------
    tuple of Singularity
        At inner vertices and in the middle of triangles, valences from `LEAST_VALENCE` to
        `most_valence`.

    Raises
    ------
    SingularityError
        If there are too few places for them.
    """
    placement = _Placement(surface, index, features)
    placement.spread(4 - most_valence, lacking)
    if fewest or not len(features):
        placement.cancel(anywhere=fewest)
    return placement.singularities


class _Placement:
    """Indices at sites, the vertices and then the triangles of a surface, and their energy."""

    def __init__(self, surface: TriSurface, index: IntArray, features: Features) -> None:
        self._surface = surface
        self._index = index.copy()
        n, m = surface.n_vertices, surface.n_faces
        # How a unit at each site loads the vertices.
        corners = np.concatenate([np.arange(n), surface.faces.reshape(-1)])
        sites = np.concatenate([np.arange(n), n + np.repeat(np.arange(m), 3)])
        weights = np.concatenate([np.ones(n), np.full(3 * m, 1 / 3)])
        self._loads = csr_array((weights, (sites, corners)), shape=(n + m, n))
        self._barred = surface.boundary_vertices.copy()
        self._barred[surface.edges[features.edges]] = True
        uncrossed = surface.edge_faces[:, 1] >= 0
        uncrossed[features.edges] = False
        one, other = surface.edge_faces[uncrossed].T
        joins = coo_array((np.ones(len(one)), (one, other)), shape=(m, m))
        region = connected_components(joins, directed=False)[1]
        at_vertices = np.empty(n, dtype=region.dtype)
        at_vertices[surface.faces] = region[:, None]
        self._region = np.concatenate([at_vertices, region])

    @property
    def singularities(self) -> tuple[Singularity, ...]:
        """The indices as singularities."""
        surface, n = self._surface, self._surface.n_vertices
        return tuple(
            Singularity(
                surface.point_at_vertex(site) if site < n else surface.point(site - n, [1 / 3] * 3),
                4 - int(self._index[site]),
            )
            for site in np.flatnonzero(self._index).tolist()
        )

    def spread(self, least_index: int, lacking: IntArray) -> None:
        """Take what a site cannot carry off it, unit by unit to where the energy falls most."""
        n = self._surface.n_vertices
        carried = self._index.copy()
        carried[:n] -= lacking
        carried = np.clip(carried, least_index, 4 - LEAST_VALENCE)
        carried[:n][self._surface.boundary_vertices] = 0
        excess = self._index - carried
        for site in np.flatnonzero(excess).tolist():
            sign = int(np.sign(excess[site]))
            for _ in range(abs(excess[site])):
                self._index[site] -= sign
                self._index[self._best(sign, least_index)] += sign

    def cancel(self, *, anywhere: bool) -> None:
        """Let indices of opposite signs cancel: near ones if the energy falls, or all there are.

        None of those on features, and none across them.
        """
        sites = np.flatnonzero(self._index)
        n = self._surface.n_vertices
        sites = sites[(sites >= n) | ~self._barred[np.minimum(sites, n - 1)]]
        k = self._index[sites].astype(np.float64)
        may = self._region[sites][:, None] == self._region[sites]
        if not anywhere:
            near = self._rings(sites, RINGS) @ self._loads[sites].T
            may &= np.asarray(near.todense()) > 0
        if not (may & (np.multiply.outer(k, k) < 0)).any():
            return
        pairs = _Pairs(self, sites, self._index)
        while True:
            opposite = np.multiply.outer(pairs.k, pairs.k) < 0
            i, j = np.nonzero(may & opposite & (np.abs(pairs.k)[:, None] <= np.abs(pairs.k)))
            if not len(i):
                break
            rise = pairs.rise(i, j)
            best = int(np.argmin(rise))
            if not anywhere and rise[best] >= 0:
                break
            pairs.take(int(i[best]), int(j[best]))
        self._index[sites] = np.rint(pairs.k).astype(np.int64)

    def solve(self, right: FloatArray) -> FloatArray:
        """Return S^+ of loads (n,) or (n, k), what is missing in their sums spread evenly.

        The solver's triangulation may have further vertices, without loads.
        """
        spread = self._mass / self._mass.sum()
        balanced = -np.multiply.outer(spread, right.sum(axis=0))
        balanced[: len(right)] += right
        h = np.zeros_like(balanced)
        h[1:] = self._solver.factorization.solve(balanced[1:])
        return np.asarray((h - spread @ h)[: len(right)])

    def field(self) -> FloatArray:
        """Return H (n,) of the indices as they are."""
        return self.solve(self._curvature - QUARTER * (self._loads.T @ self._index))

    def loads(self, sites: IntArray) -> csr_array:
        """Return how a unit at each of some sites loads the vertices, (k, n)."""
        return self._loads[sites]

    def potentials(self) -> FloatArray:
        """Return the holonomy potentials at all sites, (c, n + m), up to whole numbers."""
        values = self.holonomy.surface_values
        at_vertices = np.empty((len(values), self._surface.n_vertices))
        at_vertices[:, self._surface.faces] = values
        return np.concatenate([at_vertices, values.mean(axis=2)], axis=1)

    def defects(self, potentials: FloatArray) -> FloatArray:
        """Return the holonomy defects of the indices as they are, radians."""
        return wrap(self.holonomy.defects([]) + QUARTER * potentials @ self._index, QUARTER)

    @property
    def holonomy(self) -> Holonomy:
        """Of the surface."""
        return self._solver.holonomy

    @cached_property
    def _solver(self) -> IsotropicSolver:
        return IsotropicSolver(self._surface)

    @cached_property
    def _mass(self) -> FloatArray:
        return lumped_mass(self._solver.discretization.triangulation)

    @cached_property
    def _curvature(self) -> FloatArray:
        curvature = self._surface.angle_defects.copy()
        for vertex, turning in self._solver.corners.items():
            curvature[vertex] -= QUARTER * turning
        return curvature

    def _best(self, sign: int, least_index: int) -> int:
        """Return the free site where one more unit lets the energy fall most.

        Near a boundary it costs what its mirror image does, 1/8 log of the distance in H (the
        Green's function of the half plane, Neumann).
        """
        h = self._loads @ self.field()
        if self._surface.boundary_loops:
            rim = self._surface.vertices[self._surface.boundary_vertices]
            away = cKDTree(rim).query(self._positions)[0]
            h += sign * np.log(np.maximum(away, 1e-300)) / 8
        free = self._free(sign, least_index)
        return int(np.argmax(np.where(free, sign * h, -np.inf)))

    def _free(self, sign: int, least_index: int) -> BoolArray:
        """Return which sites one more unit may go to: as far from the others as there is room."""
        n = self._surface.n_vertices
        open_ = np.ones(len(self._index), dtype=bool)
        open_[:n] = ~self._barred
        taken = np.flatnonzero(self._index)
        for rings in range(RINGS, -1, -1):
            near = self._near(taken, rings)
            if rings:
                near |= self._near(np.flatnonzero(self._barred), rings - 1)
            free = open_ & ~near
            if free[:n].any():
                free[n:] = False  # at vertices no triangle has to be split
            if free.any():
                return free
        free = open_ & (self._index == 0)
        if not free.any():
            after = self._index + sign
            free = open_ & (least_index <= after) & (after <= 4 - LEAST_VALENCE)
        if not free.any():
            raise SingularityError(
                "there is no room for the singularities that the surface needs",
                f"{self._surface.n_faces} triangles",
                "give a finer one",
            )
        return free

    def _near(self, sites: IntArray, rings: int) -> BoolArray:
        """Return which sites have a corner within some rings of triangles around some."""
        return np.asarray(self._loads @ (self._rings(sites, rings).sum(axis=0)) > 0)

    def _rings(self, sites: IntArray, rings: int) -> csr_array:
        """Return where (k, n) vertices are within some rings of triangles around each of sites."""
        seen = self._loads[sites]
        triangles = self._loads[self._surface.n_vertices :]
        for _ in range(rings):
            seen = csr_array((seen @ triangles.T) @ triangles)
        return seen

    @cached_property
    def _positions(self) -> FloatArray:
        return np.concatenate([self._surface.vertices, self._surface.barycentres])


class _Pairs:
    """The Gram matrices of the potentials at some sites, and what a move of an index changes."""

    def __init__(self, placement: _Placement, sites: IntArray, index: IntArray) -> None:
        loads = placement.loads(sites)
        self.k = index[sites].astype(np.float64)
        self._green = np.asarray(loads @ placement.solve(loads.todense().T))
        self._h = loads @ placement.field()
        potentials = placement.potentials()
        self._defects = placement.defects(potentials)
        self._potentials = potentials[:, sites]
        self._harmonic = np.linalg.inv(placement.holonomy.harmonic_energy)

    def rise(self, i: IntArray, j: IntArray) -> FloatArray:
        """Return by how much the energy rises if each index i (p,) goes to the place of j (p,)."""
        k, green = self.k[i], self._green
        gap = green[i, i] + green[j, j] - 2 * green[i, j]
        isotropic = QUARTER * k * (self._h[i] - self._h[j]) + 0.5 * QUARTER**2 * k**2 * gap
        before, after = self._defects, self._defects_after(i, j)
        energies = np.einsum("cp,cd,dp->p", after, self._harmonic, after)
        return np.asarray(isotropic + 0.5 * (energies - before @ self._harmonic @ before))

    def take(self, i: int, j: int) -> None:
        """Take one index to the place of another."""
        self._defects = self._defects_after(np.array([i]), np.array([j]))[:, 0]
        self._h += QUARTER * self.k[i] * (self._green[:, i] - self._green[:, j])
        self.k[j] += self.k[i]
        self.k[i] = 0.0

    def _defects_after(self, i: IntArray, j: IntArray) -> FloatArray:
        turned = QUARTER * self.k[i] * (self._potentials[:, j] - self._potentials[:, i])
        return wrap(self._defects[:, None] + turned, QUARTER)
