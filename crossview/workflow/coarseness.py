"""How coarse the layout of a problem is: what moving singularities is to gain."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass

from crossview.workflow.layout import layout_soon
from crossview.workflow.pipeline import Pipeline
from crossview.workflow.problem import Problem
from solvers.errors import counted
from solvers.layouts import QuadLayout
from solvers.progress import Progress


@dataclass(frozen=True)
class Coarseness:
    """Of a layout.

    Parameters
    ----------
    patches, t_junctions : int
        How many.
    """

    patches: int
    t_junctions: int

    @classmethod
    def of(cls, layout: QuadLayout | None) -> Coarseness | None:
        """Return that of a layout; None if there is none."""
        return None if layout is None else cls(layout.patches, len(layout.t_junctions))

    def __str__(self) -> str:
        """Return it in words."""
        patches = "patch" if self.patches == 1 else "patches"
        return f"{self.patches} {patches} and {counted(self.t_junctions, 'T-junction')}"


def coarseness(problem: Problem) -> Generator[Progress, None, Coarseness | None]:
    """Return how coarse the layout of a problem is; None where there is none soon."""
    solution = yield from Pipeline().solve(problem)
    return Coarseness.of((yield from layout_soon(solution)))
