"""Where traces cross each other at right angles.

Two chords of a triangle cross if their ends alternate around it. The order of the ends along an
edge is settled once for both of its triangles, ties by the number of the trace, so that a crossing
on an edge or at a vertex is found in exactly one triangle.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solvers.layouts.charts import AXES, Chart, ComplexArray
from solvers.layouts.tracing import Chords
from solvers.surface.triangulation import BoolArray, FloatArray, IntArray


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
    """

    chord: IntArray
    trace: IntArray
    at: FloatArray

    def __len__(self) -> int:
        return len(self.chord)

    def __getitem__(self, chosen: IntArray | BoolArray) -> Crossings:
        return Crossings(self.chord[chosen], self.trace[chosen], self.at[chosen])

    @property
    def exchanged(self) -> Crossings:
        """The same with the two of each pair exchanged."""
        return Crossings(self.chord[:, ::-1], self.trace[:, ::-1], self.at[:, ::-1])


def crossings(chart: Chart, chords: Chords) -> Crossings:
    """Return all crossings at right angles of chords in the order `trace` returns them."""
    pairs = _pairs_in_faces(chords.face)
    pairs = pairs[(chords.axis[pairs[:, 0]] + chords.axis[pairs[:, 1]]) % 2 == 1]
    first, last = _places(chart, chords)
    low, high = np.minimum(first, last), np.maximum(first, last)
    a, b = pairs.T
    inside = [(low[a] < end[b]) & (end[b] < high[a]) for end in (first, last)]
    apart = np.ones(len(pairs), dtype=bool)
    for one in (first, last):
        for other in (first, last):
            apart &= one[a] != other[b]
    pairs = pairs[apart & (inside[0] != inside[1])]
    return Crossings(pairs, chords.trace[pairs], _lengths(chart, chords, pairs))


def _pairs_in_faces(face: IntArray) -> IntArray:
    """Return all pairs (p, 2) of different chords in one face, each once."""
    order = np.argsort(face, kind="stable")
    _, group, size = np.unique(face[order], return_inverse=True, return_counts=True)
    first = np.concatenate([[0], np.cumsum(size)])[:-1]
    rank = np.arange(len(face)) - first[group]
    after = size[group] - rank - 1
    a = np.repeat(np.arange(len(face)), after)
    b = a + 1 + np.arange(len(a)) - np.repeat(np.cumsum(after) - after, after)
    return np.stack([order[a], order[b]], axis=1)


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
