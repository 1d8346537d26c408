"""crossview natural: a case with the singularities that appear by themselves."""

from __future__ import annotations

from crossview.cli.options import NewCase
from crossview.workflow import configurations
from crossview.workflow.problem import Problem
from solvers.fields import CURVATURE_WEIGHT, MOST_VALENCE, NATURAL_ALIGNMENTS, NATURAL_METHODS


def natural(
    surface: str,
    /,
    *,
    method: str = NATURAL_METHODS[0],
    seed: int = 0,
    alignment: str = NATURAL_ALIGNMENTS[0],
    weight: float = CURVATURE_WEIGHT,
    most_valence: int = MOST_VALENCE,
    fewest: bool = False,
    most: int | None = None,
    scale: float | None = None,
    new: NewCase,
) -> None:
    """Place the singularities of a smooth cross-field aligned with boundaries and features.

    Parameters
    ----------
    surface
        A surface file, a case (its singularities are replaced) or the name of a built-in surface.
    method
        mbo, ginzburg-landau or globally-optimal.
    seed
        Of the random start.
    alignment
        smoothness, or curvature: also draw the crosses towards the principal directions.
    weight
        How strongly the curvature draws.
    most_valence
        Of a singularity; none has less than 2.
    fewest
        Let opposite indices cancel until as few are left as the index budget allows.
    most
        How many singularities at most: opposite indices cancel and equal ones are merged.
    scale
        Length below which details of the surface do not count, in its units; 0.03 roots of its
        area if not given, 0: all count.
    """
    found = new.chosen.case(surface)
    given = Problem.from_case(found)
    computation = configurations.natural(
        given,
        method,
        seed,
        alignment=alignment,
        weight=weight,
        most_valence=most_valence,
        fewest=fewest,
        most=most,
        scale=scale,
    )
    problem = new.watch(computation)
    count = configurations.crowded(problem)
    near = f", {count} of them as near to another as edges are long: mbo keeps them apart"
    new.write(found, problem, f"{len(problem.singularities)} singularities{near if count else ''}")
