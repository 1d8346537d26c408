"""The patches of a layout, sampled for pictures."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solvers.layouts.arrangement import Arrangement
from solvers.layouts.charts import AXES
from solvers.layouts.crossings import ends_of
from solvers.layouts.straight import barycentric_in, walk
from solvers.surface.triangulation import FloatArray, IntArray
from solvers.surface.trisurface import TriSurface

COARSEST, FINEST = 16, 64
"""Cells along a side of a patch, at least and at most. Chosen, for smooth and quick pictures."""


@dataclass(frozen=True, eq=False)
class PatchMesh:
    """Patches as fine grids of quads that share no vertex with each other.

    Parameters
    ----------
    points : (p, 3) float array
        On the surface.
    quads : (q, 4) int array
        Counter-clockwise.
    patch : (q,) int array
        The patch each lies in.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers import run
    >>> from solvers.fields import IntegratedField, aligned_field, prepare
    >>> from solvers.layouts import quad_layout
    >>> from solvers.primitives import square
    >>> aligned = aligned_field(prepare(square(n=4)))
    >>> mesh = run(quad_layout(IntegratedField(aligned, aligned.start))).patch_mesh
    >>> len(mesh.quads), np.unique(mesh.patch).tolist()  # 16 by 16 cells in the only patch
    (256, [0])
    """

    points: FloatArray
    quads: IntArray
    patch: IntArray


def sampled(surface: TriSurface, arrangement: Arrangement) -> PatchMesh:
    """Sample every rectangle about as finely as the surface's triangles are.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    arrangement : Arrangement
        The rectangles on it.
    """
    tmesh, curves = arrangement.tmesh, arrangement.curves
    sides = tmesh.side_totals(tmesh.lengths)[:, :2]
    cells = np.clip(np.ceil(2 * sides / curves.chart.edge_length), COARSEST, FINEST).astype(
        np.int64
    )
    starts, ways, quads, first = [], [], [], 0
    for r, (height, (w, h)) in enumerate(zip(sides[:, 1], cells, strict=True)):
        start = np.repeat(_along(arrangement, tmesh.side(r, 0), w)[:, :, None], h + 1, axis=2)
        way = np.tile(1j * np.arange(h + 1) * height / h, (w + 1, 1))
        # The other sides are where their arcs are: what walks along one may stray beside it.
        start[:, -1] = _along(arrangement, tmesh.side(r, 1), h)
        start[:, ::-1, -1] = _along(arrangement, tmesh.side(r, 2), w)
        start[:, 0, ::-1] = _along(arrangement, tmesh.side(r, 3), h)
        way[0] = way[-1] = way[:, -1] = 0.0
        starts.append(start.reshape(3, -1))
        ways.append(way.reshape(-1))
        number = first + np.arange((w + 1) * (h + 1)).reshape(w + 1, h + 1)
        quads.append(grid_quads(number))
        first += number.size
    chord, part, sign = np.concatenate(starts, axis=1)
    chord = chord.astype(np.int64)
    start, end = (ends[chord] for ends in ends_of(curves.chart, curves.chords))
    along = AXES[curves.chords.axis[chord]] * sign
    face, place = walk(
        curves.chart,
        curves.chords.face[chord],
        start + part * (end - start),
        np.concatenate(ways) * along,
    )
    weights = barycentric_in(curves.chart, face, place)
    face, weights = curves.chart.working.lift_points(face, weights)
    points = np.einsum("kc,kcd->kd", weights, surface.vertices[surface.faces[face]])
    patch = np.repeat(np.arange(len(quads)), [len(q) for q in quads])
    return PatchMesh(points, np.concatenate(quads), patch)


def grid_quads(grid: IntArray) -> IntArray:
    """Return the corners (w h, 4) of the quads of a grid of vertex numbers (w + 1, h + 1)."""
    corners = [grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]]
    return np.stack(corners, axis=2).reshape(-1, 4)


def _along(arrangement: Arrangement, halfarcs: IntArray, cells: int) -> FloatArray:
    """Return evenly spaced places (3, cells + 1) along a side of a rectangle.

    For each the chord of a curve, how far along it, 0 to 1, and 1 or -1: whether the side runs
    along the curve or against it.
    """
    arc, backwards = halfarcs // 2, halfarcs % 2
    ends = np.cumsum(arrangement.tmesh.lengths[arc])
    places = np.arange(cells + 1) * ends[-1] / cells
    on = np.minimum(np.searchsorted(ends, places), len(arc) - 1)
    start, end = arrangement.arc_span[arc].T
    beyond = places - (ends - arrangement.tmesh.lengths[arc])[on]
    at = np.where(backwards[on], end[on] - beyond, start[on] + beyond)
    chord, part = arrangement.curves.chords_at(arrangement.arc_curve[arc[on]], at)
    return np.stack([chord, part, 1 - 2 * backwards[on]])
