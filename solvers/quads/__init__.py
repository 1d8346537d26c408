"""From a layout to quads: whole numbers for its arcs, grids in its rectangles, smoothing."""

from __future__ import annotations

from solvers.quads.bending import MAX_CHORD, bending_conditions, bent_spacing
from solvers.quads.collapse import Condition
from solvers.quads.corners import scaled_jacobian
from solvers.quads.filling import fill
from solvers.quads.quadmesh import QuadMesh
from solvers.quads.quantization import (
    MOST_QUADS,
    Quantization,
    fewest_quads,
    quantize,
    quantize_to,
)
from solvers.quads.sizing import MAX_SIZE_RATIO, size_conditions
from solvers.quads.smoothing import smooth, smoothing_stages

__all__ = [
    "MAX_CHORD",
    "MAX_SIZE_RATIO",
    "MOST_QUADS",
    "Condition",
    "QuadMesh",
    "Quantization",
    "bending_conditions",
    "bent_spacing",
    "fewest_quads",
    "fill",
    "quantize",
    "quantize_to",
    "scaled_jacobian",
    "size_conditions",
    "smooth",
    "smoothing_stages",
]
