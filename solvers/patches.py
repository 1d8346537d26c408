"""The patches of a layout, sampled for pictures."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solvers.arrangement import Arrangement
from solvers.crossings import ends_of
from solvers.straight import barycentric_in, walk
from solvers.surface import TriSurface
from solvers.tracing import AXES
from solvers.triangulation import FloatArray, IntArray

FINEST = 64
"""Cells along a side of a patch at most."""


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
    cells = np.clip(np.ceil(sides / curves.chart.edge_length), 1, FINEST).astype(np.int64)
    chords, parts, signs, ways, quads, patch = [], [], [], [], [], []
    first = 0
    for r, ((width, height), (w, h)) in enumerate(zip(sides, cells, strict=True)):
        chord, part, sign = _along(arrangement, tmesh.side(r, 0), np.arange(w + 1) * width / w)
        for values, one in ((chords, chord), (parts, part), (signs, sign)):
            values.append(np.repeat(one, h + 1))
        ways.append(np.tile(1j * np.arange(h + 1) * height / h, w + 1))
        number = first + np.arange((w + 1) * (h + 1)).reshape(w + 1, h + 1)
        corners = [number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]]
        quads.append(np.stack(corners, axis=2).reshape(-1, 4))
        patch.append(np.full(w * h, r))
        first += number.size
    chord, part = np.concatenate(chords), np.concatenate(parts)
    start, end = (ends[chord] for ends in ends_of(curves.chart, curves.chords))
    along = AXES[curves.chords.axis[chord]] * np.concatenate(signs)
    face, place = walk(
        curves.chart,
        curves.chords.face[chord],
        start + part * (end - start),
        np.concatenate(ways) * along,
    )
    weights = barycentric_in(curves.chart, face, place)
    points = np.einsum("kc,kcd->kd", weights, surface.vertices[surface.faces[face]])
    return PatchMesh(points, np.concatenate(quads), np.concatenate(patch))


def _along(
    arrangement: Arrangement, halfarcs: IntArray, places: FloatArray
) -> tuple[IntArray, FloatArray, IntArray]:
    """Return where places along a side of a rectangle are.

    Returns
    -------
    (k,) int array
        A chord of a curve.
    (k,) float array
        How far along it, 0 to 1.
    (k,) int array
        1 or -1: whether the side runs along the curve or against it.
    """
    arc, backwards = halfarcs // 2, halfarcs % 2
    ends = np.cumsum(arrangement.tmesh.lengths[arc])
    on = np.minimum(np.searchsorted(ends, places), len(arc) - 1)
    start, end = arrangement.arc_span[arc].T
    before = np.concatenate([[0.0], ends[:-1]])
    beyond = places - before[on]
    at = np.where(backwards[on], end[on] - beyond, start[on] + beyond)
    chord, part = np.empty(len(on), dtype=np.int64), np.empty(len(on))
    for i in np.unique(on):
        chosen = on == i
        curve = int(arrangement.arc_curve[arc[i]])
        chord[chosen], part[chosen] = arrangement.curves.chords_at(curve, at[chosen])
    return chord, part, 1 - 2 * backwards[on]
