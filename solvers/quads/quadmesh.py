"""The quad mesh on a surface: connectivity, irregular vertices, quality."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from solvers.errors import CrossviewError
from solvers.frozen import freeze_arrays
from solvers.quads.projection import Projection
from solvers.surface.triangulation import BoolArray, FloatArray, IntArray
from solvers.surface.trisurface import TriSurface

ON_EDGE = 1e-9
"""Weight of a corner, from 0 to 1, below which a place is on the edge across. Chosen, well above
rounding.
"""


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
        """(q,) smallest sine of a quad's corners about its mean normal; 1 for rectangles."""
        outward = normals_at(self.surface, self.faces, self.barycentric)[self.quads].sum(axis=1)
        return scaled_jacobian(self.vertices[self.quads], outward)

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
        ends = np.stack([self.quads, np.roll(self.quads, -1, axis=1)], axis=2).reshape(-1, 2)
        ends.sort(axis=1)
        key, edge_of = np.unique(ends[:, 0] * self.n_vertices + ends[:, 1], return_inverse=True)
        edges = np.stack([key // self.n_vertices, key % self.n_vertices], axis=1)
        return edges, edge_of.reshape(-1)

    @cached_property
    def _fan_vertex(self) -> IntArray:
        """The vertex of each fan of quads: corners joined over the edges they share."""
        _, edge_of = self._edge_table
        order = np.argsort(edge_of, kind="stable")
        paired = np.flatnonzero(np.diff(edge_of[order]) == 0)
        side, other = order[paired], order[paired + 1]
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


def normals_at(surface: TriSurface, faces: IntArray, weights: FloatArray) -> FloatArray:
    """Return the (..., 3) normals at places on a surface.

    Those of the triangles (...,) where the weights (..., 3) are inside; on edges, where either of
    two triangles may be named, those interpolated: across a sharp edge the other may look away.
    """
    normals = surface.face_normals[faces]
    on_edge = weights.min(axis=-1) < ON_EDGE
    ends = surface.vertex_normals[surface.faces[faces[on_edge]]]
    normals[on_edge] = (weights[on_edge][:, :, None] * ends).sum(axis=1)
    return normals


def scaled_jacobian(corners: FloatArray, outward: FloatArray) -> FloatArray:
    """Return the quality of quads: the smallest sine of their corners about their mean normals.

    Parameters
    ----------
    corners : (..., 4, 3) float array
        Counter-clockwise seen from outside.
    outward : (..., 3) float array
        Vectors, of any length, that point to the outside.

    Returns
    -------
    (...) float array
        1 for a rectangle, 0 or less for a quad that is folded, inverted or has a side without
        length.

    Notes
    -----
    The verdict of Knupp 2000 on each corner, with the normal that the quad's diagonals span.

    Examples
    --------
    A rhombus with angles of 60 and 120 degrees, seen from above and from below:

    >>> import numpy as np
    >>> from solvers.quads import scaled_jacobian
    >>> height = np.sqrt(3) / 2
    >>> rhombus = np.array([[0, 0, 0], [1, 0, 0], [1.5, height, 0], [0.5, height, 0]])
    >>> for outward in (1.0, -1.0):
    ...     print(round(float(scaled_jacobian(rhombus, np.array([0, 0, outward]))), 6))
    0.866025
    -0.866025
    """
    ahead = np.roll(corners, -1, axis=-2) - corners
    ahead /= np.maximum(np.linalg.norm(ahead, axis=-1), 1e-300)[..., None]
    normal = np.cross(
        corners[..., 2, :] - corners[..., 0, :], corners[..., 3, :] - corners[..., 1, :]
    )
    normal /= np.maximum(np.linalg.norm(normal, axis=-1), 1e-300)[..., None]
    sines = (np.cross(np.roll(ahead, 1, axis=-2), ahead) @ normal[..., None])[..., 0].min(axis=-1)
    return np.asarray(np.where((normal * outward).sum(axis=-1) < 0, -np.abs(sines), sines))


def _counts(valence: IntArray, regular: int) -> dict[int, int]:
    value, count = np.unique(valence[valence != regular], return_counts=True)
    return dict(zip(value.tolist(), count.tolist(), strict=True))
