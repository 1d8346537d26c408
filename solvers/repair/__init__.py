"""From a triangle soup to a surface, and what that took."""

from __future__ import annotations

from solvers.repair.soup import Repaired, repair, repair_each

__all__ = ["Repaired", "repair", "repair_each"]
