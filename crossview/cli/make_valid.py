"""crossview make-valid: a case whose singularities are moved until it has an aligned field."""

from __future__ import annotations

from dataclasses import replace

from crossview.cli.options import Flag, Output, chosen_case
from crossview.cli.terminal import say, watch
from crossview.workflow.problem import Problem
from solvers.validity.make_valid import make_valid as moved_to_validity


def make_valid(
    case: str,
    /,
    *,
    output: Output,
    component: str | None = None,
    repair: Flag = False,
    quiet: Flag = False,
) -> None:
    """Move unlocked singularities as little as need be until every holonomy defect vanishes.

    Parameters
    ----------
    case
        A case or the name of a gallery case.
    output
        The new case file.
    component
        Of a surface in several pieces: largest or a number (0 is the largest).
    repair
        Also mend what cannot be mended without changing the surface.
    quiet
        Show neither progress nor summary.
    """
    found = chosen_case(case, component=component, repair=repair)
    problem = Problem.from_case(found)
    surface = problem.surface
    end = watch(
        moved_to_validity(surface, problem.singularities, problem.corners, problem.options.refine),
        quiet,
    )
    valid = replace(problem, singularities=end.singularities)
    valid.to_case(found.surface, found.title).save(output)
    if not quiet:
        before = surface.positions([s.point for s in problem.singularities])
        after = surface.positions([s.point for s in end.singularities])
        farthest = float(((after - before) ** 2).sum(axis=1).max(initial=0.0) ** 0.5)
        layout = f", aimed at {end.layout}" if end.layout else ""
        say(f"valid: singularities moved by up to {farthest:.3g}{layout}; wrote {output}")
