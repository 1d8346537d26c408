"""Where traces cross each other at right angles.

Two chords of a triangle cross if their ends alternate around it. The order of the ends along an
edge is settled once for both of its triangles, ties by the number of the trace, so that a crossing
on an edge or at a vertex is found in exactly one triangle. In which order a chord crosses others
follows from the order of their ends as well, however close they are.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from solvers.layouts.charts import AXES, Chart, ComplexArray
from solvers.layouts.tracing import Chords
from solvers.surface.triangulation import BoolArray, FloatArray, IntArray

AT_ONCE = 1_000_000
"""Pairs of chords that are looked at together, for memory's sake. Chosen."""


@dataclass(frozen=True, eq=False)
class Crossings:
    """Pairs of chords that cross at right angles.

    Parameters
    ----------
    chord : (x, 2) int array
        The two chords.
    trace : (x, 2) int array
        Their traces; may be the same.
    at : (x, 2) float array
        Length of each trace up to the crossing, in the map.
    rank : (x, 2) int array
        Orders the crossings along each trace, also where lengths are alike.
    """

    chord: IntArray
    trace: IntArray
    at: FloatArray
    rank: IntArray

    def __len__(self) -> int:
        return len(self.chord)

    def __getitem__(self, chosen: IntArray | BoolArray) -> Crossings:
        return Crossings(self.chord[chosen], self.trace[chosen], self.at[chosen], self.rank[chosen])

    @property
    def exchanged(self) -> Crossings:
        """The same with the two of each pair exchanged."""
        return Crossings(
            self.chord[:, ::-1], self.trace[:, ::-1], self.at[:, ::-1], self.rank[:, ::-1]
        )


def crossings(chart: Chart, chords: Chords) -> Crossings:
    """Return all crossings at right angles of chords in the order `trace` returns them."""
    first, last = _places(chart, chords)
    low, high = np.minimum(first, last), np.maximum(first, last)
    found = [np.empty((0, 2), dtype=np.int64)]
    for pairs in _pairs_at_right_angles(chords):
        a, b = pairs.T
        inside = [(low[a] < end[b]) & (end[b] < high[a]) for end in (first, last)]
        apart = np.ones(len(pairs), dtype=bool)
        for one in (first, last):
            for other in (first, last):
                apart &= one[a] != other[b]
        found.append(pairs[apart & (inside[0] != inside[1])])
    pairs = np.concatenate(found)
    rank = _ranks(first, last, 3 * (len(chords) + 2), pairs)
    return Crossings(pairs, chords.trace[pairs], _lengths(chart, chords, pairs), rank)


def _pairs_at_right_angles(chords: Chords) -> Iterator[IntArray]:
    """Yield all pairs (p, 2) of chords at right angles in one face, each once."""
    even, odd = (
        chosen[np.argsort(chords.face[chosen], kind="stable")]
        for chosen in (np.flatnonzero(chords.axis % 2 == parity) for parity in (0, 1))
    )
    face = chords.face[odd]
    first = np.searchsorted(face, chords.face[even], side="left")
    count = np.searchsorted(face, chords.face[even], side="right") - first
    total = np.concatenate([[0], np.cumsum(count)])
    low = 0
    while low < len(even):
        high = max(int(np.searchsorted(total, total[low] + AT_ONCE, side="right")) - 1, low + 1)
        some = count[low:high]
        within = np.arange(total[high] - total[low]) - np.repeat(total[low:high] - total[low], some)
        yield np.column_stack(
            [np.repeat(even[low:high], some), odd[np.repeat(first[low:high], some) + within]]
        )
        low = high


def _ranks(first: IntArray, last: IntArray, around: int, pairs: IntArray) -> IntArray:
    """Return numbers (x, 2) that order the crossings on each chord, and chords, along a trace."""
    chord = pairs.T.reshape(-1)
    other = pairs[:, ::-1].T.reshape(-1)
    # To its right a chord has one end of each that it crosses, in the order it crosses them.
    reach = (last[chord] - first[chord]) % around
    ends = [(end[other] - first[chord]) % around for end in (first, last)]
    on_right = np.where(ends[0] < reach, *ends)
    rank = np.empty(len(chord), dtype=np.int64)
    rank[np.lexsort((on_right, chord))] = np.arange(len(chord))
    return rank.reshape(2, -1).T


def _places(chart: Chart, chords: Chords) -> tuple[IntArray, IntArray]:
    """Return where around its triangle each chord enters and leaves: numbers to be compared."""
    twin = chart.triangulation.twin
    out = 3 * chords.face + chords.side_out
    lower = (twin[out] < 0) | (out < twin[out])
    edge = np.where(lower, out, twin[out])
    along = np.where(lower, chords.t_out, 1 - chords.t_out)
    n = len(chords)
    rank = np.empty(n, dtype=np.int64)
    rank[np.lexsort((np.arange(n), chords.trace, along, edge))] = np.arange(n) + 1
    size = n + 2
    leaves = size * chords.side_out + np.where(lower, rank, size - rank)
    leaves[chords.corner_out] = size * chords.side_out[chords.corner_out]
    # A chord enters where the one before it left, seen from the other side.
    before = np.arange(n) - 1
    enters = size * chords.side_in + np.where(lower[before], size - rank[before], rank[before])
    enters[chords.corner_in] = size * chords.side_in[chords.corner_in]
    return enters, leaves


def ends_of(chart: Chart, chords: Chords) -> tuple[ComplexArray, ComplexArray]:
    """Return the images (c,) of where chords enter and leave, in their triangles' frames."""

    def place(side: IntArray, t: FloatArray) -> ComplexArray:
        tail = chart.corners[chords.face, side]
        return np.asarray(tail + t * (chart.corners[chords.face, (side + 1) % 3] - tail))

    return place(chords.side_in, chords.t_in), place(chords.side_out, chords.t_out)


def _lengths(chart: Chart, chords: Chords, pairs: IntArray) -> FloatArray:
    """Return the lengths (x, 2) of the two traces up to their crossing."""
    place = ends_of(chart, chords)[0]
    at = []
    for one, other in ((0, 1), (1, 0)):
        a, b = pairs[:, one], pairs[:, other]
        ahead = ((place[b] - place[a]) * AXES[chords.axis[a]].conj()).real
        at.append(np.clip(chords.start[a] + ahead, chords.start[a], chords.end[a]))
    return np.stack(at, axis=1)
