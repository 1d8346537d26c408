"""From a valid configuration to a better one: singularities moved until sizes are most even.

Descent on the variance of H along directions that leave every holonomy defect at zero: limited
memory quasi-Newton on the singularities' places, its vectors carried along as they walk straight
on the surface. Distances to one another and to the boundary are kept as by `make_valid`, and so
is the last word: a fresh operator on the refined surface, whose defects are made to vanish.
"""

from __future__ import annotations

from collections.abc import Generator, Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from solvers.errors import SingularityError
from solvers.features.edges import Features, no_features
from solvers.fields.isotropic import IsotropicSolver
from solvers.progress import Progress
from solvers.singularities.budget import Singularity, checked_singularities, require_budget
from solvers.surface.refinement import LEVELS
from solvers.surface.triangulation import FloatArray
from solvers.surface.trisurface import TriSurface
from solvers.validity.attempts import make_valid
from solvers.validity.constrained_moves import (
    Blocked,
    ConstrainedMoves,
    Obstacle,
)
from solvers.validity.descent import Descent, Held, Hold, Places
from solvers.validity.search import TOLERANCE, Moved, Search
from solvers.validity.unevenness import Sizes, Unevenness

STEPS = 100
"""Steps of the descent at most. Chosen: 12 to 30 are usual."""


@dataclass(frozen=True, kw_only=True)
class Improved(Moved):
    """A step of the way to more even sizes; the last is the result.

    Parameters
    ----------
    stage : str
        As in `Progress`.
    fraction : float
        As in `Progress`.
    singularities : tuple of Singularity
        Where they are.
    defects : (c,) float array
        Their holonomy defects, radians.
    turns : tuple of int
        As in `Moved`: no turns, the configuration stays of its own layout.
    aim : str
        As in `Moved`; empty.
    start : tuple of Singularity
        The valid configuration that was started from.
    before, sizes : Sizes
        Of that one, and of this one.

    Examples
    --------
    >>> from solvers import run
    >>> from solvers.primitives import disk
    >>> from solvers.singularities import Singularity
    >>> from solvers.validity import improve
    >>> surface = disk(edge_length=0.1)
    >>> places = [[0.3, 0.1, 0], [0, 0.4, 0], [-0.5, 0, 0], [0, -0.2, 0]]
    >>> threes = [Singularity(surface.closest_point(place), 3) for place in places]
    >>> end = run(improve(surface, threes))
    >>> end.sizes.variance < 0.3 * end.before.variance
    True
    """

    start: Places
    before: Sizes
    sizes: Sizes


def improve(
    surface: TriSurface,
    singularities: Iterable[Singularity],
    corners: Mapping[int, int] | None = None,
    levels: int = LEVELS,
    *,
    wanted: FloatArray | None = None,
    features: Features | None = None,
    hold: Hold | None = None,
) -> Generator[Progress, None, Improved]:
    """Move the unlocked singularities to where sizes are most even, all defects kept at zero.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    singularities : iterable of Singularity
        A configuration that meets the index budget; if it is not valid it is made valid first.
    corners : mapping of int to int, optional
        As for `IsotropicSolver`.
    levels : int, optional
        Of refinement at the singularities, for the final check.
    wanted : (n,) array_like, optional
        Size wanted at each vertex of the surface; by default the same everywhere.
    features : Features, optional
        Of the surface. No singularity crosses one, and one on a feature stays.
    hold : callable, optional
        What more than the defects is to stay as it is: see `solvers.layouts.holding`.

    Returns
    -------
    Improved
        The valid configuration, verified by a fresh operator; never one of less even sizes.

    Raises
    ------
    SingularityError
        If the index budget is missed, or no singularity is free to move.
    ValidityError
        As `make_valid`.

    Notes
    -----
    The gradient is exact for the discrete field and costs one back-substitution (`Unevenness`); a
    step is projected on the null space of the defects' derivative and corrected by its least-norm
    Newton step.

    Examples
    --------
    Four valences 3 on a disk end at the corners of a square:

    >>> import numpy as np
    >>> from solvers import run
    >>> from solvers.primitives import disk
    >>> from solvers.singularities import Singularity
    >>> from solvers.validity import improve
    >>> surface = disk(edge_length=0.05)
    >>> places = [[0.3, 0.1, 0], [0, 0.4, 0], [-0.5, 0, 0], [0, -0.2, 0]]
    >>> end = run(improve(surface, [Singularity(surface.closest_point(p), 3) for p in places]))
    >>> places = surface.positions([s.point for s in end.singularities])
    >>> bool(np.ptp(np.linalg.norm(places, axis=1)) < 0.01)
    True
    """
    start = checked_singularities(singularities)
    solver = IsotropicSolver(surface, corners)
    require_budget(surface, start, solver.corners)
    along = no_features(surface) if features is None else features.require_on(surface)
    if not ConstrainedMoves(surface, solver.holonomy, start, along).free.any():
        locked = all(s.locked for s in start if s.index)
        advice = "move some off the features" if not locked else "unlock some"
        raise SingularityError("no singularity may move", advice=advice if start else "add some")
    unevenness = Unevenness(solver, wanted)
    if np.abs(solver.holonomy.defects(start)).max(initial=0.0) > TOLERANCE:
        start = (
            yield from make_valid(surface, start, corners, levels, features=along)
        ).singularities
    moves = ConstrainedMoves(surface, solver.holonomy, start, along)
    held = None if hold is None else hold(solver, moves, start)
    descent = Descent(moves, unevenness, start, held)
    before, none = descent.sizes, (0,) * len(solver.holonomy.conditions)

    def told(stage: str, done: float, at: Places, off: FloatArray, sizes: Sizes) -> Improved:
        return Improved(stage, done, at, off, none, start=start, before=before, sizes=sizes)

    passed: list[tuple[Places, Held | None]] = [(start, held)]
    for step in range(STEPS):
        yield told("improving", step / STEPS, descent.singularities, descent.defects, descent.sizes)
        if not descent.advance():
            break
        passed.append((descent.singularities, descent.held))
    while len(passed) > 1:
        at, held = passed[-1]
        search = Search(surface, solver.holonomy, at, along)
        try:
            near = yield from search.approach(_exact(at, held), none)
            end = yield from search.verify(near, none, corners, levels)
        except Blocked:
            # Where the refined surface cannot be made valid, it can nearer to the start.
            passed = passed[: (len(passed) + 1) // 2]
            continue
        sizes = unevenness.sizes(end.singularities)
        if sizes.variance < before.variance:
            return told(end.stage, 1.0, end.singularities, end.defects, sizes)
        break
    return told("valid", 1.0, start, solver.holonomy.defects(start), before)


def _exact(singularities: Places, held: Held | None) -> Places:
    """Return where further equations are met; raises Blocked where they cannot be."""
    if held is None:
        return singularities
    for step in held.steps():
        held = step
    if not held.met:
        raise Blocked(Obstacle.STALLED, held.equations[1])
    return held.singularities
