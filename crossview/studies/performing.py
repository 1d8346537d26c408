"""One case through its steps, in the process that works on it."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

from crossview.cases.model import Case, Options
from crossview.export.meshes import write_mesh
from crossview.export.report import report, write_files
from crossview.studies.figures import figures
from crossview.studies.outcome import DONE, FAILED, OUT_OF_MEMORY, Outcome
from crossview.studies.parcels import with_files
from crossview.studies.plan import Task
from crossview.studies.steps import Natural, Plain, Quads, Render, Step
from crossview.workflow import configurations
from crossview.workflow.loading import load_surfaces
from crossview.workflow.pipeline import Pipeline
from crossview.workflow.problem import Problem, problems_on
from crossview.workflow.quads import quads_of
from crossview.workflow.solution import Solution
from solvers.errors import CrossviewError
from solvers.layouts import QuadLayout
from solvers.progress import run
from solvers.quads import QuadMesh
from solvers.repair import Repaired

FIGURE, CASE, REPORT = "figure.png", "case.json", "report.json"
"""Names of files that are kept."""


@dataclass
class State:
    """What there is of a case so far, and the folder of the pictures that are drawn of it."""

    folder: Path
    problem: Problem
    solution: Solution | None = None
    layout: QuadLayout | None = None
    quads: QuadMesh | None = None


def perform(
    task: Task,
    home: Path,
    places: Mapping[str, str],
    folder: Path,
    tell: Callable[[str], object],
) -> Outcome:
    """Take a case through its steps; whatever goes wrong is told in what is returned.

    Parameters
    ----------
    task : Task
        The case and its steps.
    home : Path
        Where its files will be kept in the end.
    places : mapping of str to str
        Where here each file is that the case names.
    folder : Path
        Empty, for what is kept.
    tell : callable
        Called with the name of each step as it begins.

    Returns
    -------
    Outcome
        With figures up to the step that failed, if one did.
    """
    begun, state = time.perf_counter(), None
    status, reason, at = DONE, "", ""

    def begin(step: str) -> None:
        nonlocal at
        at = step
        tell(step)

    try:
        begin("reading")
        case = with_files(task.case, places)
        state = State(folder, problems_on(case, _surfaces(case))[0])
        for step in task.steps:
            begin(step.name)
            take(state, step)
        begin("writing")
        _keep(state, task, home)
    except CrossviewError as error:
        status, reason = OUT_OF_MEMORY if _full(error) else FAILED, _told(error, places)
    except Exception as error:  # no case may harm another
        status = OUT_OF_MEMORY if _full(error) else FAILED
        reason = " ".join(f"unexpected {type(error).__name__}: {error}".split())
    return Outcome(
        status,
        reason,
        "" if status == DONE else at,
        time.perf_counter() - begun,
        {} if state is None else _figures(state, status == DONE and bool(_formats(task))),
        {} if status != DONE else _contents(folder),
    )


def _full(error: BaseException) -> bool:
    """Whether memory ran out; libraries have errors of their own for it."""
    if isinstance(error, MemoryError) or "insufficient memory" in str(error):
        return True
    return error.__cause__ is not None and _full(error.__cause__)


def _surfaces(case: Case) -> tuple[Repaired, ...]:
    """The surface of a case, one of the last few if it was read already."""
    options = Options(component=case.options.component, repair=case.options.repair)
    bare = Case(case.surface, options=options)
    return _loaded(json.dumps(bare.to_json(), sort_keys=True))


@lru_cache(maxsize=2)
def _loaded(text: str) -> tuple[Repaired, ...]:
    return load_surfaces(Case.from_json(json.loads(text)))


def _natural(state: State, options: Natural) -> None:
    state.problem = run(
        configurations.natural(
            state.problem,
            options.method,
            options.seed,
            alignment=options.alignment,
            weight=options.weight,
            most_valence=options.most_valence,
            fewest=options.fewest,
            most=options.most,
            scale=options.scale,
        )
    )


def _complete(state: State, options: Plain) -> None:
    state.problem = run(configurations.complete(state.problem))


def _make_valid(state: State, options: Plain) -> None:
    state.problem = run(configurations.make_valid(state.problem))[0]


def _improve(state: State, options: Plain) -> None:
    state.problem = run(configurations.improve(state.problem))[0]


def _solve(state: State, options: Plain) -> None:
    state.solution = run(Pipeline().solve(state.problem))


def _quads(state: State, options: Quads) -> None:
    made = quads_of(_solved(state), options.mesh_options)
    state.solution, state.layout, state.quads = run(made)


def _render(state: State, options: Render) -> None:
    from crossview.export.figures import render  # VTK is loaded when it is wanted

    render(
        _solved(state),
        state.folder / FIGURE,
        layers=options.layers,
        size=options.size,
        camera=options.camera,
        layout=state.layout,
        quads=state.quads,
    )


TAKE: dict[str, Callable[[State, Any], None]] = {
    "natural": _natural,
    "complete": _complete,
    "make-valid": _make_valid,
    "improve": _improve,
    "solve": _solve,
    "quads": _quads,
    "render": _render,
}
"""What does each step."""


def take(state: State, step: Step) -> None:
    """Take one step, which changes the state.

    Parameters
    ----------
    state : State
    step : Step

    Raises
    ------
    CrossviewError
        As the step's verb.
    """
    TAKE[step.name](state, step.options)


def _solved(state: State) -> Solution:
    if state.solution is None:
        raise CrossviewError("nothing is solved yet", "", 'take the step "solve" before')
    return state.solution


def _figures(state: State, delivered: bool) -> dict[str, Any]:
    """What is known of a case: all of the report once it is solved."""
    if state.solution is None:
        placed = state.problem.singularities
        return {"method": state.problem.method, "singularities.count": len(placed)}
    return figures(report(state.solution, state.layout, state.quads, delivered))


def _keep(state: State, task: Task, home: Path) -> None:
    """Write the files that are kept, but for the picture, which is written when it is drawn."""
    kept, solution = task.files, state.solution
    if "case" in kept:
        made = state.problem.to_case(task.case.surface, task.case.title)
        data = replace(made, options=task.case.options).to_json(home)
        (state.folder / CASE).write_text(
            json.dumps(data, indent=2, ensure_ascii=False) + "\n", "utf-8"
        )
    if solution is None:
        return
    formats = _formats(task)
    options = [step.options for step in task.steps if isinstance(step.options, Quads)]
    inverted = any(of_quads.allow_inverted for of_quads in options)
    if "fields" in kept:
        write_files(solution, state.folder, state.layout, state.quads, formats, inverted)
    elif state.quads is not None:
        for suffix in formats:
            write_mesh(state.quads, state.folder / f"quads.{suffix}", allow_inverted=inverted)
    if "report" in kept and "fields" not in kept:
        told = report(solution, state.layout, state.quads, bool(formats))
        _write_json(state.folder / REPORT, told)


def _formats(task: Task) -> list[str]:
    """The formats that quads are kept in."""
    return [name for name in task.files if name not in ("case", "report", "fields")]


def _write_json(path: Path, data: Any) -> None:
    path.write_text(json.dumps(data, indent=2, ensure_ascii=False) + "\n", "utf-8")


def _told(error: CrossviewError, places: Mapping[str, str]) -> str:
    """What is wrong, without the folders that files were unpacked to."""
    line = str(error)
    for place in places.values():
        line = line.replace(f"{Path(place).parent}/", "")
    return line


def _contents(folder: Path) -> dict[str, bytes]:
    """The files in a folder by name."""
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir())}
