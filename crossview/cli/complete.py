"""crossview complete: a case with the singularities that its index budget lacks."""

from __future__ import annotations

from crossview.cli.options import NewCase
from crossview.workflow import configurations
from crossview.workflow.problem import Problem


def complete(case: str, /, *, new: NewCase) -> None:
    """Add the valences 3 or 5 that the index budget lacks, where they even out the sizes most.

    Parameters
    ----------
    case
        A case, the name of a gallery case or a surface.
    """
    found = new.chosen.case(case)
    problem = Problem.from_case(found)
    completed = new.watch(configurations.complete(problem))
    added = completed.singularities[len(problem.singularities) :]
    count = f"added {len(added)} of valence {added[0].valence}" if added else ""
    new.write(found, completed, count or "nothing is missing")
