"""crossview improve: a case whose singularities are moved to where sizes are most even."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import replace

from crossview.cli.options import Output, Quiet, SurfaceOptions
from crossview.cli.terminal import say, watch
from crossview.workflow import configurations
from crossview.workflow.layout import layout_soon
from crossview.workflow.pipeline import Pipeline
from crossview.workflow.problem import Problem
from solvers.layouts import QuadLayout
from solvers.progress import Progress


def improve(
    case: str,
    /,
    *,
    output: Output,
    chosen: SurfaceOptions = SurfaceOptions(),
    quiet: Quiet = False,
) -> None:
    """Move unlocked singularities to where sizes are most even, every holonomy defect kept at zero.

    Parameters
    ----------
    case
        A case or the name of a gallery case; if it has a size map, to where they are nearest to it.
    output
        The new case file.
    """
    found = chosen.case(case)
    problem = Problem.from_case(found)
    improved, end = watch(configurations.improve(problem), quiet)
    improved.to_case(found.surface, found.title).save(output)
    if quiet:
        return
    before = watch(_layout(replace(problem, singularities=end.start)), quiet)
    after = watch(_layout(improved), quiet)
    say(
        f"improved: variance of H {end.before.variance:.3g} -> {end.sizes.variance:.3g}, "
        f"sizes {end.before.ratio:.3g} -> {end.sizes.ratio:.3g} to 1, "
        f"{_counts(before)} -> {_counts(after)}; wrote {output}"
    )


def _layout(problem: Problem) -> Generator[Progress, None, QuadLayout | None]:
    solution = yield from Pipeline().solve(problem)
    return (yield from layout_soon(solution))


def _counts(layout: QuadLayout | None) -> str:
    if layout is None:
        return "no layout"
    return f"{layout.patches} patches and {len(layout.t_junctions)} T-junctions"
