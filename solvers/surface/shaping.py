"""Intrinsic Delaunay refinement: poor triangles are replaced, good ones stay as they are.

A triangle with too small an angle gets a vertex at its circumcentre, or its surroundings one in the
middle of the fixed edge that the circumcentre is hidden by or too near to (Ruppert 1995, Chew 1993;
on surfaces Sharp, Soliman and Crane 2019). The worst come first, all that are apart at once.
"""

from __future__ import annotations

import numpy as np

from solvers.surface.delaunay import flip_to_delaunay
from solvers.surface.moves import ComplexArray, as_complex, as_real
from solvers.surface.triangulation import (
    FloatArray,
    IntArray,
    IntrinsicTriangulation,
    heron,
    laid_out,
)
from solvers.surface.working import Edit, WorkingTriangulation

ANGLES = np.radians([4, 8, 12, 16])
"""Least angles that are aimed at, one after the other, radians. Chosen: below the 20.7 degrees that
Ruppert's refinement is known to end with, and what refinement around singularities leaves; in steps
so that the worst triangles come first where vertices run out. Measured: with 24 no map is better.
"""

GROWTH, ALWAYS = 2.0, 1000
"""Vertices that are added at most, in parts of those there are, and as many in any case. Chosen."""

NEEDLE = np.radians(120)
"""Total angle around a vertex below which its triangles may have smaller angles. Chosen: three
triangles of twice the least angle, and room.
"""

CLOSE = 0.3
"""Distance of a new vertex from others at least, in parts of the spacing of the corners it comes
from. Chosen: less than what refinement asks for but next to needles, where it never ends.
"""

ON_EDGE = 0.1
"""Distance from an edge, in its lengths, below which a vertex is put on it. Chosen."""

DIGITS = 9
"""Decimal digits of shares of lengths that decide. Chosen, above rounding, which is to decide
nothing: a surface turned in space gets the same vertices.
"""

FARTHEST = 50
"""Triangles on the way to a circumcentre at most. Chosen; it takes two or three."""

MAX_ROUNDS = 1000
"""Rounds at most. Chosen; it takes some tens."""


def shaped(working: WorkingTriangulation) -> WorkingTriangulation:
    """Return a triangulation without poor triangles, as far as that can be had.

    Parameters
    ----------
    working : WorkingTriangulation
        Intrinsic Delaunay. Marked edges, and the boundary, may be split.

    Returns
    -------
    WorkingTriangulation
        The same where no triangle is poor. Small angles may stay between fixed edges, around
        vertices of a small total angle, and where `GROWTH` allows no further vertices.

    Raises
    ------
    SolveError
        As `intrinsic_delaunay`.

    Examples
    --------
    A strip of 2 triangles, 20 by 1:

    >>> import numpy as np
    >>> from solvers.primitives import rectangle
    >>> from solvers.surface import WorkingTriangulation, shaped
    >>> strip = WorkingTriangulation.of(rectangle(40, 3, 4, 2).triangulation)
    >>> for t in (strip.triangulation, shaped(strip).triangulation):
    ...     print(bool(t.angles.min() > np.radians(16)))
    False
    True
    """
    edit = working.edit()
    refinement = _Refinement(edit)
    for angle in ANGLES:
        refinement.run(float(np.sin(angle)))
    return edit.done() if edit.n_vertices > working.triangulation.n_vertices else working


def parted(working: WorkingTriangulation, row: int) -> WorkingTriangulation:
    """Return a triangulation in which no triangle has several edges that crosses are to follow.

    Those with two are split at the third edge, those with three in the middle.

    Parameters
    ----------
    working : WorkingTriangulation
        With poor triangles or without.
    row : int
        That of the marks whose edges are to be followed, besides the boundary.

    Returns
    -------
    WorkingTriangulation
        The same where there is no such triangle.

    Examples
    --------
    A triangle whose sides are all boundary becomes three:

    >>> import numpy as np
    >>> from solvers.surface import TriSurface, WorkingTriangulation, parted
    >>> alone = TriSurface([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]).triangulation
    >>> marks = np.zeros((1, 3), dtype=np.int64)
    >>> parted(WorkingTriangulation.of(alone, marks), 0).triangulation.n_faces
    3
    """
    edit, before = working.edit(), working.triangulation.n_vertices
    while True:
        marked = edit.marks[row] != 0
        follows = (marked | marked[edit.twin] | (edit.twin < 0)).reshape(-1, 3)
        count = follows.sum(axis=1)
        enclosed = np.flatnonzero(count == 3)
        edit.split_faces(enclosed, laid_out(edit.lengths[enclosed]).mean(axis=1))
        two = np.flatnonzero(count == 2)
        if not len(two):
            return edit.done() if edit.n_vertices > before else working
        h = 3 * two + np.argmin(follows[two], axis=1)
        edit.split_edges(h[edit.disjoint(h, h // 3, edit.twin[h] // 3)])


class _Refinement:
    """The vertices while they are added."""

    def __init__(self, edit: Edit) -> None:
        self._edit = edit
        self._left = max(int(GROWTH * edit.n_vertices), ALWAYS)
        t = edit.done().triangulation
        self._spacing = _spacing(t)
        self._needle = t.curvatures > 2 * np.pi - NEEDLE

    def run(self, sine: float) -> None:
        """Add vertices until no triangle that can be mended has an angle of a smaller sine."""
        edit = self._edit
        for _ in range(MAX_ROUNDS):
            poor, rank = self._poor(sine)
            if not len(poor) or self._left <= 0:
                return
            face, place, halfedge, along = self._targets(poor)
            centre = halfedge < 0
            spacing = self._spacing[edit.faces[poor]].min(axis=1)
            radius = np.where(centre, _circumradius(edit.lengths[poor]), 0.0)
            h = halfedge[~centre]
            radius[~centre] = np.minimum(along, 1 - along)[~centre] * edit.lengths[h // 3, h % 3]
            possible = (face >= 0) & (np.round(radius / spacing, DIGITS) > CLOSE)
            possible &= centre | (face != edit.twin[halfedge] // 3)
            chosen = np.flatnonzero(possible)
            if not len(chosen):
                return
            chosen = chosen[self._apart(rank[chosen], poor[chosen], face[chosen], halfedge[chosen])]
            chosen = chosen[np.argsort(rank[chosen], kind="stable")][: self._left]
            self._insert(face, place, halfedge, along, spacing, chosen)

    def _poor(self, sine: float) -> tuple[IntArray, FloatArray]:
        """Return the triangles with an angle of a smaller sine, and these sines."""
        edit = self._edit
        least = np.round(edit.lengths.min(axis=1) / (2 * _circumradius(edit.lengths)), DIGITS)
        poor = np.flatnonzero(least < sine)
        tip = (np.argmin(edit.lengths[poor], axis=1) + 2) % 3
        vertex = edit.faces[poor, tip]
        wedge = edit.fixed(3 * poor + tip) & edit.fixed(3 * poor + (tip + 2) % 3)
        needle = np.zeros(edit.n_vertices, dtype=bool)
        needle[: len(self._needle)] = self._needle
        poor = poor[~wedge & ~needle[vertex]]
        return poor, least[poor]

    def _targets(self, poor: IntArray) -> tuple[IntArray, ComplexArray, IntArray, FloatArray]:
        """Return where the vertices that mend triangles go.

        The triangle of each (-1 for none) and the place in its frame, or the halfedge (else -1)
        and how far along it, 0 to 1.
        """
        edit = self._edit
        face, place, halfedge = _seek(edit, poor, _circumcentres(edit.lengths[poor]))
        rows = np.arange(len(poor))
        p = as_complex(laid_out(edit.lengths[np.maximum(face, 0)]))
        sides = p[:, [1, 2, 0]] - p
        beside = np.round((place[:, None] - p) / sides, DIGITS)
        h = 3 * face[:, None] + np.arange(3)
        fixed = edit.fixed(np.maximum(h, 0).reshape(-1)).reshape(-1, 3)
        # From inside the circle over a fixed edge as diameter, the edge is split instead.
        blocks = fixed & (np.abs(beside - 0.5) < 0.5)
        at = np.argmin(beside.imag + ~blocks, axis=1)
        on_fixed = blocks[rows, at] & (halfedge < 0)
        nearest = np.argmin(beside.imag, axis=1)
        on_edge = (beside.imag[rows, nearest] < ON_EDGE) & (halfedge < 0) & ~on_fixed
        along = np.where(on_edge, np.clip(beside.real[rows, nearest], ON_EDGE, 1 - ON_EDGE), 0.5)
        along[on_edge & fixed[rows, nearest]] = 0.5
        halfedge = np.where(on_fixed, h[rows, at], np.where(on_edge, h[rows, nearest], halfedge))
        return face, place, halfedge, along

    def _apart(
        self, rank: FloatArray, poor: IntArray, face: IntArray, halfedge: IntArray
    ) -> IntArray:
        """Return which vertices to add at once: one in each neighbourhood."""
        edit = self._edit
        around = edit.twin[3 * face[:, None] + np.arange(3)]
        around = np.where(around >= 0, around // 3, -1)
        across = np.where(halfedge >= 0, edit.twin[halfedge], -1)
        across = np.where(across >= 0, across // 3, -1)
        return np.flatnonzero(edit.disjoint(rank, poor, face, across, *around.T))

    def _insert(
        self,
        face: IntArray,
        place: ComplexArray,
        halfedge: IntArray,
        along: FloatArray,
        spacing: FloatArray,
        chosen: IntArray,
    ) -> None:
        edit, before = self._edit, len(self._edit.faces)
        inside, on_edge = chosen[halfedge[chosen] < 0], chosen[halfedge[chosen] >= 0]
        edit.split_faces(face[inside], as_real(place[inside]))
        other = edit.twin[halfedge[on_edge]]
        edit.split_edges(halfedge[on_edge], along[on_edge])
        added = np.concatenate([inside, on_edge])
        self._spacing = np.concatenate([self._spacing, spacing[added]])
        self._left -= len(added)
        old = [face[inside], halfedge[on_edge] // 3, other[other >= 0] // 3]
        touched = np.concatenate([*old, np.arange(before, len(edit.faces))])
        flip_to_delaunay(edit, (3 * touched[:, None] + np.arange(3)).reshape(-1))


def _spacing(t: IntrinsicTriangulation) -> FloatArray:
    """Return the second shortest edge of each vertex (n,): the shortest may lead to a near one.

    Around two near vertices triangles of their distance would do harm: a map that is to have a
    singularity elsewhere gives way in the smallest triangles first, and turns them over.
    """
    h = t.edge_halfedges
    vertex = np.concatenate([t.tail[h], t.head[h]])
    length = np.tile(t.lengths.reshape(-1)[h], 2)
    order = np.lexsort((length, vertex))
    first = np.searchsorted(vertex[order], np.arange(t.n_vertices))
    last = np.searchsorted(vertex[order], np.arange(t.n_vertices), side="right") - 1
    return np.asarray(length[order[np.minimum(first + 1, last)]])


def _circumradius(lengths: FloatArray) -> FloatArray:
    """Return the radii of the circles around triangles with sides (k, 3)."""
    area = np.maximum(heron(lengths), np.finfo(float).tiny)
    return np.asarray(lengths.prod(axis=1) / (4 * area))


def _circumcentres(lengths: FloatArray) -> ComplexArray:
    """Return the circumcentres of triangles with sides (k, 3), in their frames."""
    _, second, third = as_complex(laid_out(lengths)).T
    height = np.maximum(third.imag, np.finfo(float).tiny)
    up = (np.abs(third) ** 2 - second.real * third.real) / (2 * height)
    return np.asarray(second.real / 2 + 1j * up)


def _seek(
    edit: Edit, face: IntArray, place: ComplexArray
) -> tuple[IntArray, ComplexArray, IntArray]:
    """Go from triangles towards places outside them, in their planes unfolded on the way.

    Returns the triangle (-1 where it is too far), the place in its frame, and the fixed halfedge
    in the way (-1 for none).
    """
    face, place, blocking = face.copy(), place.copy(), np.full(len(face), -1)
    going = np.arange(len(face))
    for _ in range(FARTHEST):
        p = as_complex(laid_out(edit.lengths[face[going]]))
        sides = p[:, [1, 2, 0]] - p
        inside = np.round(((place[going, None] - p) / sides).imag, DIGITS)
        side = np.argmin(inside, axis=1)
        rows = np.arange(len(going))
        out = inside[rows, side] < 0
        going, side, p = going[out], side[out], p[out]
        h = 3 * face[going] + side
        fixed = edit.fixed(h)
        blocking[going[fixed]] = h[fixed]
        going, side, p, g = going[~fixed], side[~fixed], p[~fixed], edit.twin[h[~fixed]]
        if not len(going):
            return face, place, blocking
        rows = np.arange(len(going))
        tail, head = p[rows, side], p[rows, (side + 1) % 3]
        face[going] = g // 3
        q = as_complex(laid_out(edit.lengths[g // 3]))
        there, here = q[rows, g % 3], q[rows, (g % 3 + 1) % 3]
        turn = (there - here) / (head - tail)
        place[going] = here + (place[going] - tail) * turn / np.abs(turn)
    face[going] = -1
    return face, place, blocking
