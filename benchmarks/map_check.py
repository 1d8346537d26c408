"""Whether a map of a surface is what it should be, told from its images alone.

Shares nothing with what makes maps: images of halfedges, which halfedges are twins, and which edges
are to be followed. A map without inverted triangles may still have the wrong valences, so the
angles between images are summed at each vertex and in each sector between two followed edges.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

Ints = npt.NDArray[np.int64]
Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]

CLOSE = 1e-6
"""Gaps below, in parts of the mean length of images, and angles, quarter turns, are rounding.

Chosen, far above what solves leave.
"""


@dataclass(frozen=True, eq=False)
class Connectivity:
    """A surface cut into corners: halfedge h of triangle h // 3 leaves the corner of number h.

    Parameters
    ----------
    corners : (3 m,) int array
        The vertex that each halfedge leaves.
    twin : (3 m,) int array
        The halfedge on the other side, -1 on the boundary.
    followed : (3 m,) bool array
        Whether the halfedge's edge is one of the boundary or of a feature.
    """

    corners: Ints
    twin: Ints
    followed: Bools

    def sectors(self) -> Ints:
        """Return for each corner the number of the sector it is in, between followed edges."""
        h = np.flatnonzero((self.twin >= 0) & ~self.followed)
        beside = _after(self.twin[h])
        n = len(self.twin)
        graph = coo_array((np.ones(len(h)), (h, beside)), shape=(n, n))
        return np.asarray(connected_components(graph, directed=False)[1].astype(np.int64))


@dataclass(frozen=True)
class Findings:
    """What is wrong with a map; all zero of one that is right.

    Parameters
    ----------
    inverted : int
        Triangles whose image is turned over or has no area.
    open : int
        Triangles whose images do not close.
    torn : int
        Edges whose two images differ by more than a whole number of quarter turns.
    astray : int
        Followed edges whose image is along neither axis.
    windings : int
        Vertices at which the angles between images do not sum to the valence's quarter turns.
    empty : int
        Sectors at followed edges whose angles sum to less than one quarter turn.
    """

    inverted: int
    open: int
    torn: int
    astray: int
    windings: int
    empty: int

    @property
    def right(self) -> bool:
        """Whether nothing is wrong."""
        return not any(vars(self).values())


def check(connectivity: Connectivity, images: Floats, quads: Ints) -> Findings:
    """Check the images (3 m, 2) of halfedges against the quads (n,) wanted at each vertex."""
    c, vectors = connectivity, np.asarray(images).reshape(-1, 2)
    length = np.linalg.norm(vectors, axis=1)
    rounding = CLOSE * length.mean()
    sides = vectors.reshape(-1, 3, 2)
    inner = np.flatnonzero(c.twin > np.arange(len(c.twin)))
    on_axis = np.abs(vectors).min(axis=1) <= rounding
    angles = corner_angles(vectors) / (np.pi / 2)
    at_vertex = np.bincount(c.corners, angles, minlength=len(quads))
    used = np.bincount(c.corners, minlength=len(quads)) > 0
    return Findings(
        inverted=int((_cross(sides[:, 0], sides[:, 1]) <= 0).sum()),
        open=int((np.linalg.norm(sides.sum(axis=1), axis=1) > rounding).sum()),
        torn=int((_apart(vectors[inner], -vectors[c.twin[inner]]) > rounding).sum()),
        astray=int((c.followed & ~on_axis).sum()),
        windings=int((used & (np.abs(at_vertex - quads) > CLOSE)).sum()),
        empty=int((sums_in_sectors(c, angles) < 1 - CLOSE).sum()),
    )


def sums_in_sectors(c: Connectivity, angles: Floats) -> Floats:
    """Return the sums of corners' angles in each sector at a vertex with followed edges."""
    sector = c.sectors()
    at_followed = np.zeros(sector.max() + 1, dtype=bool)
    bounding = np.flatnonzero(c.followed)
    at_followed[sector[bounding]] = at_followed[sector[_after(bounding)]] = True
    return np.asarray(np.bincount(sector, angles)[at_followed])


def corner_angles(vectors: Floats) -> Floats:
    """Return the signed angle at each corner between the sides (3 m, 2) around it, radians."""
    back = -vectors.reshape(-1, 3, 2)[:, [2, 0, 1]].reshape(-1, 2)
    return np.asarray(np.arctan2(_cross(vectors, back), (vectors * back).sum(axis=1)))


def _apart(one: Floats, other: Floats) -> Floats:
    """How far vectors (k, 2) are from each other at best, one of them turned by quarter turns."""
    gaps = []
    for _ in range(4):
        other = np.stack([-other[:, 1], other[:, 0]], axis=1)
        gaps.append(np.linalg.norm(one - other, axis=1))
    return np.asarray(np.min(gaps, axis=0))


def _cross(one: Floats, other: Floats) -> Floats:
    return np.asarray(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0])


def _after(h: Ints) -> Ints:
    return np.asarray(3 * (h // 3) + (h + 1) % 3)
