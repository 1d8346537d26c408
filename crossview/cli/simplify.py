"""crossview simplify: a case with fewer singularities, valid again."""

from __future__ import annotations

from typing import Annotated

from cyclopts import Parameter

from crossview.cli.options import FeatureOptions, Output, Quiet
from crossview.cli.terminal import say, watch
from crossview.workflow import configurations
from crossview.workflow.problem import Problem
from solvers.fields import MOST_VALENCE


def simplify(
    case: str,
    /,
    *,
    most: Annotated[int, Parameter(name="--to")],
    output: Output,
    most_valence: int = MOST_VALENCE,
    chosen: FeatureOptions = FeatureOptions(),
    quiet: Quiet = False,
) -> None:
    """Merge unlocked singularities, those of least worth first, and make what is left valid.

    Parameters
    ----------
    case
        A case or the name of a gallery case.
    most
        How many singularities may be left.
    output
        The new case file.
    most_valence
        Of a singularity that others are merged to.
    """
    found = chosen.case(case)
    problem = Problem.from_case(found)
    fewer, _ = watch(configurations.simplify(problem, most, most_valence=most_valence), quiet)
    fewer.to_case(found.surface, found.title).save(output)
    if not quiet:
        before, after = len(problem.singularities), len(fewer.singularities)
        say(f"{before} -> {after} singularities, valid; wrote {output}")
