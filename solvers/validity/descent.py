"""Descent on the unevenness of sizes, along directions that leave every condition as it is."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Protocol

import numpy as np

from solvers.fields.isotropic import IsotropicSolver
from solvers.singularities.budget import Singularity
from solvers.surface.triangulation import FloatArray
from solvers.validity.constrained_moves import (
    LONGEST_STEP,
    ConstrainedMoves,
    Step,
    least_moves,
    rotations,
)
from solvers.validity.search import TOLERANCE
from solvers.validity.unevenness import Sizes, Unevenness

Places = tuple[Singularity, ...]

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


class Held(Protocol):
    """Further equations that are met at the start and stay so."""

    @property
    def singularities(self) -> Places:
        """Where they are."""

    @property
    def equations(self) -> tuple[FloatArray, FloatArray]:
        """How what is left of them changes with moves (p, 2 k), and that (p,)."""

    @property
    def met(self) -> bool:
        """Whether nothing is left of them that counts."""

    def followed(self, singularities: Places, moves: FloatArray) -> Held | None:
        """Return the same after moves (k, 2); None if they are lost."""

    def steps(self) -> Iterator[Held]:
        """Yield this, and what Newton's method makes of it step by step."""


Hold = Callable[[IsotropicSolver, ConstrainedMoves, Places], Held]
"""From a valid configuration on a surface to what is to be held of it."""


class Descent:
    """Limited memory quasi-Newton steps on one surface from one valid configuration."""

    def __init__(
        self,
        moves: ConstrainedMoves,
        unevenness: Unevenness,
        singularities: Places,
        held: Held | None,
    ) -> None:
        self._guide, self._unevenness, self._moves = moves.guide, unevenness, moves
        self._memory: list[tuple[FloatArray, FloatArray]] = []
        self._in_vain = 0
        self._at(singularities, unevenness.sizes(singularities), held)

    def _at(self, singularities: Places, sizes: Sizes, held: Held | None) -> None:
        self.singularities, self.sizes, self.held = singularities, sizes, held
        self.defects = self._guide.defects(singularities)
        self._slope = self._unevenness.gradient(sizes) * self._moves.free[:, None]
        gradients = self._guide.gradients([s.point for s in singularities])
        self._matrix, self._left = self._moves.by_moves(gradients), self.defects
        if held is not None:
            rows, left = held.equations
            self._matrix = np.concatenate([self._matrix, rows])
            self._left = np.concatenate([self.defects, left])

    def advance(self) -> bool:
        """Take a step; return whether to go on."""
        before, slope = self.sizes.variance, self._slope
        found: list[tuple[Places, FloatArray, Sizes, Held | None]] = []

        def propose(rows: FloatArray, gaps: FloatArray, share: float) -> FloatArray:
            both = np.concatenate([self._matrix, rows])
            right = np.concatenate([-self._left, gaps])
            return share * self._downhill(both) + least_moves(both, right)

        def accepted(step: Step) -> bool:
            at, turns = self._corrected(step)
            if np.abs(self._guide.defects(at)).max(initial=0.0) > TOLERANCE:
                return False
            sizes = self._unevenness.sizes(at)
            promised = min(float((slope * step.moves).sum()), 0.0)
            if sizes.variance >= before + ARMIJO * promised:
                return False
            held = None if self.held is None else self.held.followed(at, step.moves)
            found[:] = [(at, turns, sizes, held)]
            return held is not None or self.held is None

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
        at, turns, sizes, held = found[0]
        carried = rotations(turns)
        self._memory = [
            (_turned(carried, s), _turned(carried, y)) for s, y in self._memory[1 - MEMORY :]
        ]
        self._at(at, sizes, held)
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
