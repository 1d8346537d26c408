"""From a field to its separatrices, and to the rectangles they cut a surface into."""

from __future__ import annotations

from solvers.layouts.tmesh import TMesh

__all__ = ["TMesh"]
