"""What is said of a quad mesh: its numbers beside what was imposed, and whether all is well."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from crossview.certificate import Certificate
from crossview.view.texts import MINUS, count, grouped
from crossview.workflow.certification import verdict
from crossview.workflow.pipeline import Solution
from solvers.layouts import QuadLayout
from solvers.quads import QuadMesh

ROWS = (
    "Vertices",
    "Quads",
    "Irregular",
    "Corners",
    "Euler",
    "Edges",
    "Scaled Jac.",
    "Patches",
    "T-junctions",
    "Flips",
)
"""Titles of the facts, in their order."""


@dataclass(frozen=True)
class QuadFacts:
    """A verdict, whether it is good, and the facts by their titles."""

    good: bool
    verdict: str
    rows: Mapping[str, str]


def quad_facts(
    layout: QuadLayout, mesh: QuadMesh, solution: Solution, certificate: Certificate
) -> QuadFacts:
    """Compare a quad mesh with what was imposed, and say what its certificate finds."""
    wanted = Counter(s.valence for s in solution.singularities if s.valence != 4)
    corners = Counter(2 - k for k in solution.problem.chosen_corners.values() if k != 0)
    quality, lengths = mesh.scaled_jacobian, mesh.edge_lengths
    worst = float(quality.min())
    euler = solution.surface.euler_characteristic
    said = verdict(certificate)
    rows = {
        "Vertices": grouped(mesh.n_vertices),
        "Quads": _number(mesh),
        "Irregular": _beside(mesh.irregular, wanted, lambda n: f"valence {n}"),
        "Corners": _beside(mesh.corners, corners, lambda n: count(n, "quad")),
        "Euler": f"{mesh.euler_characteristic} of {euler}".replace("-", MINUS),
        "Edges": f"{lengths.min():.3g} to {lengths.max():.3g}\nmean {lengths.mean():.3g}",
        "Scaled Jac.": f"min {worst:.2f}\nmean {float(quality.mean()):.3f}".replace("-", MINUS),
        "Patches": f"{grouped(layout.patches)}, {'' if layout.conforming else 'not '}conforming",
        "T-junctions": grouped(len(layout.t_junctions)),
        "Flips": grouped(layout.inverted) + (f", {layout.mended} mended" if layout.mended else ""),
    }
    return QuadFacts(certificate.right, f"{said[0].upper()}{said[1:]}.", rows)


def _number(mesh: QuadMesh) -> str:
    """How many quads there are; if that is not what was wanted, that and the least possible."""
    chosen, said = mesh.quantization, grouped(mesh.n_quads)
    if chosen is not None and chosen.missed:
        said += f"\n{grouped(chosen.n_wanted or 0)} wanted"
        said += "" if chosen.n_fewest is None else f", least about {grouped(chosen.n_fewest)}"
    return said


def _beside(found: Mapping[int, int], wanted: Mapping[int, int], kind: Callable[[int], str]) -> str:
    """Return a line per kind of vertex: how many there are of how many imposed."""
    lines = [
        f"{kind(n)}: {found.get(n, 0)} of {wanted.get(n, 0)}" for n in sorted({*found, *wanted})
    ]
    return "\n".join(lines) or "none"
