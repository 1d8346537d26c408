"""crossview simplify: a case with fewer singularities, valid again."""

from __future__ import annotations

from typing import Annotated

from cyclopts import Parameter

from crossview.cli.options import NewCase
from crossview.workflow import configurations
from crossview.workflow.problem import Problem
from solvers.fields import MOST_VALENCE


def simplify(
    case: str,
    /,
    *,
    most: Annotated[int, Parameter(name="--to")],
    most_valence: int = MOST_VALENCE,
    new: NewCase,
) -> None:
    """Merge unlocked singularities, those of least worth first, and make what is left valid.

    Parameters
    ----------
    case
        A case or the name of a gallery case.
    most
        How many singularities may be left.
    most_valence
        Of a singularity that others are merged to.
    """
    found = new.chosen.case(case)
    problem = Problem.from_case(found)
    fewer, _ = new.watch(configurations.simplify(problem, most, most_valence=most_valence))
    before, after = len(problem.singularities), len(fewer.singularities)
    new.write(found, fewer, f"{before} -> {after} singularities, valid")
