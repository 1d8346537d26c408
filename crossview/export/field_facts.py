"""What a report tells of a field's sizes and of the cut graph."""

from __future__ import annotations

from typing import Any

import numpy as np

from crossview.workflow.pipeline import Solution
from solvers.fields import CrossField


def log_sizes(field: CrossField) -> dict[str, float]:
    """Return the least and the greatest of H1 and H2, and mean and standard deviation by area."""
    areas, both = field.surface.face_areas, np.concatenate([field.H1, field.H2])
    weights, each = np.tile(areas, 2), both.mean(axis=1)
    mean = float(np.average(each, weights=weights))
    return {
        "least": float(both.min()),
        "most": float(both.max()),
        "mean": mean,
        "spread": float(np.sqrt(np.average((each - mean) ** 2, weights=weights))),
    }


def cut_facts(solution: Solution) -> dict[str, Any]:
    """Return whether the cut graph opens the surface to a disk, all singularities on its rim.

    A disk has the Euler characteristic 1. A vertex inside the surface comes apart into as many as
    there are edges of the cut at it, one on the boundary into one more.
    """
    surface, cut = solution.surface, solution.cut_graph
    at, degree = np.unique(cut, return_counts=True)
    more = int((degree - ~surface.boundary_vertices[at]).sum())
    ends = surface.vertices[at]
    places = surface.positions([s.point for s in solution.singularities])
    off = [bool((np.abs(ends - place).sum(axis=1) > 0).all()) for place in places]
    return {
        "edges": len(cut),
        "euler_characteristic_opened": surface.euler_characteristic + more - len(cut),
        "singularities_off": int(sum(off)),
    }
