"""From a triangle soup to a surface, and what that took."""

from __future__ import annotations

from solvers.repair.seams import share_vertices
from solvers.repair.soup import NoComponent, Repaired, repair, repair_each

__all__ = ["NoComponent", "Repaired", "repair", "repair_each", "share_vertices"]
