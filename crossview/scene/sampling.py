"""Which faces carry a cross: a well spread choice that depends on the surface alone."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

# Candidates per chosen face: enough to fill the surface, few enough to choose among at once.
_CANDIDATES = 8.0
# A maximal choice at distance r has about 0.8 / r^2 members per unit area.
_PACKING = 0.9
# How far apart opposite directions of the normal count, in distances: thin sheets choose apart.
_NORMAL_WEIGHT = 0.75


def spread_faces(
    barycentres: npt.NDArray[np.floating[Any]],
    normals: npt.NDArray[np.floating[Any]],
    areas: npt.NDArray[np.floating[Any]],
    count: float,
) -> npt.NDArray[np.int64]:
    """Choose about `count` faces, no two near each other, none leaving a hole.

    Each face has a rank drawn from its position (not its number), and is chosen when it has the
    lowest among the faces left within a distance r: Luby's parallel choice of a maximal
    independent set. Where a surface is refined locally, the choice elsewhere stays the same.

    Parameters
    ----------
    barycentres, normals : (m, 3) float
    areas : (m,) float
    count : float
        Number of faces wanted; fewer when the surface has fewer or they lie too near.

    Returns
    -------
    (k,) int
        Chosen faces, ascending.
    """
    total = float(areas.sum())
    radius = _PACKING * np.sqrt(total / count)
    rank = _position_hash(barycentres)
    share = _CANDIDATES * count * areas / total
    candidates = np.flatnonzero(rank <= share)
    where = np.hstack([barycentres, _NORMAL_WEIGHT * radius * normals])[candidates]
    pairs = cKDTree(where).query_pairs(radius, output_type="ndarray")
    return candidates[_lowest_apart(rank[candidates] / share[candidates], pairs)]


def _position_hash(positions: npt.NDArray[np.floating[Any]]) -> npt.NDArray[np.float64]:
    """Return a number in (0, 1) per position, the same wherever the position is the same."""
    low = positions.min(axis=0)
    extent = float(np.ptp(positions, axis=0).max()) or 1.0
    grid = np.round((positions - low) / extent * 1e6).astype(np.uint64)
    mixed = grid @ np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], np.uint64)
    for shift, factor in ((31, 0x7FB5D329728EA185), (27, 0x81DADEF4BC2DD44D)):
        mixed = (mixed ^ (mixed >> np.uint64(shift))) * np.uint64(factor)
    mixed ^= mixed >> np.uint64(33)
    return (mixed >> np.uint64(11)).astype(float) / 2.0**53


def _lowest_apart(
    rank: npt.NDArray[np.float64], pairs: npt.NDArray[np.integer[Any]]
) -> npt.NDArray[np.int64]:
    """Return a maximal set of numbers no two of which are a pair, lower ranks first."""
    order = np.empty(rank.size, int)
    order[np.argsort(rank, kind="stable")] = np.arange(rank.size)
    undecided = np.ones(rank.size, bool)
    chosen = np.zeros(rank.size, bool)
    while undecided.any():
        nearest = np.full(rank.size, rank.size)
        np.minimum.at(nearest, pairs[:, 0], order[pairs[:, 1]])
        np.minimum.at(nearest, pairs[:, 1], order[pairs[:, 0]])
        now = undecided & (order < nearest)
        chosen |= now
        undecided &= ~now
        undecided[pairs[now[pairs[:, 0]], 1]] = False
        undecided[pairs[now[pairs[:, 1]], 0]] = False
        pairs = pairs[undecided[pairs].all(axis=1)]
    return np.flatnonzero(chosen)
