"""Arcs of a layout one after the other along its curves, and the way they take on the surface."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from solvers.layouts.arrangement import Arrangement
from solvers.layouts.layout import QuadLayout
from solvers.layouts.straight import barycentric_in
from solvers.quads.corners import unit
from solvers.surface.triangulation import BoolArray, FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Stretch:
    """Consecutive arcs of a curve without a critical node between them.

    Parameters
    ----------
    arcs : (k,) int array
        In the order along the curve.
    closed : bool
        Whether they are a whole loop.
    """

    arcs: IntArray
    closed: bool


@dataclass(frozen=True, eq=False)
class Polyline:
    """The way of an arc on the surface.

    Parameters
    ----------
    points : (k, 3) float array
        Points along it.
    at : (k,) float array
        How far along it, in the map, they are.
    normals : (k, 3) float array
        The surface's there, between vertices interpolated.
    """

    points: FloatArray
    at: FloatArray
    normals: FloatArray

    @property
    def share(self) -> FloatArray:
        """Length (k,) up to each point in that of the whole, which may be none."""
        return np.asarray(self.at / max(float(self.at[-1]), np.finfo(float).tiny))

    @property
    def lengths(self) -> FloatArray:
        """(k - 1,) lengths of its steps on the surface."""
        return np.asarray(np.linalg.norm(np.diff(self.points, axis=0), axis=1))

    @property
    def turns(self) -> FloatArray:
        """(k - 1,) by how much, radians, the surface's normal turns in its direction at each step.

        That is the arc's own turn out of the tangent planes, whose curvature is the normal one.
        """
        steps = np.diff(self.points, axis=0)
        along = steps / np.maximum(self.lengths, np.finfo(float).tiny)[:, None]
        turned = np.abs((np.diff(self.normals, axis=0) * along).sum(axis=1))
        return np.asarray(2 * np.arcsin(np.minimum(0.5 * turned, 1.0)))

    def shared(self, n: int) -> FloatArray:
        """Return the ends (n + 1, 3) of n edges of equal shares."""
        share = self.share * n
        columns = [np.interp(np.arange(n + 1), share, column) for column in self.points.T]
        return np.stack(columns, axis=1)

    @classmethod
    def chained(cls, lines: Sequence[Polyline]) -> Polyline:
        """Return one polyline along several that follow each other."""
        first = np.concatenate([[0.0], np.cumsum([line.at[-1] for line in lines])])
        points = [lines[0].points[:1], *(line.points[1:] for line in lines)]
        at = [np.zeros(1), *(line.at[1:] + a for line, a in zip(lines, first[:-1], strict=True))]
        normals = [lines[0].normals[:1], *(line.normals[1:] for line in lines)]
        return cls(np.concatenate(points), np.concatenate(at), np.concatenate(normals))


def stretches(arrangement: Arrangement, some: BoolArray) -> list[Stretch]:
    """Return the stretches that some of the arcs (A,) make."""
    tmesh, span = arrangement.tmesh, arrangement.arc_span
    arcs = np.flatnonzero(some)
    arcs = arcs[np.lexsort((span[arcs, 0], arrangement.arc_curve[arcs]))]
    after = np.roll(arcs, -1)
    curve = arrangement.arc_curve
    going_on = (curve[arcs] == curve[after]) & (tmesh.arcs[arcs, 1] == tmesh.arcs[after, 0])
    going_on &= ~tmesh.critical[tmesh.arcs[arcs, 1]]
    found = []
    for c in np.unique(curve[arcs]).tolist():
        on = curve[arcs] == c
        own, joined = arcs[on], going_on[on]
        # The last of a curve is followed by the first of the next one, a loop's by its own first.
        joined[-1] = tmesh.arcs[own[-1], 1] == tmesh.arcs[own[0], 0]
        joined[-1] &= not tmesh.critical[tmesh.arcs[own[-1], 1]]
        if joined.all():
            found.append(Stretch(own, closed=True))
            continue
        first = int(np.flatnonzero(~joined)[-1]) + 1
        own, joined = np.roll(own, -first), np.roll(joined, -first)
        cuts = np.flatnonzero(~joined)[:-1] + 1
        found += [Stretch(part, closed=False) for part in np.split(own, cuts)]
    return found


def polylines(layout: QuadLayout, arcs: IntArray) -> list[Polyline]:
    """Return the polyline of each arc, with all vertices that it has on the surface."""
    arrangement = layout.arrangement
    curves, at, owner = arrangement.curves, [], []
    for arc in arcs.tolist():
        start, end = arrangement.arc_span[arc]
        low, high = curves.offsets[arrangement.arc_curve[arc] + np.arange(2)]
        places = curves.chords.start[low:high]
        places = np.concatenate([places, places + curves.chords.end[high - 1]])
        inner = places[(places > start) & (places < end)]
        at.append(np.concatenate([[start], inner, [end]]))
        owner.append(np.full(len(at[-1]), arrangement.arc_curve[arc]))
    face, weights = located(layout, np.concatenate(owner), np.concatenate(at))
    corners = layout.surface.vertices[layout.surface.faces[face]]
    points = np.einsum("kc,kcd->kd", weights, corners)
    normals = layout.surface.vertex_normals[layout.surface.faces[face]]
    normals = unit(np.einsum("kc,kcd->kd", weights, normals))
    cuts = np.cumsum([len(a) for a in at])[:-1]
    split = zip(np.split(points, cuts), at, np.split(normals, cuts), strict=True)
    return [Polyline(p, a - a[0], n) for p, a, n in split]


def located(layout: QuadLayout, curve: IntArray, at: FloatArray) -> tuple[IntArray, FloatArray]:
    """Return the surface's triangles (k,) and weights (k, 3) of places along curves."""
    curves = layout.arrangement.curves
    face, place, _ = curves.faces_at(curve, at)
    return curves.chart.working.lift_points(face, barycentric_in(curves.chart, face, place))
