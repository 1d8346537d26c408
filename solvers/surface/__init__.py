"""The triangle surface: points, connectivity, validation, loops, paths, refinement."""

from __future__ import annotations

from solvers.surface.cutting import cut_graph
from solvers.surface.delaunay import intrinsic_delaunay
from solvers.surface.edge_paths import EdgePaths
from solvers.surface.geodesics import Walk, straightest
from solvers.surface.homology import HandleLoops, handle_loops
from solvers.surface.points import SurfacePoint
from solvers.surface.refinement import LEVELS, Refinement, refine_at, refine_everywhere
from solvers.surface.sectors import corner_sectors
from solvers.surface.shaping import parted, shaped
from solvers.surface.shortest import shortest_path
from solvers.surface.symmetries import Isometry, isometries
from solvers.surface.triangulation import (
    QUARTER,
    BoolArray,
    FloatArray,
    IntArray,
    IntrinsicTriangulation,
)
from solvers.surface.trisurface import TriSurface, barycentric
from solvers.surface.validation import array_problems, problems
from solvers.surface.working import Edit, Located, Segments, WorkingTriangulation

__all__ = [
    "LEVELS",
    "QUARTER",
    "BoolArray",
    "EdgePaths",
    "Edit",
    "FloatArray",
    "HandleLoops",
    "IntArray",
    "IntrinsicTriangulation",
    "Isometry",
    "Located",
    "Refinement",
    "Segments",
    "SurfacePoint",
    "TriSurface",
    "Walk",
    "WorkingTriangulation",
    "array_problems",
    "barycentric",
    "corner_sectors",
    "cut_graph",
    "handle_loops",
    "intrinsic_delaunay",
    "isometries",
    "parted",
    "problems",
    "refine_at",
    "refine_everywhere",
    "shaped",
    "shortest_path",
    "straightest",
]
