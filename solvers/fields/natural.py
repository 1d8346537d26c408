"""Singularities that appear by themselves: where a smooth cross-field must give way.

The cross is one complex number at each edge midpoint (Crouzeix-Raviart, as in Jezdimirovic et al.
2019): the fourth power of its direction against the edge. It is smoothed by

- MBO (Viertel and Osting 2019): diffuse for a short time, renormalise, until nothing changes;
- Ginzburg-Landau (Jezdimirovic et al. 2019): descend int |grad z|^2 + (|z|^2 - 1)^2 / (2 eps^2);
- globally optimal (Knoeppel et al. 2013): the smoothest field of unit norm, one eigenvector; with a
  boundary the harmonic field.

On the boundary and on features the cross is aligned. It may also be drawn towards the directions of
principal curvature (the alignment term of Knoeppel et al. 2013), the more where they differ more.
Singularities are vertices and triangles the cross turns around. Where the mesh is symmetric, the
crosses are smoothed once more among the symmetric ones, which are taken unless they cost more.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from copy import copy
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_array, csc_array, diags_array

from solvers.algebra.factorization import factorized
from solvers.algebra.lanczos import ritz_vectors
from solvers.algebra.mixing import AndersonMixing
from solvers.errors import CrossviewError
from solvers.features.edges import Features, no_features
from solvers.features.regions import face_regions
from solvers.fields.crossfield import Convergence, CrossField
from solvers.fields.details import angles_without_details, curvatures_of, settled
from solvers.fields.placement import MOST_VALENCE, placed_singularities
from solvers.fields.principal import principal_crosses
from solvers.number_checks import real_number, whole_number
from solvers.progress import Progress
from solvers.singularities.budget import Singularity, default_corners
from solvers.surface.sectors import corner_sectors
from solvers.surface.symmetries import Isometry, isometries
from solvers.surface.triangulation import QUARTER, FloatArray, IntArray, next_halfedge, wrap
from solvers.surface.trisurface import TriSurface

ComplexArray = npt.NDArray[np.complex128]

NATURAL_METHODS = ("mbo", "ginzburg-landau", "globally-optimal")
"""Names of the ways to smooth a cross-field."""

NATURAL_ALIGNMENTS = ("smoothness", "curvature")
"""Names of what the crosses are drawn towards."""

CURVATURE_WEIGHT = 200.0
"""Of the pull towards principal directions against the smoothness, in parts of the area.

Chosen: where they are as clear as on average, the crosses follow them over the fourteenth part of
the surface's size, the square root of its area over that of this weight.
"""

DETAIL = 0.03
"""Scale of details by default, in square roots of the area.

Chosen: two edges of 5 000 squares on it. Wrinkles of scans are smaller, fingers and horns are not.
"""

ITERATIONS = 400
"""Steps of a method at most. Chosen."""

MOMENTUM = 0.9
"""Share of the last change that is added before the next step (Polyak's heavy ball). Chosen."""

COMPARED = 0.01
"""For how long crosses diffuse to be compared, in parts of the area. Chosen, the middle one of the
times of MBO.
"""

WORTH = 0.1
"""How much more a symmetric cross-field may cost than another, as `_Crosses.cost`, to be taken.

Chosen: cost differs by up to 0.02 where only the vertices that hold the singularities do; that of
the cube on the sphere, a saddle, exceeds the anticube's by 0.19.
"""

SETTLED = 1e-4
"""Root mean square change of the crosses from which on singularities stay what they are: steps are
mixed, and a time that only leads to the next one ends. Measured: mixed from the start, crosses on
a torus come to rest with two singularities more.
"""

STILL = 1e-6
"""Root mean square change of the crosses, unit numbers, that ends an iteration; of an eigenvector,
its residual, relative. Chosen.
"""


@dataclass(frozen=True, eq=False)
class CrossesStep(Progress):
    """An iteration, with the crosses as they are.

    Parameters
    ----------
    stage : str
        As in `Progress`.
    fraction : float
        As in `Progress`.
    surface : TriSurface
        Where.
    z : (ne,) complex array
        Fourth power of the cross at each edge's midpoint, in the direction of the edge.

    Examples
    --------
    Crosses along the boundary at all edges of a square are the axes:

    >>> import numpy as np
    >>> from solvers.fields import CrossesStep
    >>> from solvers.primitives import square
    >>> surface = square(n=2)
    >>> t = surface.triangulation
    >>> along = np.diff(surface.vertices[surface.edges], axis=1)[:, 0, :2] @ [1, 1j]
    >>> step = CrossesStep("by hand", 0.0, surface, (np.abs(along) / along) ** 4)
    >>> u = step.field.u
    >>> bool(np.allclose(np.abs(u).max(axis=1), 1.0))
    True
    """

    surface: TriSurface
    z: ComplexArray

    @cached_property
    def theta(self) -> FloatArray:
        """(m,) angle of a cross in each triangle against its first edge, radians."""
        t = self.surface.triangulation
        turned = self.z[self.surface.face_edges.reshape(-1)] * np.exp(4j * t.directions)
        return np.asarray(np.angle(turned.reshape(-1, 3).sum(axis=1)) / 4)

    @property
    def field(self) -> CrossField:
        """The crosses alone, all of one size; to be looked at."""
        surface = self.surface
        return CrossField(
            surface=surface,
            singularities=(),
            corners={},
            method="natural",
            H=np.zeros(surface.n_vertices),
            theta=self.theta,
            defects=np.zeros(0),
            boundary_misalignment=np.zeros(0),
            residual=0.0,
            max_closing_error=0.0,
            half_log_aspect=np.zeros((surface.n_faces, 3)),
            error_density=np.zeros(surface.n_faces),
            convergence=Convergence(converged=False),
        )


def natural_singularities(
    surface: TriSurface,
    method: str = "mbo",
    seed: int = 0,
    *,
    alignment: str = "smoothness",
    weight: float = CURVATURE_WEIGHT,
    features: Features | None = None,
    most_valence: int = MOST_VALENCE,
    fewest: bool = False,
    most: int | None = None,
    scale: float | None = None,
) -> Generator[Progress, None, tuple[Singularity, ...]]:
    """Return the singularities of a smooth cross-field aligned with boundaries and features.

    Yields a `CrossesStep` for each iteration.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    method : {"mbo", "ginzburg-landau", "globally-optimal"}, optional
        How the cross-field is smoothed.
    seed : int, optional
        Of the random start of the first two methods.
    alignment : {"smoothness", "curvature"}, optional
        Whether the crosses are also drawn towards the directions of principal curvature.
    weight : float, optional
        How strongly, against the smoothness: -lambda of Knoeppel et al. times the area.
    features : Features, optional
        Edges of the surface to be aligned with; by default none.
    most_valence : int, optional
        Of a singularity, 5 or more. None has less than 2, around which no quads close: what a
        vertex has too much goes to where the energy falls most.
    fewest : bool, optional
        Whether singularities of opposite indices are to cancel, pair by pair, those first whose
        cancelling costs the least energy, until none are left in any region between features.
    most : int, optional
        How many singularities at most. Opposite ones cancel wherever they are, and equal ones of
        valence 5 and more are merged, those first by which the energy rises least.
    scale : float, optional
        Length below which details do not count: the surface's curvature is spread over it first.
        By default `DETAIL` roots of the area; with 0 all count.

    Returns
    -------
    tuple of Singularity
        At inner vertices and in triangles; their indices and those of the default corners sum
        to the budget. Every sector between features at an inner vertex has a quad at least. On a
        mesh with `solvers.surface.isometries` they are symmetric, where that costs next to no
        energy. The result of the computation, for `solvers.run`.

    Raises
    ------
    CrossviewError
        If the method or the alignment is unknown, the weight is negative or not finite, the most
        valence is below 5, the scale is below 0, or the features are of another surface.
    SingularityError
        If the surface has too few triangles for the singularities that are needed, or they cannot
        be as few as asked for.

    Notes
    -----
    Viertel and Osting 2019 (MBO), Jezdimirovic et al. 2019 (Ginzburg-Landau), Knoeppel et al. 2013
    (globally optimal, and the alignment with curvature).

    Examples
    --------
    >>> from solvers import run
    >>> from solvers.fields import natural_singularities
    >>> from solvers.primitives import disk, square
    >>> [s.valence for s in run(natural_singularities(disk(edge_length=0.2)))]
    [3, 3, 3, 3]
    >>> run(natural_singularities(square(n=8)))  # its corners are all it needs
    ()

    A torus needs none, but a smooth cross-field has some:

    >>> from solvers.primitives import torus
    >>> surface = torus(n=24)
    >>> len(run(natural_singularities(surface))), run(natural_singularities(surface, fewest=True))
    (10, ())
    """
    if method not in NATURAL_METHODS:
        raise CrossviewError(
            f'unknown method "{method}"', advice=f"one of {', '.join(NATURAL_METHODS)}"
        )
    if alignment not in NATURAL_ALIGNMENTS:
        raise CrossviewError(
            f'unknown alignment "{alignment}"', advice=f"one of {', '.join(NATURAL_ALIGNMENTS)}"
        )
    weight = real_number("the weight of the curvature", weight, 0)
    seed = whole_number("the seed", seed, 0)
    most_valence = whole_number("the most valence", most_valence, 5)
    if most is not None:
        most = whole_number("the number of singularities", most, 0)
    pull = weight if alignment == "curvature" else 0.0
    along = no_features(surface) if features is None else features.require_on(surface)
    scale = DETAIL * np.sqrt(surface.area) if scale is None else real_number("the scale", scale, 0)
    angles = surface.triangulation.angles
    if scale > 0:
        angles = angles_without_details(along, scale)
    problem = _Crosses(surface, along, pull, angles)
    z = yield from problem.smoothed(method, seed)
    group = [g for g in isometries(surface) if np.isin(g.edges[along.edges], along.edges).all()]
    if len(group) > 1:
        symmetric = yield from problem.symmetric(group).smoothed(method, seed)
        if problem.cost(symmetric) <= problem.cost(z) + WORTH:
            z = symmetric
    index = problem.indices(z)
    for corner, turning in default_corners(surface).items():
        index[corner] -= turning
    index = settled(along, index, scale)
    lacking = problem.lacking_quads(z)
    return placed_singularities(
        surface,
        index,
        along,
        lacking,
        most_valence=most_valence,
        fewest=bool(fewest),
        most=most,
        curvature=problem.curvature,
    )


class _Crosses:
    """Complex cross values at edge midpoints, the energy of their differences, and the pull."""

    def __init__(
        self, surface: TriSurface, features: Features, pull: float, angles: FloatArray
    ) -> None:
        self.surface, self.features, self.angles = surface, features, angles
        self.t = t = surface.triangulation
        self.edge = surface.face_edges.reshape(-1)
        n = len(t.edge_halfedges)
        # A halfedge that runs against its edge sees the cross turned by 180 degrees: the same.
        h = np.arange(len(t.twin))
        after = next_halfedge(h)
        self.turn = np.exp(4j * angles.reshape(-1)[after])
        self.curvature = curvatures_of(t, angles)
        # Midpoints of halfedges h and h + 1 are coupled by the corner between them.
        weight = 2.0 * t.cotangents.reshape(-1)[after]
        i, j = self.edge[h], self.edge[after]
        diagonal = np.bincount(i, weight, n) + np.bincount(j, weight, n)
        rows, columns = np.concatenate([j, i]), np.concatenate([i, j])
        values = -np.concatenate([weight * self.turn, weight * self.turn.conj()])
        every = np.arange(n)
        self.energy = coo_array(
            (
                np.concatenate([values, diagonal.astype(complex)]),
                (np.concatenate([rows, every]), np.concatenate([columns, every])),
            ),
            shape=(n, n),
        ).tocsc()
        self.mass: FloatArray = np.bincount(self.edge, np.repeat(t.areas / 3, 3), n).astype(
            np.float64
        )
        self.free = surface.edge_faces[:, 1] >= 0
        self.free[features.edges] = False
        self.between_features = np.zeros(t.n_vertices, dtype=bool)
        self.between_features[surface.edges[features.edges]] = True
        self.between_features[surface.boundary_vertices] = False  # its corners are chosen
        self.size = float(surface.area)
        self._group: tuple[Isometry, ...] = ()
        self._kept: tuple[tuple[float, float], _Hermitian] | None = None
        # pull int |z - principal|^2 is added to the energy.
        self.pulled = np.zeros(n, dtype=complex)
        if pull > 0:
            self.energy = self.energy + diags_array(pull / self.size * self.mass)
            self.pulled = pull / self.size * self.mass * principal_crosses(surface)

    def symmetric(self, group: Sequence[Isometry]) -> _Crosses:
        """Return the same problem for crosses that a group of isometries leaves as they are."""
        other = copy(self)
        other._group = tuple(group)
        return other

    def smoothed(self, method: str, seed: int) -> Generator[Progress, None, ComplexArray]:
        """Return the crosses that a method finds from a random start."""
        return {
            "mbo": self.mbo,
            "ginzburg-landau": self.ginzburg_landau,
            "globally-optimal": self.globally_optimal,
        }[method](np.random.default_rng(seed))

    def cost(self, z: ComplexArray) -> float:
        """Return by how much crosses differ from what they diffuse to, over the time.

        MBO lets it fall at each step (Esedoglu and Otto 2015). Unlike the energy of crosses of unit
        length it hardly depends on which vertices hold the singularities.
        """
        unit: ComplexArray = np.where(self.free, _unit(z), 1.0)
        time = COMPARED * self.size
        step = self._factored(time, 1.0)
        diffused = step.solve(self.mass * unit + time * self.pulled, unit)
        return float(((self.mass * unit.conj()) @ (unit - diffused)).real / time)

    def _factored(self, stiffness: float, mass: float) -> _Hermitian:
        """Return the factored sum of so much energy and mass; the last one is kept."""
        if self._kept is None or self._kept[0] != (stiffness, mass):
            self._kept = None  # room for the next
            matrix = self.energy * stiffness + diags_array(mass * self.mass)
            self._kept = (stiffness, mass), _Hermitian(matrix, self.free)
        return self._kept[1]

    def random(self, rng: np.random.Generator) -> ComplexArray:
        z = np.exp(2j * np.pi * rng.random(len(self.mass)))
        return self._averaged(np.where(self.free, z, 1.0))

    def _averaged(self, z: ComplexArray) -> ComplexArray:
        """Return the mean of crosses and of all their images.

        Against the edge a cross keeps its angle where the edge goes, a mirror changes its sign.
        """
        if not self._group:
            return z
        total = np.zeros_like(z)
        for isometry in self._group:
            total[isometry.edges] += z.conj() if isometry.mirrors else z
        return np.asarray(total / len(self._group))

    def mbo(self, rng: np.random.Generator) -> Generator[Progress, None, ComplexArray]:
        z = self.random(rng)
        for time in (0.05, 0.01):
            z = yield from self._diffuse(z, time * self.size, SETTLED)
        return (yield from self._diffuse(z, 0.002 * self.size, STILL))

    def _diffuse(
        self, z: ComplexArray, time: float, still: float
    ) -> Generator[Progress, None, ComplexArray]:
        step = self._factored(time, 1.0)

        def diffuse(z: ComplexArray) -> ComplexArray:
            return _unit(step.solve(self.mass * z + time * self.pulled, z))

        return self._until_still(z, diffuse, still, "MBO")

    def ginzburg_landau(self, rng: np.random.Generator) -> Generator[Progress, None, ComplexArray]:
        z = yield from self._diffuse(self.random(rng), 0.05 * self.size, SETTLED)
        width = max(0.05 * np.sqrt(self.size), 1.5 * float(self.t.lengths.mean()))
        pull = 3.0 / width**2  # makes the step stable for |z| <= 1
        step = self._factored(1.0, pull)

        def descend(z: ComplexArray) -> ComplexArray:
            well = pull + (1 - np.abs(z) ** 2) / width**2
            return step.solve(self.mass * well * z + self.pulled, z)

        return (yield from self._until_still(z, descend, STILL, "Ginzburg-Landau"))

    def _until_still(
        self,
        z: ComplexArray,
        step: Callable[[ComplexArray], ComplexArray],
        still: float,
        stage: str,
    ) -> Generator[Progress, None, ComplexArray]:
        """Repeat a step until the crosses hardly change.

        Singularities that drift slowly would take thousands of plain steps: each starts a little
        farther on and, once they are settled, where Anderson mixing says.
        """
        start = before = z
        mixing: AndersonMixing | None = None
        for count in range(ITERATIONS):
            z = self._averaged(step(start))
            changed = z - (start if mixing else before)
            change = np.sqrt(np.average(np.abs(changed) ** 2, weights=self.mass))
            yield CrossesStep(stage, count / ITERATIONS, self.surface, z)
            if change < still:
                break
            if change < SETTLED and mixing is None:
                mixing = AndersonMixing(self.mass)
            start = mixing.mixed(start, z) if mixing else z + MOMENTUM * (z - before)
            before = z
        return z

    def globally_optimal(self, rng: np.random.Generator) -> Generator[Progress, None, ComplexArray]:
        shift = 1e-8 / self.size
        step = self._factored(1.0, shift)
        z = self.random(rng)
        if self.pulled.any() or not self.free.all():
            return self._averaged(step.solve(self.pulled, z))
        root = np.sqrt(self.mass)

        def inverse(x: FloatArray) -> FloatArray:
            z = x.view(np.complex128)
            return np.asarray(root * self._averaged(step.solve(root * z, z))).view(np.float64)

        # Real, as the mean with mirrored images is not linear over complex numbers.
        found = ritz_vectors(inverse, (root * z).view(np.float64))
        for count, (x, residual) in zip(range(ITERATIONS), found, strict=False):
            z = x.view(np.complex128) / root
            yield CrossesStep("globally optimal", count / ITERATIONS, self.surface, z)
            if residual < STILL:
                break
        return z

    def indices(self, z: ComplexArray) -> IntArray:
        """Return the indices of vertices, then of triangles: quarter turns of the cross around.

        Between neighbouring midpoints the cross turns by the least angle, so the indices of all
        vertices and triangles sum to the budget whatever the values are.
        """
        turning = self._turning(z)
        # Halfedges h and h + 1 meet at the head of h; going around it runs from h + 1 to h.
        around = self.curvature - np.bincount(self.t.head, turning, self.t.n_vertices)
        inside = turning.reshape(-1, 3).sum(axis=1)
        return _quarter_turns(np.concatenate([around, inside]))

    def lacking_quads(self, z: ComplexArray) -> IntArray:
        """Return vertex and region (k, 2) of each quad that a sector between features is lacking.

        A sector is what lies at a vertex between two edges that the crosses are aligned with.
        """
        t = self.t
        h = np.arange(len(t.twin))
        # The corner at the head of a halfedge is that where the next one starts.
        sector = corner_sectors(t, ~self.free[self.edge])[next_halfedge(h)]
        first = np.unique(sector, return_index=True)[1]
        angle = self.angles.reshape(-1)[next_halfedge(h)]
        turned = np.bincount(sector, angle + self._turning(z)).astype(np.float64)
        quads = _quarter_turns(turned)
        lacking = np.where(self.between_features[t.head[first]], np.maximum(0, 1 - quads), 0)
        region = face_regions(self.features)[first // 3]
        return np.repeat(np.stack([t.head[first], region], axis=1), lacking, axis=0)

    def _turning(self, z: ComplexArray) -> FloatArray:
        """Return by how much the cross turns from the midpoint of each halfedge to the next's."""
        after = next_halfedge(np.arange(len(self.t.twin)))
        seen = np.angle(z[self.edge[after]] * (z[self.edge] * self.turn).conj())
        return wrap(seen, 2 * np.pi) / 4


def _quarter_turns(angle: FloatArray) -> IntArray:
    return np.rint(angle / QUARTER).astype(np.int64)


class _Hermitian:
    """A factored Hermitian positive definite system with some values imposed."""

    def __init__(self, matrix: csc_array, free: npt.NDArray[np.bool_]) -> None:
        matrix = csc_array(matrix)
        self._free = np.flatnonzero(free)
        self._imposed = np.flatnonzero(~free)
        rows = matrix[self._free]
        self._coupling = csc_array(rows[:, self._imposed])
        inner = coo_array(rows[:, self._free])
        k = len(self._free)
        # As a real symmetric matrix of twice the size, unknowns interleaved.
        i, j, a, b = inner.row, inner.col, inner.data.real, inner.data.imag
        self._factor = factorized(
            coo_array(
                (
                    np.concatenate([a, a, -b, b]),
                    (
                        np.concatenate([2 * i, 2 * i + 1, 2 * i, 2 * i + 1]),
                        np.concatenate([2 * j, 2 * j + 1, 2 * j + 1, 2 * j]),
                    ),
                ),
                shape=(2 * k, 2 * k),
            ).tocsc()
        )

    def solve(self, right: ComplexArray, imposed: ComplexArray) -> ComplexArray:
        """Return the solution that has the imposed values where they are imposed."""
        inner = right[self._free] - self._coupling @ imposed[self._imposed]
        solution = imposed.copy()
        real = np.ascontiguousarray(inner).view(np.float64)
        solution[self._free] = self._factor.solve(real).view(np.complex128)
        return solution


def _unit(z: ComplexArray) -> ComplexArray:
    return z / np.maximum(np.abs(z), 1e-300)
