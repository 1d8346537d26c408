"""The gallery performed: each case through its steps, drawn, and held against what is expected."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from crossview.cases.gallery import Exhibit, exhibits, path_of
from crossview.cases.json_values import JsonField
from crossview.cases.model import Case
from crossview.cases.pictured import Pictured
from crossview.cases.records import Record
from crossview.export.figures import render
from crossview.export.quads_report import quads_summary
from crossview.export.report import report, summary, write_files
from crossview.io.staged_files import staged
from crossview.studies.expectations import Check, checks, compared_with
from crossview.studies.figures import figures
from crossview.studies.performing import CASE, State, take
from crossview.studies.steps import Render, StepShape
from crossview.workflow.problem import Problem
from solvers.progress import Progress

QUAD_LAYERS = ("quads", "singularities", "boundary", "legend", "axes")
"""Layers of a picture of quads, if it names none."""

FINE = 2.0
"""Pixels for each of a picture's size. Chosen."""

FORMATS = (".png", ".pdf")
"""That each picture is written in."""


@dataclass(frozen=True, eq=False)
class Exhibited:
    """A case of the gallery, solved and drawn.

    Parameters
    ----------
    exhibit : Exhibit
        What is told and expected of it.
    title : str
    lines : tuple of str
        What the field, and the quads if there are any, say of themselves.
    figures : mapping of str to object
        Of its report, by name.
    checks : tuple of Check
    """

    exhibit: Exhibit
    title: str
    lines: tuple[str, ...]
    figures: Mapping[str, Any]
    checks: tuple[Check, ...]

    @property
    def passed(self) -> bool:
        """Whether all is as expected."""
        return all(check.passed for check in self.checks)


def exhibition(
    names: Iterable[str], folder: Path
) -> Generator[Progress, None, tuple[Exhibited, ...]]:
    """Solve, draw and check cases of the gallery, each into a folder of its own.

    Parameters
    ----------
    names : iterable of str
        Of cases; those that they are compared with are shown, too.
    folder : Path
        A folder for each case is made in it, whole or not at all: its report, fields and quads,
        the case as it was solved, and its pictures as PNG and PDF.

    Returns
    -------
    tuple of Exhibited
        In the order of the gallery.

    Raises
    ------
    CrossviewError
        A case cannot be solved or written.
    """
    wanted = set(names)
    every = {exhibit.case: exhibit for exhibit in exhibits()}
    wanted |= {other for name in wanted for other in compared_with(every[name].expect)}
    shown = [exhibit for exhibit in exhibits() if exhibit.case in wanted]
    lines: dict[str, tuple[str, ...]] = {}
    found: dict[str, dict[str, Any]] = {}
    for number, exhibit in enumerate(shown):
        name = exhibit.case
        with staged(folder / name) as staging:
            yield Progress(f"solving {name}", number / len(shown))
            state = performed(exhibit, staging)
            yield Progress(f"drawing {name}", (number + 0.5) / len(shown))
            lines[name], found[name] = _kept(exhibit, state)
    return tuple(
        Exhibited(
            exhibit,
            _title(exhibit),
            lines[exhibit.case],
            found[exhibit.case],
            tuple(checks(exhibit.expect, found[exhibit.case], found)),
        )
        for exhibit in shown
    )


def _title(exhibit: Exhibit) -> str:
    return Case.load(path_of(exhibit.case)).title


def performed(exhibit: Exhibit, folder: Path) -> State:
    """Take a case through its steps.

    Parameters
    ----------
    exhibit : Exhibit
    folder : Path
        For pictures, if a step draws some.

    Raises
    ------
    CrossviewError
        A step fails.
    """
    state = State(folder, Problem.from_case(Case.load(path_of(exhibit.case))))
    for step in exhibit.steps:
        take(state, StepShape().read(JsonField(step, exhibit.case), folder))
    return state


def _kept(exhibit: Exhibit, state: State) -> tuple[tuple[str, ...], dict[str, Any]]:
    """Write and draw what was made of a case; return its lines and its figures."""
    solution, source = state.solution, state.problem.source
    if solution is None or source is None:
        raise ValueError(f"the steps of {exhibit.case} do not solve it")
    case = state.problem.to_case(source, _title(exhibit))
    write_files(solution, state.folder, state.layout, state.quads)
    case.save(state.folder / CASE)
    for name, options in exhibit.pictures.items():
        how: Render = Record(Render).read(JsonField(options, exhibit.case), state.folder)
        layers = QUAD_LAYERS if name == "quads" and how.layers is None else how.layers
        for suffix in FORMATS:
            render(
                solution,
                state.folder / f"{name}{suffix}",
                layers=layers,
                size=how.size,
                scale=FINE,
                camera=how.camera,
                layout=state.layout,
                quads=state.quads,
                about=Pictured(case, how.camera).words(state.folder),
            )
    lines = [summary(solution)]
    if state.layout is not None and state.quads is not None:
        lines.append(quads_summary(solution, state.layout, state.quads))
    return tuple(lines), figures(report(solution, state.layout, state.quads))
