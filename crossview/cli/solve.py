"""crossview solve: a case to its report and VTK files."""

from __future__ import annotations

from collections.abc import Generator
from pathlib import Path

from crossview.case import Case
from crossview.cli.options import Flag, Json, Output, chosen_case
from crossview.cli.terminal import say, say_json, watch
from crossview.pipeline import Solution, solve_case
from crossview.staging import staged
from solvers.progress import Progress


def solve(
    case: str,
    /,
    *,
    output: Output,
    method: str | None = None,
    component: str | None = None,
    repair: Flag = False,
    quiet: Flag = False,
    as_json: Json = False,
) -> None:
    """Solve a case; write report.json and VTK files that ParaView opens.

    Parameters
    ----------
    case
        A case, a surface without singularities, or the name of a gallery case.
    output
        Folder for the results: all of them or, after an error, none.
    method
        isotropic, aligned, anisotropic or alternating, instead of the case's.
    component
        Of a surface in several pieces: largest, a number (0 is the largest), or all, which
        makes a folder for each.
    repair
        Also mend what cannot be mended without changing the surface.
    quiet
        Show neither progress nor summary.
    as_json
        Print the report, or a list of them for all components.
    """
    from crossview.export.report import report, summary

    found = chosen_case(case, method, component, repair)
    with staged(output) as staging:
        solutions = watch(_solved_into(staging, found), quiet)
    if as_json:
        reports = [report(solution) for solution in solutions]
        say_json(reports if found.options.component == "all" else reports[0])
    elif not quiet:
        for solution in solutions:
            say(summary(solution))
        say(f"wrote {Path(output)}")


def _solved_into(directory: Path, case: Case) -> Generator[Progress, None, tuple[Solution, ...]]:
    from crossview.export.report import write_files

    solutions = yield from solve_case(case)
    yield Progress("writing", 0.9)
    for number, solution in enumerate(solutions):
        one_of_many = case.options.component == "all"
        folder = directory / f"component-{number}" if one_of_many else directory
        folder.mkdir(exist_ok=True)
        write_files(solution, folder)
    return solutions
