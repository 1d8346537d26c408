"""From a study to its cases: what is found by patterns, varied, and known by its contents."""

from __future__ import annotations

import copy
import glob
import hashlib
import itertools
import json
import math
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from crossview.cases.gallery import find_case
from crossview.cases.json_values import CaseError
from crossview.cases.model import Case
from crossview.studies.parcels import digest, with_files
from crossview.studies.places import of_a_step, put, with_option
from crossview.studies.steps import Step, StepShape
from crossview.studies.study import Source, Study
from crossview.studies.variation import ANYWHERE, MOST_CASES, Spread, generator
from crossview.workflow.loading import load_surfaces
from solvers.errors import CrossviewError
from solvers.surface import TriSurface


@dataclass(frozen=True)
class Task:
    """One case of a study with all that is done to it.

    Parameters
    ----------
    name : str
        Where the case came from.
    varied : mapping of str to object
        What was put at each varied place.
    key : str
        What the result depends on, as a hash: the case, the contents of its files, the steps, the
        files kept and the version.
    case : Case
    steps : tuple of Step
    files : tuple of str
        What is kept of it.
    """

    name: str
    varied: Mapping[str, Any]
    key: str
    case: Case
    steps: tuple[Step, ...]
    files: tuple[str, ...]


@dataclass(frozen=True)
class Refusal:
    """A case of a study that cannot be begun.

    Parameters
    ----------
    name : str
        Where it came from.
    varied : mapping of str to object
        What was put at varied places.
    reason : str
        What is wrong with it, in one line.
    """

    name: str
    varied: Mapping[str, Any]
    reason: str


def plan(study: Study) -> list[Task | Refusal]:
    """Return the cases of a study, in the order of its sources, samples and combinations.

    Parameters
    ----------
    study : Study
        What is wanted.

    Raises
    ------
    CrossviewError
        There are too many cases, or none of them can be understood; tells why the first cannot.
    """
    opened = [found for source in study.cases for found in _opened(source)]
    axes = {place: values for place, values in map(_axis, study.vary.items()) if values}
    number = len(opened) * study.samples * math.prod(map(len, axes.values()))
    if number > MOST_CASES:
        raise CaseError(f"{number:,} cases are too many", "", f"at most {MOST_CASES:,} are run")
    if study.samples > 1 and len(axes) == len(study.vary):
        raise CaseError(
            "there are samples, but nothing is drawn at random",
            "samples",
            "vary something without a count",
        )
    tasks = [
        _task(study, name, start, dict(zip(axes, values, strict=True)), sample)
        for name, start in opened
        for sample in range(study.samples)
        for values in itertools.product(*axes.values())
    ]
    reasons = [task.reason for task in tasks if isinstance(task, Refusal)]
    if len(reasons) == len(tasks):
        raise CrossviewError("no case of the study can be begun", "", reasons[0])
    return tasks


@dataclass(frozen=True)
class _Start:
    """A case as JSON before anything varies, or why it cannot be read."""

    data: dict[str, Any] = field(default_factory=dict)
    base: Path = Path()
    reason: str = ""


def _opened(source: Source) -> Iterator[tuple[str, _Start]]:
    """The cases that a source names, each with its name."""
    if isinstance(source.given, dict):
        yield str(source.given.get("title", "case")), _Start(source.given, source.base)
        return
    path = os.path.normpath(source.base / source.given)
    if os.path.exists(path):
        named = [path]
    elif glob.has_magic(source.given):
        named = sorted(glob.glob(path, recursive=True))
        if not named:
            raise CaseError("no file fits the pattern", path, "check its folder and ending")
    else:
        named = [path if Path(source.given).suffix else source.given]
    for name in named:
        told = os.path.relpath(name, source.base) if os.path.isabs(name) else name
        try:
            yield told, _Start(find_case(name).to_json(source.base), source.base)
        except CrossviewError as error:
            yield told, _Start(reason=str(error))


def _axis(item: tuple[str, Any]) -> tuple[str, Sequence[Any]]:
    """A place and the values that it takes in turn; none if they are drawn."""
    place, values = item
    match values:
        case tuple():
            return place, values
        case Spread(count=int(count)):
            return place, values.spaced(count)
        case _:
            return place, ()


def _task(
    study: Study, name: str, start: _Start, chosen: dict[str, Any], sample: int
) -> Task | Refusal:
    """A case with its variation, or what is wrong with it."""
    drawn = {place: values for place, values in study.vary.items() if place not in chosen}
    draws = {place: generator(study.seed, sample, place) for place in drawn}
    varied = chosen | {
        place: values.drawn(draws[place])
        for place, values in drawn.items()
        if isinstance(values, Spread)
    }
    anywhere = [place for place, values in drawn.items() if values == ANYWHERE]
    if start.reason:
        return Refusal(name, varied, start.reason)
    try:
        # a point of the surface is drawn when all else is known of the case
        case, steps = _varied(study, start, varied | {place: [0.0] * 3 for place in anywhere})
        if anywhere:
            surface = _surface_of(case)
            varied |= {place: _random_point(surface, draws[place]) for place in anywhere}
            case, steps = _varied(study, start, varied)
        if case.options.component == "all":
            raise CaseError("a case of a study has one component", "options.component")
        return Task(name, varied, _key(case, steps, study.files), case, steps, study.files)
    except CrossviewError as error:
        return Refusal(name, varied, str(error))


def _varied(
    study: Study, start: _Start, varied: Mapping[str, Any]
) -> tuple[Case, tuple[Step, ...]]:
    """A case and the steps with the values of a variation."""
    steps, data = study.steps, copy.deepcopy(start.data)
    for place, value in varied.items():
        if of_a_step(place):
            steps = with_option(steps, place, value)
        else:
            put(data, place, copy.deepcopy(value))
    return Case.from_json(data, start.base), steps


def _key(case: Case, steps: tuple[Step, ...], files: tuple[str, ...]) -> str:
    """What the result depends on, as 32 hexadecimal digits."""
    named = {file: digest(file) for file in case.files}
    data = {
        "version": version("crossview"),
        "case": with_files(case, named).to_json() | {"title": ""},
        "steps": [StepShape().write(step, Path()) for step in steps],
        "files": sorted(files),
    }
    return hashlib.sha256(json.dumps(data, sort_keys=True).encode()).hexdigest()[:32]


def _surface_of(case: Case) -> TriSurface:
    """The surface of a case, one of the last few if it was made already."""
    options = {"component": case.options.component, "repair": case.options.repair}
    chosen = {name: value for name, value in options.items() if value is not None}
    return _loaded(json.dumps({"surface": case.to_json()["surface"], "options": chosen}))


@lru_cache(maxsize=8)
def _loaded(text: str) -> TriSurface:
    return load_surfaces(Case.from_json(json.loads(text)))[0].surface


def _random_point(surface: TriSurface, draws: np.random.Generator) -> list[float]:
    """A point of a surface, each as likely as any other by area."""
    reached = np.cumsum(surface.face_areas)
    face = int(np.searchsorted(reached, draws.uniform(0, reached[-1]), side="right"))
    corners = surface.vertices[surface.faces[min(face, surface.n_faces - 1)]]
    root, along = np.sqrt(draws.uniform()), draws.uniform()
    weights = np.array([1 - root, root * (1 - along), root * along])
    return (weights @ corners).tolist()  # type: ignore[no-any-return]
