"""crossview make-valid: a case whose singularities are moved until it has an aligned field."""

from __future__ import annotations

from crossview.cli.options import NewCase
from crossview.workflow import configurations
from crossview.workflow.problem import Problem


def make_valid(case: str, /, *, new: NewCase) -> None:
    """Move unlocked singularities as little as need be until every holonomy defect vanishes.

    Parameters
    ----------
    case
        A case or the name of a gallery case.
    """
    found = new.chosen.case(case)
    problem = Problem.from_case(found)
    valid, end = new.watch(configurations.make_valid(problem))
    before, after = (
        p.surface.positions([s.point for s in p.singularities]) for p in (problem, valid)
    )
    farthest = float(((after - before) ** 2).sum(axis=1).max(initial=0.0) ** 0.5)
    layout = f", aimed at {end.aim}" if end.aim else ""
    new.write(found, valid, f"valid: singularities moved by up to {farthest:.3g}{layout}")
