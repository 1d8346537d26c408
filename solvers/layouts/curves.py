"""Traces and boundary loops alike: what the arcs of a layout are parts of."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from solvers.layouts.charts import Chart, ComplexArray
from solvers.layouts.crossings import ends_of
from solvers.layouts.motorcycles import Stops
from solvers.layouts.nodes import Node
from solvers.layouts.tracing import BORDER, Chords, Traces
from solvers.surface.triangulation import QUARTER, FloatArray, IntArray, next_halfedge
from solvers.surface.trisurface import TriSurface

APART = 1e-12
"""Length of an edge along a curve at least, in that of all its edges.

Chosen, above rounding: where the map is so small, two corners still have two places.
"""


@dataclass(frozen=True, eq=False)
class Curves:
    """Traces and boundary loops alike, as chords.

    Parameters
    ----------
    chart : Chart
        The images.
    chords : Chords
        Curve by curve.
    offsets : (c + 1,) int array
        The chords of curve i are ``offsets[i]`` to ``offsets[i + 1]``.
    """

    chart: Chart
    chords: Chords
    offsets: IntArray

    def chords_at(self, curve: IntArray, at: FloatArray) -> tuple[IntArray, FloatArray]:
        """Return the chords (k,) at lengths along curves, and how far along them, 0 to 1."""
        found = np.empty(len(curve), dtype=np.int64)
        # arcs of loops may run over their seam
        whole = self.chords.end[self.offsets[curve + 1] - 1]
        at = np.where(at > whole, at - whole, at)
        for c in np.unique(curve).tolist():
            on = curve == c
            low, high = self.offsets[c], self.offsets[c + 1]
            chord = np.searchsorted(self.chords.start[low:high], at[on], side="right") - 1
            found[on] = low + np.clip(chord, 0, high - low - 1)
        start, end = self.chords.start[found], self.chords.end[found]
        return found, np.clip((at - start) / np.maximum(end - start, 1e-300), 0.0, 1.0)

    def faces_at(self, curve: IntArray, at: FloatArray) -> tuple[IntArray, ComplexArray, IntArray]:
        """Return the triangles (k,) at lengths along curves, places in their images, and chords."""
        chord, part = self.chords_at(curve, at)
        start, end = (ends[chord] for ends in ends_of(self.chart, self.chords))
        return self.chords.face[chord], start + part * (end - start), chord


def with_loops(traces: Traces, loops: Sequence[IntArray]) -> Curves:
    """Return the traces followed by boundary loops, given as halfedges in order."""
    chart, chords = traces.chart, [traces.chords]
    offsets = list(traces.offsets)
    for number, loop in enumerate(loops, start=len(traces.ends)):
        chords.append(along_edges(chart, loop, number))
        offsets.append(offsets[-1] + len(loop))
    return Curves(chart, Chords.joined(chords), np.array(offsets))


def along_edges(
    chart: Chart, halfedges: IntArray, curve: int, *, backwards: bool = False
) -> Chords:
    """Return the chords of a curve along halfedges that follow each other, or against them."""
    z = chart.images.reshape(-1)[halfedges]
    long = np.abs(z)
    length = np.concatenate([[0.0], np.cumsum(np.maximum(long, APART * long.sum()))])
    axis = np.rint(np.angle(z) / QUARTER).astype(np.int64) + 2 * backwards
    tail, head = halfedges % 3, next_halfedge(halfedges) % 3
    start, end = (head, tail) if backwards else (tail, head)
    zero, corner = np.zeros(len(z)), np.ones(len(z), dtype=bool)
    return Chords(
        np.full(len(z), curve),
        halfedges // 3,
        axis % 4,
        start,
        zero,
        corner,
        end,
        zero,
        corner,
        length[:-1],
        length[1:],
    )


def boundary_halfedges(chart: Chart, surface: TriSurface) -> tuple[IntArray, ...]:
    """Return the halfedges of each boundary loop, in the order of `TriSurface.boundary_loops`."""
    first = [int(loop[0]) for loop in surface.boundary_loops]
    return chart.triangulation.boundary_loops_from(first)


def bare_loops(
    loops: Sequence[IntArray], nodes: Sequence[Node], traces: Traces, stopped: Stops
) -> IntArray:
    """Return the numbers of the loops that no trace reaches or leaves."""
    t = traces.chart.triangulation
    last = traces.chords[traces.offsets[1:] - 1]
    hit = (3 * last.face + last.side_out)[stopped.kept & (traces.ends == BORDER)]
    touched = {int(n.vertex) for n in nodes if not n.inner} | set(t.tail[hit].tolist())
    return np.array(
        [i for i, loop in enumerate(loops) if touched.isdisjoint(t.tail[loop].tolist())],
        dtype=np.int64,
    )
