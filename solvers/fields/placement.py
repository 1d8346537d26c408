"""Where the indices of a cross-field go: spread where they are too many, merged where they may.

By the energy of the field that has them, as in `solvers.fields.merging`.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_array
from scipy.spatial import cKDTree

from solvers.errors import SingularityError
from solvers.features.edges import Features
from solvers.features.regions import face_regions, in_one_region
from solvers.fields.isotropic import IsotropicSolver
from solvers.fields.merging import (
    LEAST_VALENCE,
    Merging,
    curvature_to_carry,
    fewer_refused,
    potential,
)
from solvers.singularities.budget import Singularity
from solvers.surface.triangulation import QUARTER, BoolArray, FloatArray, IntArray
from solvers.surface.trisurface import TriSurface

RINGS = 2
"""Within how many rings of triangles two indices are near: there opposite ones may cancel, and
what is spread keeps out of it where there is room. Chosen.
"""

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
    most: int | None = None,
    curvature: FloatArray | None = None,
) -> tuple[Singularity, ...]:
    """Return singularities for indices as they were found, their sum kept.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    index : (n + m,) int array
        Of the vertices, less that of the default corners, and of the triangles.
    features : Features
        Of the surface; no index is placed on them, and none taken across: by Gauss and Bonnet each
        region between them needs its own.
    lacking : (k, 2) int array
        The vertex and the region, as of `face_regions`, of each quad that is missing in a sector
        between features.
    most_valence : int, optional
        Of a singularity.
    fewest : bool, optional
        Whether indices of opposite signs are to cancel wherever they are, those first whose
        cancelling lets the energy rise least; else only near ones that let it fall, and none where
        there are features, which hold what this energy does not know of.
    most : int, optional
        How many singularities at most; opposite ones cancel wherever they are, and equal ones of
        valence 5 and more are merged, until no more are left.
    curvature : (n,) float array, optional
        Of the vertices, for the energy; by default the surface's own.

    Returns
    -------
    tuple of Singularity
        At inner vertices and in the middle of triangles, valences from `LEAST_VALENCE` to
        `most_valence`.

    Raises
    ------
    SingularityError
        If there are too few places for them, or more are left than may be.
    """
    placement = _Placement(surface, index, features, curvature)
    placement.spread(4 - most_valence, lacking)
    if most is not None:
        placement.reduce(most, most_valence)
    if fewest or not len(features):
        placement.cancel(anywhere=fewest)
    return placement.singularities


class _Placement:
    """Indices at sites, the vertices and then the triangles of a surface, and their energy."""

    def __init__(
        self,
        surface: TriSurface,
        index: IntArray,
        features: Features,
        curvature: FloatArray | None,
    ) -> None:
        self._surface, self._features, self._curvature = surface, features, curvature
        self._index = index.copy()
        n, m = surface.n_vertices, surface.n_faces
        # How a unit at each site loads the vertices.
        corners = np.concatenate([np.arange(n), surface.faces.reshape(-1)])
        sites = np.concatenate([np.arange(n), n + np.repeat(np.arange(m), 3)])
        weights = np.concatenate([np.ones(n), np.full(3 * m, 1 / 3)])
        self._loads = csr_array((weights, (sites, corners)), shape=(n + m, n))
        self._barred = surface.boundary_vertices.copy()
        self._barred[surface.edges[features.edges]] = True
        # Which regions each site lies in or beside.
        region = face_regions(features)
        beside = np.concatenate([surface.faces.reshape(-1), n + np.arange(m)])
        near = (beside, np.concatenate([np.repeat(region, 3), region]))
        self._regions = csr_array((np.ones(4 * m), near), shape=(n + m, int(region.max()) + 1))

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
        for vertex, region in lacking.tolist():
            self._move(vertex, 1, self._within([region]), least_index)
        carried = np.clip(self._index, least_index, 4 - LEAST_VALENCE)
        carried[: self._surface.n_vertices][self._surface.boundary_vertices] = 0
        excess = self._index - carried
        for site in np.flatnonzero(excess).tolist():
            beside = self._within(self._regions[[site]].indices)
            for _ in range(abs(excess[site])):
                self._move(site, int(np.sign(excess[site])), beside, least_index)

    def _within(self, regions: npt.ArrayLike) -> BoolArray:
        """Return which sites are in or beside some regions."""
        return np.asarray(self._regions[:, np.asarray(regions)].sum(axis=1) > 0)

    def _move(self, site: int, sign: int, within: BoolArray, least_index: int) -> None:
        """Move a unit from a site to the best of some, or of all if there is no room there."""
        self._index[site] -= sign
        free = self._free(within, sign, least_index)
        if not free.any():
            free = self._free(np.ones_like(within), sign, least_index)
        if not free.any():
            raise SingularityError(
                "there is no room for the singularities that the surface needs",
                f"{self._surface.n_faces} triangles",
                "give a finer one",
            )
        self._index[self._best(free, sign)] += sign

    def cancel(self, *, anywhere: bool) -> None:
        """Let indices of opposite signs cancel: near ones if the energy falls, or all there are.

        None of those on features, and none across them.
        """
        may = self._within_regions()
        if not anywhere:
            sites = np.flatnonzero(self._index)
            near = self._rings(sites, RINGS) @ self._loads[sites].T
            may &= np.asarray(near.todense()) > 0
        k = self._index[self._index != 0]
        if (may & (np.multiply.outer(k, k) < 0)).any():
            merging = self._merging()
            merging.cancel(may, only_falling=not anywhere)
            self._keep(merging)

    def reduce(self, most: int, most_valence: int) -> None:
        """Merge indices until no more than some are left, or refuse.

        None of those on features, and none across them.
        """
        if np.count_nonzero(self._index) <= most:
            return
        merging = self._merging()
        if not merging.reduce(self._within_regions(), most, most_valence):
            raise fewer_refused(len(merging), most, most_valence)
        self._keep(merging)

    def _within_regions(self) -> BoolArray:
        return in_one_region(self._features, [s.point for s in self.singularities])

    def _merging(self) -> Merging:
        return Merging(self._solver, self.singularities, self._curvature)

    def _keep(self, merging: Merging) -> None:
        self._index[self._index != 0] = np.rint(merging.index).astype(np.int64)

    @cached_property
    def _solver(self) -> IsotropicSolver:
        return IsotropicSolver(self._surface)

    def _field(self) -> FloatArray:
        """Return H (n,) of the indices as they are."""
        n = self._surface.n_vertices
        right = curvature_to_carry(self._solver, self._curvature)
        right[:n] -= QUARTER * (self._loads.T @ self._index)
        return potential(self._solver, right)[:n]

    def _best(self, free: BoolArray, sign: int) -> int:
        """Return the site of some where one more unit lets the energy fall most.

        Near a boundary it costs what its mirror image does, 1/8 log of the distance in H (the
        Green's function of the half plane, Neumann).
        """
        h = self._loads @ self._field()
        if self._surface.boundary_loops:
            rim = self._surface.vertices[self._surface.boundary_vertices]
            away = cKDTree(rim).query(self._positions)[0]
            h += sign * np.log(np.maximum(away, 1e-300)) / 8
        return int(np.argmax(np.where(free, sign * h, -np.inf)))

    def _free(self, within: BoolArray, sign: int, least_index: int) -> BoolArray:
        """Return which sites of some one more unit may go to: where there is most room."""
        n = self._surface.n_vertices
        open_ = within.copy()
        open_[:n] &= ~self._barred
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
