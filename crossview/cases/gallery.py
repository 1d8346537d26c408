"""The cases that come with the project, and the one way to name a case."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

from crossview.cases.json_values import nearest
from crossview.cases.model import Case, CaseError
from crossview.cases.pictured import FIGURES, Pictured
from crossview.cases.project import PROJECT, Project
from solvers.primitives import BUILTIN

RESOURCES = Path(str(files("crossview.resources")))
"""Where the gallery is: the table ``gallery.json``, cases and their pictures."""


@dataclass(frozen=True)
class Exhibit:
    """What the table of the gallery tells of a case.

    Parameters
    ----------
    case : str
        Its name.
    group : str
        Title of the group that it is shown in.
    sentence : str
        What it shows.
    expect : mapping of str to object
        Figures of its report and what they must be: a value, ``{"least": 0, "most": 1}``, or
        compared with another case ``{"below": name}`` and ``{"near": name, "within": 0.1}``.
    steps : sequence, optional
        From the case to what is shown, as those of a study.
    pictures : mapping of str to dict, optional
        By the names of their files, with options as of the step ``render`` of a study.
    """

    case: str
    group: str
    sentence: str
    expect: Mapping[str, Any]
    steps: Sequence[Any] = ("solve", {"quads": {"target_quads": 1500}})
    pictures: Mapping[str, dict[str, Any]] = field(
        default_factory=lambda: {"figure": {}, "quads": {}}
    )


@cache
def exhibits() -> tuple[Exhibit, ...]:
    """The gallery, in its order."""
    table = json.loads((RESOURCES / "gallery.json").read_text(encoding="utf-8"))
    found = []
    for group in table["groups"]:
        for told in group["cases"]:
            exhibit = Exhibit(group=group["title"], **told)
            meshed = table["with quads"] if "quads" in exhibit.pictures else {}
            expect = {**table["always"], **meshed, **exhibit.expect}
            found.append(Exhibit(group=group["title"], **{**told, "expect": expect}))
    return tuple(found)


def names() -> tuple[str, ...]:
    """Names of the gallery cases, in its order."""
    return tuple(exhibit.case for exhibit in exhibits())


def path_of(name: str) -> Path:
    """File of the gallery case `name`.

    Raises
    ------
    CaseError
        There is no such case.
    """
    if name not in names():
        raise CaseError(f'no gallery case "{name}"', "", nearest(name, names()))
    return RESOURCES / "gallery" / f"{name}.json"


def find_case(target: str) -> Case:
    """The case that `target` names.

    Parameters
    ----------
    target : str
        A case file, a project, a figure of one, a surface file (a case without singularities), or
        the name of a gallery case or of a built-in surface.

    Raises
    ------
    CaseError
        There is no such thing, or the case file is wrong.
    """
    path = Path(target)
    if path.suffix.lower() == ".json":
        return Case.load(path)
    if path.suffix.lower() == PROJECT:
        return Project.load(path).case
    if path.suffix.lower() in FIGURES and os.path.exists(path):
        return Pictured.load(path).case
    if os.path.exists(path):  # also of a name too long for one
        return Case(surface=target)
    if path.name != target or path.suffix:
        raise CaseError("no such file", target, "check its name and folder")
    if target in names():
        return Case.load(path_of(target))
    if target in BUILTIN:
        return Case.from_json({"surface": {"builtin": target}})
    advice = nearest(target, {*names(), *BUILTIN})
    raise CaseError("no such file, gallery case or built-in surface", target, advice)
