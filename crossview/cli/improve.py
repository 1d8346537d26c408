"""crossview improve: a case whose singularities are moved to where sizes are most even."""

from __future__ import annotations

from dataclasses import replace

from crossview.cli.options import NewCase
from crossview.workflow import configurations
from crossview.workflow.problem import Problem


def improve(case: str, /, *, new: NewCase) -> None:
    """Move unlocked singularities to where sizes are most even, every holonomy defect kept at zero.

    Parameters
    ----------
    case
        A case or the name of a gallery case; if it has a size map, to where they are nearest to it.
    """
    found = new.chosen.case(case)
    problem = Problem.from_case(found)
    improved, end = new.watch(configurations.improve(problem))
    gained = new.gained(replace(problem, singularities=end.start), improved)
    new.write(
        found,
        improved,
        f"improved: variance of H {end.before.variance:.3g} -> {end.sizes.variance:.3g}, "
        f"sizes {end.before.ratio:.3g} -> {end.sizes.ratio:.3g} to 1, {gained}",
    )
