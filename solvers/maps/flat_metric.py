"""Flat metrics with prescribed cones: maps that cannot have an inverted triangle.

Lengths of edges make a metric, and where each sector's angles add up to the quarter turns of its
quads and nothing turns around handles and between aligned edges, the triangles laid out side by
side are a seamless map: upright, whatever the lengths, for a triangle has no other orientation.
Lengths near those that a field asks for are changed by least-norm Newton steps until they do;
edges are flipped where a triangle becomes too flat, which gives vertices of large valence the
triangles that they need.
"""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array, csc_array, csr_array, diags_array, vstack
from scipy.sparse.csgraph import connected_components, minimum_spanning_tree

from solvers.algebra.factorization import factorized
from solvers.errors import SolveError
from solvers.maps.matching import FREE, Matching
from solvers.surface.homology import DualTree
from solvers.surface.triangulation import (
    QUARTER,
    FloatArray,
    IntArray,
    IntrinsicTriangulation,
    laid_out,
    next_halfedge,
    previous_halfedge,
    wrap,
)
from solvers.surface.working import Edit

STEPS = 20
"""Newton steps at most. Chosen: those that come to an end take 3 to 13."""

FLAT = 1e-9
"""Largest angle by which a sector or a loop may be off for the metric to be flat, radians.

Chosen, above rounding; what is left is taken away by the least change of the images.
"""

SLACK = 1e-3
"""By how much two sides of a triangle are longer than the third at least, in parts of that.

Chosen: angles up to about 175 degrees.
"""

LEAST_SLACK = 1e-6
"""The same where no step helps otherwise. Chosen, above rounding."""

OBTUSE = np.radians(140)
"""Angle opposite an edge beyond which it is flipped, if flipping helps, radians. Chosen."""

CONVEX = 1e-3
"""By how much the angles of a quadrilateral are below a half turn for its edge to be flipped.

Radians. Chosen, above rounding.
"""

FARTHEST = 1.0
"""Largest change of the logarithm of a length in a step. Chosen."""

OWN = (0.0, 0.25, 0.5, 1.0)
"""Shares of the surface's own lengths in those that are started from. Chosen."""

TRIES = 4
"""How many starts are tried. Chosen."""

HALVINGS = 6
"""How often a step is halved until it helps. Chosen: smaller steps lead nowhere."""

MENDINGS, AGAIN = 200, 10
"""Rounds in which lengths are evened out until all triangles close, before flips are tried again.

Chosen; some tens are usual.
"""

RIDGE = 1e-11
"""Added to the diagonal, relative: on a closed surface one of the conditions follows from others.

Chosen, above rounding.
"""


@dataclass(frozen=True, eq=False)
class FlatMetric:
    """A seamless map as a metric.

    Parameters
    ----------
    matching : Matching
        The triangles after flips, and the topology of the field, which is the same.
    images : (m, 3, 2) float array
        Image of each halfedge in the frame of its triangle's cross, upright.
    distance : float
        Root mean square of how far the logarithms of lengths are from those asked for.
    steps : int
        Newton steps, with one factorisation each.
    """

    matching: Matching
    images: FloatArray
    distance: float
    steps: int


def flat_metric(
    matching: Matching, log_lengths: FloatArray, theta: FloatArray
) -> FlatMetric | None:
    """Return the flat metric found from lengths that a field asks for.

    Parameters
    ----------
    matching : Matching
        Of the field.
    log_lengths : (3 m,) float array
        Logarithm of the length that each halfedge's image should have; the same for twins.
    theta : (m,) float array
        Angles of the field's crosses in the frames of the triangles, radians: where nothing
        fixes the direction of the images, they are turned to be nearest to it.

    Returns
    -------
    FlatMetric or None
        None if none is found.

    Notes
    -----
    Cone metrics by Newton's method in logarithms of lengths: Capouellez and Zorin 2023 ("Metric
    optimization in Penner coordinates"); flips of triangles that do not close by Ptolemy's theorem,
    as Springborn 2020. Here others are flipped without a change of the metric, and only where they
    are too flat, so that images stay near to what the field asks for.
    """
    if (matching.quads < 1).any():
        return None  # no map has room for a sector without quads
    for metric in _starts(matching, log_lengths, theta)[:TRIES]:
        found = _flattened(metric)
        if found is not None:
            return found
    return None


def _flattened(metric: _Metric) -> FlatMetric | None:
    """Return the flat metric that Newton steps lead to from one of triangles that close."""
    for step in range(STEPS + 1):
        target = metric.target()
        conditions = _Conditions(metric, target)
        off = conditions.off(target)
        if np.abs(off).max(initial=0.0) <= FLAT:
            images = conditions.images(target)
            return FlatMetric(metric.matching(), images, metric.distance, step)
        if step == STEPS:
            break
        try:
            change = conditions.change(target, off)
        except SolveError:
            break
        following = _stepped(metric, change, float(off @ off))
        if following is None:
            following = metric.relieved()
            if following is None:
                break
        metric = following
    return None


def _starts(matching: Matching, log_lengths: FloatArray, theta: FloatArray) -> list[_Metric]:
    """Return metrics of triangles that close to start from, that nearest to a flat one first."""
    own = np.log(matching.triangulation.lengths.reshape(-1))
    own += (log_lengths - own).mean()
    found = []
    for share in OWN:
        metric = _Metric(matching, log_lengths, theta)
        metric.log_lengths += share * (own - log_lengths)
        if metric.close():
            target = metric.target()
            off = _Conditions(metric, target).off(target)
            found.append((float(off @ off), metric))
    return [metric for _, metric in sorted(found, key=lambda pair: pair[0])]


def _stepped(metric: _Metric, change: FloatArray, before: float) -> _Metric | None:
    """Return the metric after a step, halved until the squares of what is off are fewer."""
    share = min(1.0, FARTHEST / max(float(np.abs(change).max()), 1e-300))
    for _ in range(HALVINGS):
        trial = metric.copied()
        trial.log_lengths += share * change
        if trial.close():
            target = trial.target()
            off = _Conditions(trial, target).off(target)
            if off @ off < (1 - 0.2 * share) * before:
                return trial
        share /= 2
    return None


class _Metric:
    """Lengths of images on a triangulation while both change."""

    def __init__(self, matching: Matching, log_lengths: FloatArray, theta: FloatArray) -> None:
        self._edit: Edit = matching.working.edit(turns=matching.period_jumps, angles=theta)
        self.log_lengths, self._asked = log_lengths.copy(), log_lengths.copy()
        self.sector, self.axes = matching.sector.copy(), matching.axes.copy()
        self.quads, self.slack = matching.quads, SLACK

    def copied(self) -> _Metric:
        """Return another one to change."""
        other = copy(self)
        other._edit = self._edit.copied()
        other.log_lengths, other._asked = self.log_lengths.copy(), self._asked.copy()
        other.sector, other.axes = self.sector.copy(), self.axes.copy()
        return other

    def relieved(self) -> _Metric | None:
        """Return another one with more room for steps; None if nothing gives any.

        All that is obtuse is flipped, and triangles may be flatter.
        """
        other = self.copied()
        other.slack /= 10
        flipped = other.flip_flat(QUARTER)
        if not flipped and other.slack < LEAST_SLACK:
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
            one, other = self._cosine_opposite(h), self._cosine_opposite(self.twin[h])
            flat = (one + other < -1e-8) & (np.minimum(one, other) < np.cos(obtuse))
            h, rank = h[flat], (one + other)[flat]
            convex = _convex(_angles(self._edit.lengths), h, self.twin[h])
            h, rank = h[convex], rank[convex]
            if not len(h):
                return flipped
            now = self._edit.disjoint(rank, h // 3, self.twin[h] // 3)
            self._flip(h[now])
            flipped = True

    def _cosine_opposite(self, h: IntArray) -> FloatArray:
        """Return the cosine of the angle opposite each halfedge, below -1 if none closes."""
        x = self.log_lengths
        b, c = x[next_halfedge(h)] - x[h], x[previous_halfedge(h)] - x[h]
        return np.asarray(np.cosh(b - c) - 0.5 * np.exp(-b - c))

    def _flip(self, h: IntArray) -> None:
        g = self.twin[h]
        left, right = h // 3, g // 3
        diagonal, asked = (self._diagonal(x, h, g) for x in (self.log_lengths, self._asked))
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

    @staticmethod
    def _diagonal(x: FloatArray, h: IntArray, g: IntArray) -> FloatArray:
        """Return the logarithm of the other diagonal of each pair of triangles with log lengths x.

        That of the flat quadrilateral where there is one, which leaves the metric as it is; else
        that of the one with a circle around it (Ptolemy).
        """
        ahead, behind = (x[side(h)] + x[side(g)] for side in (next_halfedge, previous_halfedge))
        diagonal = np.logaddexp(ahead, behind) - x[h]
        lengths = np.exp(x).reshape(-1, 3)
        closed = (_slack(lengths[h // 3]) > 1e-6) & (_slack(lengths[g // 3]) > 1e-6)
        angle = _angles(lengths)
        flat = np.flatnonzero(closed & _convex(angle, h, g))
        h, g = h[flat], g[flat]
        at_tail = angle[h] + angle[next_halfedge(g)]
        one, other = np.exp(x[previous_halfedge(h)]), np.exp(x[next_halfedge(g)])
        square = one**2 + other**2 - 2 * one * other * np.cos(at_tail)
        diagonal[flat] = 0.5 * np.log(np.maximum(square, 1e-300))
        return np.asarray(diagonal)

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
            open_ = np.flatnonzero(~(_slack(lengths) >= self.slack))
            if not len(open_):
                return True
            longest = lengths[open_].argmax(axis=1)
            most = lengths[open_, longest]
            half = 0.5 * np.log(most * (1 + 1.1 * self.slack) / (lengths[open_].sum(axis=1) - most))
            change = np.zeros_like(lengths)
            change[open_] = half[:, None]
            change[open_, longest] *= -1
            moved = change.reshape(-1)
            count = (moved != 0) + np.where(inner, moved[self.twin] != 0, False)
            moved = moved + np.where(inner, moved[self.twin], 0.0)
            self.log_lengths += moved / np.maximum(count, 1)
        return False


class _Conditions:
    """What makes a metric flat with its cones: linear in angles."""

    def __init__(self, metric: _Metric, target: IntrinsicTriangulation) -> None:
        t, self._metric = target, metric
        aligned = np.flatnonzero(metric.axes != FREE)
        self._root = int(aligned[0]) if len(aligned) else -1
        none = np.zeros((1, len(t.twin)), dtype=bool)
        self._tree = DualTree(t, max(self._root, 0) // 3, none)
        self._read = self._read_at(t, aligned)
        n = len(t.twin)
        sectors = csr_array(
            (np.ones(n), (metric.sector, np.arange(n))), shape=(len(metric.quads), n)
        )
        self._rows = csr_array(vstack([sectors, self._loop_rows(t)]))

    def _read_at(self, t: IntrinsicTriangulation, aligned: IntArray) -> IntArray:
        """Return where loops close and alignment is read: inner, then aligned halfedges."""
        crossed = self._tree.crossing[1:]
        left = t.twin > np.arange(len(t.twin))
        left[crossed] = left[t.twin[crossed]] = False
        h = np.flatnonzero(left)
        node = _joined(t.n_vertices, t, t.boundary_halfedges)
        one, other = np.sort(np.stack([node[t.tail[h]], node[t.head[h]]]), axis=0)
        apart = np.flatnonzero(one != other)
        _, first = np.unique(one[apart] * t.n_vertices + other[apart], return_index=True)
        chosen = apart[first]
        shape = (t.n_vertices, t.n_vertices)
        graph = csr_array((chosen + 1.0, (one[chosen], other[chosen])), shape=shape)
        spanning = np.rint(minimum_spanning_tree(graph).data).astype(np.int64) - 1
        loops = np.delete(h, spanning)
        together = _joined(t.n_vertices, t, aligned)[t.tail[aligned]]
        _, one_of_each = np.unique(together, return_index=True)
        others = aligned[one_of_each][together[one_of_each] != together[:1]]
        self._n_loops = len(loops)
        return np.concatenate([loops, others])

    def _loop_rows(self, t: IntrinsicTriangulation) -> csr_array:
        """Return by how much each reading changes with the angles (3 m,)."""
        columns, values, rows = [], [], []
        for row, h in enumerate(self._read):
            paths = [(self._tree.path(int(h) // 3), 1)]
            ends = [(h, 1)]
            if row < self._n_loops:
                paths.append((self._tree.path(int(t.twin[h]) // 3), -1))
                ends.append((t.twin[h], -1))
            else:
                ends.append((self._root, -1))
            crossed = np.concatenate([path for path, _ in paths])
            sign = np.concatenate([np.full(len(path), s) for path, s in paths])
            at = np.concatenate([crossed, t.twin[crossed], [e for e, _ in ends]])
            by = np.concatenate([sign, -sign, [s for _, s in ends]])
            columns.append(at)
            values.append(by)
            rows.append(np.full(len(at), row))
        n = len(t.twin)
        if not rows:
            return csr_array((0, n))
        by_direction = coo_array(
            (
                np.concatenate(values).astype(np.float64),
                (np.concatenate(rows), np.concatenate(columns)),
            ),
            shape=(len(self._read), n),
        ).tocsr()
        # Directions in a triangle: 0, then a half turn less its second angle or more its first.
        first = 3 * np.arange(t.n_faces)
        turning = coo_array(
            (
                np.concatenate([-np.ones(t.n_faces), np.ones(t.n_faces)]),
                (np.concatenate([first + 1, first + 2]), np.concatenate([first + 1, first])),
            ),
            shape=(n, n),
        ).tocsr()
        return csr_array(by_direction @ turning)

    def _directions(self, t: IntrinsicTriangulation) -> FloatArray:
        """Return the direction of each halfedge's image against the cross carried to it."""
        crossing, jumps = self._tree.crossing, self._metric.turns
        entered = t.twin[crossing]
        steps = t.directions[crossing] - t.directions[entered] + np.pi + QUARTER * jumps[crossing]
        root = self._root
        at_root = QUARTER * self._metric.axes[root] - t.directions[root] if root >= 0 else 0.0
        turn = self._tree.accumulate(float(at_root), steps)
        return np.asarray(t.directions + np.repeat(turn, 3))

    def off(self, t: IntrinsicTriangulation) -> FloatArray:
        """Return by how much sectors and loops are off, radians."""
        metric, direction = self._metric, self._directions(t)
        angles = np.bincount(metric.sector, t.angles.reshape(-1), len(metric.quads))
        h = self._read
        loops, ends = h[: self._n_loops], h[self._n_loops :]
        beyond = direction[t.twin[loops]] - np.pi - QUARTER * metric.turns[loops]
        gaps = [direction[loops] - beyond, direction[ends] - QUARTER * metric.axes[ends]]
        return np.concatenate(
            [angles - QUARTER * metric.quads, wrap(np.concatenate(gaps), 2 * np.pi)]
        )

    def change(self, t: IntrinsicTriangulation, off: FloatArray) -> FloatArray:
        """Return the least change of the lengths' logarithms (3 m,) that takes it away."""
        n, cotangents = len(t.twin), t.cotangents.reshape(-1)
        h = np.arange(n)
        edge = np.empty(n, dtype=np.int64)
        edge[t.edge_halfedges] = np.arange(len(t.edge_halfedges))
        inner = t.edge_halfedges[t.twin[t.edge_halfedges] >= 0]
        edge[t.twin[inner]] = edge[inner]
        ahead, behind = next_halfedge(h), previous_halfedge(h)
        one, other = cotangents[ahead], cotangents[behind]
        # An angle grows with the side opposite, and falls with the two beside it.
        by_length = coo_array(
            (
                np.concatenate([one + other, -one, -other]),
                (np.tile(h, 3), np.concatenate([edge[ahead], edge[h], edge[behind]])),
            ),
            shape=(n, len(t.edge_halfedges)),
        ).tocsr()
        derivative = csc_array(self._rows @ by_length)
        normal = csc_array(derivative @ derivative.T)
        normal = csc_array(normal + diags_array(RIDGE * normal.diagonal()))
        return np.asarray((derivative.T @ factorized(normal).solve(-off))[edge])

    def images(self, t: IntrinsicTriangulation) -> FloatArray:
        """Return the images of halfedges (m, 3, 2) in the frames of the crosses."""
        direction = self._directions(t)
        if self._root < 0:
            apart = self._metric.wanted_directions() - direction
            weight = t.lengths.reshape(-1) ** 2
            direction = direction + np.angle(weight @ np.exp(1j * apart))
        images = t.lengths.reshape(-1, 1) * np.stack([np.cos(direction), np.sin(direction)], axis=1)
        return np.asarray(images.reshape(-1, 3, 2))


def _joined(n: int, t: IntrinsicTriangulation, h: IntArray) -> IntArray:
    """Return the component of each vertex in the graph of halfedges."""
    graph = coo_array((np.ones(len(h)), (t.tail[h], t.head[h])), shape=(n, n))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)


def _slack(lengths: FloatArray) -> FloatArray:
    """Return by how much two sides are longer than the longest (k,), in parts of that."""
    longest = lengths.max(axis=1)
    return np.asarray(lengths.sum(axis=1) / longest - 2)


def _angles(lengths: FloatArray) -> FloatArray:
    """Return the angle at the corner that each halfedge starts at (3 m,), of any lengths."""
    a, b, c = lengths.T
    pairs = ((a, c, b), (b, a, c), (c, b, a))
    cosines = [(p**2 + q**2 - r**2) / (2 * p * q) for p, q, r in pairs]
    return np.asarray(np.arccos(np.clip(np.stack(cosines, axis=1), -1, 1)).reshape(-1))


def _convex(angle: FloatArray, h: IntArray, g: IntArray) -> np.ndarray:
    """Return whether quadrilaterals are convex at both ends of their diagonals h, g."""
    most = np.pi - CONVEX
    at_tail = angle[h] + angle[next_halfedge(g)]
    at_head = angle[next_halfedge(h)] + angle[g]
    return np.asarray((at_tail < most) & (at_head < most))
