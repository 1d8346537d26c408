"""crossview make-valid: a case whose singularities are moved until it has an aligned field."""

from __future__ import annotations

from crossview.cli.options import Output, Quiet, SurfaceOptions
from crossview.cli.terminal import say, watch
from crossview.workflow import configurations
from crossview.workflow.problem import Problem


def make_valid(
    case: str,
    /,
    *,
    output: Output,
    chosen: SurfaceOptions = SurfaceOptions(),
    quiet: Quiet = False,
) -> None:
    """Move unlocked singularities as little as need be until every holonomy defect vanishes.

    Parameters
    ----------
    case
        A case or the name of a gallery case.
    output
        The new case file.
    """
    found = chosen.case(case)
    problem = Problem.from_case(found)
    valid, end = watch(configurations.make_valid(problem), quiet)
    valid.to_case(found.surface, found.title).save(output)
    if not quiet:
        before, after = (
            p.surface.positions([s.point for s in p.singularities]) for p in (problem, valid)
        )
        farthest = float(((after - before) ** 2).sum(axis=1).max(initial=0.0) ** 0.5)
        layout = f", aimed at {end.aim}" if end.aim else ""
        say(f"valid: singularities moved by up to {farthest:.3g}{layout}; wrote {output}")
