"""Where one singularity may go: level lines of its holonomy potentials.

With all others in place, the defect of condition i is that of the others plus (pi/2) k Z_i(x) for a
singularity of index k at x, modulo a quarter turn. So it stays on the level lines of Z_i, which
continue over the jumps of Z_i, and vanishes on some of them.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from solvers.fields.holonomy import Holonomy
from solvers.number_checks import whole_number
from solvers.singularities.budget import Singularity, checked_singularities
from solvers.surface.geodesics import straightest
from solvers.surface.points import SurfacePoint
from solvers.surface.triangulation import QUARTER, FloatArray, IntArray
from solvers.surface.trisurface import TriSurface

EXACT = 1e-12
"""Defect that counts as zero, radians. Chosen, some thousand times the rounding of an angle."""

REFINEMENTS = 12
"""How many steps take a crossing to where the potential says. Chosen; regula falsi needs fewer."""


@dataclass(frozen=True, eq=False)
class LevelLines:
    """Straight pieces, each in one triangle.

    Parameters
    ----------
    faces : (s,) int array
        The triangle of each piece.
    weights : (s, 2, 3) float array
        Barycentric weights of its two ends, on edges of the triangle.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers.primitives import square
    >>> from solvers.validity import LevelLines
    >>> piece = LevelLines(np.array([0]), np.array([[[0.5, 0.5, 0.0], [0.5, 0.0, 0.5]]]))
    >>> piece.ends(square(n=2, size=2.0)).tolist()  # of triangle 0
    [[[-0.5, -1.0, 0.0], [-0.5, -0.5, 0.0]]]
    """

    faces: IntArray
    weights: FloatArray

    def ends(self, surface: TriSurface) -> FloatArray:
        """Return the (s, 2, 3) coordinates of the ends.

        Parameters
        ----------
        surface : TriSurface
            That the lines lie on.
        """
        return np.asarray(
            np.einsum("sek,skd->sed", self.weights, surface.vertices[surface.faces[self.faces]])
        )


class Guide:
    """The level lines for one singularity of a configuration.

    Parameters
    ----------
    holonomy : Holonomy
        The potentials of the surface.
    singularities : iterable of Singularity
        The configuration, on the same surface.
    moving : int
        Which of them is to move.

    Raises
    ------
    CrossviewError
        If there is no such singularity, or one is of another surface; its methods if there is no
        such condition.

    Examples
    --------
    On an annulus a valence 5 fits a valence 3 where both lie on one ray:

    >>> import numpy as np
    >>> from solvers.fields import IsotropicSolver
    >>> from solvers.primitives import annulus
    >>> from solvers.singularities import Singularity
    >>> from solvers.validity import Guide
    >>> surface = annulus(n=24)
    >>> three = Singularity(surface.closest_point([0.8, 0.0, 0.0]), 3)
    >>> five = Singularity(surface.closest_point([-0.6, 0.0, 0.0]), 5)
    >>> guide = Guide(IsotropicSolver(surface).holonomy, [three, five], moving=1)
    >>> x, y, _ = guide.closing(0).ends(surface).reshape(-1, 3).T
    >>> bool(x.min() > 0 and np.allclose(y, 0))
    True
    >>> nearest = guide.kept(0, surface.closest_point([0.5, 0.2, 0.0]))
    >>> round(float(surface.position(nearest)[1]), 9) + 0.0
    0.0
    """

    def __init__(
        self, holonomy: Holonomy, singularities: Iterable[Singularity], moving: int
    ) -> None:
        self._holonomy = holonomy
        self._singularities = checked_singularities(singularities)
        last = len(self._singularities) - 1
        self._moving = whole_number("the number of the singularity that moves", moving, 0, last)
        others = [s for i, s in enumerate(self._singularities) if i != self._moving]
        self._index = self._singularities[self._moving].index
        self._others = holonomy.defects(others) / QUARTER

    def closing(self, condition: int) -> LevelLines:
        """Return where the defect of a condition vanishes.

        Parameters
        ----------
        condition : int
            Its number.
        """
        return self._lines(self._numbered(condition), 0.0)

    def keeping(self, condition: int) -> LevelLines:
        """Return where the defect of a condition is what it is now.

        Parameters
        ----------
        condition : int
            Its number.
        """
        condition = self._numbered(condition)
        now = self._holonomy.defects(self._singularities)[condition]
        return self._lines(condition, float(now) / QUARTER)

    def kept(self, condition: int, point: SurfacePoint, limit: int = 20) -> SurfacePoint:
        """Return the point near another at which the defect of a condition vanishes.

        Newton's method along the gradient of the potential.

        Parameters
        ----------
        condition : int
            Its number.
        point : SurfacePoint
            Where the singularity would be.
        limit : int, optional
            Of the number of steps.
        """
        surface = self._holonomy.discretization.surface
        condition = self._numbered(condition)
        for _ in range(whole_number("the limit of steps", limit, 0)):
            moved = list(self._singularities)
            moved[self._moving] = replace(moved[self._moving], point=point)
            defect = self._holonomy.defects(moved)[condition]
            if abs(defect) < EXACT:
                break
            slope = QUARTER * self._index * self._holonomy.gradients([point])[condition, 0]
            steepness = float(slope @ slope)
            if steepness * surface.area < EXACT:  # flat: no direction is better than another
                break
            point = straightest(surface, point, -defect * slope / steepness).end
        return point

    def _numbered(self, condition: int) -> int:
        last = len(self._holonomy.conditions) - 1
        return whole_number("the number of a holonomy condition", condition, 0, last)

    def _lines(self, condition: int, level: float) -> LevelLines:
        corners = self._index * self._holonomy.surface_values[condition]
        lines = _integer_lines(corners + (self._others[condition] - level))
        if not self._holonomy.discretization.working.unchanged:
            lines = self._exact(lines, condition, level)
        return lines.made()

    def _exact(self, lines: _Crossings, condition: int, level: float) -> _Crossings:
        """Return the crossings moved along edges that the operator has not.

        Between their ends the potential bends; it is followed by regula falsi (Illinois).
        """
        low, high = np.zeros(len(lines.share)), np.ones(len(lines.share))
        below, above = lines.below.copy(), lines.above.copy()
        share, last = lines.share, np.zeros(len(low), dtype=np.int64)
        for _ in range(REFINEMENTS):
            lines = replace(lines, share=share)
            z = self._holonomy.values_at(lines.faces, lines.weights)[condition]
            phase = self._index * z + self._others[condition] - level
            off = phase - np.rint(phase)
            rises = off * above < 0  # still on the side of the lower end
            low, high = np.where(rises, share, low), np.where(rises, high, share)
            halved = np.where(last == np.where(rises, 1, 2), 0.5, 1.0)
            below = np.where(rises, off, below * halved)
            above = np.where(rises, above * halved, off)
            last = np.where(rises, 1, 2)
            reach = np.where(above == below, 1.0, above - below)
            share = np.clip(low - below * (high - low) / reach, 0.0, 1.0)
        return replace(lines, share=share)


@dataclass(frozen=True, eq=False)
class _Crossings:
    """Where lines cross edges; two after one another are the ends of a piece.

    `faces` (n,), `start` and `end` (n,) corners of the edge, `share` (n,) of the way from one to
    the other, `below` and `above` (n,) how far the values there are from that of the line.
    """

    faces: IntArray
    start: IntArray
    end: IntArray
    share: FloatArray
    below: FloatArray
    above: FloatArray

    @property
    def weights(self) -> FloatArray:
        """(n, 3) barycentric weights."""
        weights = np.zeros((len(self.faces), 3))
        every = np.arange(len(self.faces))
        weights[every, self.start] = 1 - self.share
        weights[every, self.end] = self.share
        return weights

    def made(self) -> LevelLines:
        """Return the pieces."""
        return LevelLines(self.faces[::2], self.weights.reshape(-1, 2, 3))


def _integer_lines(corners: FloatArray) -> _Crossings:
    """Return where piecewise linear values, (m, 3) at the corners, are whole numbers.

    Values may jump by whole numbers from one triangle to the next (marching triangles).
    """
    a, b, c = corners.T
    first = np.floor(np.minimum(np.minimum(a, b), c))
    count = (np.floor(np.maximum(np.maximum(a, b), c)) - first).astype(np.int64)
    crossed = np.flatnonzero(count)
    faces = np.repeat(crossed, count[crossed])
    before = np.repeat(np.cumsum(count[crossed]) - count[crossed], count[crossed])
    number = first[faces] + 1 + np.arange(len(faces)) - before
    off = corners[faces] - number[:, None]
    # Each line parts one corner from the two others: it crosses the sides from it to them.
    high = off >= 0
    lone = np.argmax(high == (high.sum(axis=1) == 1)[:, None], axis=1)
    start = np.repeat(lone, 2)
    end = (start + np.tile([1, 2], len(lone))) % 3
    piece = np.repeat(np.arange(len(faces)), 2)
    at_start, at_end = off[piece, start], off[piece, end]
    share = at_start / (at_start - at_end)
    return _Crossings(np.repeat(faces, 2), start, end, share, at_start, at_end)
