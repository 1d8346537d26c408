"""Feature edges: sharp or marked edges inside a surface that crosses are to follow.

Features form a network of curves. A curve ends where other than two of its edges meet, on the
boundary, and where it turns so sharply that quads beside it turn a corner.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components, depth_first_order

from solvers.errors import CrossviewError, listed
from solvers.features.sectors import Sectors, sectors_between
from solvers.frozen import freeze_arrays, frozen_property
from solvers.kind_checks import one_of_kind
from solvers.singularities.budget import TIE
from solvers.surface.refinement import Refinement
from solvers.surface.triangulation import FloatArray, IntArray
from solvers.surface.trisurface import TriSurface, barycentric

SHARP_TURN = np.pi / 4 * (1 + TIE)
"""By how much a curve may turn at a vertex and still go on, radians.

From theory: beyond half a quarter turn three quads, or one, fit its angle better than two.
"""


@dataclass(frozen=True, eq=False)
class FeatureCurve:
    """A smooth piece of a feature network.

    Parameters
    ----------
    members : (k,) int array
        Its edges in order, as positions in `Features.edges`.
    vertices : (k + 1,) int array
        Its vertices in order; the first again at the end if closed.

    Examples
    --------
    The middle circle of an annulus:

    >>> import numpy as np
    >>> from solvers.features import Features
    >>> from solvers.primitives import annulus
    >>> surface = annulus(n=12)  # four circles of 12 vertices
    >>> on_circle = (surface.edges // 12 == 1).all(axis=1)
    >>> (curve,) = Features(surface, np.flatnonzero(on_circle)).curves
    >>> len(curve.members), len(curve.vertices), curve.closed
    (12, 13, True)
    """

    members: IntArray
    vertices: IntArray

    @property
    def closed(self) -> bool:
        """Whether it ends where it starts."""
        return bool(self.vertices[0] == self.vertices[-1])


@dataclass(frozen=True, eq=False)
class Features:
    """Feature edges of a surface.

    Parameters
    ----------
    surface : TriSurface
        Where.
    edges : (k,) int array
        Their numbers among the surface's edges, none on the boundary; kept in ascending order.

    Raises
    ------
    CrossviewError
        If the surface has no such edge, or it is on the boundary.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers.features import Features
    >>> from solvers.primitives import square
    >>> surface = square(n=4, size=2.0)  # the vertices 10 to 14 lie on the x axis
    >>> on_axis = (surface.vertices[surface.edges][:, :, 1] == 0).all(axis=1)
    >>> features = Features(surface, np.flatnonzero(on_axis))
    >>> len(features), np.sort(features.ends).tolist()
    (4, [[10, 11], [11, 12], [12, 13], [13, 14]])
    >>> features.corners.tolist(), [curve.vertices.tolist() for curve in features.curves]
    ([10, 14], [[10, 11, 12, 13, 14]])
    """

    surface: TriSurface
    edges: IntArray

    def __post_init__(self) -> None:
        one_of_kind("the surface of features", self.surface, TriSurface)
        edges = self.surface.require_edges(self.edges)
        border = edges[self.surface.edge_faces[edges, 1] < 0]
        if len(border):
            raise CrossviewError(
                "edges on the boundary are no features",
                f"edges {listed(border)}",
                "leave them out: crosses follow every boundary",
            )
        object.__setattr__(self, "edges", np.unique(edges))
        freeze_arrays(self)

    def require_on(self, surface: TriSurface) -> Features:
        """Return them if they are features of a surface.

        Parameters
        ----------
        surface : TriSurface
            Which they are used on.

        Raises
        ------
        CrossviewError
            They are features of another surface, whose edges have other numbers.
        """
        if self.surface.mark != surface.mark:
            raise CrossviewError(
                "features of another surface are given",
                f"it has {self.surface.n_faces} triangles, this one {surface.n_faces}",
                "make them for this one",
            )
        return self

    def __len__(self) -> int:
        """Return how many there are."""
        return len(self.edges)

    @property
    def halfedges(self) -> IntArray:
        """(k,) one halfedge of each."""
        return self.surface.triangulation.edge_halfedges[self.edges]

    @frozen_property
    def ends(self) -> IntArray:
        """(k, 2) end vertices of each."""
        return self.surface.edges[self.edges]

    @frozen_property
    def degrees(self) -> IntArray:
        """(n,) number of feature edges at each vertex."""
        return np.bincount(self.ends.reshape(-1), minlength=self.surface.n_vertices)

    @cached_property
    def sectors(self) -> Sectors:
        """What they and the boundary cut the neighbourhoods of vertices into."""
        return sectors_between(self.surface.triangulation, self.halfedges)

    @frozen_property
    def turns(self) -> FloatArray:
        """(n,) by how much the features turn at vertices where two of them meet, else 0; radians.

        Half the difference of the angles on both sides: what is left when a cone is unfolded.
        """
        angle, vertex = self.sectors.angle, self.sectors.vertex
        passed = (self.degrees == 2) & ~self.surface.boundary_vertices
        of_passed = np.flatnonzero(passed[vertex])
        by_vertex = of_passed[np.argsort(vertex[of_passed], kind="stable")]
        one, other = by_vertex[::2], by_vertex[1::2]
        turn = np.zeros(self.surface.n_vertices)
        turn[vertex[one]] = np.abs(angle[one] - angle[other]) / 2
        return turn

    @frozen_property
    def corners(self) -> IntArray:
        """Vertices where curves end, at ends, junctions, sharp turns and the boundary."""
        passed = (self.degrees == 2) & ~self.surface.boundary_vertices & (self.turns < SHARP_TURN)
        return np.flatnonzero((self.degrees > 0) & ~passed)

    @cached_property
    def curves(self) -> tuple[FeatureCurve, ...]:
        """The smooth pieces; closed ones start where they turn most."""
        if len(self.edges) == 0:
            return ()
        links, at = self._links()
        order, label = along_chains(len(self.edges), links, self.turns[at])
        starts = np.flatnonzero(np.diff(label[order], prepend=-1) != 0)
        return tuple(self._curve(members) for members in np.split(order, starts[1:]))

    @cached_property
    def curve_of(self) -> IntArray:
        """(k,) the curve that each edge is part of."""
        number = np.empty(len(self.edges), dtype=np.int64)
        for i, curve in enumerate(self.curves):
            number[curve.members] = i
        return number

    def _links(self) -> tuple[IntArray, IntArray]:
        """Return pairs (l, 2) of edges that follow each other, and the vertices between them."""
        vertex = self.ends.reshape(-1)
        is_corner = np.zeros(self.surface.n_vertices, dtype=bool)
        is_corner[self.corners] = True
        passing = np.flatnonzero(~is_corner[vertex])
        passing = passing[np.argsort(vertex[passing], kind="stable")]
        return (passing // 2).reshape(-1, 2), vertex[passing[::2]]

    def _curve(self, members: IntArray) -> FeatureCurve:
        ends = self.ends[members]
        if len(members) == 1:
            return FeatureCurve(members, ends[0])
        shared = (ends[:-1, :, None] == ends[1:, None, :]).any(axis=2)
        between = ends[:-1][shared]
        first = ends[0][~shared[0]]
        last = ends[-1][ends[-1] != between[-1]]
        return FeatureCurve(members, np.concatenate([first, between, last]))

    def united(self, edges: npt.ArrayLike) -> Features:
        """Return these and further edges; those on the boundary are left out.

        Parameters
        ----------
        edges : (l,) array_like of int
            Among the surface's edges.

        Raises
        ------
        CrossviewError
            If the surface has no such edge.
        """
        edges = self.surface.require_edges(edges)
        inner = edges[self.surface.edge_faces[edges, 1] >= 0]
        return Features(self.surface, np.union1d(self.edges, inner))

    def refined(self, refinement: Refinement) -> Features:
        """Return the same features on a refined surface: refinement splits edges, no more.

        Parameters
        ----------
        refinement : Refinement
            Of `surface`.
        """
        if len(self.edges) == 0 or refinement.surface is self.surface:
            return Features(refinement.surface, self.edges)
        fine, parent = refinement.surface, refinement.parent_face
        left, right = fine.edge_faces.T
        between = np.flatnonzero((right >= 0) & (parent[left] != parent[right]))
        # An edge between parts of two triangles lies on the side that its middle is nearest to.
        middle = fine.vertices[fine.edges[between]].mean(axis=1)
        face = parent[left[between]]
        corners = self.surface.vertices[self.surface.faces[face]]
        side = (np.argmin(barycentric(corners, middle), axis=1) + 1) % 3
        on_feature = np.isin(self.surface.face_edges[face, side], self.edges)
        return Features(fine, between[on_feature])


def no_features(surface: TriSurface) -> Features:
    """Return the empty network.

    Parameters
    ----------
    surface : TriSurface
        Where.

    Returns
    -------
    Features
        Of no edges.

    Examples
    --------
    >>> from solvers.features import no_features
    >>> from solvers.primitives import square
    >>> features = no_features(square(n=2))
    >>> len(features), features.curves
    (0, ())
    """
    return Features(surface, np.empty(0, dtype=np.int64))


def along_chains(n: int, links: IntArray, turn: FloatArray) -> tuple[IntArray, IntArray]:
    """Order edges along the chains that links make of them.

    Parameters
    ----------
    n : int
        Number of edges.
    links : (l, 2) int array
        Pairs that follow each other.
    turn : (l,) float array
        Of each pair; a closed chain is opened at its largest.

    Returns
    -------
    order : (n,) int array
        The edges, chain by chain.
    label : (n,) int array
        The number of each edge's chain.
    """
    label = _components(n, links)
    closed = np.bincount(label[links[:, 0]], minlength=n) == np.bincount(label, minlength=n)
    by_turn = np.lexsort((turn, label[links[:, 0]]))
    sharpest = by_turn[np.flatnonzero(np.diff(label[links[by_turn, 0]], append=-1) != 0)]
    opened = sharpest[closed[label[links[sharpest, 0]]]]
    links = np.delete(links, opened, axis=0)
    degree = np.bincount(links.reshape(-1), minlength=n)
    ends = np.flatnonzero(degree < 2)
    _, first = np.unique(label[ends], return_index=True)
    roots = ends[first]
    # One search from a root joined to an end of each chain runs along one after the other.
    rows = np.concatenate([links[:, 0], links[:, 1], np.full(len(roots), n)])
    columns = np.concatenate([links[:, 1], links[:, 0], roots])
    graph = csr_array((np.ones(len(rows), dtype=np.int8), (rows, columns)), shape=(n + 1, n + 1))
    order = depth_first_order(graph, n, return_predecessors=False)[1:]
    return order.astype(np.int64), label


def _components(n: int, links: IntArray) -> IntArray:
    ones = np.ones(len(links), dtype=np.int8)
    graph = coo_array((ones, (links[:, 0], links[:, 1])), shape=(n, n))
    return np.asarray(connected_components(graph, directed=False)[1].astype(np.int64))
