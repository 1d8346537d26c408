"""Counts for arcs that make a mesh: where the nearest ones break it, an arc gets one edge more."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from solvers.layouts.tmesh import TMesh
from solvers.quads.collapse import Condition, broken, least_counts
from solvers.quads.integer_program import WHOLE, Program, Total, balances
from solvers.surface.triangulation import FloatArray, IntArray

MOST_ROUNDS = 1_000
"""How often bounds are raised. Chosen: a few dozen were the most seen."""


class Separation:
    """Finds counts that make a mesh of a T-mesh, near to any that are wanted.

    What the nearest counts break becomes a condition; of each broken condition the arc that falls
    short most gets one edge more at least. Bounds of single arcs keep the program a flow, which
    conditions as rows would not. Conditions that hold for all lengths are kept for later calls.

    Parameters
    ----------
    tmesh : TMesh
        The rectangles.
    conditions : sequence of Condition
        What else counts are to meet.
    """

    def __init__(self, tmesh: TMesh, conditions: Sequence[Condition] = ()) -> None:
        self._tmesh = tmesh
        self._balance, self._least = balances(tmesh), least_counts(tmesh)
        for condition in conditions:
            if len(condition.arcs) == 1:
                arc = condition.arcs[0]
                self._least[arc] = max(self._least[arc], condition.least)
        self._conditions = [c for c in conditions if len(c.arcs) > 1]

    def nearest(
        self,
        wanted: FloatArray,
        weights: FloatArray | None = None,
        total: Total | None = None,
    ) -> IntArray | None:
        """Return counts (A,) near to wanted ones that make a mesh, or None if none were found.

        Parameters
        ----------
        wanted : (A,) float array
            Where counts are to be near to.
        weights : (A,) float array, optional
            Of the distances; 1 each by default.
        total : Total, optional
            A further condition.
        """
        program = Program(wanted, self._balance, self._least, weights, total)
        for _ in range(MOST_ROUNDS):
            program, fractional = self._relaxed(program)
            counts = None if fractional is None else program.whole(fractional)
            if counts is None:
                return None
            failed = self._failed(counts)
            if not failed:
                failed = broken(self._tmesh, counts)
                self._conditions += [c for c in failed if c.least == 1]
            if not failed:
                return counts
            program = _raised(program, counts, failed)
        return None

    def fractional(self, wanted: FloatArray) -> FloatArray | None:
        """Return counts (A,), whole or not, near to wanted ones and under what is known so far."""
        return self._relaxed(Program(wanted, self._balance, self._least))[1]

    def _relaxed(self, program: Program) -> tuple[Program, FloatArray | None]:
        """Return the program with bounds under which its fractional optimum fails nothing known."""
        for _ in range(MOST_ROUNDS):
            found = program.fractional()
            failed = [] if found is None else self._failed(found)
            if found is None or not failed:
                break
            program = _raised(program, found, failed)
        return program, found

    def _failed(self, counts: FloatArray | IntArray) -> list[Condition]:
        return [c for c in self._conditions if counts[c.arcs].sum() < c.least - WHOLE]


def _raised(
    program: Program, counts: FloatArray | IntArray, failed: Sequence[Condition]
) -> Program:
    """Return a program where of each failed condition one arc gets more edges than in counts."""
    least, short = program.least.copy(), program.wanted - counts
    for condition in failed:
        arc = condition.arcs[np.argmax(short[condition.arcs])]
        least[arc] = max(least[arc], np.floor(counts[arc] + WHOLE) + 1)
    return replace(program, least=least)
