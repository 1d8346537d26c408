"""Straight walks in a seamless map, many at once."""

from __future__ import annotations

import numpy as np

from solvers.layouts.charts import AXES, Chart, ComplexArray
from solvers.surface.triangulation import FloatArray, IntArray


def walk(
    chart: Chart, face: IntArray, place: ComplexArray, way: ComplexArray
) -> tuple[IntArray, ComplexArray]:
    """Walk straight from places in a map; at the boundary a walk ends.

    Parameters
    ----------
    chart : Chart
        The map; none of the triangles walked through is inverted.
    face : (k,) int array
        Triangles the walks start in.
    place, way : (k,) complex arrays
        Where they start and where they lead, in the triangles' frames.

    Returns
    -------
    (k,) int array
        The triangles they end in.
    (k,) complex array
        Where in those triangles' frames.
    """
    face, place, way = face.copy(), place.copy(), way.copy()
    entered = np.full(len(face), -1)
    going = np.arange(len(face))
    for _ in range(len(chart.images)):
        sides, corners = chart.images[face[going]], chart.corners[face[going]]
        inside = (sides.conj() * (place[going, None] - corners)).imag
        rate = (sides.conj() * way[going, None]).imag
        reach = np.where(rate < 0, np.maximum(inside, 0.0) / np.where(rate < 0, -rate, 1.0), np.inf)
        reach[np.arange(3) == entered[going, None]] = np.inf
        side = reach.argmin(axis=1)
        rows = np.arange(len(going))
        step = np.minimum(reach[rows, side], 1.0)
        place[going] += step * way[going]
        way[going] *= 1 - step
        h = 3 * face[going] + side
        twin = chart.triangulation.twin[h]
        on = (step < 1) & (twin >= 0)
        z = sides[rows, side]
        along = ((place[going] - corners[rows, side]) / z).real[on]
        going, h, twin = going[on], h[on], twin[on]
        if not len(going):
            break
        face[going], entered[going] = twin // 3, twin % 3
        start, z = chart.corners[twin // 3, twin % 3], chart.images[twin // 3, twin % 3]
        place[going] = start + (1 - along) * z
        way[going] *= AXES[chart.period_jumps[h] % 4]
    return face, place


def barycentric_in(chart: Chart, face: IntArray, place: ComplexArray) -> FloatArray:
    """Return the weights (k, 3) of places in the frames of triangles, moved inside if outside."""
    one, two = chart.corners[face, 1], chart.corners[face, 2]
    double = (one.conj() * two).imag
    second, third = (place.conj() * two).imag / double, (one.conj() * place).imag / double
    weights = np.maximum(np.stack([1 - second - third, second, third], axis=1), 0.0)
    return np.asarray(weights / weights.sum(axis=1)[:, None])
