"""Singularities and corners: the index budget, what is possible, pairs, symmetry, spacing."""

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
from solvers.singularities.connections import Connections, checked_connections
from solvers.singularities.decision import Existence, existence
from solvers.singularities.farthest import far_points
from solvers.singularities.pairs import merged, pair_at, split
from solvers.singularities.places import require_places
from solvers.singularities.remedies import (
    AddMissing,
    AddPair,
    ChangeCorners,
    ChangeOne,
    ChangeTurns,
    MergeTwo,
    MoveInside,
    RemoveOne,
    SplitOne,
)
from solvers.singularities.symmetry import mirrored, rotated
from solvers.singularities.theorems import Theorem
from solvers.singularities.topology import decide

__all__ = [
    "AddMissing",
    "AddPair",
    "ChangeCorners",
    "ChangeOne",
    "ChangeTurns",
    "Connections",
    "Existence",
    "IndexBudget",
    "MergeTwo",
    "MoveInside",
    "RemoveOne",
    "Singularity",
    "SplitOne",
    "Theorem",
    "checked_connections",
    "checked_corners",
    "checked_singularities",
    "decide",
    "default_corners",
    "existence",
    "far_points",
    "index_budget",
    "merged",
    "mirrored",
    "pair_at",
    "require_budget",
    "require_places",
    "rotated",
    "split",
]
