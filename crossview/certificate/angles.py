"""The angles at the corners of faces, in the tangent planes of the surface under them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from crossview.certificate.faces import Bools, Faces, Floats
from crossview.certificate.samples import Ground, doubled

FEW, MANY = 2, 6
"""Places under the quarter of a face at a corner, in each direction. Chosen: the first for all
corners, the second for those near the limits."""

AGREEING = 0.95
"""Length of the mean of unit normals above which few places are enough. Chosen: two normals are
then 36 degrees apart."""

NEAR = 30.0
"""Degrees above 0 and below 180 up to which an angle is measured with more places. Chosen."""

STRAIGHT = 1e-6
"""Degrees below 180, and above 0, that count as 180 and 0. Chosen, above rounding."""

AT_ONCE = (0.01, 0.2)
"""How far around a corner places are taken together, in its half sides. Chosen: as good as at the
corner, and over what a coarse surface has for its bend."""

NO_LENGTH = 1e-9
"""Length of a side that counts as none, in that of the face's longest. Chosen, above rounding."""

SLIVER = 1e-3
"""Length of a side, in that of its face's longest, below which it has hardly any. Chosen."""

FULL = 361.0
"""Degrees that two faces around a vertex may have together where the surface is flat. Chosen,
above rounding."""


@dataclass(frozen=True)
class Angles:
    """Angles at the corners of a mesh that lies on a surface.

    Faces that are oriented against their piece, and pieces against the surface, count as turned
    over: that is a fault of its own.

    Attributes
    ----------
    faces : Faces
    across : (c, 3) float array
        Cross product of the sides at each corner, on to the next corner and back to the last.
    level : (c,) float array
        Product of the two in the tangent plane.
    normals : (c, 3) float array
        Unit normals of the tangent planes.
    """

    faces: Faces
    across: Floats
    level: Floats
    normals: Floats

    @cached_property
    def _upright(self) -> Floats:
        """(c,) length of `across` along the normal."""
        return np.asarray(np.einsum("ij,ij->i", self.across, self.normals))

    @cached_property
    def _senses(self) -> tuple[Floats, Floats]:
        """-1 for each face turned against its piece, and for each piece against the surface."""
        turned = np.where(self.faces.turned[0], -1.0, 1.0)
        upright = np.bincount(self.faces.owner, self._upright) * turned
        return turned, np.where(np.bincount(self.faces.pieces[1], upright) < 0, -1.0, 1.0)

    @property
    def inside_out(self) -> int:
        """Number of pieces oriented against the surface."""
        return int(np.count_nonzero(self._senses[1] < 0))

    @cached_property
    def _sines(self) -> Floats:
        turned, pieces = self._senses
        return self._upright * (turned * pieces[self.faces.pieces[1]])[self.faces.owner]

    @cached_property
    def degrees(self) -> Floats:
        """(c,) angle of each corner, from 0 to 360."""
        return np.asarray(np.degrees(np.arctan2(self._sines, self.level)) % 360)

    @cached_property
    def scaled_jacobian(self) -> Floats:
        """(m,) least sine of a face's corners; -1 with a side without length (Knupp 2000)."""
        size = self.faces.lengths * self.faces.lengths[self.faces.before]
        sines = np.where(self.collapsed, -1.0, self._sines / np.where(size > 0, size, 1))
        return np.asarray(np.minimum.reduceat(sines, self.faces.starts))

    @cached_property
    def evenness(self) -> Floats:
        """(m,) a face's shortest side in its longest; 0 where none has a length."""
        length, starts = self.faces.lengths, self.faces.starts
        longest = np.maximum.reduceat(length, starts)
        shortest = np.minimum.reduceat(length, starts)
        return np.asarray(shortest / np.where(longest > 0, longest, 1))

    @cached_property
    def collapsed(self) -> Bools:
        """(c,) whether one of the two sides at a corner has no length."""
        length = self.faces.lengths
        longest = np.maximum.reduceat(length, self.faces.starts)[self.faces.owner]
        none = length <= NO_LENGTH * longest
        return np.asarray(none | none[self.faces.before])

    @cached_property
    def slivers(self) -> Bools:
        """(m,) whether a side of a face has hardly any length, but some."""
        none = np.bincount(self.faces.owner, self.collapsed) > 0
        return np.asarray((self.evenness < SLIVER) & ~none)

    @cached_property
    def _folded(self) -> Bools:
        """(c,) whether a corner has 180 degrees or more, or none."""
        convex = (self.degrees > STRAIGHT) & (self.degrees < 180 - STRAIGHT)
        return np.asarray(~convex | self.collapsed)

    @cached_property
    def excused(self) -> Bools:
        """(c,) whether a corner has 180 degrees or more because it is one of two in flat land."""
        faces = self.faces
        together = np.bincount(faces.corners, self.degrees, minlength=len(faces.points))
        two = (faces.meeting == 2) & ~faces.on_rim & (together < FULL)
        return np.asarray(self._folded & ~self.collapsed & two[faces.corners])

    @cached_property
    def inverted(self) -> Bools:
        """(c,) whether a corner has 180 degrees or more, or none, and nothing excuses it."""
        return np.asarray(self._folded & ~self.excused)


def corner_angles(faces: Faces, triangles: Floats, ground: Ground) -> Angles:
    """Measure a mesh on a surface.

    The normal at a corner is the mean of the surface's normals under the quarter of the face there
    (between the corner, the middles of its two sides and that of the face): those of its own side
    of a crease, however the face itself is bent. Where the surface bends much under a quarter, as
    at the tip of a horn, the means all around the corner itself are tried too, and the one taken
    in which the corner is most upright.

    Parameters
    ----------
    faces : Faces
    triangles : (t, 3, 3) float array
        The surface, oriented.
    ground : Ground
        Of the same triangles.
    """
    ends = faces.points[faces.sides]
    ahead = ends[:, 1] - ends[:, 0]
    back = -ahead[faces.before]
    across = np.cross(ahead, back)

    def measured(normals: Floats) -> Angles:
        rise = np.einsum("ij,ij->i", ahead, normals) * np.einsum("ij,ij->i", back, normals)
        level = np.einsum("ij,ij->i", ahead, back) - rise
        return Angles(faces, across, level, normals)

    unit = _unit(doubled(triangles))

    def mean(patch: Floats, n: int) -> tuple[Floats, Bools]:
        return _mean_normals(unit, ground, patch, n)

    quarter = _quarters(faces)
    wide, clear = mean(quarter, FEW)
    degrees = measured(wide).degrees
    again = np.flatnonzero((degrees < NEAR) | (degrees > 180 - NEAR) | ~clear)
    wide[again] = mean(quarter[:, again], MANY)[0]
    best = wide
    for reach in AT_ONCE:
        near = wide.copy()
        near[again] = mean(_around(quarter[:, again], wide[again], reach), MANY)[0]
        upright = measured(near)._sines > measured(best)._sines
        best = np.where(upright[:, None], near, best)
    return measured(best)


def _quarters(faces: Faces) -> Floats:
    """The quarter of a face at each corner (4, c, 3): corner, middles of sides and of the face."""
    places = faces.points[faces.corners]
    on, back = ((places + places[at]) / 2 for at in (faces.following, faces.before))
    return np.stack([places, on, faces.middles[faces.owner], back])


def _around(quarter: Floats, normals: Floats, reach: float) -> Floats:
    """A square (4, k, 3) about the corners of quarters, across normals, so far as part of a side.

    However straight the corner is: so the mean normal in it is the one weighted by angles.
    """
    here, on, _, back = quarter
    sides = np.stack([on - here, back - here])
    level = sides - np.einsum("skx,kx->sk", sides, normals)[..., None] * normals
    longer = np.linalg.norm(level, axis=2).argmax(axis=0)[None, :, None]
    first = np.take_along_axis(level, longer, axis=0)[0]
    second = np.cross(normals, first)
    turns = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    return np.asarray(here + reach * np.stack([a * first + b * second for a, b in turns]))


def _mean_normals(unit: Floats, ground: Ground, patch: Floats, n: int) -> tuple[Floats, Bools]:
    """Mean normals (k, 3) under n x n places of each patch (4, k, 3), and whether they agree."""
    step = (np.arange(n) + 0.5) / n
    s, t = np.repeat(step, n), np.tile(step, n)
    weights = np.stack([(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t])
    under = ground.under(np.einsum("qp,qkx->kpx", weights, patch).reshape(-1, 3))
    mean = unit[under].reshape(patch.shape[1], n * n, 3).mean(axis=1)
    return _unit(mean), np.asarray(np.linalg.norm(mean, axis=1) > AGREEING)


def _unit(vectors: Floats) -> Floats:
    """Vectors (k, 3) of length 1 in the same directions; 0 stays 0."""
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=1), 1e-300)[:, None])
