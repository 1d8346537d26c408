"""crossview complete: a case with the singularities that its index budget lacks."""

from __future__ import annotations

from crossview.cli.options import Output, Quiet, SurfaceOptions
from crossview.cli.terminal import say, watch
from crossview.workflow import configurations
from crossview.workflow.problem import Problem


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
    completed = watch(configurations.complete(problem), quiet)
    completed.to_case(found.surface, found.title).save(output)
    if not quiet:
        added = completed.singularities[len(problem.singularities) :]
        count = f"added {len(added)} of valence {added[0].valence}" if added else ""
        say(f"{count or 'nothing is missing'}; wrote {output}")
