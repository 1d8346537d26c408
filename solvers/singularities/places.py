"""Where singularities may be: inside the surface, each at a place of its own."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from scipy.spatial import cKDTree

from solvers.errors import SingularityError
from solvers.singularities.budget import Singularity, checked_singularities
from solvers.singularities.remedies import MergeTwo, MoveInside
from solvers.surface.refinement import SNAP
from solvers.surface.triangulation import FloatArray, IntArray, next_halfedge
from solvers.surface.trisurface import TriSurface


def require_places(surface: TriSurface, singularities: Iterable[Singularity]) -> None:
    """Refuse a configuration with singularities on the boundary, or two at one place.

    Nothing is refined or solved for it. A place is as wide as what refinement takes for one.

    Parameters
    ----------
    surface : TriSurface
        The surface.
    singularities : iterable of Singularity
        On it.

    Raises
    ------
    CrossviewError
        If a singularity is something else, or of another surface.
    SingularityError
        It names the first on the boundary, or the first two at one place, and what helps.

    Notes
    -----
    The paper's section 2: on the boundary there are corners, inside it singularities.

    Examples
    --------
    >>> from solvers.primitives import disk
    >>> from solvers.singularities import Singularity, require_places
    >>> surface = disk(edge_length=0.2)
    >>> inside = Singularity(surface.point_at_vertex(0), 3)
    >>> require_places(surface, [inside])
    >>> require_places(surface, [inside, inside])
    Traceback (most recent call last):
    solvers.errors.SingularityError: singularities 1 and 2 are at the same place: ...
    """
    placed = checked_singularities(singularities)
    points = surface.require_own(s.point for s in placed)
    if not points:
        return
    faces = np.array([point.face for point in points])
    weights = np.array([point.barycentric for point in points])
    positions = surface.positions(points)
    wide = SNAP * surface.triangulation.lengths.reshape(-1, 3)[faces].max(axis=1)
    on_boundary = np.flatnonzero(_boundary_gap(surface, faces, weights, positions) <= wide)
    if len(on_boundary):
        number = int(on_boundary[0])
        raise SingularityError(
            f"singularity {number + 1} lies on the boundary",
            advice="give the boundary a corner there",
            remedies=(MoveInside("move it inside", number),),
        )
    pairs = cKDTree(positions).query_pairs(float(wide.max()), output_type="ndarray")
    apart = np.linalg.norm(np.diff(positions[pairs], axis=1)[:, 0], axis=1)
    together = pairs[apart <= np.minimum(*wide[pairs].T)]
    if len(together):
        one, other = sorted(min(together.tolist()))
        raise SingularityError(
            f"singularities {one + 1} and {other + 1} are at the same place",
            advice="move one of them away",
            remedies=(MergeTwo("merge them", one, other),),
        )


def _boundary_gap(
    surface: TriSurface, faces: IntArray, weights: FloatArray, positions: FloatArray
) -> FloatArray:
    """Return how far points are from boundary edges and vertices of their triangles."""
    t = surface.triangulation
    corners = surface.faces[faces]
    gaps = np.linalg.norm(surface.vertices[corners] - positions[:, None], axis=2)
    gaps[~surface.boundary_vertices[corners]] = np.inf
    sides = 3 * faces[:, None] + np.arange(3)
    length = t.lengths.reshape(-1)[sides]
    opposite = np.take_along_axis(weights, next_halfedge(next_halfedge(np.arange(3)))[None], axis=1)
    heights = 2 * t.areas[faces, None] * opposite / length
    heights[t.twin[sides] >= 0] = np.inf
    return np.asarray(np.minimum(gaps.min(axis=1), heights.min(axis=1)))
