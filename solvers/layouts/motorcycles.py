"""The motorcycle graph of traces: how far each is kept.

Traces that come to an end are kept whole. The others, limit cycles, stop where they first meet one
that was there before them, at right angles: all of them grow at one speed, as the motorcycles of
Eppstein et al. 2008.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solvers.layouts.crossings import Crossings
from solvers.layouts.tracing import BORDER, LENGTH, NODE, Traces
from solvers.surface.triangulation import BoolArray, FloatArray


@dataclass(frozen=True, eq=False)
class Stops:
    """How far each trace is kept.

    Parameters
    ----------
    kept : (k,) bool array
        False for those that another runs along the other way.
    at : (k,) float array
        Length in the map up to which each is kept; infinite if nothing stops it.
    limit_cycle : (k,) bool array
        Whether it stops at a T-junction.
    """

    kept: BoolArray
    at: FloatArray
    limit_cycle: BoolArray


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
    limit_cycle = np.zeros(len(kept), dtype=bool)
    events = crossings[kept[crossings.trace].all(axis=1) & endless[crossings.trace].any(axis=1)]
    when = np.where(endless[events.trace], events.at, -1.0)
    for i in np.argsort(when.max(axis=1), kind="stable"):
        pair, reached = events.trace[i], events.at[i]
        if (reached > at[pair]).any():
            continue
        later = int(np.lexsort((pair, when[i]))[-1])
        at[pair[later]] = reached[later]
        limit_cycle[pair[later]] = True
    unstopped = endless & ~limit_cycle & (traces.ends != LENGTH)
    at[unstopped] = traces.lengths[unstopped]
    return Stops(kept, at, limit_cycle)


def left_of(crossings: Crossings, stopped: Stops) -> Crossings:
    """Return the crossings of what is kept of traces."""
    left = stopped.kept[crossings.trace].all(axis=1)
    reached = (crossings.at <= stopped.at[crossings.trace]).all(axis=1)
    return crossings[np.flatnonzero(left & reached)]


def doubled(traces: Traces) -> BoolArray:
    """Return which traces run along another between two nodes, the other way."""
    starts = traces.starts
    number = {key: i for i, key in enumerate(zip(starts.node, starts.slot, strict=True))}
    runs_along = np.zeros(len(traces.ends), dtype=bool)
    for i in np.flatnonzero(traces.ends == NODE):
        other = number.get((traces.end_node[i], traces.end_slot[i]), -1)
        if not runs_along[i] and other >= 0 and other != i:
            runs_along[other] = True
    return runs_along
