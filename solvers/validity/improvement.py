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
    LONGEST_STEP,
    Blocked,
    ConstrainedMoves,
    Step,
    least_moves,
    rotations,
)
from solvers.validity.search import TOLERANCE, Moved, Search
from solvers.validity.unevenness import Sizes, Unevenness

Places = tuple[Singularity, ...]

STEPS = 100
"""Steps of the descent at most. Chosen: 12 to 30 are usual."""

ENOUGH, PATIENCE = 1e-4, 3
"""Relative gain of a step below which it counts as none, and how many such end the descent.

Chosen.
"""

ARMIJO = 1e-4
"""Share of the gain that the slope promises which a step must bring. Usual (Nocedal, Wright)."""

ASTRAY = np.radians(5)
"""Largest defect after a step for it to be corrected, radians: farther off, steps are too long.

Chosen.
"""

CORRECTIONS = 6
"""Newton steps after each, by look-up, to take its defects away. Chosen: 2 or 3 are usual."""

FIRST = 0.03
"""Longest move of the first step, in square roots of the surface's area. Chosen."""

MEMORY = 12
"""Pairs of moves and changes of the slope that the descent remembers. Chosen."""


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
    descent = _Descent(surface, solver, unevenness, start, along)
    before, none = descent.sizes, (0,) * len(solver.holonomy.conditions)

    def told(stage: str, done: float, at: Places, off: FloatArray, sizes: Sizes) -> Improved:
        return Improved(stage, done, at, off, none, start=start, before=before, sizes=sizes)

    passed = [start]
    for step in range(STEPS):
        yield told("improving", step / STEPS, descent.singularities, descent.defects, descent.sizes)
        if not descent.advance():
            break
        passed.append(descent.singularities)
    while len(passed) > 1:
        search = Search(surface, solver.holonomy, passed[-1], along)
        try:
            near = yield from search.approach(passed[-1], none)
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


class _Descent:
    """Limited memory quasi-Newton steps on one surface from one valid configuration."""

    def __init__(
        self,
        surface: TriSurface,
        solver: IsotropicSolver,
        unevenness: Unevenness,
        singularities: Places,
        features: Features,
    ) -> None:
        self._guide, self._unevenness = solver.holonomy, unevenness
        self._moves = ConstrainedMoves(surface, solver.holonomy, singularities, features)
        self._memory: list[tuple[FloatArray, FloatArray]] = []
        self._in_vain = 0
        self._at(singularities, unevenness.sizes(singularities))

    def _at(self, singularities: Places, sizes: Sizes) -> None:
        self.singularities, self.sizes = singularities, sizes
        self.defects = self._guide.defects(singularities)
        self._slope = self._unevenness.gradient(sizes) * self._moves.free[:, None]
        gradients = self._guide.gradients([s.point for s in singularities])
        self._matrix = self._moves.by_moves(gradients)

    def advance(self) -> bool:
        """Take a step; return whether to go on."""
        before, slope = self.sizes.variance, self._slope
        found: list[tuple[Places, FloatArray, Sizes]] = []

        def propose(rows: FloatArray, gaps: FloatArray, share: float) -> FloatArray:
            both = np.concatenate([self._matrix, rows])
            right = np.concatenate([-self.defects, gaps])
            return share * self._downhill(both) + least_moves(both, right)

        def accepted(step: Step) -> bool:
            at, turns = self._corrected(step)
            if np.abs(self._guide.defects(at)).max(initial=0.0) > TOLERANCE:
                return False
            sizes = self._unevenness.sizes(at)
            found[:] = [(at, turns, sizes)]
            promised = min(float((slope * step.moves).sum()), 0.0)
            return sizes.variance < before + ARMIJO * promised

        while True:
            longest = float(np.linalg.norm(self._downhill(self._matrix), axis=1).max())
            reach = (LONGEST_STEP if self._memory else FIRST) * self._moves.unit
            share = min(1.0, reach / max(longest, 1e-300))
            step = self._moves.advance(self.singularities, propose, accepted, share)
            if isinstance(step, Step):
                break
            if not self._memory:
                return False
            self._memory = []  # once more, along the slope
        at, turns, sizes = found[0]
        carried = rotations(turns)
        self._memory = [
            (_turned(carried, s), _turned(carried, y)) for s, y in self._memory[1 - MEMORY :]
        ]
        self._at(at, sizes)
        self._remember(_turned(carried, step.moves), self._slope - _turned(carried, slope))
        self._in_vain = self._in_vain + 1 if sizes.variance > (1 - ENOUGH) * before else 0
        return self._in_vain < PATIENCE

    def _corrected(self, step: Step) -> tuple[Places, FloatArray]:
        """Return where a step leads and its turns, the defects that it left taken away."""
        at, turns = step.singularities, step.turns
        for _ in range(CORRECTIONS):
            defects = self._guide.defects(at)
            if not TOLERANCE < np.abs(defects).max(initial=0.0) < ASTRAY:
                break
            matrix = self._moves.by_moves(self._guide.gradients([s.point for s in at]))
            further = self._moves.moved(at, least_moves(matrix, -defects))
            at, turns = further.singularities, turns + further.turns
        return at, turns

    def _remember(self, moved: FloatArray, change: FloatArray) -> None:
        along = float((moved * change).sum())
        if along > 1e-8 * float(np.linalg.norm(moved) * np.linalg.norm(change)):
            self._memory.append((moved, change))

    def _downhill(self, rows: FloatArray) -> FloatArray:
        """Return the quasi-Newton move (k, 2) within the null space of equations."""
        q = _within(rows, self._slope)
        shares = []
        for s, y in reversed(self._memory):
            share = float((s * q).sum() / (s * y).sum())
            shares.append(share)
            q = q - share * y
        if self._memory:
            s, y = self._memory[-1]
            q = q * float((s * y).sum() / (y * y).sum())
        else:
            steepest = float(np.linalg.norm(q, axis=1).max())
            q = q * (FIRST * self._moves.unit / max(steepest, 1e-300))
        for (s, y), share in zip(self._memory, reversed(shares), strict=True):
            q = q + (share - float((y * q).sum() / (s * y).sum())) * s
        return -_within(rows, q)


def _within(rows: FloatArray, moves: FloatArray) -> FloatArray:
    """Return the part of moves (k, 2) that leaves linear equations (c, 2 k) as they are."""
    if not len(rows):
        return moves
    return moves - least_moves(rows, rows @ moves.reshape(-1))


def _turned(rotations: FloatArray, vectors: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("kij,kj->ki", rotations, vectors))
