"""The cases that come with the project, and the one way to name a case."""

from __future__ import annotations

import os
from importlib.resources import files
from pathlib import Path

from crossview.cases.json_values import nearest
from crossview.cases.model import Case, CaseError
from crossview.cases.pictured import FIGURES, Pictured
from solvers.primitives import BUILTIN


def names() -> tuple[str, ...]:
    """Names of the gallery cases, in alphabetical order."""
    folder = Path(str(files("crossview.resources") / "gallery"))
    return tuple(sorted(path.stem for path in folder.glob("*.json")))


def path_of(name: str) -> Path:
    """File of the gallery case `name`.

    Raises
    ------
    CaseError
        There is no such case.
    """
    if name not in names():
        raise CaseError(f'no gallery case "{name}"', "", nearest(name, names()))
    return Path(str(files("crossview.resources") / "gallery" / f"{name}.json"))


def find_case(target: str) -> Case:
    """The case that `target` names.

    Parameters
    ----------
    target : str
        A case file, a figure of one, a surface file (a case without singularities), or the name
        of a gallery case or of a built-in surface.

    Raises
    ------
    CaseError
        There is no such thing, or the case file is wrong.
    """
    path = Path(target)
    if path.suffix.lower() == ".json":
        return Case.load(path)
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
