"""crossview snap: a case whose separatrices meet the singularities that they nearly met."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from crossview.cli.options import NewCase
from crossview.workflow import configurations
from crossview.workflow.problem import Problem
from solvers.errors import counted


def snap(case: str, /, *, new: NewCase) -> None:
    """Move unlocked singularities until separatrices meet what they nearly meet, all loops closed.

    What is joined so is kept by further commands: `connections` of the case.

    Parameters
    ----------
    case
        A case or the name of a gallery case.
    """
    found = new.chosen.case(case)
    problem = Problem.from_case(found)
    snapped, end = new.watch(configurations.snap(problem))
    before, after = (
        problem.surface.positions([s.point for s in p.singularities]) for p in (problem, snapped)
    )
    farthest = float(np.linalg.norm(after - before, axis=1).max())
    gained = new.gained(replace(problem, singularities=end.start), snapped)
    new.write(
        found,
        snapped,
        f"snapped: {counted(len(end.connections), 'connection')}, singularities moved by up to "
        f"{farthest:.3g}, {gained}",
    )
