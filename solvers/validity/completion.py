"""Where the indices that are missing would do the most good.

An isotropic field's H costs the energy 1/2 int |grad H|^2. A singularity of index k at x lowers it
by (pi/2) k H(x) and adds its own energy, which near a boundary grows as its mirror image comes
near: -(pi/16) log of twice the distance for an index of 1 or -1 (Green's function of the half
plane, Neumann). What is still missing is spread evenly meanwhile, so that H always exists.
"""

from __future__ import annotations

from collections.abc import Generator, Iterable, Sequence

import numpy as np
from scipy.spatial import cKDTree

from solvers.errors import SingularityError
from solvers.fields.isotropic import IsotropicSolver
from solvers.progress import Progress
from solvers.singularities.budget import Singularity, checked_singularities, index_budget
from solvers.surface.triangulation import QUARTER, BoolArray, FloatArray

SWEEPS = 2
"""How often each is taken away and placed again, knowing all the others. Chosen."""

MOST_PLACED = 64
"""How many are placed at most. Chosen: with more, a few of higher valence are meant."""

CLEAR = 0.03
"""How far from singularities and boundary places are looked for, in square roots of the area.

Chosen, farther than `spacing.CLOSEST`.
"""


def missing_singularities(
    solver: IsotropicSolver, singularities: Iterable[Singularity]
) -> Generator[Progress, None, tuple[Singularity, ...]]:
    """Find places for the valences 3 or 5 that the index budget lacks.

    Greedily where the energy falls most, one back-substitution each; then each is placed again.

    Parameters
    ----------
    solver : IsotropicSolver
        On the surface, with its corners.
    singularities : iterable of Singularity
        What is there.

    Returns
    -------
    tuple of Singularity
        What to add, at vertices; all of valence 3 or all of valence 5. The result of the
        computation, for `solvers.run`.

    Raises
    ------
    SingularityError
        More are missing than can be placed, or than there is room for.

    Examples
    --------
    On a disk the four valences 3 are best at the corners of a square:

    >>> import numpy as np
    >>> from solvers import run
    >>> from solvers.fields import IsotropicSolver
    >>> from solvers.primitives import disk
    >>> from solvers.validity import missing_singularities
    >>> surface = disk(edge_length=0.1)
    >>> found = run(missing_singularities(IsotropicSolver(surface), []))
    >>> [s.valence for s in found]
    [3, 3, 3, 3]
    >>> radii = np.linalg.norm(surface.positions([s.point for s in found]), axis=1)
    >>> bool(np.allclose(radii, radii[0]))
    True
    """
    surface = solver.surface
    singularities = checked_singularities(singularities)
    missing = index_budget(surface, singularities, solver.corners).missing
    count = abs(missing)
    if count > MOST_PLACED:
        raise SingularityError(
            f"{count} singularities are missing", advice="add one of a higher valence first"
        )
    if count == 0:
        return ()
    places = _Places(solver, singularities, 1 if missing > 0 else -1)
    steps = count * (1 + SWEEPS)
    for step in range(steps):
        yield Progress("placing singularities", step / steps)
        places.place(step % count)
    valence = 3 if missing > 0 else 5
    return tuple(Singularity(surface.point_at_vertex(v), valence) for v in places.chosen)


class _Places:
    """Vertices chosen for singularities of one index, and the field they leave."""

    def __init__(
        self, solver: IsotropicSolver, singularities: Sequence[Singularity], index: int
    ) -> None:
        self._solver = solver
        self._index = index
        self.chosen: list[int] = []
        t, surface = solver.discretization.triangulation, solver.surface
        self._right = t.curvatures.copy()
        for vertex, corner in solver.corners.items():
            self._right[vertex] -= QUARTER * corner
        faces, weights = solver.discretization.place([s.point for s in singularities])
        indices = np.array([s.index for s in singularities], dtype=np.float64)
        np.subtract.at(self._right, t.faces[faces], QUARTER * indices[:, None] * weights)
        self._clear = CLEAR * float(np.sqrt(surface.area))
        rim = surface.vertices[surface.boundary_vertices]
        self._bias = np.zeros(surface.n_vertices)
        self._open = ~surface.boundary_vertices
        if len(rim):
            to_rim = cKDTree(rim).query(surface.vertices)[0]
            self._bias = np.log(np.maximum(to_rim, 1e-300)) / 8
            self._open &= (to_rim > self._clear) | (to_rim >= 0.5 * to_rim.max())
        self._shut(surface.positions([s.point for s in singularities]), self._open)
        taken = [surface.nearest_vertex(s.point) for s in singularities if 1 in s.point.barycentric]
        self._open[taken] = False

    def place(self, number: int) -> None:
        """Choose a vertex for one of them, all the others kept."""
        others = [v for i, v in enumerate(self.chosen) if i != number]
        open_ = self._open.copy()
        self._shut(self._solver.surface.vertices[others], open_)
        open_[others] = False
        if not open_.any():
            raise SingularityError(
                "there is no room for all the singularities that are missing",
                f"{self._open.sum()} vertices inside are free",
                "give a finer surface, or add some of a higher valence first",
            )
        h = self._field(others)[: len(open_)]  # there may be further vertices
        score = np.where(open_, self._index * h + self._bias, -np.inf)
        best = int(np.argmax(score))
        self.chosen[number : number + 1] = [best]

    def _field(self, vertices: list[int]) -> FloatArray:
        """Return H of the configuration with some of its own, what is missing spread evenly."""
        right = self._right.copy()
        np.subtract.at(right, np.array(vertices, dtype=np.int64), QUARTER * self._index)
        mass = self._solver.mass
        right -= right.sum() / mass.sum() * mass
        h = np.zeros(len(right))
        h[1:] = self._solver.factorization.solve(right[1:])
        return h

    def _shut(self, positions: FloatArray, open_: BoolArray) -> None:
        """Take the surroundings of places out of the choice, as far as some is left."""
        if not len(positions):
            return
        away = cKDTree(positions).query(self._solver.surface.vertices)[0]
        near: BoolArray = away <= self._clear
        if (open_ & ~near).any():
            open_ &= ~near
