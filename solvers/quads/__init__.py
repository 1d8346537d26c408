"""From a layout to quads: whole numbers for its arcs, grids in its rectangles, smoothing."""

from __future__ import annotations

from solvers.quads.quadmesh import scaled_jacobian
from solvers.quads.quantization import Quantization, quantize, quantize_to

__all__ = ["Quantization", "quantize", "quantize_to", "scaled_jacobian"]
