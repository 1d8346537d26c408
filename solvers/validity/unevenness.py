"""How uneven the sizes of an isotropic field are, and how that changes as singularities move.

H is smoothed over a triangle or two: what is finer tells of the mesh, and singularities would come
to rest in the wells that each of its triangles makes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import diags_array

from solvers.algebra.factorization import factorized
from solvers.algebra.operators import stiffness
from solvers.fields.isotropic import IsotropicSolver
from solvers.fields.sizes import size_map
from solvers.singularities.budget import Singularity
from solvers.surface.triangulation import QUARTER, FloatArray

SMOOTHED = 4.0
"""How long H diffuses as heat before it is measured, in mean areas of triangles.

Chosen: eight valences 3 on a sphere come to the anticube, whose variance is 4 % below the cube's;
with less of it they stay anywhere in between.
"""


class Spread:
    """What it costs that each singularity's curvature is spread over its triangle's corners.

    Spread with mean square distance s, it changes H by (pi/8) k s at its place, less the mean, and
    the variance of H smoothed by (pi/4) k s H over the area, where H is smoothed twice.
    Without this the variance would be least wherever triangles are largest.

    Parameters
    ----------
    solver : IsotropicSolver
        On the surface.
    singularities : sequence of Singularity
        The configuration.
    """

    def __init__(self, solver: IsotropicSolver, singularities: Sequence[Singularity]) -> None:
        d = solver.discretization
        points = [s.point for s in singularities]
        self.at = d.locate(points)
        faces, self.weights = d.place(points)
        t = d.triangulation
        self.index = np.array([s.index for s in singularities], dtype=np.float64)
        self.weight = QUARTER / 2 * self.index / solver.mass.sum()
        self.corners = t.faces[faces]
        corner = t.corner_positions[faces]
        place = np.einsum("ki,kid->kd", self.weights, corner)
        self.squares = ((corner - place[:, None]) ** 2).sum(axis=2)
        self.square = (self.weights * self.squares).sum(axis=1)

    def mean(self, values: FloatArray) -> FloatArray:
        """Return values of the triangulation's vertices at the singularities."""
        return np.asarray((self.weights * values[self.corners]).sum(axis=1))


@dataclass(frozen=True, eq=False)
class Sizes:
    """The sizes of one configuration's field against those wanted.

    Parameters
    ----------
    off : (n,) float array
        H less the logarithm of what is wanted, of mean zero, on the working triangulation.
    smoothed : (n,) float array
        The same, smoothed.
    variance : float
        Mean of the squares of what is smoothed over the surface.
    spread : Spread
        Of the configuration's curvature over the triangulation.

    Examples
    --------
    >>> from solvers.fields import IsotropicSolver
    >>> from solvers.primitives import annulus
    >>> from solvers.validity import Unevenness
    >>> surface = annulus(inner=0.5, n=48)  # where H = log r
    >>> sizes = Unevenness(IsotropicSolver(surface)).sizes([])
    >>> round(sizes.ratio, 1)
    2.0
    """

    off: FloatArray
    smoothed: FloatArray
    variance: float
    spread: Spread

    @property
    def ratio(self) -> float:
        """How many times the largest size is the smallest, what is wanted being 1 everywhere."""
        return float(np.exp(np.ptp(self.off)))


class Unevenness:
    """The variance of H, smoothed, over the surface, as a function of the singularities' places.

    Parameters
    ----------
    solver : IsotropicSolver
        On the surface.
    wanted : (n,) array_like, optional
        Size wanted at each vertex of the surface; by default the same everywhere.

    Raises
    ------
    CrossviewError
        The sizes are not one for each vertex.

    Notes
    -----
    With S H = K - (pi/2) k, A = (m + t S)^-1 m and S p = 2 m A^2 (H - H0) / sum m, moving
    singularity j by d changes the variance of A H by -(pi/2) k_j grad p . d: two more
    back-substitutions, whatever their number. What it costs that curvature is spread over a
    triangle is taken off, to first order in its area.

    Examples
    --------
    On a disk four valences 3 make sizes most even far out, short of where the boundary's corners
    would be:

    >>> import numpy as np
    >>> from solvers.fields import IsotropicSolver
    >>> from solvers.primitives import disk
    >>> from solvers.singularities import Singularity
    >>> from solvers.validity import Unevenness
    >>> surface = disk(edge_length=0.05)
    >>> unevenness = Unevenness(IsotropicSolver(surface))
    >>> def variance(radius: float) -> float:
    ...     places = radius * np.array([[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]])
    ...     threes = [Singularity(surface.closest_point(place), 3) for place in places]
    ...     return unevenness.sizes(threes).variance
    >>> variance(0.4) > variance(0.6) > variance(0.75) < variance(0.95)
    True
    """

    def __init__(self, solver: IsotropicSolver, wanted: FloatArray | None = None) -> None:
        self._solver = solver
        self._mass = solver.mass / solver.mass.sum()
        d = solver.discretization
        time = SMOOTHED * float(d.triangulation.areas.mean())
        heat = time * stiffness(d.triangulation) + diags_array(solver.mass)
        self._heat = factorized(heat.tocsc())
        self._wanted = np.zeros(d.triangulation.n_vertices)
        if wanted is not None:
            sizes = size_map(wanted, solver.surface.n_vertices)
            faces, weights = d.vertex_points
            corners = np.log(sizes)[solver.surface.faces[faces]]
            self._wanted = np.einsum("ki,ki->k", weights, corners)

    def sizes(self, singularities: Sequence[Singularity]) -> Sizes:
        """Return the sizes of a configuration, by three back-substitutions.

        Parameters
        ----------
        singularities : sequence of Singularity
            Anywhere on the surface, the index budget met.
        """
        off = self._solver.log_sizes(singularities) - self._wanted
        off -= self._mass @ off
        smoothed = self._smoothed(off)
        spread = Spread(self._solver, singularities)
        excess = spread.weight * spread.square @ spread.mean(self._smoothed(smoothed))
        return Sizes(off, smoothed, float(self._mass @ smoothed**2 - excess), spread)

    def gradient(self, sizes: Sizes) -> FloatArray:
        """Return how the variance changes as each singularity moves, by four back-substitutions.

        Parameters
        ----------
        sizes : Sizes
            Those of the configuration.

        Returns
        -------
        (k, 2) float array
            In the frames of the singularities' triangles.
        """
        solver, spread = self._solver, sizes.spread
        twice = self._smoothed(sizes.smoothed)
        excess = spread.weight * spread.square
        loads = np.zeros(len(twice))
        np.add.at(loads, spread.corners, excess[:, None] * spread.weights)
        mass = solver.mass
        right = 2 * self._mass * twice - mass * self._heat.solve(mass * self._heat.solve(loads))
        right -= right.sum() * self._mass
        p = np.zeros(len(right))
        p[1:] = solver.factorization.solve(right[1:])
        values = np.stack([p[spread.corners], spread.squares, twice[spread.corners]])
        by_p, by_square, by_twice = solver.discretization.gradients(values, spread.at)
        by_excess = spread.mean(twice)[:, None] * by_square + spread.square[:, None] * by_twice
        curvature = QUARTER * spread.index
        return np.asarray(-curvature[:, None] * by_p - spread.weight[:, None] * by_excess)

    def _smoothed(self, values: FloatArray) -> FloatArray:
        return self._heat.solve(self._solver.mass * values)
