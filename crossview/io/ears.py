"""Polygons cut into triangles: n - 2 of each, all polygons of a size at once."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from solvers.surface import FloatArray, IntArray

ROOM = 1 << 20
"""Pairs of an ear and a corner that are looked at together; bounds memory. Chosen."""

EVEN = 1e-9
"""Diagonals of a quad whose triangles differ less in shape count as equal. From rounding."""


def cut(points: FloatArray, polygons: IntArray) -> tuple[IntArray, npt.NDArray[np.bool_]]:
    """Cut ears off polygons of one size, seen along their mean normals, until triangles are left.

    A quad is cut along the diagonal that makes the better triangles. Of larger ones the ear of the
    best shape goes first. Where all triangles turn the way the polygon does they cover it once,
    also if it has a hole that a double edge leads to: their sum of areas is the polygon's.

    Parameters
    ----------
    points : (n, 3) float array
    polygons : (p, k) int array
        Corners, k at least 4.

    Returns
    -------
    (p, k - 2, 3) int array
        The triangles of each.
    (p,) bool array
        Which polygons cannot be cut so: those that cross themselves.
    """
    at = _flat(points[polygons])
    total = _turn(at, np.roll(at, -1, axis=1), np.zeros(2)).sum(axis=1)
    rows = np.arange(len(polygons))
    triangles = np.empty((len(polygons), polygons.shape[1] - 2, 3), dtype=np.int64)
    kept = np.broadcast_to(np.arange(polygons.shape[1]), polygons.shape)
    least = np.full(len(polygons), np.inf)
    shape = _shapes(at, np.arange(at.shape[1]))
    for number in range(polygons.shape[1] - 3):
        k = at.shape[1]
        if k == 4:
            one, other = (np.minimum(shape[:, i], shape[:, i + 2]) for i in (1, 0))
            tip = np.where(one >= other - EVEN, 1, 0)
        else:
            none = np.flatnonzero(np.isneginf(shape).all(axis=1))
            shape[none] = _shapes(at[none], np.arange(k))  # what was in the way may be gone
            tip = shape.argmax(axis=1)
        three = (tip[:, None] + [-1, 0, 1]) % k
        corners = np.take_along_axis(kept, three, axis=1)
        triangles[:, number] = np.take_along_axis(polygons, corners, axis=1)
        a, b, c = (at[rows, three[:, i]] for i in range(3))
        least = np.minimum(least, _turn(a, b, c))
        rest = np.arange(k) != tip[:, None]
        kept, shape = kept[rest].reshape(-1, k - 1), shape[rest].reshape(-1, k - 1)
        at = at[rest].reshape(-1, k - 1, 2)
        if k - 1 > 3:
            beside = np.stack([tip - 1, tip], axis=1) % (k - 1)
            np.put_along_axis(shape, beside, _shapes(at, beside), axis=1)
    triangles[:, -1] = np.take_along_axis(polygons, kept, axis=1)
    least = np.minimum(least, _turn(at[:, 0], at[:, 1], at[:, 2]))
    return triangles, ~(least >= -EVEN * total)


def _flat(corners: FloatArray) -> FloatArray:
    """Polygons (p, k, 3) seen along their mean normals (Newell), as (p, k, 2) of unit size."""
    centred = corners - corners.mean(axis=1, keepdims=True)
    size = np.abs(centred).max(axis=(1, 2), keepdims=True)
    centred = centred / np.where(size > 0, size, 1)
    normal = np.cross(centred, np.roll(centred, -1, axis=1)).sum(axis=1)
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    normal = np.where(length > 0, normal / np.where(length > 0, length, 1), [0, 0, 1])
    axis = np.eye(3)[np.abs(normal).argmin(axis=1)]
    u = np.cross(axis, normal)
    u /= np.linalg.norm(u, axis=1, keepdims=True)
    frame = np.stack([u, np.cross(normal, u)], axis=2)
    return np.asarray(centred @ frame)


def _turn(a: FloatArray, b: FloatArray, c: FloatArray) -> FloatArray:
    """Twice the signed areas of triangles in the plane."""
    u, v = a - c, b - c
    return np.asarray(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0])


def _shapes(at: FloatArray, tips: IntArray) -> FloatArray:
    """The shapes (p, t) of ears with given tips (t,) or (p, t): 1 equilateral, 0 flat.

    Ears that turn the wrong way have shapes below 0, those that a corner is in the way of -inf; of
    quads only the first is looked at.
    """
    count, k = at.shape[:2]
    tips = np.broadcast_to(tips, (count, tips.shape[-1]))
    shape = np.empty(tips.shape)
    block = max(ROOM // (k * tips.shape[1]), 1)
    for first in range(0, count, block):
        rows = slice(first, first + block)
        step = max(ROOM // (k * len(at[rows])), 1)
        for column in range(0, tips.shape[1], step):
            part = slice(column, column + step)
            shape[rows, part] = _shapes_of(at[rows], tips[rows, part])
    return shape


def _shapes_of(at: FloatArray, tips: IntArray) -> FloatArray:
    k = at.shape[1]
    rows = np.arange(len(at))[:, None]
    a, b, c = (at[rows, (tips + i) % k] for i in (-1, 0, 1))
    area = _turn(a, b, c)
    squares = ((a - b) ** 2 + (b - c) ** 2 + (c - a) ** 2).sum(axis=-1)
    shape = 2 * np.sqrt(3) * area / np.where(squares > 0, squares, 1)
    if k == 4:
        return np.asarray(shape)
    # a corner that turns left is in the way only if another is, too
    before, after = np.roll(at, 1, axis=1), np.roll(at, -1, axis=1)
    reflex = _turn(before, at, after) <= 0
    a, b, c, each = a[:, :, None], b[:, :, None], c[:, :, None], at[:, None]
    inside = (_turn(a, b, each) >= 0) & (_turn(b, c, each) >= 0) & (_turn(c, a, each) >= 0)
    apart = (each != a).any(axis=-1) & (each != b).any(axis=-1) & (each != c).any(axis=-1)
    in_the_way = (inside & apart & reflex[:, None]).any(axis=-1)
    return np.where(in_the_way | (area <= 0), -np.inf, shape)
