"""Triangles by the lengths of their sides: what closes, angles, and other diagonals."""

from __future__ import annotations

import numpy as np

from solvers.surface.triangulation import (
    BoolArray,
    FloatArray,
    IntArray,
    next_halfedge,
    previous_halfedge,
)

CONVEX = 1e-3
"""By how much the angles of a quadrilateral are below a half turn for its edge to be flipped.

Radians. Chosen, above rounding.
"""

CLOSED = 1e-6
"""Slack of triangles that are laid out to find a diagonal. Chosen, above rounding."""


def slack(lengths: FloatArray) -> FloatArray:
    """Return by how much two sides are longer than the longest (k,), in parts of that.

    Parameters
    ----------
    lengths : (k, 3) float array
        Of the sides; negative where the triangle does not close.

    Examples
    --------
    >>> import numpy as np
    >>> slack(np.array([[1.0, 1.0, 1.0], [1.0, 1.0, 4.0]])).tolist()
    [1.0, -0.5]
    """
    longest = lengths.max(axis=1)
    return np.asarray(lengths.sum(axis=1) / longest - 2)


def corner_angles(lengths: FloatArray) -> FloatArray:
    """Return the angle at the corner that each halfedge starts at (3 k,), radians.

    Parameters
    ----------
    lengths : (k, 3) float array
        Of the sides; where the triangle does not close, its angles are 0 or half turns.

    Examples
    --------
    >>> import numpy as np
    >>> np.degrees(corner_angles(np.array([[3.0, 4.0, 5.0]]))).round(1).tolist()
    [53.1, 90.0, 36.9]
    """
    a, b, c = lengths.T
    pairs = ((a, c, b), (b, a, c), (c, b, a))
    cosines = [(p**2 + q**2 - r**2) / (2 * p * q) for p, q, r in pairs]
    return np.asarray(np.arccos(np.clip(np.stack(cosines, axis=1), -1, 1)).reshape(-1))


def convex(angle: FloatArray, h: IntArray, g: IntArray) -> BoolArray:
    """Return whether pairs of triangles are quadrilaterals convex at both ends of their edge.

    Parameters
    ----------
    angle : (3 m,) float array
        As of `corner_angles`.
    h, g : (k,) int arrays
        Both halfedges of each edge.
    """
    most = np.pi - CONVEX
    at_tail = angle[h] + angle[next_halfedge(g)]
    at_head = angle[next_halfedge(h)] + angle[g]
    return np.asarray((at_tail < most) & (at_head < most))


def cosine_opposite(log_lengths: FloatArray, h: IntArray) -> FloatArray:
    """Return the cosine of the angle opposite halfedges (k,), below -1 if no triangle closes.

    Parameters
    ----------
    log_lengths : (3 m,) float array
        Logarithm of the length of each halfedge.
    h : (k,) int array
        The halfedges.
    """
    x = log_lengths
    b, c = x[next_halfedge(h)] - x[h], x[previous_halfedge(h)] - x[h]
    return np.asarray(np.cosh(b - c) - 0.5 * np.exp(-b - c))


def log_diagonal(log_lengths: FloatArray, h: IntArray, g: IntArray) -> FloatArray:
    """Return the logarithm of the other diagonal of each pair of triangles (k,).

    That of the flat quadrilateral where there is one, which leaves the metric as it is; else that
    of the one with a circle around it (Ptolemy).

    Parameters
    ----------
    log_lengths : (3 m,) float array
        Logarithm of the length of each halfedge.
    h, g : (k,) int arrays
        Both halfedges of each edge.
    """
    x = log_lengths
    ahead, behind = (x[side(h)] + x[side(g)] for side in (next_halfedge, previous_halfedge))
    diagonal = np.logaddexp(ahead, behind) - x[h]
    lengths = np.exp(x).reshape(-1, 3)
    closed = (slack(lengths[h // 3]) > CLOSED) & (slack(lengths[g // 3]) > CLOSED)
    angle = corner_angles(lengths)
    flat = np.flatnonzero(closed & convex(angle, h, g))
    h, g = h[flat], g[flat]
    at_tail = angle[h] + angle[next_halfedge(g)]
    one, other = np.exp(x[previous_halfedge(h)]), np.exp(x[next_halfedge(g)])
    square = one**2 + other**2 - 2 * one * other * np.cos(at_tail)
    diagonal[flat] = 0.5 * np.log(np.maximum(square, 1e-300))
    return np.asarray(diagonal)


def log_cevian(log_lengths: FloatArray, h: IntArray, at: FloatArray) -> FloatArray:
    """Return the logarithm of the length from a place on halfedges to the corner opposite (k,).

    Parameters
    ----------
    log_lengths : (3 m,) float array
        Logarithm of the length of each halfedge.
    h : (k,) int array
        The halfedges.
    at : (k,) float array
        Where along each, 0 to 1.

    Notes
    -----
    Stewart's theorem.
    """
    x = log_lengths
    base, ahead, behind = (np.exp(2 * x[k]) for k in (h, next_halfedge(h), previous_halfedge(h)))
    square = (1 - at) * behind + at * ahead - at * (1 - at) * base
    return np.asarray(0.5 * np.log(np.maximum(square, 1e-12 * base)))
