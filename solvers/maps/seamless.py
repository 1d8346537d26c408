"""The seamless map: every edge's image in the plane, consistent up to whole quarter turns.

The unknown is one vector for each edge, in the frame of its triangle's cross; the other side sees
it turned by the matching. The three vectors of a triangle close, edges of the boundary and of
features have no component across, and the vectors stay as near as possible to what the field asks
for. Where triangles come out inverted or a vertex is wound around wrongly, the map is that of the
flat metric nearest by. Where there is none, and where joins turn triangles over, these are asked
for the image that their mean cross and sizes give, which is not, with more weight, until none is.
"""

from __future__ import annotations

from copy import copy
from dataclasses import replace

import numpy as np
from scipy.sparse import csr_array

from solvers.fields.aligned import IntegratedField
from solvers.fields.integrability import Integrability
from solvers.maps.closed_images import ClosestImages, Conditions, Joining, SeamlessMap
from solvers.maps.flat_metric import flat_metric
from solvers.maps.matching import Matching
from solvers.surface.triangulation import FloatArray, IntrinsicTriangulation

LEAST_WEIGHT = 0.05
"""Edges opposite right or obtuse angles still count this much, in cotangents. Chosen."""

STIFFER, ROUNDS, PATIENCE = 5.0, 6, 2
"""Growth of the weight of inverted triangles, how often it grows at most, and how often in vain.

Chosen.
"""

FEW = 5
"""Triangles that joining may turn over before they are mended. Chosen."""

HOPELESS = 0.05
"""Share of inverted triangles beyond which mending them is not tried. Chosen."""


def seamless_map(integrated: IntegratedField) -> SeamlessMap:
    """Return the seamless map nearest to a field, by a few sparse solves.

    Parameters
    ----------
    integrated : IntegratedField
        The field.

    Returns
    -------
    SeamlessMap
        The one with the fewest inverted triangles.

    Examples
    --------
    In a map lengths are divided by the field's sizes, and a flat square is its own map:

    >>> import numpy as np
    >>> from solvers.fields import IntegratedField, aligned_field, prepare
    >>> from solvers.maps import seamless_map
    >>> from solvers.primitives import square
    >>> aligned = aligned_field(prepare(square(n=4)))
    >>> map_ = seamless_map(IntegratedField(aligned, aligned.start))
    >>> lengths = np.linalg.norm(map_.images, axis=2)
    >>> np.allclose(lengths, square(n=4).triangulation.lengths), round(map_.distance, 9)
    (True, 0.0)
    """
    return SeamlessFit(integrated).map


class SeamlessFit:
    """The seamless map nearest to a field, and its factor for further conditions on it.

    Parameters
    ----------
    integrated : IntegratedField
        The field.

    Attributes
    ----------
    matching : Matching
        What every map of the field keeps.
    map : SeamlessMap
        The one with the fewest inverted triangles.
    joins : Joining
        The further conditions it satisfies.
    """

    map: SeamlessMap

    def __init__(self, integrated: IntegratedField) -> None:
        integrability, x = integrated.aligned.integrability, integrated.x
        self.matching = Matching.of(integrability)
        t = self.matching.triangulation
        self._weight = np.maximum(t.weights, LEAST_WEIGHT / 2) * _by_size(integrability, x)
        self._wanted = _wanted(integrability, x)
        self._upright = _wanted_by_means(integrability, x)
        self._start()
        if not self.map.upright and not self._repaired(_theta(integrability, x)):
            self.map = self._mended(self.map)

    def _start(self) -> None:
        """Fit the map nearest to what is wanted, without joins."""
        t = self.matching.triangulation
        self._stiffer = np.zeros(t.n_faces, dtype=bool)
        self._fit = ClosestImages(Conditions(self.matching), self._wanted, self._weight)
        self.joins = self._fit.joining(csr_array((0, 6 * t.n_faces)))
        self.map = self._fit.joined(self.joins)

    def _repaired(self, theta: FloatArray) -> bool:
        """Fit the map to the flat metric near what is wanted; return whether there is one."""
        log_lengths = 0.5 * np.log((self._wanted**2).sum(axis=1))
        twin = self.matching.triangulation.twin
        beyond = np.where(twin >= 0, log_lengths[twin], log_lengths)
        metric = flat_metric(self.matching, (log_lengths + beyond) / 2, theta)
        if metric is None:
            return False
        self.matching, t = metric.matching, metric.matching.triangulation
        self._wanted = self._upright = metric.images.reshape(-1, 2)
        size = t.lengths.reshape(-1) ** 2 / (self._wanted**2).sum(axis=1)
        self._weight = np.maximum(t.weights, LEAST_WEIGHT / 2) * size / size.max()
        self._start()
        self.map = replace(self.map, distance=metric.distance)
        return True

    @property
    def mended(self) -> int:
        """Number of triangles made stiffer."""
        return int(self._stiffer.sum())

    def joining(self, rows: csr_array) -> Joining:
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
        return self._fit.joining(rows, self.joins)

    def distance(self, joining: Joining) -> float:
        """Return how far the map with joins would be from what the field asks for, unsolved.

        Parameters
        ----------
        joining : Joining
            The combinations, prepared by this fit.
        """
        return self._fit.distance(joining)

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
            None if the map would be farther off, or have more inverted triangles.
        """
        found = self._fit.joined(joining)
        if found.distance > most or len(found.inverted) > len(self.map.inverted) + FEW:
            return None
        other = copy(self)
        other._wanted, other._weight = self._wanted.copy(), self._weight.copy()
        other._stiffer = self._stiffer.copy()
        other.joins = joining
        other.map = other._mended(found)
        return other if len(other.map.inverted) <= len(self.map.inverted) else None

    def _mended(self, found: SeamlessMap) -> SeamlessMap:
        """Return the map with the fewest inverted triangles, making those stiffer."""
        best, in_vain = found, 0
        for _ in range(ROUNDS):
            over = found.inverted
            hopeless = len(over) > HOPELESS * len(self._stiffer) or in_vain == PATIENCE
            if len(over) == 0 or hopeless:
                break
            self._stiffer[over] = True
            h = (3 * over[:, None] + np.arange(3)).reshape(-1)
            self._wanted[h] = self._upright[h]
            self._weight[h] *= STIFFER
            self._fit = ClosestImages(self._fit.conditions, self._wanted, self._weight)
            self.joins = self._fit.joining(self.joins.rows)
            found = self._fit.joined(self.joins)
            in_vain += 1
            if len(found.inverted) < len(best.inverted):
                best, in_vain = found, 0
        return best


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


def _theta(integrability: Integrability, x: FloatArray) -> FloatArray:
    """Return the angle of the cross at each barycentre (m,), radians."""
    return np.asarray(integrability.theta + integrability.local(x)[2].mean(axis=1))


def _wanted_by_means(integrability: Integrability, x: FloatArray) -> FloatArray:
    """Return the same by each triangle's mean cross and sizes: a linear map, not inverted."""
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
