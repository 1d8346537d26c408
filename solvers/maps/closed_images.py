"""Images of edges that close around every triangle, as near as possible to wanted ones.

One vector for each edge, in the frame of its first triangle's cross; the other side sees it turned
by the matching. Boundary and feature edges have no component across. What else is to vanish is met
by least moves (a few back-substitutions with the same factor).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import coo_array, csc_array, csr_array, diags_array, vstack

from solvers.algebra.factorization import Analysis
from solvers.frozen import freeze_arrays, frozen_property
from solvers.maps.matching import Matching
from solvers.surface.triangulation import (
    QUARTER,
    BoolArray,
    FloatArray,
    IntArray,
    previous_halfedge,
)

PASSES, ROUNDING = 3, 1e-14
"""Most solves that close images, and the gap, in parts of them, left for rounding. Chosen."""

AT_ONCE = 16
"""Joins that are solved for together. Chosen: more are no faster and take memory."""


@dataclass(frozen=True, eq=False)
class SeamlessMap:
    """The images of a surface's edges.

    Parameters
    ----------
    matching : Matching
        The triangles, and what the images keep.
    images : (m, 3, 2) float array
        Image of each halfedge in the frame of its triangle's cross: along u, along v.
    distance : float
        How far they are from what the field asks for, relative, in the weighted norm.

    Examples
    --------
    Of a flat square of area 1; triangle 0 has its first two sides along x and y:

    >>> from solvers.fields import IntegratedField, aligned_field, prepare
    >>> from solvers.maps import seamless_map
    >>> from solvers.primitives import square
    >>> aligned = aligned_field(prepare(square(n=4)))
    >>> map_ = seamless_map(IntegratedField(aligned, aligned.start))
    >>> map_.images[0].round(9).tolist()
    [[0.25, 0.0], [0.0, 0.25], [-0.25, -0.25]]
    >>> map_.inverted.tolist()
    []
    """

    matching: Matching
    images: FloatArray
    distance: float

    def __post_init__(self) -> None:
        freeze_arrays(self)

    @property
    def inverted(self) -> IntArray:
        """Triangles whose image is inverted or has no area."""
        first, last = self.images[:, 0], self.images[:, 2]
        area = last[:, 0] * first[:, 1] - last[:, 1] * first[:, 0]
        return np.flatnonzero(area <= 0)

    @property
    def upright(self) -> bool:
        """Whether it is injective near every point, nothing inverted and nothing wound wrongly."""
        return not len(self.inverted) and not len(self.wrong_windings)

    @frozen_property
    def wrong_windings(self) -> IntArray:
        """Vertices with a sector whose images do not turn by as many quarters as quads meet there.

        A map without inverted triangles may still go around a vertex once too often.
        """
        z = self.images.reshape(-1, 2) @ np.array([1, 1j])
        tips = np.angle(-z[previous_halfedge(np.arange(len(z)))] / np.where(z == 0, 1, z))
        m = self.matching
        turned = np.bincount(m.sector, tips, len(m.quads))
        return np.unique(m.vertex[np.rint(turned / QUARTER) != m.quads])


@dataclass(frozen=True, eq=False)
class Joining:
    """Linear combinations of images that are to vanish, and how closed images answer to them.

    Parameters
    ----------
    rows : (k, 6 m) sparse array
        Coefficients of the components of halfedges' images.
    wanted : (k, 2 ne) sparse array
        The same for edges' images.
    compliance : (k, k) float array
        How much each changes when closed images are pulled along another one.
    """

    rows: csr_array
    wanted: csr_array
    compliance: FloatArray

    def first(self, count: int) -> Joining:
        """Return the first ones."""
        some = slice(count)
        return Joining(self.rows[some], self.wanted[some], self.compliance[some, some])

    def force(self, off: FloatArray) -> FloatArray:
        """Return the pulls (k,) that change the combinations by so much, as well as can be."""
        scale = np.sqrt(np.maximum(self.compliance.diagonal(), np.finfo(np.float64).tiny))
        relative = self.compliance / scale[:, None] / scale
        return np.asarray(np.linalg.lstsq(relative, off / scale, rcond=1e-10)[0] / scale)


class Conditions:
    """What every seamless map of a field satisfies, in terms of one image for each edge.

    Parameters
    ----------
    matching : Matching
        Of the field.
    """

    def __init__(self, matching: Matching) -> None:
        edges = matching.triangulation.edge_halfedges
        self.matching = matching
        self.spread = _to_halfedges(matching, edges)
        self.closing = _closing(matching, self.spread)
        self.free = _free(matching, edges).reshape(-1)
        self.analysis = Analysis()


class ClosestImages:
    """The seamless maps nearest to wanted images.

    Parameters
    ----------
    conditions : Conditions
        What every map satisfies.
    wanted : (3 m, 2) float array
        The wanted image of each halfedge.
    weight : (3 m,) float array
        What each counts.
    """

    def __init__(self, conditions: Conditions, wanted: FloatArray, weight: FloatArray) -> None:
        spread, closing = conditions.spread, conditions.closing
        squares = np.repeat(weight, 2)
        self.conditions = conditions
        self._diagonal = spread.power(2).T @ squares
        free = conditions.free
        self._asked = free * (spread.T @ (squares * wanted.reshape(-1))) / self._diagonal
        self._inverse = free / self._diagonal
        schur = closing @ diags_array(self._inverse) @ closing.T
        # On a flat torus the closing of all triangles together is no condition.
        schur = csc_array(schur + 1e-13 * diags_array(schur.diagonal()))
        self._factor = conditions.analysis.factor(schur)

    def _closed(self, images: FloatArray) -> FloatArray:
        """Return the nearest images of edges (2 ne,) that close everywhere."""
        closing = self.conditions.closing
        for _ in range(PASSES):
            gap = closing @ images
            if np.abs(gap).max(initial=0.0) <= ROUNDING * np.abs(images).max(initial=0.0):
                break
            images = images - self._inverse * (closing.T @ self._factor.solve(gap))
        return np.asarray(images)

    def _answers(self, pulls: FloatArray) -> FloatArray:
        """Return how closed images of edges change, (2 ne, k), under such pulls, to some digits."""
        moves, closing = self._inverse[:, None] * pulls, self.conditions.closing
        turned = closing.T @ self._factor.solve(closing @ moves)
        return np.asarray(moves - self._inverse[:, None] * turned)

    @cached_property
    def _nearest(self) -> FloatArray:
        """The nearest images of edges (2 ne,) that close, without joins."""
        return self._closed(self._asked)

    @cached_property
    def _size(self) -> float:
        """Square of the weighted norm of what is wanted."""
        return float(self._diagonal @ self._asked**2)

    def joining(self, rows: csr_array, before: Joining | None = None) -> Joining:
        """Return the answers to rows of halfedges' images (k, 6 m), after those known before."""
        wanted = csr_array(rows @ self.conditions.spread)
        new, old = rows.shape[0], 0
        if before is not None:
            old = before.rows.shape[0]
            rows, wanted = (
                csr_array(vstack(pair)) for pair in ((before.rows, rows), (before.wanted, wanted))
            )
        compliance = np.zeros((old + new, old + new))
        if before is not None:
            compliance[:old, :old] = before.compliance
        for low in range(old, old + new, AT_ONCE):
            some = slice(low, low + AT_ONCE)
            compliance[:, some] = wanted @ self._answers(wanted[some].toarray().T)
            compliance[some, :low] = compliance[:low, some].T
        return Joining(rows, wanted, compliance)

    def distance(self, joining: Joining) -> float:
        """Return how far the map would be from what is wanted, as of `SeamlessMap`, unsolved."""
        off = joining.wanted @ self._nearest
        # What closes images is at right angles to what joins them.
        closing = self._diagonal @ (self._nearest - self._asked) ** 2
        return float(np.sqrt((closing + max(off @ joining.force(off), 0.0)) / self._size))

    def joined(self, joining: Joining) -> SeamlessMap:
        """Return the nearest map on which also these combinations of its images vanish."""
        images = self._nearest
        for _ in range(PASSES):
            off = joining.wanted @ images
            if np.abs(off).max(initial=0.0) <= ROUNDING * np.abs(images).max(initial=0.0):
                break
            pulls = joining.wanted.T @ joining.force(off)
            images = self._closed(images - self._inverse * pulls)
        distance = np.sqrt(self._diagonal @ (images - self._asked) ** 2 / self._size)
        conditions = self.conditions
        spread = (conditions.spread @ images).reshape(-1, 3, 2)
        return SeamlessMap(conditions.matching, spread, float(distance))


def _to_halfedges(matching: Matching, edges: IntArray) -> csc_array:
    """Return the (6 m, 2 ne) matrix from edges' images to those of all halfedges."""
    t = matching.triangulation
    inner = t.twin[edges] >= 0
    number = np.arange(len(edges))
    h = np.concatenate([edges, t.twin[edges[inner]]])
    column = np.concatenate([number, number[inner]])
    # The twin runs the other way, and its cross is p quarter turns behind.
    turns = np.concatenate([np.zeros(len(edges), int), 2 + matching.period_jumps[edges[inner]]])
    cosine = np.array([1, 0, -1, 0])[turns % 4]
    sine = np.array([0, 1, 0, -1])[turns % 4]
    rows = np.concatenate([2 * h, 2 * h, 2 * h + 1, 2 * h + 1])
    columns = np.concatenate([2 * column, 2 * column + 1, 2 * column, 2 * column + 1])
    values = np.concatenate([cosine, -sine, sine, cosine]).astype(np.float64)
    return coo_array((values, (rows, columns)), shape=(2 * len(t.twin), 2 * len(edges))).tocsc()


def _closing(matching: Matching, spread: csc_array) -> csc_array:
    """Return the (2 m, 2 ne) matrix that sums the edges of each triangle."""
    m = matching.triangulation.n_faces
    rows = np.repeat(np.arange(m), 3)
    summing = coo_array(
        (
            np.ones(6 * m),
            (np.stack([2 * rows, 2 * rows + 1], axis=1).reshape(-1), np.arange(6 * m)),
        ),
        shape=(2 * m, 6 * m),
    ).tocsc()
    return csc_array(summing @ spread)


def _free(matching: Matching, edges: IntArray) -> BoolArray:
    """Return which components (ne, 2) are free: on aligned edges only the one along them."""
    axes = matching.axes[edges]
    free = np.ones((len(edges), 2), dtype=bool)
    border = axes >= 0
    free[border, 0] = axes[border] % 2 == 0
    free[border, 1] = axes[border] % 2 == 1
    return free
