"""How many edges arcs of boundaries and features need to follow their bends, and where."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from solvers.layouts.layout import QuadLayout
from solvers.number_checks import real_number
from solvers.quads.collapse import Condition
from solvers.quads.spacing import spread
from solvers.quads.stretches import Polyline, Stretch, located, polylines, stretches
from solvers.surface.triangulation import BoolArray, FloatArray, IntArray

MAX_CHORD = 0.01
"""Largest distance of an edge from the arc it stands for, in radii of the arc.

Chosen: an edge may turn by 16.2 degrees then, and a circle has 23 at least.
"""

TIGHT = 0.75
"""Turn of edges where vertices are spaced by turning, in what they may turn by.

Chosen: a circle of edges that turn by so much has nearly half the error in area.
"""

MOST_BENDS = 0.9
"""What turning counts at most, beside length, for the sake of `TIGHT`.

Measured: with 1, where a boundary is straight between bends, a scan has 9 inverted quads, not 0.
"""

ON_EDGE = 1e-9
"""Barycentric weight up to which a point lies on an edge. Chosen: far above round-off."""


def bending_conditions(layout: QuadLayout, max_chord: float = MAX_CHORD) -> list[Condition]:
    """Return how many edges arcs of boundaries and features need to follow their bends.

    Parameters
    ----------
    layout : QuadLayout
        The rectangles on the surface.
    max_chord : float
        Largest distance of an edge from its arc, in radii of the arc; at most 1, a half circle.

    Returns
    -------
    list of Condition
        For single arcs, for consecutive arcs that one edge may not span, and for whole curves.
        Arcs that join two features, or a feature with a singularity or the boundary, need one edge.

    Raises
    ------
    CrossviewError
        If the chord error is not above 0 and at most 1.

    Notes
    -----
    An edge that turns by an angle a is off by 1 - cos(a / 2) radii, and by tan(a / 4) / 2 of its
    length. An arc needs as many edges as its turning asks for, or fewer if equal shares of it keep
    to the second: a zigzag turns much and is hardly off.

    Examples
    --------
    The unit circle around a square patch and four more needs 23 edges at least:

    >>> from solvers import run
    >>> from solvers.fields import IntegratedField, aligned_field, prepare
    >>> from solvers.layouts import quad_layout
    >>> from solvers.primitives import disk
    >>> from solvers.singularities import Singularity
    >>> surface = disk(edge_length=0.1)
    >>> places = [[0.5, 0, 0], [0, 0.5, 0], [-0.5, 0, 0], [0, -0.5, 0]]
    >>> threes = [Singularity(surface.closest_point(place), 3) for place in places]
    >>> aligned = aligned_field(prepare(surface, threes))
    >>> layout = run(quad_layout(IntegratedField(aligned, aligned.start)))
    >>> from solvers.quads import bending_conditions
    >>> conditions = bending_conditions(layout)
    >>> sorted(condition.least for condition in conditions)
    [6, 6, 6, 6]
    """
    turn = _largest_turn(max_chord)
    bent, crossing = _arcs_of_features(layout)
    found = [Condition(np.array([arc]), 1) for arc in np.flatnonzero(crossing).tolist()]
    for stretch in stretches(layout.arrangement, bent):
        found += _of_stretch(stretch, polylines(layout, stretch.arcs), turn)
    return found


def bent_spacing(
    layout: QuadLayout, counts: IntArray, max_chord: float = MAX_CHORD
) -> dict[int, FloatArray]:
    """Return where along bent arcs vertices are to be, where equal shares do not follow the bend.

    Parameters
    ----------
    layout : QuadLayout
        The rectangles on the surface.
    counts : (A,) int array
        Number of edges along each arc.
    max_chord : float
        As of `bending_conditions`.

    Returns
    -------
    dict from int to (count + 1,) float array
        For an arc how far along it, from 0 to 1 in the map, its vertices are: as nearly in equal
        shares as lets no edge turn by too much; the other arcs go along. Empty if all are in equal
        shares.

    Examples
    --------
    One patch, the sides of which are straight:

    >>> import numpy as np
    >>> from solvers import run
    >>> from solvers.fields import IntegratedField, aligned_field, prepare
    >>> from solvers.layouts import quad_layout
    >>> from solvers.primitives import square
    >>> aligned = aligned_field(prepare(square(n=4)))
    >>> layout = run(quad_layout(IntegratedField(aligned, aligned.start)))
    >>> from solvers.quads import bent_spacing
    >>> bent_spacing(layout, np.full(layout.tmesh.n_arcs, 3))
    {}
    """
    turn = _largest_turn(max_chord)
    bent = np.flatnonzero(_arcs_of_features(layout)[0] & (counts > 1))
    if len(bent) == 0:
        return {}
    lines = zip(bent.tolist(), polylines(layout, bent), strict=True)
    spaced = {arc: _spaced(line, int(counts[arc]), turn) for arc, line in lines}
    if all(places is None for places in spaced.values()):
        return {}
    equal = {arc: np.arange(counts[arc] + 1) / counts[arc] for arc in bent.tolist()}
    held = {arc: equal[arc] if places is None else places for arc, places in spaced.items()}
    every = polylines(layout, np.arange(layout.tmesh.n_arcs))
    points = [line.shared(int(n)) for line, n in zip(every, counts, strict=True)]
    return spread(layout.tmesh, points, counts, held)


def _largest_turn(max_chord: float) -> float:
    """Return by how much an edge may turn, radians."""
    return float(2 * np.arccos(1 - real_number("the chord error", max_chord, above=0, most=1)))


def _arcs_of_features(layout: QuadLayout) -> tuple[BoolArray, BoolArray]:
    """Return which arcs lie on the boundary or on features, and which lead from one to another."""
    arrangement, tmesh = layout.arrangement, layout.tmesh
    bent = tmesh.arc_on_boundary.copy()
    features = layout.integrated.aligned.features
    if len(features) == 0:
        return bent, np.zeros(len(bent), dtype=bool)
    face, weights = located(layout, arrangement.arc_curve, arrangement.arc_span.mean(axis=1))
    corner = weights.argmin(axis=1)
    edge = layout.surface.face_edges[face, (corner + 1) % 3]
    bent |= (weights.min(axis=1) < ON_EDGE) & np.isin(edge, features.edges)
    featured = np.zeros(tmesh.n_nodes, dtype=bool)
    featured[tmesh.arcs[bent & ~tmesh.arc_on_boundary]] = True
    held = featured | tmesh.critical | tmesh.node_on_boundary
    ends = tmesh.arcs
    return bent, ~bent & held[ends].all(axis=1) & featured[ends].any(axis=1)


def _of_stretch(stretch: Stretch, polylines: Sequence[Polyline], turn: float) -> list[Condition]:
    """Return the conditions of its arcs, of windows that one edge may not span, and of all."""
    arcs, k = stretch.arcs, len(stretch.arcs)
    need = np.array([_edges_for(line, turn) for line in polylines])
    found = [Condition(arcs[[i]], int(need[i])) for i in np.flatnonzero(need > 1)]
    if k == 1:
        return found
    whole = _edges_for(Polyline.chained(polylines), turn)
    if whole > need.sum():
        found.append(Condition(np.unique(arcs), whole))
    lines = [*polylines, *polylines] if stretch.closed else polylines
    for i in range(k):
        for j in range(i + 1, min(i + k, len(lines))):
            if (need[np.arange(i, j + 1) % k] > 1).any():
                break
            if _edges_for(Polyline.chained(lines[i : j + 1]), turn) > 1:
                found.append(Condition(np.unique(arcs[np.arange(i, j + 1) % k]), 2))
                break
    return found


def _edges_for(line: Polyline, turn: float) -> int:
    """Return the least number of edges, of equal shares or spaced, none of which is off by much."""
    turning = _turning(line, turn)
    most = max(1, int(np.ceil(turning.sum() / turn - 1e-6)))
    return next((n for n in range(1, most) if _follow(line, turning, n, turn)), most)


def _spaced(line: Polyline, n: int, turn: float) -> FloatArray | None:
    """Return where (n + 1,) vertices are so that edges follow, from 0 to 1; None if equally far."""
    turning = _turning(line, turn)
    if n < 2 or _follow(line, turning, n, turn):
        return None
    total = _total(turning)
    need = total[-1] / (n * turn)
    bends = min(1.0, max(need, min(MOST_BENDS, need / TIGHT)))
    even = line.share
    share = (1 - bends) * even + bends * total / total[-1]
    return np.asarray(np.interp(np.arange(n + 1) / n, share, even))


def _turning(line: Polyline, turn: float) -> FloatArray:
    """Return the turn (k,) at each point, at most as much as an edge may turn by.

    No number of edges follows a corner between two steps better than one that ends at it.
    """
    steps = np.diff(line.points, axis=0)
    length = np.linalg.norm(steps, axis=1)
    product = length[1:] * length[:-1]
    cosine = np.einsum("kd,kd->k", steps[1:], steps[:-1]) / np.where(product > 0, product, 1.0)
    angle = np.where(product > 0, np.arccos(np.clip(cosine, -1.0, 1.0)), 0.0)
    return np.concatenate([[0.0], np.minimum(angle, turn), [0.0]])


def _total(turning: FloatArray) -> FloatArray:
    """Return the turn (k,) up to each point; that at a point is spread over the steps beside it."""
    return np.asarray(np.cumsum(turning) - 0.5 * turning)


def _follow(line: Polyline, turning: FloatArray, n: int, turn: float) -> bool:
    """Return whether n edges of equal shares turn by little, or are off by little."""
    share, ends = line.share * n, line.shared(n)
    edge = np.clip(share.astype(np.int64), 0, n - 1)
    much = np.diff(np.interp(np.arange(n + 1), share, _total(turning))) > turn * (1 + 1e-6)
    along = np.diff(ends, axis=0)
    square = np.einsum("kd,kd->k", along, along)[edge]
    beside = line.points - ends[edge]
    product = np.einsum("kd,kd->k", beside, along[edge])
    part = np.clip(product / np.where(square > 0, square, 1.0), 0.0, 1.0)
    gap = np.linalg.norm(beside - part[:, None] * along[edge], axis=1)
    return not (much[edge] & (gap > np.tan(turn / 4) / 2 * np.sqrt(square))).any()
