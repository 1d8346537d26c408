"""The seamless map: every edge's image in the plane, consistent up to whole quarter turns.

The unknown is one vector for each edge, in the frame of its triangle's cross; the other side sees
it turned by the matching. The three vectors of a triangle close, edges of the boundary and of
features have no component across, and the vectors stay as near as possible to what the field asks
for. Triangles that come out turned over (at singularities) are asked for the image that their mean
cross and sizes give, which is not, with more weight, until none is.
"""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array, csc_array, diags_array, vstack

from solvers.factorization import Analysis, Factorization
from solvers.integrability import Integrability
from solvers.triangulation import FloatArray, IntArray, IntrinsicTriangulation

LEAST_WEIGHT = 0.05
"""Edges opposite right or obtuse angles still count this much, in cotangents."""

STIFFER, ROUNDS, PATIENCE = 5.0, 6, 2
"""Growth of the weight of triangles turned over, how often it grows at most, and how often in vain.
"""

FEW = 20
"""Triangles that joining may turn over before they are mended."""

HOPELESS = 0.05
"""Share of triangles turned over beyond which mending them is not tried."""


@dataclass(frozen=True, eq=False)
class SeamlessMap:
    """The images of a surface's edges.

    Parameters
    ----------
    images : (m, 3, 2) float array
        Image of each halfedge in the frame of its triangle's cross: along u, along v.
    distance : float
        How far they are from what the field asks for, relative, in the weighted norm.
    """

    images: FloatArray
    distance: float

    @property
    def flipped(self) -> IntArray:
        """Triangles whose image is turned over or has no area."""
        first, last = self.images[:, 0], self.images[:, 2]
        area = last[:, 0] * first[:, 1] - last[:, 1] * first[:, 0]
        return np.flatnonzero(area <= 0)


def seamless_map(integrability: Integrability, x: FloatArray) -> SeamlessMap:
    """Return the seamless map nearest to a field, by a few sparse solves.

    Parameters
    ----------
    integrability : Integrability
        The problem whose unknowns `x` are.
    x : (N,) float array
        The field.

    Returns
    -------
    SeamlessMap
        The one with the fewest triangles turned over.
    """
    return SeamlessFit(integrability, x).map


class SeamlessFit:
    """The seamless map nearest to a field, and its factor for further conditions on it.

    Parameters
    ----------
    integrability : Integrability
        The problem whose unknowns `x` are.
    x : (N,) float array
        The field.

    Attributes
    ----------
    map : SeamlessMap
        The one with the fewest triangles turned over.
    joins : Joining
        The further conditions it satisfies.
    """

    def __init__(self, integrability: Integrability, x: FloatArray) -> None:
        t = integrability.triangulation
        self._weight = np.maximum(t.weights, LEAST_WEIGHT / 2) * _by_size(integrability, x)
        self._wanted = _wanted(integrability, x)
        self._upright = _wanted_by_means(integrability, x)
        self._stiffer = np.zeros(t.n_faces, dtype=bool)
        self._fit = _Fit(_Conditions(integrability), self._wanted, self._weight)
        self.joins = self._fit.joining(csc_array((0, 6 * t.n_faces)))
        self.map = self._mended(self._fit.joined(self.joins))

    @property
    def mended(self) -> int:
        """Number of triangles made stiffer."""
        return int(self._stiffer.sum())

    def joining(self, rows: csc_array) -> Joining:
        """Return what `joined` needs to make linear combinations of images vanish.

        Parameters
        ----------
        rows : (k, 6 m) sparse array
            Coefficients of the images' components.

        Returns
        -------
        Joining
            Those that do already come first.
        """
        return self.joins.followed_by(self._fit.joining(rows))

    def joined(self, joining: Joining, most: float) -> SeamlessFit | None:
        """Return the nearest map on which more linear combinations of images vanish.

        Rows that contradict others are met as well as can be.

        Parameters
        ----------
        joining : Joining
            The combinations, prepared by this fit.
        most : float
            Largest distance of the map from what the field asks for.

        Returns
        -------
        SeamlessFit or None
            None if the map would be farther off, or have more triangles turned over.
        """
        found = self._fit.joined(joining)
        if found.distance > most or len(found.flipped) > len(self.map.flipped) + FEW:
            return None
        other = copy(self)
        other._wanted, other._weight = self._wanted.copy(), self._weight.copy()
        other._stiffer = self._stiffer.copy()
        other.joins = joining
        other.map = other._mended(found)
        return other if len(other.map.flipped) <= len(self.map.flipped) else None

    def _mended(self, found: SeamlessMap) -> SeamlessMap:
        """Return the map with the fewest triangles turned over, making those stiffer."""
        best, in_vain = found, 0
        for _ in range(ROUNDS):
            over = found.flipped
            hopeless = len(over) > HOPELESS * len(self._stiffer) or in_vain == PATIENCE
            if len(over) == 0 or hopeless:
                break
            self._stiffer[over] = True
            h = (3 * over[:, None] + np.arange(3)).reshape(-1)
            self._wanted[h] = self._upright[h]
            self._weight[h] *= STIFFER
            self._fit = _Fit(self._fit.conditions, self._wanted, self._weight)
            self.joins = self._fit.joining(self.joins.rows)
            found = self._fit.joined(self.joins)
            in_vain += 1
            if len(found.flipped) < len(best.flipped):
                best, in_vain = found, 0
        return best


@dataclass(frozen=True, eq=False)
class Joining:
    """Linear combinations of images that are to vanish, and the moves that change each.

    Parameters
    ----------
    rows : (k, 6 m) sparse array
        Coefficients of the components of halfedges' images.
    wanted, moves : (k, 2 ne) float arrays
        The same for edges' images, and the least closed change of those for each.
    """

    rows: csc_array
    wanted: FloatArray
    moves: FloatArray

    def followed_by(self, other: Joining) -> Joining:
        """Return these and others."""
        return Joining(
            csc_array(vstack([self.rows, other.rows])),
            np.concatenate([self.wanted, other.wanted]),
            np.concatenate([self.moves, other.moves]),
        )

    def first(self, count: int) -> Joining:
        """Return the first ones."""
        return Joining(csc_array(self.rows[:count]), self.wanted[:count], self.moves[:count])


class _Conditions:
    """What every seamless map of a field satisfies, in terms of one image for each edge."""

    def __init__(self, integrability: Integrability) -> None:
        edges = integrability.triangulation.edge_halfedges
        self.spread = _to_halfedges(integrability, edges)
        self.closing = _closing(integrability, self.spread)
        self.free = _free(integrability, edges).reshape(-1)
        self._analysis: Analysis | None = None

    def factor(self, matrix: csc_array) -> Factorization:
        """Factor a matrix that has the same pattern each time."""
        if self._analysis is None:
            self._analysis = Analysis(matrix)
        return self._analysis.factor(matrix)


class _Fit:
    """Closed images as near as possible to wanted ones (3 m, 2) with weights (3 m,)."""

    def __init__(self, conditions: _Conditions, wanted: FloatArray, weight: FloatArray) -> None:
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
        self._factor = conditions.factor(schur)

    def _closed(self, images: FloatArray) -> FloatArray:
        """Return the nearest images of edges that close around every triangle."""
        closing = self.conditions.closing
        forces = closing.T @ self._factor.solve(closing @ images)
        return np.asarray(images - self._inverse * forces)

    def _as_map(self, images: FloatArray) -> SeamlessMap:
        change = images - self._asked
        asked = self._diagonal @ self._asked**2
        distance = np.sqrt(self._diagonal @ change**2 / asked)
        return SeamlessMap((self.conditions.spread @ images).reshape(-1, 3, 2), float(distance))

    def joining(self, rows: csc_array) -> Joining:
        """Return the rows of halfedges' images (k, 6 m) with the moves that change each."""
        wanted = csc_array(rows @ self.conditions.spread).toarray()
        moves = [self._closed(self._inverse * row) for row in wanted]
        return Joining(rows, wanted, np.array(moves).reshape(wanted.shape))

    def joined(self, joining: Joining) -> SeamlessMap:
        """Return the nearest map on which also these combinations of its images vanish."""
        images = self._closed(self._asked)
        wanted, moves = joining.wanted, joining.moves
        if len(wanted):
            force = np.linalg.lstsq(wanted @ moves.T, wanted @ images, rcond=1e-10)[0]
            images = images - force @ moves
        return self._as_map(images)


def _wanted(integrability: Integrability, x: FloatArray) -> FloatArray:
    """Return what the field makes of each halfedge (3 m, 2): its lengths over the sizes."""
    i, t = integrability, integrability.triangulation
    a, s, delta = i.local(x)
    following = np.array([1, 2, 0])
    a = (a + a[:, following]) / 2
    s = (s + s[:, following]) / 2
    return _over_sizes(t, i.theta[:, None] + i.offsets + delta, a, s)


def _by_size(integrability: Integrability, x: FloatArray) -> FloatArray:
    """Return the square of the size at each halfedge (3 m,): to be off by part of a quad counts.

    Sizes may differ a thousandfold; without, the smallest images give way to the largest.
    """
    a = integrability.local(x)[0]
    square = np.exp(-(a + a[:, [1, 2, 0]])).reshape(-1)
    return np.asarray(square / square.max())


def _wanted_by_means(integrability: Integrability, x: FloatArray) -> FloatArray:
    """Return the same by each triangle's mean cross and sizes: a linear map, not turned over."""
    i = integrability
    a, s, delta = (values.mean(axis=1)[:, None] for values in i.local(x))
    return _over_sizes(i.triangulation, i.theta[:, None] + delta, a, s)


def _over_sizes(
    t: IntrinsicTriangulation, theta: FloatArray, a: FloatArray, s: FloatArray
) -> FloatArray:
    """Return halfedges (3 m, 2) along the cross over the sizes; arguments (m, 3) or (m, 1)."""
    angle = t.directions.reshape(-1, 3) - theta
    length = t.lengths.reshape(-1, 3)
    # Sizes are exp(H1) = exp(-a - s) along u and exp(H2) = exp(-a + s) along v.
    along_u = np.exp(a + s) * length * np.cos(angle)
    along_v = np.exp(a - s) * length * np.sin(angle)
    return np.stack([along_u, along_v], axis=2).reshape(-1, 2)


def _to_halfedges(integrability: Integrability, edges: IntArray) -> csc_array:
    """Return the (6 m, 2 ne) matrix from edges' images to those of all halfedges."""
    t = integrability.triangulation
    inner = t.twin[edges] >= 0
    number = np.arange(len(edges))
    h = np.concatenate([edges, t.twin[edges[inner]]])
    column = np.concatenate([number, number[inner]])
    # The twin runs the other way, and its cross is p quarter turns behind.
    turns = np.concatenate(
        [np.zeros(len(edges), int), 2 + integrability.quarter_turns[edges[inner]]]
    )
    cosine = np.array([1, 0, -1, 0])[turns % 4]
    sine = np.array([0, 1, 0, -1])[turns % 4]
    rows = np.concatenate([2 * h, 2 * h, 2 * h + 1, 2 * h + 1])
    columns = np.concatenate([2 * column, 2 * column + 1, 2 * column, 2 * column + 1])
    values = np.concatenate([cosine, -sine, sine, cosine]).astype(np.float64)
    return coo_array((values, (rows, columns)), shape=(2 * len(t.twin), 2 * len(edges))).tocsc()


def _closing(integrability: Integrability, spread: csc_array) -> csc_array:
    """Return the (2 m, 2 ne) matrix that sums the edges of each triangle."""
    m = integrability.triangulation.n_faces
    rows = np.repeat(np.arange(m), 3)
    summing = coo_array(
        (
            np.ones(6 * m),
            (np.stack([2 * rows, 2 * rows + 1], axis=1).reshape(-1), np.arange(6 * m)),
        ),
        shape=(2 * m, 6 * m),
    ).tocsc()
    return csc_array(summing @ spread)


def _free(integrability: Integrability, edges: IntArray) -> np.ndarray:
    """Return which components (ne, 2) are free: on aligned edges only the one along them."""
    i, t = integrability, integrability.triangulation
    free = np.ones((len(edges), 2), dtype=bool)
    border = i.aligned_edges
    h = edges[border]
    angle = t.directions[h] - (i.theta[:, None] + i.offsets).reshape(-1)[h]
    along_v = np.rint(angle / (np.pi / 2)).astype(int) % 2
    free[border, 0] = along_v == 0
    free[border, 1] = along_v == 1
    return free
