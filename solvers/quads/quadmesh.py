"""The quad mesh on a surface: connectivity, irregular vertices, quality."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from solvers.errors import CrossviewError
from solvers.frozen import freeze_arrays
from solvers.quads.corners import TangentPlanes
from solvers.quads.incidence import edge_table, paired_sides
from solvers.quads.projection import Projection
from solvers.quads.quantization import Quantization
from solvers.surface.triangulation import BoolArray, FloatArray, IntArray
from solvers.surface.trisurface import TriSurface


@dataclass(frozen=True, eq=False)
class QuadMesh:
    """Quads whose vertices lie on a triangle surface.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    vertices : (n, 3) float array
        Coordinates.
    quads : (q, 4) int array
        Corner vertices, counter-clockwise seen from outside.
    patch : (q,) int array
        The patch of the layout each quad lies in.
    faces : (n,) int array
        The triangle of the surface each vertex lies in.
    barycentric : (n, 3) float array
        Its weights there.
    fixed : (n,) bool array
        Vertices that have their place: singularities and corners.
    boundary_loop : (n,) int array
        Number of the boundary loop of the surface each vertex lies on, or -1.
    quantization : Quantization, optional
        The numbers of edges that made it, where they were chosen for a number of quads.

    Examples
    --------
    Irregular vertices are just the singularities imposed:

    >>> from solvers import run
    >>> from solvers.fields import IntegratedField, aligned_field, prepare
    >>> from solvers.layouts import quad_layout
    >>> from solvers.primitives import disk
    >>> from solvers.singularities import Singularity
    >>> surface = disk(edge_length=0.1)
    >>> places = [[0.5, 0, 0], [0, 0.5, 0], [-0.5, 0, 0], [0, -0.5, 0]]
    >>> threes = [Singularity(surface.closest_point(place), 3) for place in places]
    >>> aligned = aligned_field(prepare(surface, threes))
    >>> layout = run(quad_layout(IntegratedField(aligned, aligned.start)))
    >>> from solvers.quads import fill, quantize_to
    >>> mesh = fill(layout, quantize_to(layout.tmesh, 80).counts)
    >>> mesh.check()  # the quads tile the surface
    >>> mesh.irregular, mesh.corners, mesh.euler_characteristic
    ({3: 4}, {}, 1)
    """

    surface: TriSurface
    vertices: FloatArray
    quads: IntArray
    patch: IntArray
    faces: IntArray
    barycentric: FloatArray
    fixed: BoolArray
    boundary_loop: IntArray
    quantization: Quantization | None = None

    def __post_init__(self) -> None:
        freeze_arrays(self)

    @property
    def n_vertices(self) -> int:
        """Number of vertices."""
        return len(self.vertices)

    @property
    def n_quads(self) -> int:
        """Number of quads."""
        return len(self.quads)

    @cached_property
    def valence(self) -> IntArray:
        """(n,) number of quads that meet at each vertex."""
        return np.bincount(self.quads.reshape(-1), minlength=self.n_vertices)

    @cached_property
    def edges(self) -> IntArray:
        """(e, 2) end vertices of each edge, the smaller number first."""
        return self._edge_table[0]

    @cached_property
    def edge_lengths(self) -> FloatArray:
        """(e,) length of each edge."""
        ends = self.vertices[self.edges]
        return np.asarray(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1))

    @cached_property
    def on_boundary(self) -> BoolArray:
        """(n,) whether each vertex lies on an edge of one quad only."""
        mask = np.zeros(self.n_vertices, dtype=bool)
        edges, edge_of = self._edge_table
        mask[edges[np.bincount(edge_of, minlength=len(edges)) == 1]] = True
        return mask

    @cached_property
    def irregular(self) -> dict[int, int]:
        """How many inner vertices there are of each valence other than 4."""
        return _counts(self.valence[~self.on_boundary], 4)

    @cached_property
    def corners(self) -> dict[int, int]:
        """How many boundary vertices there are with each number of quads other than 2."""
        return _counts(self.valence[self.on_boundary], 2)

    @property
    def euler_characteristic(self) -> int:
        """V - E + F."""
        return self.n_vertices - len(self.edges) + self.n_quads

    @cached_property
    def scaled_jacobian(self) -> FloatArray:
        """(q,) least sine of a quad's corners, in the surface's tangent planes; 1 for rectangles.

        0 or less where a corner has 180 degrees or more there, or a side no length.
        """
        planes = TangentPlanes(self.surface)
        return planes.quality(self.faces, self.barycentric, self.vertices, self.quads)

    @cached_property
    def max_distance_to_surface(self) -> float:
        """Largest distance of a vertex from the surface."""
        projection = Projection(self.surface)
        near = projection.positions(*projection.slide(self.faces, self.vertices))
        gap = np.linalg.norm(near - self.vertices, axis=1)
        # Where the triangle it is said to lie in leads astray, look everywhere.
        far = np.flatnonzero(gap > 1e-9 * self.surface.diagonal)
        if len(far):
            near = projection.positions(*projection.nearest(self.vertices[far]))
            gap[far] = np.linalg.norm(near - self.vertices[far], axis=1)
        return float(gap.max(initial=0.0))

    def check(self) -> None:
        """Check that the quads tile the surface.

        Raises
        ------
        CrossviewError
            If a quad has a vertex twice, an edge not two quads or one on the boundary, a vertex
            more than one fan of quads, or if the topology is not that of the surface.
        """
        for what, where in self._cracks():
            if len(where):
                raise CrossviewError(
                    f"the quad mesh is broken: {len(where)} {what}",
                    f"the first at {np.round(self.vertices[where[0]], 6).tolist()}",
                    "choose shorter edges",
                )
        found = (self.euler_characteristic, self._n_loops)
        wanted = (self.surface.euler_characteristic, len(self.surface.boundary_loops))
        if found != wanted:
            raise CrossviewError(
                "the quad mesh has another topology than the surface",
                f"Euler characteristic {found[0]} and {found[1]} boundary loops, "
                f"not {wanted[0]} and {wanted[1]}",
                "choose shorter edges",
            )

    def _cracks(self) -> list[tuple[str, IntArray]]:
        """Return what may be wrong, each with a vertex of every place where it is."""
        q = self.quads
        twice = (np.sort(q, axis=1)[:, 1:] == np.sort(q, axis=1)[:, :-1]).any(axis=1)
        directed = q.reshape(-1) * self.n_vertices + np.roll(q, -1, axis=1).reshape(-1)
        value, count = np.unique(directed, return_counts=True)
        edges, edge_of = self._edge_table
        quads_at = np.bincount(edge_of, minlength=len(edges))
        inside = (self.boundary_loop[edges] < 0).any(axis=1)
        fans = np.bincount(self._fan_vertex, minlength=self.n_vertices)
        return [
            ("quads with a vertex twice", q[twice, 0]),
            ("edges with more than two quads", edges[quads_at > 2, 0]),
            ("edges run twice in one direction", value[count > 1] // self.n_vertices),
            ("inner edges with one quad", edges[(quads_at == 1) & inside, 0]),
            ("vertices of no quad", np.flatnonzero(self.valence == 0)),
            ("vertices where quads touch", np.flatnonzero(fans > 1)),
        ]

    @cached_property
    def _edge_table(self) -> tuple[IntArray, IntArray]:
        """The edges (e, 2), and the edge of each side (4 q,) of the quads."""
        return edge_table(self.quads)

    @cached_property
    def _fan_vertex(self) -> IntArray:
        """The vertex of each fan of quads: corners joined over the edges they share."""
        side, other = paired_sides(self._edge_table[1])
        after = side - side % 4 + (side + 1) % 4
        other_after = other - other % 4 + (other + 1) % 4
        corner = self.quads.reshape(-1)
        # Side i joins corners i and i + 1; pair those of one vertex, whichever way sides run.
        along = corner[side] == corner[other]
        a = np.concatenate([side, after])
        b = np.concatenate(
            [np.where(along, other, other_after), np.where(along, other_after, other)]
        )
        n = len(corner)
        graph = coo_array((np.ones(len(a), dtype=np.int8), (a, b)), shape=(n, n))
        _, fan = connected_components(graph, directed=False)
        return np.asarray(corner[np.unique(fan, return_index=True)[1]])

    @cached_property
    def _n_loops(self) -> int:
        edges, edge_of = self._edge_table
        rim = edges[np.bincount(edge_of, minlength=len(edges)) == 1]
        ends, number = np.unique(rim, return_inverse=True)
        number = number.reshape(-1, 2)
        graph = coo_array(
            (np.ones(len(rim), dtype=np.int8), (number[:, 0], number[:, 1])),
            shape=(len(ends), len(ends)),
        )
        return int(connected_components(graph, directed=False)[0])


def _counts(valence: IntArray, regular: int) -> dict[int, int]:
    value, count = np.unique(valence[valence != regular], return_counts=True)
    return dict(zip(value.tolist(), count.tolist(), strict=True))
