"""crossview complete: a case with the singularities that its index budget lacks."""

from __future__ import annotations

from dataclasses import replace

from crossview.cli.options import Output, Quiet, SurfaceOptions
from crossview.cli.terminal import say, watch
from crossview.workflow.problem import Problem
from solvers.fields import IsotropicSolver
from solvers.validity import missing_singularities


def complete(
    case: str,
    /,
    *,
    output: Output,
    chosen: SurfaceOptions = SurfaceOptions(),
    quiet: Quiet = False,
) -> None:
    """Add the valences 3 or 5 that the index budget lacks, where they even out the sizes most.

    Parameters
    ----------
    case
        A case, the name of a gallery case or a surface.
    output
        The new case file.
    """
    found = chosen.case(case)
    problem = Problem.from_case(found)
    solver = IsotropicSolver(problem.surface, problem.corners)
    added = watch(missing_singularities(solver, problem.singularities), quiet)
    completed = replace(problem, singularities=(*problem.singularities, *added))
    completed.to_case(found.surface, found.title).save(output)
    if not quiet:
        count = f"added {len(added)} of valence {added[0].valence}" if added else ""
        say(f"{count or 'nothing is missing'}; wrote {output}")
