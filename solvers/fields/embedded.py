"""A singularity inside a triangle, without a new vertex or factor.

Splitting a triangle at an inner point adds one hat function whose gradient integrates to zero over
the triangle, so it is orthogonal to every old P1 function. Hence H on the split triangulation is:
the old values, solved with the Dirac spread by barycentric weights, and one local value at the
point. The field closes exactly; nothing is approximated but the triangle's shape being unrefined.
"""

from __future__ import annotations

import numpy as np

from solvers.algebra.operators import corner_midpoint_offsets
from solvers.surface.triangulation import FloatArray


def split_offsets(
    corners: FloatArray, weights: FloatArray, index: int, values: FloatArray
) -> FloatArray:
    """Return how far the field turns from barycentre to edge midpoints in a split triangle.

    Parameters
    ----------
    corners : (3, 2) float array
        The triangle laid out in its frame.
    weights : (3,) float array
        Barycentric weights of the singularity, none of them next to zero.
    index : int
        Its index, in quarter turns.
    values : (3,) float array
        H at the corners.

    Returns
    -------
    (3,) float array
        theta at each edge midpoint minus theta at the triangle's barycentre, radians; any two
        ways around the singularity differ by whole quarter turns.
    """
    x = weights @ corners
    # Part i has corners i, i + 1 and the singularity.
    parts = np.stack([corners, corners[[1, 2, 0]], np.broadcast_to(x, (3, 2))], axis=1)
    a, b = parts[:, [1, 2, 0]] - parts, parts[:, [2, 0, 1]] - parts
    # Part i has the share of the corner it lacks; from x its area would be lost to rounding.
    double_areas = weights[[2, 0, 1]] * corners[1, 0] * corners[2, 1]
    cotangents = (a * b).sum(axis=2) / double_areas[:, None]
    # The spoke to corner i lies opposite corner i + 1 of part i and corner i - 1 of part i - 1.
    spokes = 0.5 * (cotangents[:, 1] + cotangents[[2, 0, 1], 0])
    at_x = (spokes @ values - 0.5 * np.pi * index) / spokes.sum()
    by_part = np.stack([values, values[[1, 2, 0]], np.full(3, at_x)], axis=1)
    offsets = corner_midpoint_offsets(cotangents, by_part)
    # Part i is left over halfedge 1 (corner i + 1 to x), which is halfedge 2 of part i + 1.
    theta = np.zeros(3)
    theta[1] = theta[0] + offsets[0, 1] - offsets[1, 2]
    theta[2] = theta[1] + offsets[1, 1] - offsets[2, 2]
    home = (int(np.argmax(weights)) + 1) % 3  # the barycentre is opposite the nearest corner
    centre = corners.mean(axis=0)
    at_centre = theta[home] + _turn(parts[home], by_part[home], centre - parts[home].mean(axis=0))
    return np.asarray(theta + offsets[:, 0] - at_centre)


def _turn(corners: FloatArray, values: FloatArray, displacement: FloatArray) -> float:
    """Return J grad(H) . displacement for one triangle (3, 2) with H at its corners."""
    opposite = corners[[2, 0, 1]] - corners[[1, 2, 0]]
    first, second = corners[1] - corners[0], corners[2] - corners[0]
    double_area = first[0] * second[1] - first[1] * second[0]
    # grad phi_i = J opposite_i / (2 A), so J grad H = -sum H_i opposite_i / (2 A).
    return float(-(values @ opposite) @ displacement / double_area)
