"""What a reader returns: points and polygons, to be triangulated."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from crossview.io.ears import cut
from solvers.errors import SurfaceError, counted, listed
from solvers.surface import FloatArray, IntArray

MOST_CORNERS = 5_000
"""Of a polygon that is cut up. Measured: 4 s, which grow with the square."""

TOGETHER = 100_000
"""Polygons of a size that are cut up together; bounds memory. Chosen."""


@dataclass(frozen=True)
class Polygons:
    """The surface elements of a file, as they stand there.

    Attributes
    ----------
    points : (n, 3) float array
    sizes : (m,) int array
        Number of corners of each polygon.
    corners : (sum of sizes,) int array
        The polygons' corners one after another.
    notes : tuple of str
        What was left out, in plain words.
    """

    points: FloatArray
    sizes: IntArray
    corners: IntArray
    notes: tuple[str, ...] = ()

    @classmethod
    def of_blocks(
        cls, points: FloatArray, blocks: Sequence[IntArray], notes: Sequence[str] = ()
    ) -> Polygons:
        """Join arrays (m_i, s_i) of polygons with s_i corners each."""
        sizes = [np.full(len(block), block.shape[1]) for block in blocks]
        corners = [block.reshape(-1) for block in blocks]
        none = [np.empty(0, dtype=np.int64)]
        return cls(
            points, np.concatenate(sizes + none), np.concatenate(corners + none), tuple(notes)
        )

    def triangles(self) -> tuple[IntArray, tuple[str, ...]]:
        """Return the (k, 3) triangles, n - 2 of each larger polygon, and the notes.

        A corner that follows itself in a larger polygon is left out before.

        Raises
        ------
        SurfaceError
            When polygons have corners that do not exist, fewer than three corners or more than
            `MOST_CORNERS`, or cross themselves; their numbers are told.
        """
        if (self.sizes == 3).all():
            return self.corners.reshape(-1, 3), self.notes
        owner = np.repeat(np.arange(len(self.sizes)), self.sizes)
        outside = (self.corners < 0) | (self.corners >= len(self.points))
        _refuse(owner[outside], f"polygons name vertices outside 0..{len(self.points) - 1}")
        _refuse(np.flatnonzero(self.sizes < 3), "polygons have fewer than three corners")
        _refuse(
            np.flatnonzero(self.sizes > MOST_CORNERS), f"polygons of over {MOST_CORNERS} corners"
        )
        first = np.cumsum(self.sizes) - self.sizes
        following = np.arange(1, len(self.corners) + 1)
        following[first + self.sizes - 1] = first
        again = (self.corners == self.corners[following]) & (self.sizes[owner] > 3)
        sizes = self.sizes - np.bincount(owner[again], minlength=len(self.sizes))
        _refuse(np.flatnonzero(sizes < 3), "polygons have fewer than three corners")
        corners = self.corners[~again]
        first = np.cumsum(sizes) - sizes
        place = np.cumsum(sizes - 2) - (sizes - 2)
        triangles = np.empty(((sizes - 2).sum(), 3), dtype=np.int64)
        crossed = []
        for size, these in _by_size(sizes):
            polygons = corners[first[these, None] + np.arange(size)]
            if size == 3:
                triangles[place[these]] = polygons
                continue
            cut_up, bad = cut(self.points, polygons)
            triangles[place[these, None] + np.arange(size - 2)] = cut_up
            crossed.append(these[bad])
        if crossed:
            what = "polygons cross themselves, or are far from flat"
            _refuse(np.concatenate(crossed), what)
        larger = int((self.sizes != 3).sum())
        notes = [f"split {counted(larger, 'polygon')} of more than three corners into triangles"]
        if again.any():
            notes.append(f"left out {counted(int(again.sum()), 'corner')} that follow themselves")
        return triangles, (*self.notes, *notes)


def _by_size(sizes: IntArray) -> Iterator[tuple[int, IntArray]]:
    """Yield the numbers of polygons of each size, not too many at once."""
    for size in np.unique(sizes).tolist():
        these = np.flatnonzero(sizes == size)
        for start in range(0, len(these), TOGETHER):
            yield size, these[start : start + TOGETHER]


def _refuse(polygons: IntArray, what: str) -> None:
    """Raise an error about polygons, if any."""
    bad = np.unique(polygons)
    if len(bad):
        where, advice = f"polygons {listed(bad)}", "mend the file they come from"
        raise SurfaceError(what, where, advice, bad, "faces")
