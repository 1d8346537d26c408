"""Valid configurations: where a singularity may go, and the way to where it does."""

from __future__ import annotations

from solvers.validity.guide import Guide, LevelLines

__all__ = ["Guide", "LevelLines"]
