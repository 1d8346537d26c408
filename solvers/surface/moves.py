"""Local moves of a triangulation, many at a time: edge flips, edge splits and face splits.

A move replaces the triangles of a small flat patch by others; the metric of the surface stays as it
is. Laid out in one plane, old and new triangles tell where points went, how frames turned, and,
run backwards, where points and lines come from.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from solvers.frozen import freeze_arrays
from solvers.surface.triangulation import FloatArray, IntArray

ComplexArray = npt.NDArray[np.complex128]

ON_LINE = 1e-12
"""Distance from a line, in parts of its length, at which a point counts as on it. From double
precision: nearer ones would be cut to pieces without length.
"""


@dataclass(frozen=True, eq=False)
class Round:
    """Moves in k disjoint patches, each of a old and b new triangles.

    Parameters
    ----------
    old : (k, a) int array
        The triangles of each patch before; one or two.
    new : (k, b) int array
        Those after; they take the numbers of the old ones and further ones.
    old_frames : (k, a, 2) complex array
        Origin and x direction of each old triangle's frame in the plane of its patch.
    new_corners : (k, b, 3) complex array
        Corners of the new triangles in that plane.
    between : (k, 2) complex array
        Ends of the edge between two old triangles, the first of them on its left.
    """

    old: IntArray
    new: IntArray
    old_frames: ComplexArray
    new_corners: ComplexArray
    between: ComplexArray

    def __post_init__(self) -> None:
        freeze_arrays(self)

    def forwards(
        self, patch: IntArray, face: IntArray, place: ComplexArray
    ) -> tuple[IntArray, ComplexArray, FloatArray]:
        """Return where points of old triangles lie among the new ones.

        Parameters
        ----------
        patch : (k,) int array
            The patch of each point.
        face : (k,) int array
            Its old triangle.
        place : (k,) complex array
            Its place in that triangle's frame.

        Returns
        -------
        face : (k,) int array
            Its new triangle.
        place : (k,) complex array
            Its place in that triangle's frame.
        turn : (k,) float array
            What to add to angles in the old frame for those in the new one, radians.
        """
        origin, along = self._old_frame(patch, face)
        flat = origin + along * place
        corners = self.new_corners[patch]
        sides = corners[:, :, [1, 2, 0]] - corners
        left = ((flat[:, None, None] - corners) * sides.conj() / np.abs(sides)).imag
        at = np.argmax(left.min(axis=2), axis=1)
        origin, new_along = frame_of(corners[np.arange(len(at)), at])
        return self.new[patch, at], (flat - origin) / new_along, np.angle(along / new_along)

    def backwards(
        self, patch: IntArray, face: IntArray, place: ComplexArray
    ) -> tuple[IntArray, ComplexArray, FloatArray]:
        """Return where points of new triangles lie among the old ones.

        Parameters
        ----------
        patch : (k,) int array
            The patch of each point.
        face : (k,) int array
            Its new triangle.
        place : (k,) complex array
            Its place in that triangle's frame.

        Returns
        -------
        face : (k,) int array
            Its old triangle.
        place : (k,) complex array
            Its place in that triangle's frame.
        turn : (k,) float array
            What to add to angles in the new frame for those in the old one, radians.
        """
        flat, new_along = self._flat(patch, face, place)
        at = (self._side(patch, flat) < 0).astype(np.int64)
        origin, along = self.old_frames[patch, at].T
        return self.old[patch, at], (flat - origin) / along, np.angle(new_along / along)

    def cuts(
        self, patch: IntArray, face: IntArray, start: ComplexArray, end: ComplexArray
    ) -> FloatArray:
        """Return where segments of new triangles cross the edge between the two old ones.

        Parameters
        ----------
        patch : (k,) int array
            The patch of each segment.
        face : (k,) int array
            Its new triangle.
        start, end : (k,) complex arrays
            Its ends in that triangle's frame.

        Returns
        -------
        (k,) float array
            How far along, 0 to 1; not a number for those that do not.
        """
        one, other = (self._side(patch, self._flat(patch, face, z)[0]) for z in (start, end))
        crosses = (one * other < 0) & (np.minimum(np.abs(one), np.abs(other)) > ON_LINE)
        return np.where(crosses, one / np.where(crosses, one - other, 1.0), np.nan)

    def _old_frame(self, patch: IntArray, face: IntArray) -> tuple[ComplexArray, ComplexArray]:
        at = np.argmax(self.old[patch] == face[:, None], axis=1)
        origin, along = self.old_frames[patch, at].T
        return origin, along

    def _flat(
        self, patch: IntArray, face: IntArray, place: ComplexArray
    ) -> tuple[ComplexArray, ComplexArray]:
        """Return places of new triangles in the plane, and the x directions of their frames."""
        at = np.argmax(self.new[patch] == face[:, None], axis=1)
        origin, along = frame_of(self.new_corners[patch, at])
        return origin + along * place, along

    def _side(self, patch: IntArray, flat: ComplexArray) -> FloatArray:
        """Return how far left of the edge between the old triangles places are, in its lengths."""
        if self.old.shape[1] == 1:
            return np.ones(len(patch))
        tail, head = self.between[patch].T
        return np.asarray(((flat - tail) / (head - tail)).imag)


def frame_of(corners: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
    """Return the origins and x directions (k,) of triangles' frames, from their corners (k, 3)."""
    along = corners[..., 1] - corners[..., 0]
    return corners[..., 0], along / np.abs(along)


def as_complex(place: FloatArray) -> ComplexArray:
    """Return places (..., 2) of the plane as complex numbers (...)."""
    return np.asarray(place[..., 0] + 1j * place[..., 1])


def as_real(place: ComplexArray) -> FloatArray:
    """Return complex numbers (...) as places (..., 2) of the plane."""
    return np.stack([place.real, place.imag], axis=-1)
