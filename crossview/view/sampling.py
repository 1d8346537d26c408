"""Where crosses stand: a well spread choice that depends on the surface alone."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from crossview.view.geometry import FloatArray, IntArray, Triangles

USUAL, USUAL_PLANAR = 2200, 1400
"""How many crosses there are at density 1; of a planar surface all are seen at once. Chosen."""

_CANDIDATES = 8.0
"""Candidates per chosen site.

Chosen: enough to fill the surface, few enough to choose among at once.
"""

_PACKING = 0.77
"""Distance of sites, in square roots of the area for each.

Measured: a maximal choice at distance r has about 0.6 / r^2 members per unit area.
"""

_NORMAL_WEIGHT = 0.75
"""How far apart opposite directions of the normal count, in distances: thin sheets choose apart.

Chosen.
"""

_BORDER = 0.36
"""No site nearer to the boundary than this, in distances. Chosen."""

_SHARP = 50.0
"""Edges sharper than this, in degrees, end the arms of crosses. Chosen."""

_LARGE = 3.0
"""Triangles larger than this, in areas per site, hold more than one. Chosen."""


@dataclass(frozen=True, eq=False)
class Sites:
    """Places on triangles.

    Attributes
    ----------
    faces : (k,) int
    weights : (k, 3) float
        Barycentric; a third each unless the triangle is large.
    positions : (k, 3) float
    free : (k,) float
        Distance that is free around each of boundary and sharp edges; inf far from them.
    spacing : float
        A middling distance between sites.
    """

    faces: IntArray
    weights: FloatArray
    positions: FloatArray
    free: FloatArray
    spacing: float


def usual_sites(triangles: Triangles, density: float = 1.0) -> Sites:
    """Return places for crosses, as many as suit a picture times `density`."""
    number = USUAL if triangles.plane_normal is None else USUAL_PLANAR
    return spread_sites(triangles, density * number)


@lru_cache(maxsize=2)
def spread_sites(triangles: Triangles, count: float) -> Sites:
    """Choose about `count` places, no two near each other, none leaving a hole.

    Each candidate, a triangle's barycentre, has a rank drawn from its position (not its number),
    and is chosen when it has the lowest among those left within a distance r: Luby's parallel
    choice of a maximal independent set. Where a surface is refined locally, the choice elsewhere
    stays the same.

    Parameters
    ----------
    triangles : Triangles
    count : float
        Number of places wanted; fewer when the triangles are fewer.
    """
    total = float(triangles.areas.sum()) or 1.0
    radius = _PACKING * np.sqrt(total / count)
    share = _CANDIDATES * count * triangles.areas / total
    faces, weights = _candidates(share)
    positions = np.einsum("kc,kcx->kx", weights, triangles.points[triangles.faces[faces]])
    centre = np.arange(len(faces)) < len(share)
    rank = _position_hash(positions, triangles.points)
    border = _distance(positions, triangles.points[triangles.boundary_edges], radius)
    sharp = triangles.points[triangles.sharp_edges(_SHARP)]
    # Crosses end at sharp edges too, but there may be any number of them.
    free = np.minimum(border, np.maximum(_distance(positions, sharp, radius), _BORDER * radius))
    kept = ((rank <= share[faces]) | ~centre) & (border >= _BORDER * radius)
    # The barycentres first: more sites in a large triangle only fill it up.
    order = np.where(centre, rank / np.maximum(share[faces], 1e-300), 1.0 + rank)
    chosen = np.flatnonzero(kept)
    where = np.hstack([positions, _NORMAL_WEIGHT * radius * triangles.normals[faces]])[chosen]
    pairs = cKDTree(where).query_pairs(radius, output_type="ndarray")
    chosen = chosen[_lowest_apart(order[chosen], pairs)]
    spacing = float(np.sqrt(total / max(len(chosen), 1)))
    return Sites(faces[chosen], weights[chosen], positions[chosen], free[chosen], spacing)


def _candidates(share: FloatArray) -> tuple[IntArray, FloatArray]:
    """Every barycentre, and evenly strewn points in large triangles: faces, weights."""
    extra = np.where(share > _LARGE * _CANDIDATES, share, 0.0).astype(int)
    faces = np.repeat(np.arange(len(share)), extra)
    number = np.arange(len(faces)) - np.repeat(np.cumsum(extra) - extra, extra)
    # The sequence of Roberts: the plastic number's powers spread evenly over a square.
    a, b = ((0.5 + number[:, None] * np.array([0.7548776662466927, 0.5698402909980532])) % 1.0).T
    folded = a + b > 1.0
    a, b = np.where(folded, 1.0 - a, a), np.where(folded, 1.0 - b, b)
    inside = np.stack([1.0 - a - b, a, b], axis=1)
    thirds = np.full((len(share), 3), 1.0 / 3.0)
    return np.concatenate([np.arange(len(share)), faces]), np.vstack([thirds, inside])


def _distance(positions: FloatArray, ends: FloatArray, radius: float) -> FloatArray:
    """Distance of each position to segments (e, 2, 3), told from points on them, to radius / 8."""
    if not len(ends):
        return np.full(len(positions), np.inf)
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    pieces = np.maximum(np.ceil(lengths / (0.25 * radius)), 1.0).astype(int)
    edge = np.repeat(np.arange(len(ends)), pieces)
    number = np.arange(len(edge)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    along = ((number + 0.5) / pieces[edge])[:, None]
    points = (1.0 - along) * ends[edge, 0] + along * ends[edge, 1]
    return np.asarray(cKDTree(points).query(positions, distance_upper_bound=2.0 * radius)[0])


def _position_hash(positions: FloatArray, points: FloatArray) -> npt.NDArray[np.float64]:
    """Return a number in (0, 1) per position, the same wherever the position is the same."""
    low = points.min(axis=0)
    extent = float(np.ptp(points, axis=0).max()) or 1.0
    grid = np.round((positions - low) / extent * 1e6).astype(np.uint64)
    mixed = grid @ np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], np.uint64)
    for shift, factor in ((31, 0x7FB5D329728EA185), (27, 0x81DADEF4BC2DD44D)):
        mixed = (mixed ^ (mixed >> np.uint64(shift))) * np.uint64(factor)
    mixed ^= mixed >> np.uint64(33)
    return np.asarray((mixed >> np.uint64(11)).astype(float) / 2.0**53)


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
