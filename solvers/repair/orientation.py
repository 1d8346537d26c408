"""Turn triangles until neighbours agree."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from solvers.errors import SurfaceError, counted, listed
from solvers.surface.triangulation import BoolArray, FloatArray, IntArray
from solvers.surface.validation import HalfedgePairs


def orient(points: FloatArray, triangles: IntArray) -> tuple[FloatArray, IntArray, str]:
    """Return the arrays with all triangles of a sheet oriented alike, and a note.

    As few triangles as possible are turned in each sheet; a closed sheet that needed it faces
    outwards. A sheet ends at its boundary and at edges of more than two triangles.

    Parameters
    ----------
    points : (n, 3) float array
        Coordinates.
    triangles : (m, 3) int array
        Corners.

    Returns
    -------
    points, triangles : arrays
        The points are those given.
    note : str
        How many triangles were turned; empty for none.

    Raises
    ------
    SurfaceError
        When a sheet is one-sided.
    """
    m = len(triangles)
    pairs = HalfedgePairs(len(points), triangles)
    h = np.flatnonzero(pairs.twin >= 0)
    twin = pairs.twin[h]
    tail = triangles.reshape(-1)
    alike = tail[h] != tail[twin]
    if alike.all():
        return points, triangles, ""
    # two copies of each triangle, as it is (f) and turned (f + m), joined where they agree
    shift = np.where(alike, 0, m)
    rows = np.concatenate([h // 3, h // 3 + m])
    columns = np.concatenate([twin // 3 + shift, (twin // 3 + m + shift) % (2 * m)])
    graph = coo_array((np.ones(len(rows), dtype=np.int8), (rows, columns)), (2 * m, 2 * m))
    label = connected_components(graph, directed=False)[1]
    as_is, turned = label[:m], label[m:]
    one_sided = np.flatnonzero(as_is == turned)
    if len(one_sided):
        raise SurfaceError(
            "the surface is one-sided, like a Moebius strip: no orientation fits",
            f"{counted(len(one_sided), 'triangle')}, {listed(one_sided)}",
            "cut it open, or remove that part",
            one_sided,
            "faces",
        )
    size = np.bincount(as_is, minlength=label.max() + 1)
    flip = size[turned] > size[as_is]
    # equally many either way: the sheet's lower label decides, one way for the whole sheet
    flip |= (size[turned] == size[as_is]) & (turned < as_is)
    result = np.where(flip[:, None], triangles[:, ::-1], triangles)
    sheet = np.minimum(as_is, turned)
    mixed = np.isin(sheet, sheet[h[~alike] // 3])
    inward = mixed & _encloses_negative_volume(points, result, sheet, pairs)
    result[inward] = result[inward][:, ::-1]
    changed = int((flip ^ inward).sum())
    return points, result, f"turned {counted(changed, 'triangle')} to agree with the others"


def _encloses_negative_volume(
    points: FloatArray, triangles: IntArray, sheet: IntArray, pairs: HalfedgePairs
) -> BoolArray:
    """Return for each triangle whether it belongs to a closed sheet that faces inwards."""
    middle = points.mean(axis=0)
    volume = np.linalg.det(points[triangles] - middle)
    total = np.bincount(sheet, volume)
    closed = np.bincount(sheet, (pairs.twin.reshape(-1, 3) < 0).any(axis=1)) == 0
    return np.asarray((closed & (total < 0))[sheet])
