"""The motorcycle graph of traces: how far each is kept.

Traces that come to an end are kept whole. The others, limit cycles, stop where they first meet one
that was there before them, at right angles: all of them grow at one speed, as the motorcycles of
Eppstein et al. 2008.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solvers.layouts.crossings import Crossings
from solvers.layouts.tracing import BORDER, LENGTH, Traces
from solvers.surface.triangulation import BoolArray, FloatArray, IntArray

WHOLE = np.iinfo(np.int64).max
"""Rank beyond all crossings of a trace that nothing stops."""


@dataclass(frozen=True, eq=False)
class Stops:
    """How far each trace is kept.

    Parameters
    ----------
    kept : (k,) bool array
        False for those that another runs along the other way.
    at : (k,) float array
        Length in the map up to which each is kept; infinite if nothing stops it.
    rank : (k,) int array
        Rank of the crossing at which each is stopped; larger than any if nothing stops it.
    """

    kept: BoolArray
    at: FloatArray
    rank: IntArray

    @property
    def cut(self) -> BoolArray:
        """(k,) whether it stops at another, in a T-junction."""
        return self.rank < WHOLE


def stops(traces: Traces, crossings: Crossings, longest: float = np.inf) -> Stops:
    """Return how far each trace is kept.

    Parameters
    ----------
    traces, crossings
        The traces and where they cross.
    longest : float, optional
        Traces that are longer, in the map, stop at others even if they come to the boundary.
    """
    kept = ~doubled(traces)
    long = (traces.ends == BORDER) & (traces.lengths > longest)
    endless = ((traces.ends == LENGTH) | long) & kept
    at = np.where(endless, np.inf, traces.lengths)
    events = crossings[kept[crossings.trace].all(axis=1) & endless[crossings.trace].any(axis=1)]
    when = np.where(endless[events.trace], events.at, -1.0)
    later = np.where(
        when[:, 1] == when[:, 0], events.trace[:, 1] > events.trace[:, 0], when[:, 1] > when[:, 0]
    )
    rows, own = np.arange(len(events)), later.astype(np.int64)
    order = np.lexsort((events.rank[rows, own], when.max(axis=1)))
    one, other = (c[rows, which][order] for c in (events.trace,) for which in (own, 1 - own))
    rank_one, rank_other = (events.rank[rows, which][order] for which in (own, 1 - own))
    last = [WHOLE] * len(kept)
    events_in_order = (column.tolist() for column in (one, other, rank_one, rank_other))
    for number, (i, j, here, there) in enumerate(zip(*events_in_order, strict=True)):
        if here <= last[i] and there <= last[j]:
            last[i] = here
            at[i] = events.at[order[number], own[order[number]]]
    rank = np.array(last, dtype=np.int64)
    unstopped = np.isinf(at) & (traces.ends != LENGTH)
    at[unstopped] = traces.lengths[unstopped]
    return Stops(kept, at, rank)


def left_of(crossings: Crossings, stopped: Stops) -> Crossings:
    """Return the crossings of what is kept of traces."""
    left = stopped.kept[crossings.trace].all(axis=1)
    reached = (crossings.rank <= stopped.rank[crossings.trace]).all(axis=1)
    return crossings[np.flatnonzero(left & reached)]


def doubled(traces: Traces) -> BoolArray:
    """Return which traces run along another between two nodes, the other way."""
    back = traces.leading_back
    runs_along = np.zeros(len(back), dtype=bool)
    for i in np.flatnonzero(back >= 0):
        runs_along[back[i]] |= not runs_along[i] and back[i] != i
    return runs_along
