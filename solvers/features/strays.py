"""Sharp edges that are no features: those with no room beside longer ones, and strays.

Strays are short ends and zigzags that the triangles make, not the shape.
"""

from __future__ import annotations

import numpy as np

from solvers.features.edges import SHARP_TURN, Features, along_chains
from solvers.surface.triangulation import FloatArray, IntArray

NARROW = np.radians(30)
"""Angle between two features that leaves no room for a quad, radians.

Chosen below the 45 degrees up to which no quad is nearer to the angle than one, to drop few.
"""

CLOSE = np.radians(60)
"""Angle below which a weak curve gives way to a longer one, radians.

Chosen by trial: with it maps of scanned shapes have hardly any inverted triangles.
"""

SHORT = 6
"""Edges of a thread that is not short, at least. Chosen."""

STRONG = 1.5
"""By how much more than asked for a curve bends, a factor, not to be weak. Chosen."""

ZIGZAG = 0.5
"""Share of the vertices within a thread at which it turns sharply, if it is a zigzag. Chosen."""


def without_spurs(features: Features, bends: FloatArray, least: float) -> Features:
    """Return features less curves that leave a longer one at too sharp an angle.

    No quad fits between two curves that are next to parallel where they meet; beside a weak one
    it had better not be tried.

    Parameters
    ----------
    features : Features
        Sharp edges.
    bends : (ne,) float array
        By how much the surface bends over each of its edges, radians.
    least : float
        By how much it does over each of the features, at least, radians.

    Returns
    -------
    Features
        Those that are left.

    Examples
    --------
    A diagonal that ends on a straight crease, at 45 degrees, gives way where it is weak:

    >>> import numpy as np
    >>> from solvers.features import no_features, without_spurs
    >>> from solvers.primitives import square
    >>> from solvers.surface import EdgePaths
    >>> surface = square(n=4)
    >>> drawn = EdgePaths(surface).through(np.array([10, 14, 12, 18]))
    >>> features = no_features(surface).united(drawn)
    >>> [
    ...     len(without_spurs(features, np.full(len(surface.edges), bend), least=0.7))
    ...     for bend in (1.5, 0.8)
    ... ]
    [5, 4]
    """
    while len(spurs := _spurs(features, bends, least)):
        kept = ~np.isin(features.curve_of, spurs)
        features = Features(features.surface, features.edges[kept])
    return features


def _spurs(features: Features, bends: FloatArray, least: float) -> IntArray:
    """Return the curves that are the shorter side of a narrow sector."""
    found, count = features.sectors, len(features.curves)
    bounded = np.flatnonzero((found.angle < CLOSE) & (found.start >= 0) & (found.end >= 0))
    pairs = features.curve_of[np.stack([found.start[bounded], found.end[bounded]])]
    lengths = features.surface.triangulation.lengths.reshape(-1)[features.halfedges]
    length = np.bincount(features.curve_of, lengths, count)
    bend = np.bincount(features.curve_of, lengths * bends[features.edges], count)
    shorter = np.where(length[pairs[0]] < length[pairs[1]], pairs[0], pairs[1])
    weak = bend < STRONG * least * length
    no_room = weak[shorter] | (found.angle[bounded] < NARROW)
    return np.unique(shorter[no_room & (pairs[0] != pairs[1])])


def without_strays(features: Features, bends: FloatArray, least: float) -> Features:
    """Return features less threads with a loose end that are weak and short, or zigzag.

    A thread runs from one vertex where other than two features meet to the next, or to the
    boundary; closed ones and those between others have no loose end and stay. With a stray gone
    others may have become longer, or have a loose end: it is looked again until none is left.

    Parameters
    ----------
    features : Features
        Sharp edges.
    bends : (ne,) float array
        By how much the surface bends over each of its edges, radians.
    least : float
        By how much it does over each of the features, at least, radians.

    Returns
    -------
    Features
        Those that are left.

    Notes
    -----
    As hysteresis in edge detection (Canny 1986): what is weak stays where it goes on for long.

    Examples
    --------
    A crease across a sheet stays; a single edge of it within the sheet is a stray:

    >>> import numpy as np
    >>> from solvers.features import Features, without_strays
    >>> from solvers.primitives import square
    >>> surface = square(n=4)
    >>> on_axis = np.flatnonzero((surface.vertices[surface.edges][:, :, 1] == 0).all(axis=1))
    >>> bends = np.full(len(surface.edges), np.radians(50))
    >>> [
    ...     len(without_strays(Features(surface, edges), bends, np.radians(40)))
    ...     for edges in (on_axis, on_axis[1:2])
    ... ]
    [4, 0]
    """
    while len(strays := _strays(features, bends, least)):
        features = Features(features.surface, np.delete(features.edges, strays))
    return features


def _strays(features: Features, bends: FloatArray, least: float) -> IntArray:
    """Return the stray edges, by their positions among the features."""
    ends, degree = features.ends, features.degrees
    on_boundary = features.surface.boundary_vertices
    within = np.flatnonzero((degree == 2)[ends.reshape(-1)] & ~on_boundary[ends.reshape(-1)])
    vertex = ends.reshape(-1)[within]
    by_vertex = within[np.argsort(vertex, kind="stable")].reshape(-1, 2)
    passed = ends.reshape(-1)[by_vertex[:, 0]]
    turn = features.turns[passed]
    thread = np.unique(along_chains(len(features), by_vertex // 2, turn)[1], return_inverse=True)[1]
    count = np.bincount(thread)
    sharp, inner = (
        np.bincount(thread[by_vertex[:, 0] // 2], weights, len(count))
        for weights in (turn >= SHARP_TURN, None)
    )
    loose = ((degree == 1) & ~on_boundary)[ends].any(axis=1)
    has_loose = np.bincount(thread, loose) > 0
    bend = np.bincount(thread, bends[features.edges]) / count
    weak = (count < SHORT) & (bend < STRONG * least)
    zigzag = (inner > 0) & (sharp >= ZIGZAG * inner)
    return np.flatnonzero((has_loose & (weak | zigzag))[thread])
