"""Whole numbers of quads for the arcs of a T-mesh, by mixed-integer programming.

Opposite sides of every rectangle get the same number, and arcs stay as near as possible to their
lengths in units of the edge length, in the sum of absolute deviations. Arcs may get none where
topology and singularities stay what they are. Nothing depends on a clock.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from solvers.errors import CrossviewError, SolveError
from solvers.layouts.tmesh import TMesh
from solvers.number_checks import real_number, whole_number
from solvers.quads.collapse import Condition
from solvers.quads.integer_program import Total
from solvers.quads.separation import Separation
from solvers.surface.triangulation import FloatArray, IntArray

MOST_QUADS = 2_000_000
"""More are not asked for but by a slip of the pen. Chosen."""

NEAR_ENOUGH = 0.01
"""Relative distance from a wanted number of quads at which the secant ends. Chosen."""

TOLERANCE = 0.02
"""Relative distance from a wanted number of quads up to which counts are taken. Chosen."""

MISSED = 0.05
"""Relative distance from a wanted number of quads that is told.

Chosen: nearer ones are no other mesh, and looking for them takes seconds.
"""

MOST_TRIALS = 4
"""Edge lengths at most for which whole counts are looked for. Chosen."""

MOST_STEPS = 12
"""Steps of the secant that finds an edge length by fractional counts. Chosen."""

DESCENTS = 4
"""Steps towards a number of quads that is linear in the counts near the best. Chosen."""


@dataclass(frozen=True, eq=False)
class Quantization:
    """Whole numbers of quads along the arcs of a T-mesh.

    Parameters
    ----------
    counts : (A,) int array
        Edges of quads along each arc.
    edge_length : float
        What they are near to, in units of the map.
    n_quads : int
        Number of quads that the counts give.
    deviation : float
        Sum of the distances of the arcs' counts from lengths / edge length.
    n_wanted : int, optional
        Number of quads that was wanted, if one was.
    n_fewest : int, optional
        About the fewest quads that there can be, where fewer than found were wanted.

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
    >>> chosen.counts.tolist()
    [3, 1, 3, 1]
    >>> round(chosen.deviation, 6) == round(2 * (3 - 2 / 0.7) + 2 * (1 / 0.7 - 1), 6)
    True
    """

    counts: IntArray
    edge_length: float
    n_quads: int
    deviation: float
    n_wanted: int | None = None
    n_fewest: int | None = None

    @property
    def missed(self) -> bool:
        """Whether a number was wanted and is missed by more than `MISSED` of it."""
        return self.n_wanted is not None and _missed(self, self.n_wanted) > MISSED


def quantize(
    tmesh: TMesh, edge_length: float, *, conditions: Sequence[Condition] = ()
) -> Quantization:
    """Return counts nearest to the arcs' lengths.

    Parameters
    ----------
    tmesh : TMesh
        The rectangles.
    edge_length : float
        Wanted length of the quads' edges, in units of the map.
    conditions : sequence of Condition, optional
        What counts are to meet besides topology and singularities.

    Returns
    -------
    Quantization
        The same number on opposite sides of every rectangle.

    Raises
    ------
    CrossviewError
        If the edge length is not positive, or makes more than `MOST_QUADS` quads.
    SolveError
        If no counts were found.

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
    number = float(tmesh.area) / edge_length / edge_length  # no square underflows
    if number > MOST_QUADS:
        raise CrossviewError(
            f"edges of {edge_length:.3g} make {number:.3g} quads",
            f"at most {MOST_QUADS:.3g}",
            "choose longer edges",
        )
    return _nearest(tmesh, edge_length, Separation(tmesh, conditions))


def quantize_to(
    tmesh: TMesh, n_quads: int, *, conditions: Sequence[Condition] = ()
) -> Quantization:
    """Return counts whose number of quads is near to a wanted one, by a few programs.

    Parameters
    ----------
    tmesh : TMesh
        The rectangles.
    n_quads : int
        Wanted number of quads.
    conditions : sequence of Condition, optional
        What counts are to meet besides topology and singularities.

    Returns
    -------
    Quantization
        With the edge length that makes them, in units of the map. There are more quads than
        wanted where fewer do not keep topology, singularities and conditions; then the fewest are
        told, too.

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
    separation = Separation(tmesh, conditions)
    best = _by_length(tmesh, n_quads, separation)
    if _missed(best, n_quads) > MISSED:
        best = _by_total(best, tmesh, n_quads, separation)
    fewest = None
    if best.n_quads > (1 + MISSED) * n_quads:
        starts = (best, _longest(tmesh, separation))
        tried = [best, *(_descended(start, tmesh, separation) for start in starts)]
        best = min(tried, key=lambda found: _missed(found, n_quads))
        fewest = min(found.n_quads for found in tried)
    return replace(best, n_wanted=n_quads, n_fewest=fewest)


def fewest_quads(tmesh: TMesh, *, conditions: Sequence[Condition] = ()) -> Quantization:
    """Return counts with about the fewest quads that there can be.

    Parameters
    ----------
    tmesh : TMesh
        The rectangles.
    conditions : sequence of Condition, optional
        What counts are to meet besides topology and singularities.

    Returns
    -------
    Quantization
        Near to an edge length so large that no arc asks for an edge.

    Raises
    ------
    SolveError
        As of `quantize`.

    Notes
    -----
    The number is bilinear in the counts: a few programs, each linear near what the last one gave,
    that only go down. There may be fewer still.

    Examples
    --------
    A rectangle of 2 by 1, as in `solvers.layouts.TMesh`:

    >>> import numpy as np
    >>> from solvers.layouts import TMesh
    >>> from solvers.quads import fewest_quads
    >>> every, ends = np.ones(4, dtype=bool), np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
    >>> lengths, sides = np.array([2.0, 1.0, 2.0, 1.0]), 2 * np.arange(4)
    >>> tmesh = TMesh(ends, lengths, every, np.full(4, 2), every, every, np.arange(5), sides)
    >>> fewest_quads(tmesh).n_quads
    1
    """
    separation = Separation(tmesh, conditions)
    return _descended(_longest(tmesh, separation), tmesh, separation)


def number_of_quads(tmesh: TMesh, counts: IntArray) -> int:
    """Return how many quads fill the rectangles, given the counts (A,) of the arcs."""
    sides = np.rint(tmesh.side_totals(counts.astype(float)))
    return int((sides[:, 0] * sides[:, 1]).sum())


def _by_length(tmesh: TMesh, n_quads: int, separation: Separation) -> Quantization:
    """Return the best of counts near to several edge lengths."""
    aim, length, tried = float(n_quads), float(np.sqrt(tmesh.area / n_quads)), []
    for _ in range(MOST_TRIALS):
        length = _length_for(tmesh, aim, length, separation)
        tried.append(_nearest(tmesh, length, separation))
        if _missed(tried[-1], n_quads) <= TOLERANCE:
            break
        aim *= n_quads / tried[-1].n_quads
        length *= float(np.sqrt(tried[-1].n_quads / n_quads))
    return min(tried, key=lambda found: _missed(found, n_quads))


def _length_for(tmesh: TMesh, n_quads: float, start: float, separation: Separation) -> float:
    """Return the edge length near to which fractional counts make a number of quads."""
    length, low, high = start, 0.0, np.inf
    for _ in range(MOST_STEPS):
        counts = separation.fractional(tmesh.lengths / length)
        if counts is None:
            break
        sides = tmesh.side_totals(counts)
        number = float((sides[:, 0] * sides[:, 1]).sum())
        too_many = number > n_quads
        if abs(number / n_quads - 1) <= NEAR_ENOUGH or (too_many and length > tmesh.lengths.sum()):
            break
        low, high = (length, high) if too_many else (low, length)
        # The number goes with the inverse square; where that leads out of the bounds, halve.
        length *= float(np.sqrt(number / n_quads))
        if length <= low or length >= high:
            length = float(np.sqrt(low * high)) if low > 0 else 0.5 * high
    return length


def _by_total(
    best: Quantization, tmesh: TMesh, n_quads: int, separation: Separation
) -> Quantization:
    """Return counts nearer to a wanted number: nearest under a number linear near the best."""
    wanted = tmesh.lengths / best.edge_length
    for _ in range(DESCENTS):
        slope = _slope(tmesh, best.counts)
        # n_quads is of second degree: its value at the best is half of its slope's there.
        aim, slack = n_quads + best.n_quads, 0.5 * TOLERANCE * n_quads
        total = Total(slope, aim - slack, aim + slack)
        counts = separation.nearest(wanted, total=total)
        if counts is None:
            break
        found = _quantization(tmesh, counts, best.edge_length)
        if _missed(found, n_quads) >= _missed(best, n_quads):
            break
        best = found
        if _missed(best, n_quads) <= TOLERANCE:
            break
    return best


def _longest(tmesh: TMesh, separation: Separation) -> Quantization:
    """Return counts near to an edge length so large that no arc asks for an edge."""
    return _nearest(tmesh, float(tmesh.lengths.sum()), separation)


def _descended(best: Quantization, tmesh: TMesh, separation: Separation) -> Quantization:
    """Return counts with fewer quads, each the least of a number that is linear near the last."""
    for _ in range(DESCENTS):
        wanted = tmesh.lengths / best.edge_length
        counts = separation.nearest(wanted, 1e-3 + _slope(tmesh, best.counts))
        if counts is None or number_of_quads(tmesh, counts) >= best.n_quads:
            break
        best = _quantization(tmesh, counts, best.edge_length)
    return best


def _slope(tmesh: TMesh, counts: IntArray) -> FloatArray:
    """Return the derivatives (A,) of the number of quads by the counts.

    Either of two opposite sides has half of it.
    """
    sides = tmesh.side_totals(counts.astype(float))
    across = 0.5 * sides[:, [1, 0, 1, 0]].reshape(-1)
    repeated = np.repeat(across, np.diff(tmesh.side_offsets))
    return np.asarray(np.bincount(tmesh.side_halfarcs // 2, repeated, tmesh.n_arcs), dtype=float)


def _nearest(tmesh: TMesh, edge_length: float, separation: Separation) -> Quantization:
    counts = separation.nearest(tmesh.lengths / edge_length)
    if counts is None:
        raise SolveError("no numbers of quads were found for the arcs of the layout")
    return _quantization(tmesh, counts, edge_length)


def _missed(found: Quantization, n_quads: int) -> float:
    """Return by how much a wanted number is missed, relative to it."""
    return abs(found.n_quads - n_quads) / n_quads


def _quantization(tmesh: TMesh, counts: IntArray, edge_length: float) -> Quantization:
    deviation = float(np.abs(counts - tmesh.lengths / edge_length).sum())
    return Quantization(counts, edge_length, number_of_quads(tmesh, counts), deviation)
