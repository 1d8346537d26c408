"""crossview solve: a case to its report and VTK files."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from crossview.cases.model import Case
from crossview.cli.options import QUADS, CaseOptions, Flag, Json, Output, QuadOptions, Quiet
from crossview.cli.terminal import complain, say, say_json, watch
from crossview.io.staged_files import staged
from crossview.workflow.certification import certified
from crossview.workflow.layout import layout_soon
from crossview.workflow.pipeline import Solution, of_component, solve_case
from crossview.workflow.quads import MeshOptions, quads_of, require_closing
from solvers.errors import CrossviewError
from solvers.layouts import QuadLayout
from solvers.progress import Progress
from solvers.quads import QuadMesh

Result = tuple[Solution, QuadLayout | None, QuadMesh | None]
Results = list[Result]


def solve(
    case: str,
    /,
    *,
    output: Output,
    chosen: CaseOptions = CaseOptions(),
    quads: Annotated[Flag, Parameter(group=QUADS)] = False,
    sizes: QuadOptions = QuadOptions(),
    formats: Annotated[str | None, Parameter(group=QUADS)] = None,
    allow_inverted: Annotated[Flag, Parameter(group=QUADS)] = False,
    quiet: Quiet = False,
    as_json: Json = False,
) -> int:
    """Solve a case; write report.json and VTK files that ParaView opens.

    Parameters
    ----------
    case
        A case, a surface without singularities, or the name of a gallery case.
    output
        Folder for the results: all of them or, after an error, none. If all components are solved,
        it has a folder for each.
    quads
        Also make the quad layout and a quad mesh, which need an aligned and integrable field.
    formats
        Of the quads: some of obj, vtk, vtu, ply, gltf, glb and msh (Gmsh, with named boundaries),
        such as vtk,msh; vtk,obj if not given.
    allow_inverted
        Write quads also where one is inverted; the exit status is 1 either way.
    as_json
        Print the report, or a list of them for all components.
    """
    from crossview.export.quads_report import quads_summary
    from crossview.export.report import report, summary

    wanted = sizes.wanted(quads, "add --quads")
    kinds = _formats(formats, quads)
    if allow_inverted and not quads:
        raise CrossviewError("--allow-inverted is about quads", "", "add --quads")
    found = chosen.case(case)
    with staged(output, found.files) as staging:
        results = watch(_solved_into(staging, found, wanted, kinds, allow_inverted), quiet)
    spoiled = _spoiled(results)
    if as_json:
        withheld = [] if allow_inverted else spoiled
        reports = [report(*made, i not in withheld) for i, made in enumerate(results)]
        say_json(reports if found.options.component == "all" else reports[0])
    elif not quiet:
        for solution, layout, made in results:
            say(summary(solution))
            if layout is not None and made is not None:
                say(quads_summary(solution, layout, made))
        say(f"wrote {Path(output)}")
    for number in spoiled:
        _complain(results[number], number if len(results) > 1 else None, allow_inverted)
    return 1 if spoiled else 0


def _spoiled(results: Results) -> list[int]:
    """Which results have inverted quads."""
    return [
        number
        for number, (solution, _, made) in enumerate(results)
        if made is not None and certified(solution, made).inverted
    ]


def _complain(result: Result, component: int | None, allowed: bool) -> None:
    """Tell how many quads are inverted, where, and what is to be done."""
    solution, _, made = result
    if made is None:
        return
    faults = certified(solution, made).faults
    fault = next(str(fault) for fault in faults if fault.kind == "inverted")
    where = "" if component is None else f"component {component}: "
    done = "written as allowed" if allowed else "no quads are written, all else is"
    advice = "" if allowed else ": try another number of quads, or add --allow-inverted"
    complain(f"crossview: {where}{fault}; {done}{advice}")


def _formats(text: str | None, quads: bool) -> Sequence[str]:
    """The formats that quads are wanted in."""
    from crossview.export.meshes import check_kind
    from crossview.export.report import FORMATS

    if text is None:
        return FORMATS
    if not quads:
        raise CrossviewError("--formats is about quads", "", "add --quads")
    names = [name.strip().lower().removeprefix(".") for name in text.split(",")]
    for name in names:
        check_kind(Path(f"quads.{name}"))
    return names


def _solved_into(
    directory: Path, case: Case, wanted: MeshOptions | None, formats: Sequence[str], inverted: bool
) -> Generator[Progress, None, Results]:
    from crossview.export.report import write_files

    results: Results = []
    if wanted is not None:
        require_closing(case.singularities)
    solutions = yield from solve_case(case, wanted is not None)
    for number, solution in enumerate(solutions):
        if wanted is None:
            results.append((solution, (yield from layout_soon(solution)), None))
        else:
            with of_component(number if len(solutions) > 1 else None):
                results.append((yield from quads_of(solution, wanted)))
    yield Progress("checking the quads", 0.8)
    spoiled = [] if inverted else _spoiled(results)
    yield Progress("writing", 0.9)
    for number, (solution, layout, made) in enumerate(results):
        one_of_many = case.options.component == "all"
        folder = directory / f"component-{number}" if one_of_many else directory
        folder.mkdir(exist_ok=True)
        kinds = () if number in spoiled else formats
        write_files(solution, folder, layout, made, kinds, inverted)
    return results
