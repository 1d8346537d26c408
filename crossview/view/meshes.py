"""From the solvers' separatrices, layouts and quad meshes to what the scene shows.

Each is made once: the same value gives the same drawing, in which the scene sees no change.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import TypeVar
from weakref import WeakKeyDictionary

import numpy as np

from crossview.view.geometry import Triangles
from crossview.view.sampling import usual_sites
from crossview.view.values import FloatArray, Polylines, Quads
from crossview.workflow.spots import POOR, worst_quads
from solvers.layouts import NearMisses, QuadLayout, Separatrices
from solvers.quads import QuadMesh
from solvers.surface import TriSurface

Source = TypeVar("Source")
Drawing = TypeVar("Drawing")


def _once(draw: Callable[[Source], Drawing]) -> Callable[[Source], Drawing]:
    """Keep each drawing for as long as there is what it is of."""
    drawn: WeakKeyDictionary[Source, Drawing] = WeakKeyDictionary()

    @wraps(draw)
    def kept(source: Source) -> Drawing:
        if source not in drawn:
            drawn[source] = draw(source)
        return drawn[source]

    return kept


@_once
def triangles_of(surface: TriSurface) -> Triangles:
    """Return the triangles of a surface as they are drawn, with what that needs of them."""
    triangles = Triangles(surface.vertices, surface.faces)
    _ = triangles.outward, triangles.boundary_edges, usual_sites(triangles)
    return triangles


@_once
def curves_of(separatrices: Separatrices) -> Polylines:
    """Return separatrices as curves to draw."""
    return Polylines(separatrices.points, separatrices.offsets, separatrices.valences)


@_once
def near_misses_of(found: NearMisses) -> Polylines:
    """Return near misses as curves to draw."""
    return Polylines(found.points, found.offsets, np.zeros(len(found), dtype=np.int64))


@_once
def t_junctions_of(separatrices: Separatrices) -> FloatArray:
    """Return (k, 3) where separatrices are cut at T-junctions."""
    return separatrices.t_junctions


@_once
def worst_of(mesh: QuadMesh) -> FloatArray:
    """Return (k, 3) the middles of the worst quads, of those that are poor."""
    poor = [quad.spot.place for quad in worst_quads(mesh) if quad.quality < POOR]
    return np.array(poor).reshape(-1, 3)


@_once
def patches_of(layout: QuadLayout) -> Quads:
    """Return the sampled patches of a layout as quads to draw."""
    sampled = layout.patch_mesh
    return Quads(sampled.points, sampled.quads, sampled.patch, apart=True)


@_once
def quads_of(mesh: QuadMesh) -> Quads:
    """Return a quad mesh to draw, its quality and inner irregular vertices with it."""
    irregular = np.flatnonzero((mesh.valence != 4) & ~mesh.on_boundary)
    a, b, c, d = (mesh.vertices[corner] for corner in mesh.quads.T)
    normals = np.zeros(mesh.vertices.shape)
    np.add.at(normals, mesh.quads, np.cross(c - a, d - b)[:, None])
    return Quads(
        mesh.vertices,
        mesh.quads,
        mesh.patch,
        mesh.scaled_jacobian,
        mesh.vertices[irregular],
        mesh.valence[irregular],
        normals[irregular],
    )
