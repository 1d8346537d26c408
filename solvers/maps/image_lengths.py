"""Lengths of images on a triangulation while both change: flips, splits, triangles that close."""

from __future__ import annotations

from copy import copy

import numpy as np

from solvers.maps.matching import FREE, Matching
from solvers.maps.triangle_lengths import (
    convex,
    corner_angles,
    cosine_opposite,
    log_cevian,
    log_diagonal,
    slack,
)
from solvers.surface.triangulation import (
    QUARTER,
    BoolArray,
    FloatArray,
    IntArray,
    IntrinsicTriangulation,
    laid_out,
    next_halfedge,
    previous_halfedge,
)
from solvers.surface.working import Edit

SLACK = 1e-3
"""By how much two sides of a triangle are longer than the third at least, in parts of that.

Chosen: angles up to about 175 degrees.
"""

LEAST_SLACK = 1e-6
"""The same where no step helps otherwise. Chosen, above rounding."""

OBTUSE = np.radians(140)
"""Angle opposite an edge beyond which it is flipped, if flipping helps, radians. Chosen."""

FLAT = np.radians(155)
"""Angle opposite an edge beyond which it is split, if it cannot be flipped, radians.

Measured on 6 fields whose linear map is folded: with 174 some need 23 steps, with 155 none over 10.
"""

RELIEVED = np.radians(140)
"""The same where no step helps, radians. Chosen."""

SPLITS = 0.1
"""Most edges that are split, in parts of the triangles. Chosen; where it helps, 0.01 are."""

BETWEEN = 0.2, 0.8
"""Least and largest share of an edge that is split. Chosen."""

MENDINGS, AGAIN = 60, 3
"""Rounds in which lengths are evened out until all triangles close, before flips are tried again.

Chosen; some tens are usual. Where more are needed a smaller step costs less.
"""

EVENED = 3e-3
"""Slack that triangles which do not close are evened out to. Chosen, above `SLACK`."""

Sides = tuple[tuple[np.ndarray, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray, np.ndarray]]
"""Values on the halfedges of both parts of triangles that are cut."""


class ImageLengths:
    """Lengths of images on a triangulation while both change.

    Parameters
    ----------
    matching : Matching
        The triangles to start from, and what every map of the field keeps.
    log_lengths : (3 m,) float array
        Logarithm of the length that each halfedge's image should have; the same for twins.
    theta : (m,) float array
        Angles of the field's crosses in the frames of the triangles, radians.

    Attributes
    ----------
    log_lengths : (3 m,) float array
        Logarithms of lengths so far.
    sector, axes, quads : int arrays
        As of `Matching`, so far.
    slack : float
        By how much two sides are to be longer than the third at least, in parts of that.
    """

    def __init__(self, matching: Matching, log_lengths: FloatArray, theta: FloatArray) -> None:
        self._edit: Edit = matching.working.edit(turns=matching.period_jumps, angles=theta)
        self.log_lengths, self._asked = log_lengths.copy(), log_lengths.copy()
        self.sector, self.axes = matching.sector.copy(), matching.axes.copy()
        self.quads, self.slack = matching.quads, SLACK
        self._room = int(SPLITS * len(theta))

    def copied(self) -> ImageLengths:
        """Return another one to change."""
        other = copy(self)
        other._edit = self._edit.copied()
        other.log_lengths, other._asked = self.log_lengths.copy(), self._asked.copy()
        other.sector, other.axes = self.sector.copy(), self.axes.copy()
        return other

    def relieved(self) -> ImageLengths | None:
        """Return another one with more room for steps; None if nothing gives any.

        All that is obtuse is flipped, more is split, and triangles may be flatter.
        """
        other = self.copied()
        other.slack /= 10
        flipped = other.flip_flat(QUARTER)
        split = other.split_flat(RELIEVED)
        if not flipped and not split and other.slack < LEAST_SLACK:
            return None
        return other if other.close() else None

    def matching(self) -> Matching:
        """Return the topology on the triangles as they are."""
        edit = self._edit
        return Matching(edit.done(), edit.turns, self.axes, self.sector, self.quads)

    @property
    def distance(self) -> float:
        """How far the lengths are from those asked for, as of `FlatMetric`."""
        return float(np.sqrt(((self.log_lengths - self._asked) ** 2).mean()))

    @property
    def twin(self) -> IntArray:
        """(3 m,) as of `IntrinsicTriangulation`."""
        return self._edit.twin

    @property
    def turns(self) -> IntArray:
        """(3 m,) the period jumps."""
        return self._edit.turns

    def target(self) -> IntrinsicTriangulation:
        """Return the triangles with the lengths of their images."""
        edit = self._edit
        lengths = np.exp(self.log_lengths).reshape(-1, 3)
        return IntrinsicTriangulation(edit.n_vertices, edit.faces.copy(), edit.twin.copy(), lengths)

    def wanted_directions(self) -> FloatArray:
        """Return the angle of each halfedge against the field's cross, radians."""
        own = laid_out(self._edit.lengths) @ np.array([1, 1j])
        sides = own[:, [1, 2, 0]] - own
        return np.asarray((np.angle(sides) - self._edit.angles[:, None]).reshape(-1))

    def flip_flat(self, obtuse: float = OBTUSE) -> bool:
        """Flip edges opposite too large angles, of triangles that close or not, where it helps.

        Parameters
        ----------
        obtuse : float, optional
            The largest angle that is not too large, radians.

        Returns
        -------
        bool
            Whether there was one.
        """
        flipped = False
        while True:
            h = np.flatnonzero(self.twin > np.arange(len(self.twin)))
            h = h[(h // 3 != self.twin[h] // 3) & ~self._edit.fixed(h)]
            one, other = (cosine_opposite(self.log_lengths, e) for e in (h, self.twin[h]))
            flat = (one + other < -1e-8) & (np.minimum(one, other) < np.cos(obtuse))
            h, rank = h[flat], (one + other)[flat]
            convex_ = self._convex(h)
            h, rank = h[convex_], rank[convex_]
            if not len(h):
                return flipped
            now = self._edit.disjoint(rank, h // 3, self.twin[h] // 3)
            self._flip(h[now])
            flipped = True

    def split_flat(self, obtuse: float = FLAT) -> bool:
        """Split edges opposite too large angles that cannot be flipped, of triangles that close.

        At the foot of the height, in parts of the edge, of the images and of the surface alike.

        Parameters
        ----------
        obtuse : float, optional
            The largest angle that is not too large, radians.

        Returns
        -------
        bool
            Whether there was one, and room for what is split.
        """
        h, g = np.arange(len(self.twin)), self.twin
        inner = np.flatnonzero((g >= 0) & ~self._edit.fixed(h))
        flippable = np.zeros(len(h), dtype=bool)
        flippable[inner] = self._convex(inner)
        one = cosine_opposite(self.log_lengths, h)
        other = np.where(self._edit.fixed(h), -1.0, one[g])
        flat = (one < np.cos(obtuse)) & (one + other < 0) & ~flippable & (g // 3 != h // 3)
        h = h[flat]
        right = np.where(g[h] >= 0, g[h] // 3, -1)
        h = h[self._edit.disjoint(one[h], h // 3, right)]
        if not len(h) or len(h) > self._room:
            return False
        self._room -= len(h)
        self._split(h)
        return True

    def _split(self, h: IntArray) -> None:
        """Put vertices on edges at the feet of the heights of the triangles on their left."""
        inner = self.twin[h] >= 0
        h = np.concatenate([h[inner], h[~inner]])
        g = self.twin[h[: inner.sum()]]
        x, s, k = self.log_lengths, self.sector, len(g)
        ahead, behind = (
            np.exp(2 * (x[e] - x[h])) for e in (next_halfedge(h), previous_halfedge(h))
        )
        at = np.clip(0.5 + 0.5 * (behind - ahead), *BETWEEN)
        # Each triangle is cut from the corner opposite: near its halfedge's tail, far from it.
        e, share = np.concatenate([h, g]), np.concatenate([at, 1 - at[:k]])
        after, before = next_halfedge(e), previous_halfedge(e)
        none = np.full(len(e), FREE)
        new = self._new_sectors(self.axes[h] != FREE, k)
        parts: dict[str, Sides] = {
            "sector": ((s[e], new, s[before]), (new, s[after], s[before])),
            "axes": (
                (self.axes[e], none, self.axes[before]),
                (self.axes[e], self.axes[after], none),
            ),
        }
        for name, x in (("log_lengths", self.log_lengths), ("_asked", self._asked)):
            between = log_cevian(x, e, share)
            near = x[e] + np.log(share), between, x[before]
            parts[name] = near, (x[e] + np.log1p(-share), x[after], between)
        self._edit.split_edges(h, at)
        near_face, n = e // 3, len(self.twin)
        far_face = self.twin[3 * near_face + 1] // 3
        for name, sides in parts.items():
            old = getattr(self, name)
            values = np.concatenate([old, np.zeros(n - len(old), dtype=old.dtype)])
            for face, three in zip((near_face, far_face), sides, strict=True):
                for i, side in enumerate(three):
                    values[3 * face + i] = side
            setattr(self, name, values)

    def _new_sectors(self, aligned: BoolArray, k: int) -> IntArray:
        """Return the sector left of new vertices (p,), then right of the first k."""
        left = len(self.quads) + np.arange(len(aligned))
        apart = np.flatnonzero(aligned[:k])
        right = left[:k].copy()
        right[apart] = len(self.quads) + len(left) + np.arange(len(apart))
        around = np.where(aligned, 2, 4), np.full(len(apart), 2)
        self.quads = np.concatenate([self.quads, *around])
        return np.concatenate([left, right])

    def _convex(self, h: IntArray) -> BoolArray:
        """Return whether edges can be flipped without a change of the surface."""
        return convex(corner_angles(self._edit.lengths), h, self.twin[h])

    def _flip(self, h: IntArray) -> None:
        g = self.twin[h]
        left, right = h // 3, g // 3
        diagonal, asked = (log_diagonal(x, h, g) for x in (self.log_lengths, self._asked))
        crossed = self.turns[h]
        bc, ca = next_halfedge(h), previous_halfedge(h)
        ad, db = next_halfedge(g), previous_halfedge(g)
        source = np.concatenate([db, bc, ca, ad])
        at_a, at_b, at_c, at_d = (self.sector[x] for x in (h, bc, ca, db))
        log_lengths, asked_around = self.log_lengths[source], self._asked[source]
        axes = self.axes[source]
        # What lay right is now seen from the left cross, and the other way.
        none = np.zeros_like(crossed)
        seen = np.where(axes == FREE, 0, np.concatenate([-crossed, none, crossed, none]))
        target = self._edit.flip(h)
        self.log_lengths[target], self._asked[target] = log_lengths, asked_around
        self.axes[target] = np.where(axes == FREE, FREE, (axes + seen) % 4)
        for face, corners in ((left, (at_c, at_d, at_b)), (right, (at_d, at_c, at_a))):
            self.log_lengths[3 * face], self._asked[3 * face] = diagonal, asked
            self.axes[3 * face] = FREE
            for i, sector in enumerate(corners):
                self.sector[3 * face + i] = sector

    def close(self) -> bool:
        """Flip edges, and even lengths out, until all triangles close; return whether they do."""
        for _ in range(AGAIN):
            self.flip_flat()
            if self._evened():
                return True
        return False

    def _evened(self) -> bool:
        """Even lengths out until all triangles close with some slack; return whether they do."""
        inner = self.twin >= 0
        for _ in range(MENDINGS):
            lengths = np.exp(self.log_lengths).reshape(-1, 3)
            open_ = np.flatnonzero(~(slack(lengths) >= self.slack))
            if not len(open_):
                return True
            longest = lengths[open_].argmax(axis=1)
            most = lengths[open_, longest]
            half = 0.5 * np.log(most * (1 + EVENED) / (lengths[open_].sum(axis=1) - most))
            change = np.zeros_like(lengths)
            change[open_] = half[:, None]
            change[open_, longest] *= -1
            moved = change.reshape(-1)
            count = (moved != 0) + np.where(inner, moved[self.twin] != 0, False)
            moved = moved + np.where(inner, moved[self.twin], 0.0)
            self.log_lengths += moved / np.maximum(count, 1)
        return False
