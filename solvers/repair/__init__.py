"""From a triangle soup to a surface, and what that took."""

from __future__ import annotations

from solvers.repair.flat_triangles import merge_coincident
from solvers.repair.soup import NoComponent, Repaired, repair, repair_each

__all__ = ["NoComponent", "Repaired", "merge_coincident", "repair", "repair_each"]
