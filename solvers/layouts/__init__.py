"""From a field to its separatrices, and to the rectangles they cut a surface into."""

from __future__ import annotations

from solvers.layouts.candidates import NearMisses, nearly_connected
from solvers.layouts.errors import LayoutError
from solvers.layouts.gauge import in_joining_gauge, joined_field
from solvers.layouts.layout import QuadLayout, quad_layout
from solvers.layouts.patches import PatchMesh
from solvers.layouts.saddle_connections import holding
from solvers.layouts.separatrices import Separatrices, field_separatrices
from solvers.layouts.snapping import Snapped, join, snap
from solvers.layouts.tmesh import TMesh

__all__ = [
    "LayoutError",
    "NearMisses",
    "PatchMesh",
    "QuadLayout",
    "Separatrices",
    "Snapped",
    "TMesh",
    "field_separatrices",
    "holding",
    "in_joining_gauge",
    "join",
    "joined_field",
    "nearly_connected",
    "quad_layout",
    "snap",
]
