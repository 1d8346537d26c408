"""What quads say about themselves in the report, and in one line; the certificate included."""

from __future__ import annotations

from typing import Any

import numpy as np

from crossview.certificate import Certificate
from crossview.workflow.certification import certified, verdict
from crossview.workflow.pipeline import Solution
from solvers.errors import counted
from solvers.layouts import QuadLayout
from solvers.quads import QuadMesh


def quads_report(solution: Solution, mesh: QuadMesh, delivered: bool = True) -> dict[str, Any]:
    """Counts and quality of a quad mesh; valences are written as text, for they are keys."""
    quality, chosen = mesh.scaled_jacobian, mesh.quantization
    certificate = certified(solution, mesh)
    return {
        "vertices": mesh.n_vertices,
        "quads": mesh.n_quads,
        "delivered": delivered,
        "wanted": None if chosen is None else chosen.n_wanted,
        "least_possible": None if chosen is None else chosen.n_fewest,
        "non_quads": certificate.measures["counts"]["non_quads"],
        "patches": len(np.unique(mesh.patch)),
        "irregular": {str(valence): count for valence, count in mesh.irregular.items()},
        "irregular_on_boundary": {str(valence): count for valence, count in mesh.corners.items()},
        "euler_characteristic": mesh.euler_characteristic,
        "min_scaled_jacobian": float(quality.min()),
        "mean_scaled_jacobian": float(quality.mean()),
        "inverted": certificate.inverted,
        "max_distance_to_surface": mesh.max_distance_to_surface,
        "certificate": certificate.to_json(),
    }


def quads_summary(solution: Solution, layout: QuadLayout, quads: QuadMesh) -> str:
    """Counts and quality of the quads and their layout, in one line, and what is found wrong."""
    certificate = certified(solution, quads)
    quality, irregular = quads.scaled_jacobian, sum(quads.irregular.values())
    patches = f"{layout.patches} {'patch' if layout.patches == 1 else 'patches'}, "
    patches += "conforming" if layout.conforming else f"{len(layout.t_junctions)} T-junctions"
    return (
        f"{quads.n_quads} quads{_missed(quads)} in {patches}; "
        f"{counted(irregular, 'irregular vertex')}, "
        f"scaled Jacobian at least {quality.min():.2f}, mean {quality.mean():.3f}"
        f"{_excused(certificate)}; {verdict(certificate)}"
    )


def _missed(quads: QuadMesh) -> str:
    """By how much the wanted number is missed, and the least there can be, if it is missed."""
    chosen = quads.quantization
    if chosen is None or not chosen.missed:
        return ""
    least = "" if chosen.n_fewest is None else f", about {chosen.n_fewest} is the least possible"
    return f" ({chosen.n_wanted} wanted{least})"


def _excused(certificate: Certificate) -> str:
    """How many vertices are excused where two quads share 360 degrees: nothing helps there."""
    wide = certificate.measures["corners"]["excused_at_valence_2"]
    if not wide:
        return ""
    return f"; {wide} have a corner of 180 degrees or more, as those around a valence 2 do"
