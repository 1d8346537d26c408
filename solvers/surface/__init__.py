"""The triangle surface: points, connectivity, validation, loops, paths, refinement."""

from __future__ import annotations

from solvers.surface.cutting import cut_graph
from solvers.surface.delaunay import DelaunayTriangulation, Located
from solvers.surface.edge_paths import EdgePaths
from solvers.surface.geodesics import straightest
from solvers.surface.homology import HandleLoops, handle_loops
from solvers.surface.points import SurfacePoint
from solvers.surface.refinement import LEVELS, Refinement, refine_at, refine_everywhere
from solvers.surface.triangulation import (
    QUARTER,
    BoolArray,
    FloatArray,
    IntArray,
    IntrinsicTriangulation,
)
from solvers.surface.trisurface import TriSurface, barycentric
from solvers.surface.validation import array_problems, problems

__all__ = [
    "LEVELS",
    "QUARTER",
    "BoolArray",
    "DelaunayTriangulation",
    "EdgePaths",
    "FloatArray",
    "HandleLoops",
    "IntArray",
    "IntrinsicTriangulation",
    "Located",
    "Refinement",
    "SurfacePoint",
    "TriSurface",
    "array_problems",
    "barycentric",
    "cut_graph",
    "handle_loops",
    "problems",
    "refine_at",
    "refine_everywhere",
    "straightest",
]
