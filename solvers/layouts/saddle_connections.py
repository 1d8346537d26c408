"""Saddle connections as equations: which separatrices are to meet which singularities.

A passing, where a separatrix nearly meets a singularity, is one real equation for the places of all
of them, beside those of the holonomy defects.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from functools import cached_property

import numpy as np

from solvers.errors import SingularityError
from solvers.fields.isotropic import IsotropicSolver
from solvers.fields.prepared import prepare
from solvers.layouts.near_misses import SeparatrixWays
from solvers.singularities.budget import Singularity
from solvers.singularities.connections import Connections, checked_connections
from solvers.surface.refinement import LEVELS
from solvers.surface.triangulation import FloatArray, IntArray
from solvers.validity.constrained_moves import ConstrainedMoves, Step, least_moves

Places = tuple[Singularity, ...]

NEAR = np.radians(5)
"""Angle by which a separatrix misses what it is to meet, at most, radians. Chosen."""

MET, EXACT = np.radians(0.5), np.radians(0.1)
"""Angles of a miss that counts as none, and of one that is not tried to be made smaller, radians.

Chosen: the maps that layouts are cut along differ from the field by as much as the second, and they
join what is nearer than a degree.
"""

STEPS = 8
"""Newton steps at most. Chosen: 2 to 4 are usual."""

FARTHEST = 0.06
"""How far singularities may move for one connection, in square roots of the area. Chosen."""

LEAST_HOLD = 0.05
"""Change of a miss, radians, by a move of the square root of the area: less is no hold. Chosen."""

INDEPENDENT = 0.2
"""Share of an equation that those before leave of it, if it is one more. Chosen."""

LOST = 0.2
"""How far from where it is expected a passing may be found again, in its length. Chosen."""

FALLS = 0.9
"""What is left of all misses after a good step, at most. Chosen."""


class Configuration:
    """Singularities, their separatrices and defects, and how both change as they move."""

    def __init__(
        self, solver: IsotropicSolver, moves: ConstrainedMoves, levels: int, at: Places
    ) -> None:
        self.solver, self.moves, self.levels, self.singularities = solver, moves, levels, at
        surface, guide = solver.surface, solver.holonomy
        self.ways = SeparatrixWays(prepare(surface, at, refine=levels, corners=solver.corners))
        self.defects = guide.defects(at)
        points = [s.point for s in at]
        self.matrix = moves.by_moves(guide.gradients(points))
        self._axes = np.stack(surface.face_frames, axis=1)[[p.face for p in points]]

    def elsewhere(self, singularities: Places) -> Configuration:
        """Return the same with its singularities moved."""
        return Configuration(self.solver, self.moves, self.levels, singularities)

    def equations(self, which: IntArray) -> tuple[FloatArray, FloatArray]:
        """Return how the misses of some passings change with moves (p, 2 k), and those (p,).

        Where nothing fixes the direction of crosses, up to a turn of all of them.
        """
        passings = self.ways.passings[which]
        gradients = self.ways.gradients(passings, self._axes) * self.moves.free[:, None]
        rows = gradients.reshape(len(which), -1) / passings.length[:, None]
        misses = passings.offset / passings.length
        if self.ways.gauge_free:
            return rows - rows.mean(axis=0), misses - misses.mean()
        return rows, misses

    @cached_property
    def _direct(self) -> IntArray:
        """The passings of separatrices that have met no other singularity before."""
        passings = self.ways.passings
        trace = self.ways.trace_of(passings)
        met, meets = np.full(trace.max(initial=-1) + 1, np.inf), passings.angles < MET
        np.minimum.at(met, trace[meets], passings.length[meets])
        return np.flatnonzero((passings.angles < NEAR) & (passings.length <= met[trace]))

    def between(self, pairs: Connections) -> IntArray:
        """Return the passings that are meant by pairs of singularities: those that miss least.

        Raises
        ------
        SingularityError
            Not so many separatrices of a pair nearly meet.
        """
        passings, nearest = self.ways.passings, self._direct
        nearest = nearest[np.argsort(np.abs(passings.offset[nearest]), kind="stable")]
        once = np.unique(passings.line[nearest], axis=0, return_index=True)[1]
        nearest = nearest[np.sort(once)]
        ends = np.sort(passings.nodes[nearest], axis=1)
        found: list[int] = []
        for pair, count in Counter(checked_connections(pairs, len(self.singularities))).items():
            meant = nearest[(ends == pair).all(axis=1)][:count]
            if len(meant) < count:
                raise _apart(*pair)
            found += meant.tolist()
        return np.array(found, dtype=np.int64)

    def near_misses(self, kept: IntArray) -> IntArray:
        """Return the passings to be made none: some, then others that take the least moves."""
        passings = self.ways.passings
        near = np.flatnonzero(passings.angles < NEAR)
        # Of those along a separatrix the first.
        near = near[np.unique(self.ways.trace_of(passings[near]), return_index=True)[1]]
        return self._chosen(kept, near)

    def connections(self, kept: IntArray) -> IntArray:
        """Return the passings that are none: some, then others that do not follow from them."""
        near = self._direct
        return self._chosen(kept, near[self.ways.passings.angles[near] < MET])

    def _chosen(self, kept: IntArray, near: IntArray) -> IntArray:
        """Return some passings and those others that are equations of their own."""
        passings = self.ways.passings
        near = np.concatenate([kept, near[~np.isin(near, kept)]])
        if not len(near):
            return near
        rows, misses = self.equations(near)
        if len(self.matrix):
            rows = rows - np.linalg.lstsq(self.matrix.T, rows.T, rcond=1e-9)[0].T @ self.matrix
        hold = np.linalg.norm(rows, axis=1) * self.moves.unit
        moves = np.abs(misses) / np.maximum(hold, 1e-300)
        basis = np.zeros((0, rows.shape[1]))
        chosen: list[int] = []
        room = 2 * int(self.moves.free.sum()) - len(self.matrix)
        moves[: len(kept)] = 0.0
        order = np.argsort(moves, kind="stable")
        once = np.unique(passings.line[near[order]], axis=0, return_index=True)[1]
        for i in order[np.sort(once)]:
            if moves[i] > FARTHEST or (i >= len(kept) and len(chosen) >= room):
                break
            left = rows[i] - (basis @ rows[i]) @ basis
            size = float(np.linalg.norm(left))
            further = hold[i] > LEAST_HOLD and size * self.moves.unit > INDEPENDENT * hold[i]
            if further:
                basis = np.concatenate([basis, left[None] / size])
            if further or i < len(kept):
                chosen.append(int(near[i]))
        return np.array(chosen, dtype=np.int64)


class Connected:
    """A configuration and some passings of it that are to be none."""

    def __init__(self, base: Configuration, which: IntArray) -> None:
        self.base, self.which = base, which
        self.passings = base.ways.passings[which]

    @property
    def singularities(self) -> Places:
        """Where they are."""
        return self.base.singularities

    @property
    def turns(self) -> tuple[int, ...]:
        """None."""
        return (0,) * len(self.base.defects)

    @property
    def pairs(self) -> IntArray:
        """(p, 2) the singularities that are to be joined, the lower number of each two first."""
        return np.sort(self.passings.nodes, axis=1)

    @cached_property
    def equations(self) -> tuple[FloatArray, FloatArray]:
        """How the misses change with moves (p, 2 k), and those (p,), radians."""
        return self.base.equations(self.which)

    @property
    def worst(self) -> float:
        """The largest miss or defect, radians."""
        both = np.append(self.equations[1], self.base.defects)
        return float(np.abs(both).max(initial=0.0))

    @property
    def met(self) -> bool:
        """Whether no miss and no defect is one that counts."""
        return bool(self.worst < MET)

    def steps(self) -> Iterator[Connected]:
        """Yield this, and what Newton's method makes of it step by step."""
        at: Connected | None = self
        for _ in range(STEPS):
            if at is None:
                return
            yield at
            at = None if at.worst < EXACT else at.advance()

    def advance(self) -> Connected | None:
        """Take the least step that makes them none, or a part of it; None where none is good."""
        rows, misses = self.equations
        linear = np.concatenate([self.base.matrix, rows])
        right = -np.concatenate([self.base.defects, misses])
        before, found = float(np.linalg.norm(misses)), list[Connected]()

        def propose(more: FloatArray, gaps: FloatArray, share: float) -> FloatArray:
            return least_moves(np.concatenate([linear, more]), np.append(share * right, gaps))

        def accepted(step: Step) -> bool:
            there = self.followed(step.singularities, step.moves)
            if there is None or np.linalg.norm(there.equations[1]) > FALLS * before:
                return False
            found[:] = [there]
            return True

        step = self.base.moves.advance(self.singularities, propose, accepted)
        return found[0] if isinstance(step, Step) else None

    def followed(self, singularities: Places, moves: FloatArray) -> Connected | None:
        """Return the same after moves (k, 2); None if not all passings are found again."""
        base, passings = self.base.elsewhere(singularities), self.passings
        there = base.ways.passings
        expected = passings.offset + passings.length * (self.equations[0] @ moves.reshape(-1))
        which = np.zeros(len(passings), dtype=np.int64)
        for i, nodes in enumerate(passings.nodes):
            same = np.flatnonzero((there.nodes == nodes).all(axis=1))
            off = np.hypot(
                there.length[same] - passings.length[i], there.offset[same] - expected[i]
            )
            if off.min(initial=np.inf) > LOST * passings.length[i]:
                return None
            which[i] = same[np.argmin(off)]
        return Connected(base, which)


def _apart(one: int, other: int) -> SingularityError:
    return SingularityError(
        f"singularities {one + 1} and {other + 1} cannot be kept joined",
        f"no separatrix of one passes the other by less than {np.degrees(NEAR):.0f} degrees",
        "move them nearer to that, or let the connection go",
    )


def holding(
    pairs: Connections, levels: int = LEVELS
) -> Callable[[IsotropicSolver, ConstrainedMoves, Places], Connected]:
    """Return what `solvers.validity.improve` holds for singularities to stay joined.

    Parameters
    ----------
    pairs : tuple of (int, int)
        As of `solvers.layouts.join`, which has joined them.
    levels : int, optional
        Of refinement at the singularities.

    Returns
    -------
    callable
        From a solver, the moves that singularities may make, and where they are, to what is held.

    Examples
    --------
    Four valences 3 on a disk come to a square's corners, two of them joined all the while:

    >>> from solvers import run
    >>> from solvers.layouts import holding, join
    >>> from solvers.primitives import disk
    >>> from solvers.singularities import Singularity
    >>> from solvers.validity import improve
    >>> surface = disk(edge_length=0.1)
    >>> places = [[0.5, 0.03, 0], [0, 0.4, 0], [-0.5, 0, 0], [0, -0.5, 0]]
    >>> threes = [Singularity(surface.closest_point(place), 3) for place in places]
    >>> joined = run(join(surface, threes, ((0, 1),))).singularities
    >>> better = run(improve(surface, joined, hold=holding(((0, 1),))))
    >>> again = run(join(surface, better.singularities, ((0, 1),)))
    >>> again.singularities == better.singularities
    True
    """

    def hold(solver: IsotropicSolver, moves: ConstrainedMoves, at: Places) -> Connected:
        first = Configuration(solver, moves, levels, at)
        return Connected(first, first.between(pairs))

    return hold
