"""Counts for arcs that make a mesh, by cutting planes: what they break becomes one more."""

from __future__ import annotations

import time

import numpy as np
from scipy.sparse import csr_array

from solvers.layouts.tmesh import TMesh
from solvers.quads.collapse import CuttingPlane, broken, least_counts
from solvers.quads.integer_program import arcs_alone, balances, nearest_counts
from solvers.surface.triangulation import FloatArray, IntArray

MOST_ROUNDS = 40
"""How often what the nearest counts break is ruled out, before longest arcs get an edge. Chosen."""


def separated_counts(
    tmesh: TMesh,
    wanted: FloatArray,
    measured: csr_array,
    collapse: bool,
    time_limit: float,
    cuts: list[CuttingPlane],
) -> tuple[IntArray | None, bool]:
    """Return the nearest counts that make a mesh, if any in time, and whether they surely are.

    Whatever the nearest counts break becomes a condition, until they break nothing.

    Parameters
    ----------
    tmesh : TMesh
        The rectangles.
    wanted : (A,) float array
        Where counts are to be near to.
    measured : (k, A) sparse array
        The combinations whose deviations are summed.
    collapse : bool
        Whether arcs may do without edges.
    time_limit : float
        Seconds.
    cuts : list of CuttingPlane
        Conditions known; those found that hold for all lengths join them.
    """
    balance, least = balances(tmesh), least_counts(tmesh, collapse=collapse)
    end = time.monotonic() + time_limit
    ruled = list(cuts)
    for _ in range(MOST_ROUNDS):
        left = end - time.monotonic()
        if left <= 0:
            break
        counts, optimal = nearest_counts(wanted, measured, balance, least, ruled, left)
        if counts is None:
            break
        found = broken(tmesh, counts)
        if not found:
            return counts, optimal
        ruled += found
        cuts += [cut for cut in found if cut.least == 1]
    return None, False


def greedy_counts(
    tmesh: TMesh, wanted: FloatArray, collapse: bool, time_limit: float, cuts: list[CuttingPlane]
) -> IntArray | None:
    """Return counts that make a mesh, if any in time, though not the nearest.

    The longest arc of every condition gets an edge, so that no program needs much branching.

    Parameters
    ----------
    tmesh : TMesh
        The rectangles.
    wanted : (A,) float array
        Where counts are to be near to.
    collapse : bool
        Whether arcs may do without edges.
    time_limit : float
        Seconds for each program.
    cuts : list of CuttingPlane
        Conditions known.
    """
    balance, least = balances(tmesh), least_counts(tmesh, collapse=collapse)
    ruled = list(cuts)
    for _ in range(tmesh.n_arcs):  # each time another arc gets an edge
        longest = [cut.arcs[np.argmax(wanted[cut.arcs])] for cut in ruled]
        least[longest] = np.maximum(least[longest], 1)
        counts, _ = nearest_counts(wanted, arcs_alone(tmesh), balance, least, ruled, time_limit)
        found = [] if counts is None else broken(tmesh, counts)
        if not found:
            return counts
        ruled += found
    return None
