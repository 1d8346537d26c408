"""Which edges of a surface are features: by an angle, and by hand."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from crossview.cases.parts import PlacedFeatures, Polyline, Position
from solvers.features import Features, no_features, sharp_edges
from solvers.surface import EdgePaths, IntArray, TriSurface


@dataclass(frozen=True)
class Marking:
    """A choice of feature edges on one surface.

    Attributes
    ----------
    dihedral_degrees : float or None
        Edges over which the surface bends by more are features; None: none for that reason.
    marked : frozenset of int
        Edges that are features however little the surface bends.
    unmarked : frozenset of int
        Edges that are not although the surface bends.
    """

    dihedral_degrees: float | None = None
    marked: frozenset[int] = frozenset()
    unmarked: frozenset[int] = frozenset()

    def on(self, surface: TriSurface) -> Features:
        """The features it chooses."""
        sharp = np.empty(0, dtype=np.int64)
        if self.dihedral_degrees is not None:
            sharp = sharp_edges(surface, self.dihedral_degrees)
        chosen = no_features(surface).united(np.concatenate([sharp, _numbers(self.marked)]))
        return Features(surface, np.setdiff1d(chosen.edges, _numbers(self.unmarked)))

    def toggled(self, surface: TriSurface, edges: IntArray) -> Marking:
        """The same with edges marked; or, if all of them are features, with none of them one."""
        path = frozenset(int(edge) for edge in edges)
        if not path <= set(self.on(surface).edges.tolist()):
            return replace(self, marked=self.marked | path, unmarked=self.unmarked - path)
        sharp = set(Marking(self.dihedral_degrees).on(surface).edges.tolist())
        unmarked = self.unmarked | (path & sharp)
        return replace(self, marked=self.marked - path, unmarked=unmarked)

    def placed(self, surface: TriSurface) -> PlacedFeatures:
        """The same by points of space."""
        curves, without = (
            tuple(_polyline(surface, curve.vertices) for curve in Features(surface, edges).curves)
            for edges in map(_numbers, (self.marked, self.unmarked))
        )
        return PlacedFeatures(self.dihedral_degrees, curves, without)


class EdgeTracer:
    """Draws polylines on a surface along its edges."""

    def __init__(self, surface: TriSurface) -> None:
        self._tree = cKDTree(surface.vertices)
        self._paths = EdgePaths(surface)

    def edges(self, lines: Sequence[Polyline]) -> frozenset[int]:
        """The edges that polylines run along, through the vertices nearest to their points."""
        edges = [self._paths.through(self._tree.query(np.array(line))[1]) for line in lines]
        return frozenset(int(edge) for path in edges for edge in path)


def _polyline(surface: TriSurface, vertices: IntArray) -> Polyline:
    places: list[Position] = [
        (float(x), float(y), float(z)) for x, y, z in surface.vertices[vertices]
    ]
    return tuple(places)


def _numbers(edges: frozenset[int]) -> IntArray:
    return np.array(sorted(edges), dtype=np.int64)
