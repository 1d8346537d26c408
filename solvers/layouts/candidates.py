"""Near misses to be shown: what `snap` would make connections of."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Mapping
from dataclasses import dataclass

from solvers.features.edges import Features
from solvers.frozen import freeze_arrays
from solvers.layouts.saddle_connections import EXACT
from solvers.layouts.snapping import configuration
from solvers.progress import Progress
from solvers.singularities.budget import Singularity
from solvers.singularities.connections import Connections
from solvers.surface.refinement import LEVELS
from solvers.surface.triangulation import FloatArray, IntArray
from solvers.surface.trisurface import TriSurface


@dataclass(frozen=True, eq=False)
class NearMisses:
    """Separatrices that nearly meet a singularity, those first that the least moves make meet it.

    Parameters
    ----------
    pairs : (q, 2) int array
        The singularity that each leaves, and the one that it nearly meets.
    angles : (q,) float array
        By how much it misses, radians.
    points : (p, 3) float array
        Of curves on the surface from the one to the other, one after the other.
    offsets : (q + 1,) int array
        The points of curve i are ``offsets[i]`` to ``offsets[i + 1]``.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers import run
    >>> from solvers.layouts import nearly_connected
    >>> from solvers.primitives import disk
    >>> from solvers.singularities import Singularity
    >>> surface = disk(edge_length=0.1)
    >>> places = [[0.5, 0.03, 0], [0, 0.5, 0], [-0.5, 0, 0], [0, -0.5, 0]]
    >>> threes = [Singularity(surface.closest_point(place), 3) for place in places]
    >>> found = run(nearly_connected(surface, threes))
    >>> first = found.points[: found.offsets[1]]
    >>> ends = surface.positions([threes[i].point for i in found.pairs[0]])
    >>> bool(np.abs(first[[0, -1]] - ends).max() < 1e-9)
    True
    """

    pairs: IntArray
    angles: FloatArray
    points: FloatArray
    offsets: IntArray

    def __post_init__(self) -> None:
        freeze_arrays(self)

    def __len__(self) -> int:
        """Return how many there are."""
        return len(self.pairs)


def nearly_connected(
    surface: TriSurface,
    singularities: Iterable[Singularity],
    corners: Mapping[int, int] | None = None,
    levels: int = LEVELS,
    *,
    features: Features | None = None,
    kept: Connections = (),
) -> Generator[Progress, None, NearMisses]:
    """Find the separatrices that `snap` would make meet a singularity that they nearly meet.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    singularities : iterable of Singularity
        As for `snap`.
    corners : mapping of int to int, optional
        As for `IsotropicSolver`.
    levels : int, optional
        Of refinement at the singularities.
    features : Features, optional
        Of the surface.
    kept : tuple of (int, int), optional
        Connections that there are: they are left out, as is what misses by less than 0.1 degrees.

    Returns
    -------
    NearMisses
        The result of the computation, for `solvers.run`.

    Raises
    ------
    SingularityError
        As `snap`, but if there are none.
    ValidityError
        As `make_valid`.

    Examples
    --------
    Of four valences 3 on a disk the first is a little off the corner of their square:

    >>> import numpy as np
    >>> from solvers import run
    >>> from solvers.layouts import nearly_connected
    >>> from solvers.primitives import disk
    >>> from solvers.singularities import Singularity
    >>> surface = disk(edge_length=0.1)
    >>> places = [[0.5, 0.03, 0], [0, 0.5, 0], [-0.5, 0, 0], [0, -0.5, 0]]
    >>> threes = [Singularity(surface.closest_point(place), 3) for place in places]
    >>> found = run(nearly_connected(surface, threes))
    >>> len(found), bool(found.angles.max() < np.radians(5))
    (4, True)
    """
    yield Progress("looking for near misses", 0.0)
    first = yield from configuration(surface, singularities, corners, levels, features)
    held = first.between(kept)
    passings = first.ways.passings[first.near_misses(held)[len(held) :]]
    passings = passings[passings.angles > EXACT]
    return NearMisses(passings.nodes, passings.angles, *first.ways.curves(passings))
