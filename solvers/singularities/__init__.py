"""Singularities and corners: the index budget, pairs, symmetry, spacing."""

from __future__ import annotations

from solvers.singularities.budget import (
    IndexBudget,
    Singularity,
    checked_corners,
    checked_singularities,
    default_corners,
    index_budget,
    require_budget,
)
from solvers.singularities.farthest import far_points
from solvers.singularities.pairs import merged, pair_at, split
from solvers.singularities.remedies import AddMissing, ChangeOne, RemoveOne
from solvers.singularities.symmetry import mirrored, rotated

__all__ = [
    "AddMissing",
    "ChangeOne",
    "IndexBudget",
    "RemoveOne",
    "Singularity",
    "checked_corners",
    "checked_singularities",
    "default_corners",
    "far_points",
    "index_budget",
    "merged",
    "mirrored",
    "pair_at",
    "require_budget",
    "rotated",
    "split",
]
