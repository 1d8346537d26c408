"""A solution as VTK polygonal data, as ParaView opens it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyvista as pv
from numpy.typing import NDArray

from crossview.workflow.pipeline import Solution
from solvers.layouts import QuadLayout, Separatrices

ARM = 0.35
"""Length of a cross's arm in a triangle of typical H, in lengths of the triangle's size."""


def field_surface(solution: Solution) -> pv.PolyData:
    """The surface solved on, with the field.

    Point data: H, the mean of the two log sizes. Cell data: theta (radians), u, v (unit vectors),
    H1 and H2 (log sizes along u and v at the barycentre), log_aspect = |H2 - H1| and
    error_density, which integrates to the square of E.
    """
    field = solution.field
    mesh = pv.PolyData.from_regular_faces(solution.surface.vertices, solution.surface.faces)
    mesh.point_data["H"] = field.H
    mesh.cell_data["theta"] = field.theta
    mesh.cell_data["u"] = field.u
    mesh.cell_data["v"] = field.v
    mesh.cell_data["H1"] = field.H1.mean(axis=1)
    mesh.cell_data["H2"] = field.H2.mean(axis=1)
    mesh.cell_data["log_aspect"] = field.log_aspect
    mesh.cell_data["error_density"] = field.error_density
    return mesh


def cross_lines(solution: Solution) -> pv.PolyData:
    """Two lines per triangle along u and v, their lengths proportional to exp(H1) and exp(H2).

    Cell data: "face" the triangle of ``surface.vtp``, "axis" 0 for u and 1 for v, "H" the log
    size along the line.
    """
    field, surface = solution.field, solution.surface
    H = np.stack([field.H1.mean(axis=1), field.H2.mean(axis=1)], axis=1)
    # a typical cross just fits its triangle
    typical = ARM * np.sqrt(np.median(surface.face_areas))
    arms = (typical * np.exp(H - np.median(H)))[..., None] * np.stack([field.u, field.v], axis=1)
    ends = surface.barycentres[:, None, None] + np.stack([-arms, arms], axis=2)
    lines = np.arange(4 * surface.n_faces).reshape(-1, 2)
    mesh = _lines(ends.reshape(-1, 3), lines)
    mesh.cell_data["face"] = np.repeat(np.arange(surface.n_faces), 2)
    mesh.cell_data["axis"] = np.tile([0, 1], surface.n_faces)
    mesh.cell_data["H"] = H.reshape(-1)
    return mesh


def cut_lines(solution: Solution) -> pv.PolyData:
    """The edges of the cut graph."""
    used, pairs = np.unique(solution.cut_graph, return_inverse=True)
    return _lines(solution.surface.vertices[used], pairs.reshape(-1, 2))


def feature_lines(solution: Solution) -> pv.PolyData:
    """The feature edges.

    Cell data: "curve" the number of the curve that each is part of, "misalignment_degrees" the
    largest angle between it and the crosses.
    """
    features = solution.features
    used, pairs = np.unique(features.ends, return_inverse=True)
    mesh = _lines(solution.surface.vertices[used], pairs.reshape(-1, 2))
    mesh.cell_data["curve"] = features.curve_of
    off = np.degrees(solution.field.feature_misalignment)
    mesh.cell_data["misalignment_degrees"] = off[features.curve_of]
    return mesh


def singularity_points(solution: Solution) -> pv.PolyData:
    """The singularities as points with "valence" and "index" (quarter turns)."""
    singularities = solution.singularities
    points = solution.surface.positions([s.point for s in singularities])
    mesh = pv.PolyData(points)
    mesh.point_data["valence"] = np.array([s.valence for s in singularities], dtype=int)
    mesh.point_data["index"] = np.array([s.index for s in singularities], dtype=int)
    return mesh


def separatrix_lines(curves: Separatrices) -> pv.PolyData:
    """Separatrices as polylines.

    Cell data: "valence" of the singularity each leaves (0 for a corner, -1 for a curve added to
    make rectangles), "end" 0 at a singularity or corner, 1 on the boundary, 2 at a T-junction, 3
    for a curve cut for its length.
    """
    mesh = pv.PolyData()
    mesh.points = curves.points.astype(np.float64).reshape(-1, 3)
    numbers = np.arange(len(curves.points))
    mesh.lines = np.insert(numbers, curves.offsets[:-1], np.diff(curves.offsets))
    mesh.cell_data["valence"] = curves.valences
    mesh.cell_data["end"] = curves.ends
    return mesh


def layout_patches(layout: QuadLayout) -> pv.PolyData:
    """The patches of a layout, finely sampled; cell data "patch" is the number of each."""
    sampled = layout.patch_mesh
    mesh = pv.PolyData.from_regular_faces(sampled.points, sampled.quads)
    mesh.cell_data["patch"] = sampled.patch
    return mesh


def _lines(points: NDArray[np.float64], pairs: NDArray[Any]) -> pv.PolyData:
    """Separate line segments between pairs of points."""
    mesh = pv.PolyData()
    mesh.points = points.astype(np.float64).reshape(-1, 3)
    mesh.lines = np.insert(pairs, 0, 2, axis=1).ravel()
    return mesh
