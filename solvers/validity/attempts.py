"""From any configuration to a valid one: singularities moved as little as need be.

Newton on the holonomy defects (Abel-Jacobi conditions), first towards zero, then, where the way
is blocked, towards further quarter turns around single conditions: another layout of the same
singularities. The points walk straight on the surface. At the end they are inserted as vertices of
the refined surface, where the defects of a fresh operator are corrected until they vanish too.
"""

from __future__ import annotations

from collections.abc import Generator, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from solvers.errors import SingularityError
from solvers.features.edges import Features, no_features
from solvers.fields.connection import Condition
from solvers.fields.isotropic import IsotropicSolver
from solvers.progress import Progress, relayed
from solvers.remedies import ANISOTROPIC, Remedy
from solvers.singularities.budget import Singularity, checked_singularities, require_budget
from solvers.singularities.decision import existence
from solvers.singularities.farthest import far_points
from solvers.singularities.pairs import pair_at
from solvers.singularities.theorems import Theorem
from solvers.surface.refinement import LEVELS
from solvers.surface.triangulation import QUARTER, FloatArray
from solvers.surface.trisurface import TriSurface
from solvers.validity.constrained_moves import Blocked, Obstacle
from solvers.validity.search import Moved, Search

NEAREST = 16
"""How many layouts are tried before something else is proposed. Chosen."""

FARTHER = 8
"""How many layouts that are farther off are tried for a remedy. Chosen."""

SITES, AIMS = 3, 3
"""How many places, and how many layouts at each, are tried for one more pair. Chosen."""


@dataclass(frozen=True)
class PlaceAnew(Remedy):
    """Take a valid configuration, tried and verified, in place of the one there is.

    Parameters
    ----------
    words : str
        As in `Remedy`.
    singularities : tuple of Singularity
        Those of another layout, or with one more pair.
    step : str
        What a history calls it.

    Examples
    --------
    >>> from solvers import run
    >>> from solvers.primitives import torus
    >>> from solvers.singularities import Singularity
    >>> from solvers.validity import PlaceAnew, ValidityError, make_valid
    >>> surface = torus(n=24)
    >>> places = [surface.closest_point([x, 0.0, 0.0]) for x in (1.4, -0.6)]
    >>> pair = [Singularity(place, valence) for place, valence in zip(places, (3, 5))]
    >>> try:
    ...     run(make_valid(surface, pair))
    ... except ValidityError as error:
    ...     (remedy,) = error.remedies
    >>> isinstance(remedy, PlaceAnew), [s.valence for s in remedy.singularities]
    (True, [3, 5, 3, 5])
    """

    singularities: tuple[Singularity, ...]
    step: str


class ValidityError(SingularityError):
    """A configuration that could not be made valid.

    Parameters
    ----------
    what, where, advice : str
        As in `CrossviewError`.
    condition : int
        The holonomy condition in the way.
    remedies : iterable of Remedy
        What helps, the least change first.

    Examples
    --------
    No torus with one valence 3 and one valence 5 is valid (Izmestiev et al. 2013):

    >>> from solvers import run
    >>> from solvers.primitives import torus
    >>> from solvers.singularities import Singularity
    >>> from solvers.validity import ValidityError, make_valid
    >>> surface = torus(n=24)
    >>> places = [surface.closest_point([x, 0.0, 0.0]) for x in (1.4, -0.6)]
    >>> pair = [Singularity(place, valence) for place, valence in zip(places, (3, 5))]
    >>> try:
    ...     run(make_valid(surface, pair))
    ... except ValidityError as error:
    ...     print(error.what)
    the configuration is never valid: no quadrangulation of a torus has one valence 3, ...
    """

    def __init__(
        self, what: str, where: str, advice: str, condition: int, remedies: Iterable[Remedy]
    ) -> None:
        super().__init__(what, where, advice, remedies=remedies)
        self.condition = condition


def make_valid(
    surface: TriSurface,
    singularities: Iterable[Singularity],
    corners: Mapping[int, int] | None = None,
    levels: int = LEVELS,
    *,
    features: Features | None = None,
) -> Generator[Progress, None, Moved]:
    """Move the unlocked singularities until every holonomy defect is below 1e-6 degrees.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    singularities : iterable of Singularity
        A configuration that meets the index budget.
    corners : mapping of int to int, optional
        As for `IsotropicSolver`.
    levels : int, optional
        Of refinement at the singularities, for the final check.
    features : Features, optional
        Of the surface. No singularity crosses one, and one on a feature stays.

    Returns
    -------
    Moved
        The valid configuration, verified by a fresh operator; the result of the computation, for
        `solvers.run`.

    Raises
    ------
    SingularityError
        If the index budget is missed.
    ValidityError
        If there is no valid configuration near enough; it says which condition is in the way and
        why, and what helps.

    Notes
    -----
    The paper names the conditions (section "Valid singularity configurations"); the way to where
    they hold is Newton's, along the gradients of `Holonomy`.

    Examples
    --------
    On an annulus a valence 3 and a valence 5 must lie on one ray:

    >>> import numpy as np
    >>> from solvers import run
    >>> from solvers.primitives import annulus
    >>> from solvers.singularities import Singularity
    >>> from solvers.validity import make_valid
    >>> surface = annulus(n=24)
    >>> three = Singularity(surface.closest_point([0.8, 0.0, 0.0]), 3, locked=True)
    >>> five = Singularity(surface.closest_point([0.3, 0.5, 0.0]), 5)
    >>> end = run(make_valid(surface, [three, five]))
    >>> bool(np.degrees(np.abs(end.defects).max()) < 1e-6)
    True
    >>> x, y, _ = surface.position(end.singularities[1].point)
    >>> bool(x > 0 and abs(y) < 0.01)  # as far as the mesh is symmetrical
    True
    """
    start = checked_singularities(singularities)
    solver = IsotropicSolver(surface, corners)
    require_budget(surface, start, solver.corners)
    along = no_features(surface) if features is None else features.require_on(surface)
    return (yield from _Attempt(solver, corners, levels, along).make_valid(start))


class _Attempt:
    """Tries on one surface; the operator and its potentials are kept."""

    def __init__(
        self,
        solver: IsotropicSolver,
        corners: Mapping[int, int] | None,
        levels: int,
        features: Features,
    ) -> None:
        self._surface = solver.surface
        self._guide = solver.holonomy
        self._corners = corners
        self._index = solver.corners
        self._levels = levels
        self._features = features

    def make_valid(self, start: tuple[Singularity, ...]) -> Generator[Progress, None, Moved]:
        """Take the nearest layout that can be reached, or say what helps."""
        conditions = self._guide.conditions
        known = existence(self._surface, start, self._index)
        if known.theorem is not None:
            remedies = yield from self._remedies(start, None)
            raise _refusal(known.theorem, self._guide.defects(start), conditions, remedies)
        try:
            return (yield from self._nearest(start, _near(self._guide.defects(start))))
        except Blocked as blocked:
            why, remaining = blocked.why, blocked.remaining
        remedies = yield from self._remedies(start, why)
        raise _refusal(why, remaining, conditions, remedies)

    def _nearest(
        self, start: tuple[Singularity, ...], aims: Sequence[tuple[int, ...]]
    ) -> Generator[Progress, None, Moved]:
        """Try layouts one after the other; what blocks the first tells why all failed."""
        first: Blocked | None = None
        for turns in aims:
            search = Search(self._surface, self._guide, start, self._features)
            try:
                moved = yield from search.approach(start, turns)
                end = yield from search.verify(moved, turns, self._corners, self._levels)
                return replace(end, aim=_in_words(turns, self._guide.conditions))
            except Blocked as blocked:
                first = first or blocked
                if first.why is Obstacle.TOO_FEW:
                    break
        raise first or Blocked(Obstacle.TOO_FEW, self._guide.defects(start))

    def _remedies(
        self, start: tuple[Singularity, ...], why: Obstacle | None
    ) -> Generator[Progress, None, tuple[Remedy, ...]]:
        found: list[Remedy] = []
        if why not in (None, Obstacle.TOO_FEW):
            farther = yield from self._tried("trying other layouts", start, self._far(start))
            if farther is not None:
                words = f"aim at {farther.aim}"
                found.append(PlaceAnew(words, farther.singularities, "another layout"))
        sites = yield from far_points(self._surface, start, SITES)
        for site in sites:
            try:
                more = (*start, *pair_at(self._surface, start, site))
            except SingularityError:  # no room here
                continue
            aims = _near(self._guide.defects(more))[:AIMS]
            paired = yield from self._tried("trying one more pair", more, aims)
            if paired is not None:
                place = ", ".join(f"{x:.3g}" for x in self._surface.position(site))
                words = f"add a pair of 3 and 5 near ({place})"
                found.append(PlaceAnew(words, paired.singularities, "one more pair"))
                break
        if why is not None:
            found.append(ANISOTROPIC)
        return tuple(found)

    def _tried(
        self, stage: str, start: tuple[Singularity, ...], aims: Sequence[tuple[int, ...]]
    ) -> Generator[Progress, None, Moved | None]:
        """Return where a try for a remedy leads; None where it is blocked."""

        def plainly(step: Progress) -> Progress:
            return Progress(stage, step.fraction)

        try:
            return (yield from relayed(self._nearest(start, aims), plainly))
        except Blocked:
            return None

    def _far(self, start: tuple[Singularity, ...]) -> list[tuple[int, ...]]:
        """Return layouts beyond those of `_near`, one condition a quarter turn or two farther."""
        defects = self._guide.defects(start)
        tried = set(_near(defects))
        alone = np.eye(len(defects), dtype=int)
        aims = [tuple((n * row).tolist()) for row in alone for n in (-2, -1, 1, 2)]
        return _sorted(defects, (turns for turns in aims if turns not in tried))[:FARTHER]


def _near(defects: FloatArray) -> list[tuple[int, ...]]:
    """Return the quarter turns to aim at, the nearest first: on the defects' own side."""
    sides = [int(np.sign(r)) or 1 for r in defects]
    aims = (
        tuple(n * side for n, side in zip(chosen, sides, strict=True))
        for chosen in product((0, 1), repeat=len(defects))
        if sum(chosen) <= 2
    )
    return _sorted(defects, aims)[:NEAREST]


def _sorted(defects: FloatArray, aims: Iterator[tuple[int, ...]]) -> list[tuple[int, ...]]:
    quarters = defects / QUARTER
    return sorted(aims, key=lambda turns: float(np.linalg.norm(quarters - turns)))


def _in_words(turns: Sequence[int], conditions: Sequence[Condition]) -> str:
    parts = [
        f"{90 * n:+d} degrees {_around(condition)}"
        for n, condition in zip(turns, conditions, strict=True)
        if n
    ]
    return " and ".join(parts)


def _around(condition: Condition) -> str:
    return condition.label if condition.kind == "boundary" else f"around {condition.label}"


def _refusal(
    why: Obstacle | Theorem,
    defects: FloatArray,
    conditions: Sequence[Condition],
    remedies: tuple[Remedy, ...],
) -> ValidityError:
    worst = int(np.argmax(np.abs(defects)))
    if isinstance(why, Theorem):
        what = f"the configuration is never valid: {why.statement[:1].lower()}{why.statement[1:]}"
        advice = "" if remedies else "add a pair of singularities"
        return ValidityError(what, why.source, advice, worst, remedies)
    return ValidityError(
        f"the configuration cannot be made valid by moving its singularities: {why.value}",
        f"{conditions[worst].label}, {np.degrees(abs(defects[worst])):.3g} degrees off",
        "unlock some" if why is Obstacle.TOO_FEW else "",
        worst,
        remedies,
    )
