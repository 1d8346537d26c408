"""Whole numbers of quads for the arcs of a T-mesh, by mixed-integer programming.

Opposite sides of every rectangle get the same number. The arcs stay as near as possible to their
lengths in units of the edge length, and so do the offsets between nodes that nearly face another
across a rectangle, where lines of quads would slant; both in the sum of absolute deviations. The
arcs alone make a minimum-cost flow through the rectangles, so branching has little to do.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_array, vstack

from solvers.errors import CrossviewError, SolveError
from solvers.layouts.tmesh import TMesh
from solvers.number_checks import real_number, whole_number
from solvers.quads.collapse import CuttingPlane
from solvers.quads.cutting_planes import greedy_counts, separated_counts
from solvers.quads.integer_program import arcs_alone, offsets
from solvers.surface.triangulation import IntArray

MOST_QUADS = 2_000_000
"""More are not asked for but by a slip of the pen. Chosen."""

NEAR_ENOUGH = 0.01
"""Relative distance from a wanted number of quads at which looking further ends. Chosen."""

FAR = 1.5
"""So many times the wanted number, found twice, is the least that there is. Chosen."""

STRAIGHTENING = 0.2
"""Share of the time limit for counts that are nearest with `offsets`, besides those without.

Chosen.
"""

MOST_TRIALS = 8
"""Programs solved at most for a wanted number of quads. Chosen."""


@dataclass(frozen=True, eq=False)
class Quantization:
    """Whole numbers of quads along the arcs of a T-mesh.

    Parameters
    ----------
    counts : (A,) int array
        Edges of quads along each arc.
    edge_length : float
        What was asked for, in units of the map.
    n_quads : int
        Number of quads that the counts give.
    deviation : float
        Sum of the distances of the arcs' counts, and of `offsets`, from what lengths / edge
        length make of them.
    optimal : bool
        False if time was up before the counts were known to be the best.

    Examples
    --------
    A rectangle of 2 by 1, as in `solvers.layouts.TMesh`; no whole number is 1 / 0.7 or 2 / 0.7:

    >>> import numpy as np
    >>> from solvers.layouts import TMesh
    >>> from solvers.quads import quantize
    >>> every, ends = np.ones(4, dtype=bool), np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
    >>> lengths, sides = np.array([2.0, 1.0, 2.0, 1.0]), 2 * np.arange(4)
    >>> tmesh = TMesh(ends, lengths, every, np.full(4, 2), every, every, np.arange(5), sides)
    >>> chosen = quantize(tmesh, 0.7)
    >>> chosen.counts.tolist(), chosen.optimal
    ([3, 1, 3, 1], True)
    >>> round(chosen.deviation, 6) == round(2 * (3 - 2 / 0.7) + 2 * (1 / 0.7 - 1), 6)
    True
    """

    counts: IntArray
    edge_length: float
    n_quads: int
    deviation: float
    optimal: bool


def quantize(
    tmesh: TMesh, edge_length: float, *, collapse: bool = False, time_limit: float = 10.0
) -> Quantization:
    """Return the counts nearest to the arcs' lengths, at least 1 each.

    Parameters
    ----------
    tmesh : TMesh
        The rectangles.
    edge_length : float
        Wanted length of the quads' edges, in units of the map.
    collapse : bool, optional
        Let short arcs have no edge where topology and singularities stay what they are; curves
        that nearly coincide become one.
    time_limit : float, optional
        Seconds after which the best counts found are taken.

    Returns
    -------
    Quantization
        The same number on opposite sides of every rectangle.

    Raises
    ------
    CrossviewError
        If the edge length is not positive, or makes more than `MOST_QUADS` quads.
    SolveError
        If time was up before any counts were found.

    Examples
    --------
    A rectangle of 2 by 1, as in `solvers.layouts.TMesh`:

    >>> import numpy as np
    >>> from solvers.layouts import TMesh
    >>> from solvers.quads import quantize
    >>> every, ends = np.ones(4, dtype=bool), np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
    >>> lengths, sides = np.array([2.0, 1.0, 2.0, 1.0]), 2 * np.arange(4)
    >>> tmesh = TMesh(ends, lengths, every, np.full(4, 2), every, every, np.arange(5), sides)
    >>> chosen = quantize(tmesh, edge_length=0.5)
    >>> chosen.counts.tolist(), chosen.n_quads
    ([4, 2, 4, 2], 8)
    """
    edge_length = real_number("the edge length", edge_length, above=0)
    time_limit = real_number("the time limit", time_limit, 0)
    number = float(tmesh.area) / edge_length / edge_length  # no square underflows
    if number > MOST_QUADS:
        raise CrossviewError(
            f"edges of {edge_length:.3g} make {number:.3g} quads",
            f"at most {MOST_QUADS:.3g}",
            "choose longer edges",
        )
    cuts: list[CuttingPlane] = []
    found = _nearest(tmesh, edge_length, collapse, time_limit, cuts)
    return _straightened(found, tmesh, collapse, STRAIGHTENING * time_limit, cuts)


def quantize_to(
    tmesh: TMesh, n_quads: int, *, collapse: bool = False, time_limit: float = 10.0
) -> Quantization:
    """Return the counts whose number of quads is nearest to a wanted one, by a few programs.

    Parameters
    ----------
    tmesh : TMesh
        The rectangles.
    n_quads : int
        Wanted number of quads.
    collapse : bool, optional
        Let short arcs have no edge, as in `quantize`.
    time_limit : float, optional
        Seconds after which the best counts found are taken.

    Returns
    -------
    Quantization
        With the edge length that makes them, in units of the map.

    Raises
    ------
    CrossviewError
        If fewer than one or more than `MOST_QUADS` quads are wanted.
    SolveError
        As of `quantize`.

    Examples
    --------
    A rectangle of 2 by 1, as in `solvers.layouts.TMesh`:

    >>> import numpy as np
    >>> from solvers.layouts import TMesh
    >>> from solvers.quads import quantize_to
    >>> every, ends = np.ones(4, dtype=bool), np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
    >>> lengths, sides = np.array([2.0, 1.0, 2.0, 1.0]), 2 * np.arange(4)
    >>> tmesh = TMesh(ends, lengths, every, np.full(4, 2), every, every, np.arange(5), sides)
    >>> chosen = quantize_to(tmesh, 200)
    >>> chosen.counts.tolist(), round(chosen.edge_length, 6)
    ([20, 10, 20, 10], 0.1)
    """
    n_quads = whole_number("the number of quads", n_quads, 1, MOST_QUADS)
    length = np.sqrt(tmesh.area / n_quads)
    low, high = 0.0, np.inf
    end = time.monotonic() + time_limit
    cuts: list[CuttingPlane] = []
    best = found = _nearest(tmesh, float(length), collapse, time_limit, cuts)
    for _ in range(MOST_TRIALS - 1):
        left = end - time.monotonic()
        if abs(best.n_quads - n_quads) <= NEAR_ENOUGH * n_quads or left < 0.1 * time_limit:
            break
        low, high = (length, high) if found.n_quads > n_quads else (low, length)
        before = found.n_quads
        # The number goes with the inverse square; where that leads out of the bounds, halve.
        length = length * np.sqrt(found.n_quads / n_quads)
        if length <= low or length >= high:
            length = np.sqrt(low * high)
        try:
            found = _nearest(tmesh, float(length), collapse, left, cuts)
        except SolveError:
            break
        if abs(found.n_quads - n_quads) < abs(best.n_quads - n_quads):
            best = found
        if found.n_quads == before > FAR * n_quads:
            break  # there are no fewer
    straight = _straightened(best, tmesh, collapse, STRAIGHTENING * time_limit, cuts)
    off = max(abs(best.n_quads - n_quads), NEAR_ENOUGH * n_quads)
    return straight if abs(straight.n_quads - n_quads) <= off else best


def number_of_quads(tmesh: TMesh, counts: IntArray) -> int:
    """Return how many quads fill the rectangles, given the counts (A,) of the arcs."""
    sides = np.rint(tmesh.side_totals(counts.astype(float)))
    return int((sides[:, 0] * sides[:, 1]).sum())


def _nearest(
    tmesh: TMesh, edge_length: float, collapse: bool, time_limit: float, cuts: list[CuttingPlane]
) -> Quantization:
    """Return counts near to the arcs' lengths alone; conditions found on the way join `cuts`."""
    wanted, half = tmesh.lengths / edge_length, 0.5 * time_limit
    counts, optimal = separated_counts(tmesh, wanted, arcs_alone(tmesh), collapse, half, cuts)
    if counts is None:
        counts = greedy_counts(tmesh, wanted, collapse, half, cuts)
    if counts is None and collapse:
        return _nearest(tmesh, edge_length, False, time_limit, [])
    if counts is None:
        raise SolveError(
            "no numbers of quads were found for the arcs of the layout",
            f"within {time_limit:g} s",
            "choose shorter edges",
        )
    return _quantization(tmesh, counts, edge_length, optimal)


def _straightened(
    found: Quantization, tmesh: TMesh, collapse: bool, time_limit: float, cuts: list[CuttingPlane]
) -> Quantization:
    """Return counts that are nearest with `offsets`, too, if there are any in time."""
    across = offsets(tmesh)
    if across.shape[0] == 0:
        return found
    measured = csr_array(vstack([arcs_alone(tmesh), across]))
    wanted = tmesh.lengths / found.edge_length
    counts, optimal = separated_counts(tmesh, wanted, measured, collapse, time_limit, cuts)
    if counts is not None:
        straight = _quantization(tmesh, counts, found.edge_length, optimal)
        if straight.deviation <= found.deviation:
            return straight
    return replace(found, optimal=False)


def _quantization(
    tmesh: TMesh, counts: IntArray, edge_length: float, optimal: bool
) -> Quantization:
    off = counts - tmesh.lengths / edge_length
    total = float(np.abs(off).sum() + np.abs(offsets(tmesh) @ off).sum())
    return Quantization(counts, edge_length, number_of_quads(tmesh, counts), total, optimal)
