"""Working triangulations: what a surface is solved on, whatever the shape of its triangles.

A working triangulation has the metric of the triangulation that it was made from, and other
triangles: edges are flipped, edges and triangles are split. Points, directions and lines are taken
from one to the other and back, exactly but for rounding: what Sharp, Soliman and Crane 2019 do by
tracing signposts is done by replaying the moves.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from copy import copy
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from solvers.frozen import freeze_arrays
from solvers.surface.moves import ComplexArray, Round, as_complex, as_real, frame_of
from solvers.surface.triangulation import (
    BoolArray,
    FloatArray,
    IntArray,
    IntrinsicTriangulation,
    laid_out,
    next_halfedge,
    previous_halfedge,
)


@dataclass(frozen=True, eq=False)
class Located:
    """Points of one triangulation, found on another with the same metric.

    Parameters
    ----------
    face : (k,) int array
        The triangle of each.
    place : (k, 2) float array
        Coordinates in that triangle's frame.
    turn : (k,) float array
        Angle, in that frame, of a direction that was at angle zero in the frame of the triangle
        that it comes from, radians.

    Examples
    --------
    The kite of `intrinsic_delaunay`, whose vertex 0 is the last corner of the new triangle 0:

    >>> import numpy as np
    >>> from solvers.surface import TriSurface, intrinsic_delaunay
    >>> kite = TriSurface(
    ...     [[-2, 0, 0], [0, -1, 0], [2, 0, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]]
    ... ).triangulation
    >>> working = intrinsic_delaunay(kite)
    >>> corner = working.triangulation.corner_positions[0, 2]
    >>> where = working.locate(np.array([0]), np.array([[0.0, 0.0]]))
    >>> bool(np.allclose(where.place, corner))
    True
    """

    face: IntArray
    place: FloatArray
    turn: FloatArray

    def __post_init__(self) -> None:
        freeze_arrays(self)


@dataclass(frozen=True, eq=False)
class Segments:
    """Pieces of straight lines, each inside one triangle of the original triangulation.

    Parameters
    ----------
    line : (k,) int array
        The line that each is part of; in order, and in order along it.
    part : (k, 2) float array
        Where on the line it starts and ends, 0 to 1.
    face : (k,) int array
        Its triangle.
    ends : (k, 2, 2) float array
        Its start and its end in that triangle's frame.

    Examples
    --------
    The short diagonal of the kite of `intrinsic_delaunay` crosses both triangles:

    >>> import numpy as np
    >>> from solvers.surface import TriSurface, intrinsic_delaunay
    >>> kite = TriSurface(
    ...     [[-2, 0, 0], [0, -1, 0], [2, 0, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]]
    ... ).triangulation
    >>> working = intrinsic_delaunay(kite)
    >>> start, end, _ = working.triangulation.corner_positions[0]
    >>> pieces = working.lift_segments(np.array([0]), start[None], end[None])
    >>> pieces.face.tolist(), pieces.part.round(9).tolist()
    ([0, 1], [[0.0, 0.5], [0.5, 1.0]])
    """

    line: IntArray
    part: FloatArray
    face: IntArray
    ends: FloatArray

    def __post_init__(self) -> None:
        freeze_arrays(self)


@dataclass(frozen=True, eq=False)
class WorkingTriangulation:
    """A triangulation, the moves that made it from an original one, and marked edges.

    Further rounds of moves are made on an `Edit`, ``working.edit()``; ``edit.done()`` is another
    working triangulation of the same original. Values on triangles and halfedges may go along.

    Parameters
    ----------
    original : IntrinsicTriangulation
        What it was made from. Its vertices keep their numbers.
    triangulation : IntrinsicTriangulation
        What came of it.
    rounds : tuple of Round
        The moves, in order.
    marks : (r, 3 m) int array
        Rows of numbers on halfedges of the triangulation, 0 for none. Marked edges are not
        flipped, and both halves of one that is split have its number.

    Examples
    --------
    Two triangles become four at the middle of the edge between them, and none is lost:

    >>> import numpy as np
    >>> from solvers.surface import TriSurface, WorkingTriangulation
    >>> square = TriSurface([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    >>> edit = WorkingTriangulation.of(square.triangulation).edit()
    >>> edit.split_edges(np.array([2])).tolist()  # the new vertex
    [4]
    >>> split = edit.done()
    >>> split.triangulation.n_faces, round(float(split.triangulation.areas.sum()), 12)
    (4, 1.0)
    """

    original: IntrinsicTriangulation
    triangulation: IntrinsicTriangulation
    rounds: tuple[Round, ...]
    marks: IntArray

    def __post_init__(self) -> None:
        freeze_arrays(self)

    @classmethod
    def of(
        cls, triangulation: IntrinsicTriangulation, marks: IntArray | None = None
    ) -> WorkingTriangulation:
        """Return a triangulation as it is.

        Parameters
        ----------
        triangulation : IntrinsicTriangulation
            The original.
        marks : (r, 3 m) int array, optional
            Numbers on its halfedges, as the attribute; by default none.
        """
        none = np.zeros((0, len(triangulation.twin)), dtype=np.int64)
        return cls(triangulation, triangulation, (), none if marks is None else marks)

    @property
    def unchanged(self) -> bool:
        """Whether its triangles are the original ones."""
        return not self.rounds

    @cached_property
    def n_flips(self) -> int:
        """Number of edges flipped."""
        return sum(len(r.old) for r in self.rounds if r.new.shape[1] == 2 == r.old.shape[1])

    def edit(self, *, turns: IntArray | None = None, angles: FloatArray | None = None) -> Edit:
        """Return it as something to change.

        Parameters
        ----------
        turns : (3 m,) int array, optional
            Whole numbers on halfedges, of opposite sign on twins, such as period jumps, to be
            carried along.
        angles : (m,) float array, optional
            Angles of crosses in the frames of triangles, to be carried along.
        """
        return Edit(self, turns, angles)

    def locate(self, face: IntArray, place: FloatArray) -> Located:
        """Return where points of the original lie on the triangulation.

        Parameters
        ----------
        face : (k,) int array
            Original triangle of each point.
        place : (k, 2) float array
            Coordinates in that triangle's frame.

        Returns
        -------
        Located
        """
        at, turn = as_complex(place), np.zeros(len(face))
        face = face.copy()
        for round_, who, patch in self._replayed(self.rounds, face):
            face[who], at[who], turned = round_.forwards(patch, face[who], at[who])
            turn[who] += turned
        return Located(face, as_real(at), turn)

    def lift(self, face: IntArray, place: FloatArray) -> Located:
        """Return where points of the triangulation lie on the original.

        Parameters
        ----------
        face : (k,) int array
            Triangle of each point.
        place : (k, 2) float array
            Coordinates in that triangle's frame.

        Returns
        -------
        Located
        """
        at, turn = as_complex(place), np.zeros(len(face))
        face = face.copy()
        for round_, who, patch in self._replayed(self.rounds[::-1], face, back=True):
            face[who], at[who], turned = round_.backwards(patch, face[who], at[who])
            turn[who] += turned
        return Located(face, as_real(at), turn)

    def lift_points(self, face: IntArray, weights: FloatArray) -> tuple[IntArray, FloatArray]:
        """Return points of the triangulation as points of the original.

        Parameters
        ----------
        face : (k,) int array
            Triangle of each point.
        weights : (k, 3) float array
            Its barycentric weights.

        Returns
        -------
        face : (k,) int array
            Its original triangle.
        weights : (k, 3) float array
            Its barycentric weights there, none negative.
        """
        if self.unchanged:
            return face, weights
        lifted = self.lift(face, self.triangulation.places(face, weights))
        return lifted.face, weights_inside(self.original, lifted.face, lifted.place)

    def lift_segments(self, face: IntArray, start: FloatArray, end: FloatArray) -> Segments:
        """Return straight lines inside triangles as lines on the original.

        Parameters
        ----------
        face : (k,) int array
            Triangle of each line.
        start, end : (k, 2) float arrays
            Its ends in that triangle's frame.

        Returns
        -------
        Segments
        """
        pieces = _Pieces(face, as_complex(start), as_complex(end))
        for round_ in self.rounds[::-1]:
            for _, who, patch in self._replayed([round_], pieces.face, back=True):
                pieces.take_back(round_, who, patch)
        return pieces.segments()

    def _replayed(
        self, rounds: Iterable[Round], face: IntArray, *, back: bool = False
    ) -> Iterator[tuple[Round, IntArray, IntArray]]:
        """Yield each round with the points in triangles that it replaces, and their patches."""
        patch_of = np.full(self.triangulation.n_faces, -1, dtype=np.int64)
        for round_ in rounds:
            moved = round_.new if back else round_.old
            patch_of[moved] = np.arange(len(moved))[:, None]
            patch = patch_of[face]
            patch_of[moved] = -1
            who = np.flatnonzero(patch >= 0)
            if len(who):
                yield round_, who, patch[who]


def weights_inside(t: IntrinsicTriangulation, face: IntArray, place: FloatArray) -> FloatArray:
    """Return the weights (k, 3) of places in triangles, moved inside where rounding put them out.

    First towards the first side, then along it: in flat triangles rounding makes large weights, but
    moves no point far.
    """
    corners = t.corner_positions[face]
    third = np.clip(place[:, 1] / corners[:, 2, 1], 0.0, 1.0)
    second = (place[:, 0] - third * corners[:, 2, 0]) / corners[:, 1, 0]
    second = np.clip(second, 0.0, 1.0 - third)
    return np.stack([1.0 - second - third, second, third], axis=1)


class _Pieces:
    """Pieces of lines on their way back to the original triangulation."""

    def __init__(self, face: IntArray, start: ComplexArray, end: ComplexArray) -> None:
        k = len(face)
        self._line, self.face = np.arange(k), face.copy()
        self._part = np.stack([np.zeros(k), np.ones(k)], axis=1)
        self._ends = np.stack([start, end], axis=1)

    def take_back(self, round_: Round, who: IntArray, patch: IntArray) -> None:
        """Take pieces back over one round, cut where the old triangles met."""
        at = round_.cuts(patch, self.face[who], *self._ends[who].T)
        cut = np.flatnonzero(~np.isnan(at))
        if len(cut):
            k, first = len(self.face), who[cut]
            middle = self._ends[first, 0] + at[cut] * (self._ends[first, 1] - self._ends[first, 0])
            where = self._part[first, 0] + at[cut] * np.diff(self._part[first])[:, 0]
            self._line = np.concatenate([self._line, self._line[first]])
            self.face = np.concatenate([self.face, self.face[first]])
            self._part = np.concatenate([self._part, self._part[first]])
            self._ends = np.concatenate([self._ends, self._ends[first]])
            self._part[first, 1] = self._part[k:, 0] = where
            self._ends[first, 1] = self._ends[k:, 0] = middle
            who = np.concatenate([who, np.arange(k, len(self.face))])
            patch = np.concatenate([patch, patch[cut]])
        # A piece lies where its middle does; its ends may be on the edge between.
        start, end = self._ends[who].T
        face, place, turn = round_.backwards(patch, self.face[who], (start + end) / 2)
        half = (end - start) / 2 * np.exp(1j * turn)
        self._ends[who] = np.stack([place - half, place + half], axis=1)
        self.face[who] = face

    def segments(self) -> Segments:
        """Return the pieces in order."""
        order = np.lexsort((self._part[:, 0], self._line))
        return Segments(
            self._line[order], self._part[order], self.face[order], as_real(self._ends[order])
        )


class Edit:
    """A working triangulation while it changes.

    Each verb makes one round of moves in patches that must not overlap; `disjoint` chooses such.

    Parameters
    ----------
    working : WorkingTriangulation
        What to start from.
    turns : (3 m,) int array, optional
        As of `WorkingTriangulation.edit`.
    angles : (m,) float array, optional
        As of `WorkingTriangulation.edit`.

    Attributes
    ----------
    n_vertices : int
        Number of vertices so far.
    faces, twin, lengths : int, int and float arrays
        As of `IntrinsicTriangulation`, so far.
    marks : (r, 3 m) int array
        As of `WorkingTriangulation`, so far.
    turns : (3 m,) int array
        The whole numbers so far. A new triangle continues the cross of an old one, so that those
        between the same crosses stay the same; 0 where none were given.
    angles : (m,) float array
        The angles so far.

    Examples
    --------
    An edge is flipped, with a quarter turn between the crosses on its sides:

    >>> import numpy as np
    >>> from solvers.surface import TriSurface, WorkingTriangulation
    >>> square = TriSurface([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    >>> turns = np.array([0, 0, 1, -1, 0, 0])  # halfedges 2 and 3 are twins
    >>> edit = WorkingTriangulation.of(square.triangulation).edit(turns=turns)
    >>> around = edit.flip(np.array([2]))
    >>> edit.turns[edit.turns != 0].tolist(), edit.turns[around].tolist()
    ([1, -1], [0, 0, 0, 0])
    """

    def __init__(
        self,
        working: WorkingTriangulation,
        turns: IntArray | None = None,
        angles: FloatArray | None = None,
    ) -> None:
        t = working.triangulation
        self._original = working.original
        self._rounds = list(working.rounds)
        self.n_vertices = t.n_vertices
        self.faces, self.twin = t.faces.copy(), t.twin.copy()
        self.lengths, self.marks = t.lengths.copy(), working.marks.copy()
        self.turns = np.zeros(len(t.twin), dtype=np.int64) if turns is None else turns.copy()
        self.angles = np.zeros(t.n_faces) if angles is None else angles.copy()
        self._number = np.arange(len(t.twin))
        self._claimed = np.full(t.n_faces, len(t.twin), dtype=np.int64)

    @property
    def unchanged(self) -> bool:
        """Whether no move has been made on the original triangles."""
        return not self._rounds

    def copied(self) -> Edit:
        """Return another one, with what has been done so far, to try moves on."""
        other = copy(self)
        other._rounds = list(self._rounds)
        for name in ("faces", "twin", "lengths", "marks", "turns", "angles", "_number", "_claimed"):
            setattr(other, name, getattr(self, name).copy())
        return other

    def done(self) -> WorkingTriangulation:
        """Return what has become of it."""
        t = IntrinsicTriangulation(
            self.n_vertices, self.faces.copy(), self.twin.copy(), self.lengths.copy()
        )
        return WorkingTriangulation(self._original, t, tuple(self._rounds), self.marks.copy())

    def fixed(self, h: IntArray) -> BoolArray:
        """Return which halfedges lie on marked edges or the boundary.

        Parameters
        ----------
        h : (k,) int array
            Halfedges.
        """
        marked = (self.marks[:, h] != 0) | (self.marks[:, self.twin[h]] != 0)
        return np.asarray(marked.any(axis=0) | (self.twin[h] < 0))

    def disjoint(self, rank: npt.NDArray[np.generic], *faces: IntArray) -> BoolArray:
        """Return which moves can be made at once: those that come first in all their triangles.

        Parameters
        ----------
        rank : (k,) array
            What tells which move goes first, the smallest.
        *faces : (k,) int arrays
            Triangles of each move; -1 for none.
        """
        place = np.empty(len(rank), dtype=np.int64)
        place[np.argsort(rank, kind="stable")] = np.arange(len(rank))
        for face in faces:
            np.minimum.at(self._claimed, face[face >= 0], place[face >= 0])
        first = np.ones(len(rank), dtype=bool)
        for face in faces:
            first &= (face < 0) | (self._claimed[face] == place)
        for face in faces:
            self._claimed[face[face >= 0]] = len(self.twin)
        return first

    def flip(self, h: IntArray) -> IntArray:
        """Flip edges, no two of the same triangle; their quadrilaterals have to be convex.

        Parameters
        ----------
        h : (k,) int array
            A halfedge of each; not fixed.

        Returns
        -------
        (4 k,) int array
            The halfedges around.
        """
        g = self.twin[h]
        left, right = h // 3, g // 3
        a, b, c, d, frames = self._quadrilateral(h, g)
        corners = np.stack([np.stack([c, d, b], axis=1), np.stack([d, c, a], axis=1)], axis=1)
        bc, ca = next_halfedge(h), previous_halfedge(h)
        ad, db = next_halfedge(g), previous_halfedge(g)
        va, vb, vc, vd = (self.faces.reshape(-1)[x] for x in (h, g, ca, db))
        crossed = self.turns[h]
        # The new left face is (c, d, b), the new right face (d, c, a).
        source = np.concatenate([db, bc, ca, ad])
        target = np.concatenate([3 * left + 1, 3 * left + 2, 3 * right + 1, 3 * right + 2])
        # What lay right is now seen from the left cross, and the other way.
        none = np.zeros_like(crossed)
        self._move(source, target, np.concatenate([crossed, none, -crossed, none]))
        self.faces[left] = np.stack([vc, vd, vb], axis=1)
        self.faces[right] = np.stack([vd, vc, va], axis=1)
        self._join(3 * left, 3 * right, np.abs(d - c), crossed)
        both = np.stack([left, right], axis=1)
        self._record(both, both, frames, corners, np.stack([a, b], axis=1), [0, 1])
        return target

    def split_edges(self, h: IntArray, at: float | FloatArray = 0.5) -> IntArray:
        """Put a vertex on edges, no two of the same triangle.

        The triangle on the left of h, with corners a, b and c, becomes that with the new vertex
        instead of b, under its old number, and that with it instead of a.

        Parameters
        ----------
        h : (k,) int array
            A halfedge of each.
        at : float or (k,) float array, optional
            Where along it, between 0 and 1.

        Returns
        -------
        (k,) int array
            The new vertices.
        """
        inner = self.twin[h] >= 0
        along = np.broadcast_to(np.asarray(at, dtype=np.float64), h.shape)
        new = self._new_vertices(len(h))
        self._split_inner(h[inner], along[inner], new[inner])
        self._split_border(h[~inner], along[~inner], new[~inner])
        return new

    def split_faces(self, face: IntArray, place: FloatArray) -> IntArray:
        """Put a vertex into triangles.

        Parameters
        ----------
        face : (k,) int array
            The triangles, none twice.
        place : (k, 2) float array
            Where, in the frame of each.

        Returns
        -------
        (k,) int array
            The new vertices.
        """
        new = self._new_vertices(len(face))
        if not len(face):
            return new
        p, z = as_complex(laid_out(self.lengths[face])), as_complex(place)
        second, third = self._new_faces(len(face)), self._new_faces(len(face))
        a, b, c = self.faces[face].T
        one, two, three = 3 * face, 3 * second, 3 * third
        # Each part keeps one side as its first: (a, b, new), (b, c, new), (c, a, new).
        self._move(np.concatenate([one + 1, one + 2]), np.concatenate([two, three]))
        for part, tail, head in ((face, a, b), (second, b, c), (third, c, a)):
            self.faces[part] = np.stack([tail, head, new], axis=1)
        spokes = np.abs(p - z[:, None]).T
        for i, (before, after) in enumerate(((one, three), (two, one), (three, two))):
            self._join(before + 2, after + 1, spokes[i])
        corners = np.stack(
            [np.stack([p[:, i], p[:, (i + 1) % 3], z], axis=1) for i in range(3)], axis=1
        )
        frames = np.broadcast_to(np.array([0.0, 1.0 + 0j]), (len(face), 1, 2))
        nothing = np.zeros((len(face), 2), dtype=complex)
        parts = np.stack([face, second, third], axis=1)
        self._record(face[:, None], parts, frames, corners, nothing, [0, 0, 0])
        return new

    def _split_inner(self, h: IntArray, at: FloatArray, new: IntArray) -> None:
        if not len(h):
            return
        g = self.twin[h]
        left, right = h // 3, g // 3
        a, b, c, d, frames = self._quadrilateral(h, g)
        m = a + at * (b - a)
        bc, ca = next_halfedge(h), previous_halfedge(h)
        ad, db = next_halfedge(g), previous_halfedge(g)
        va, vb, vc, vd = (self.faces.reshape(-1)[x] for x in (h, g, ca, db))
        ahead, back, crossed = self.marks[:, h], self.marks[:, g], self.turns[h]
        beyond, across = self._new_faces(len(h)), self._new_faces(len(h))
        # Left (a, m, c) and (m, b, c), right (b, m, d) and (m, a, d).
        source = np.concatenate([ca, bc, db, ad])
        target = np.concatenate([3 * left + 2, 3 * beyond + 1, 3 * right + 2, 3 * across + 1])
        self._move(source, target)
        parts = (left, beyond, right, across)
        rows = ((va, new, vc), (new, vb, vc), (vb, new, vd), (new, va, vd))
        for part, row in zip(parts, rows, strict=True):
            self.faces[part] = np.stack(row, axis=1)
        self._join(3 * left, 3 * across, np.abs(m - a), crossed, ahead, back)
        self._join(3 * beyond, 3 * right, np.abs(b - m), crossed, ahead, back)
        self._join(3 * left + 1, 3 * beyond + 2, np.abs(c - m))
        self._join(3 * right + 1, 3 * across + 2, np.abs(d - m))
        places = ((a, m, c), (m, b, c), (b, m, d), (m, a, d))
        corners = np.stack([np.stack(place, axis=1) for place in places], axis=1)
        old = np.stack([left, right], axis=1)
        between = np.stack([a, b], axis=1)
        self._record(old, np.stack(parts, axis=1), frames, corners, between, [0, 0, 1, 1])

    def _split_border(self, h: IntArray, at: FloatArray, new: IntArray) -> None:
        if not len(h):
            return
        face, i, rows = h // 3, h % 3, np.arange(len(h))
        p = as_complex(laid_out(self.lengths[face]))
        a, b, c = p[rows, i], p[rows, (i + 1) % 3], p[rows, (i + 2) % 3]
        m = a + at * (b - a)
        bc, ca = next_halfedge(h), previous_halfedge(h)
        va, vb, vc = (self.faces.reshape(-1)[x] for x in (h, bc, ca))
        ahead = self.marks[:, h]
        beyond = self._new_faces(len(h))
        self._move(np.concatenate([ca, bc]), np.concatenate([3 * face + 2, 3 * beyond + 1]))
        self.faces[face] = np.stack([va, new, vc], axis=1)
        self.faces[beyond] = np.stack([new, vb, vc], axis=1)
        for part, length in ((face, np.abs(m - a)), (beyond, np.abs(b - m))):
            self.twin[3 * part], self.lengths[part, 0] = -1, length
            self.marks[:, 3 * part], self.turns[3 * part] = ahead, 0
        self._join(3 * face + 1, 3 * beyond + 2, np.abs(c - m))
        corners = np.stack([np.stack([a, m, c], axis=1), np.stack([m, b, c], axis=1)], axis=1)
        frames = np.broadcast_to(np.array([0.0, 1.0 + 0j]), (len(h), 1, 2))
        parts = np.stack([face, beyond], axis=1)
        between = np.stack([a, b], axis=1)
        self._record(face[:, None], parts, frames, corners, between, [0, 0])

    def _quadrilateral(
        self, h: IntArray, g: IntArray
    ) -> tuple[ComplexArray, ComplexArray, ComplexArray, ComplexArray, ComplexArray]:
        """Lay pairs of triangles out in the plane, in the frames of the left ones.

        Returns the corners a, b (the edge), c (left apex) and d (right apex), and the frames
        (k, 2, 2) of left and right triangle.
        """
        left, i, right, j = h // 3, h % 3, g // 3, g % 3
        p, q = (as_complex(laid_out(self.lengths[face])) for face in (left, right))
        rows = np.arange(len(h))
        a, b, c = p[rows, i], p[rows, (i + 1) % 3], p[rows, (i + 2) % 3]
        # From a to b in the right triangle's frame, where j runs from b to a.
        there = q[rows, j] - q[rows, (j + 1) % 3]
        along = (b - a) / there
        along /= np.abs(along)
        origin = a - along * q[rows, (j + 1) % 3]
        d = origin + along * q[rows, (j + 2) % 3]
        own = np.broadcast_to(np.array([0.0, 1.0 + 0j]), (len(h), 2))
        return a, b, c, d, np.stack([own, np.stack([origin, along], axis=1)], axis=1)

    def _new_vertices(self, count: int) -> IntArray:
        first = self.n_vertices
        self.n_vertices += count
        return np.arange(first, self.n_vertices)

    def _new_faces(self, count: int) -> IntArray:
        """Make room for triangles and return their numbers."""
        first, m = len(self.faces), len(self.faces) + count
        self.faces = np.concatenate([self.faces, np.zeros((count, 3), dtype=np.int64)])
        self.lengths = np.concatenate([self.lengths, np.zeros((count, 3))])
        self.twin = np.concatenate([self.twin, np.full(3 * count, -1)])
        self.turns = np.concatenate([self.turns, np.zeros(3 * count, dtype=np.int64)])
        self.angles = np.concatenate([self.angles, np.zeros(count)])
        blank = np.zeros((len(self.marks), 3 * count), dtype=np.int64)
        self.marks = np.concatenate([self.marks, blank], axis=1)
        self._number = np.arange(3 * m)
        self._claimed = np.full(m, 3 * m, dtype=np.int64)
        return np.arange(first, m)

    def _move(self, source: IntArray, target: IntArray, turns: IntArray | None = None) -> None:
        """Give halfedges around patches new numbers, with all that they carry, turns added."""
        self._number[source] = target
        outer = self.twin[source]
        outer = np.where(outer >= 0, self._number[outer], -1)
        self._number[source] = source
        lengths = self.lengths.reshape(-1)
        lengths[target] = lengths[source]
        self.marks[:, target] = self.marks[:, source]
        self.turns[target] = self.turns[source]
        self.twin[target] = outer
        inner = outer >= 0
        self.twin[outer[inner]] = target[inner]
        if turns is not None:
            # One by one: both sides of an edge may have moved.
            np.add.at(self.turns, target[inner], turns[inner])
            np.subtract.at(self.turns, outer[inner], turns[inner])

    def _join(
        self,
        one: IntArray,
        other: IntArray,
        length: FloatArray,
        turns: IntArray | int = 0,
        ahead: IntArray | int = 0,
        back: IntArray | int = 0,
    ) -> None:
        """Make halfedges the two sides of an edge."""
        lengths = self.lengths.reshape(-1)
        for h, g, sign, mark in ((one, other, 1, ahead), (other, one, -1, back)):
            self.twin[h], lengths[h] = g, length
            self.turns[h], self.marks[:, h] = sign * turns, mark

    def _record(
        self,
        old: IntArray,
        new: IntArray,
        frames: ComplexArray,
        corners: ComplexArray,
        between: ComplexArray,
        parents: list[int],
    ) -> None:
        """Add a round; each new triangle continues the cross of one of the old ones."""
        self._rounds.append(Round(old, new, frames, corners, between))
        _, along = frame_of(corners)
        before = self.angles[old]
        self.angles[new] = before[:, parents] + np.angle(frames[:, parents, 1] / along)
