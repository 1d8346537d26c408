"""What the JSON of a case says, checked key by key."""

from __future__ import annotations

import inspect
import os
from dataclasses import fields
from pathlib import Path
from typing import Any

from crossview.case_parts import Builtin, Options, PlacedCorner, PlacedSingularity, check_method
from crossview.jsonfield import JsonField, nearest
from solvers.primitives import BUILTIN

MOST_REFINE = 10
"""Levels of refinement after which triangles at a singularity are a thousandth of the others."""


def read_case(root: JsonField, base: Path) -> dict[str, Any]:
    """The arguments of the `Case` at the root of a JSON document, its paths relative to `base`.

    Raises
    ------
    CaseError
        A value is wrong; names its place in the document.
    """
    members = root.object(["surface"], ["singularities", "corners", "method", "options", "title"])
    case: dict[str, Any] = {"surface": _surface(members["surface"], base)}
    if "singularities" in members:
        case["singularities"] = tuple(map(_singularity, members["singularities"].items()))
    if "corners" in members:
        case["corners"] = _corners(members["corners"])
    if "method" in members:
        case["method"] = check_method(members["method"].text(), members["method"].where)
    if "options" in members:
        case["options"] = _options(members["options"])
    if "title" in members:
        case["title"] = members["title"].text()
    return case


def _surface(entry: JsonField, base: Path) -> str | Builtin:
    """A file relative to `base`, else the name of a built-in, or a built-in with parameters."""
    if isinstance(entry.value, dict):
        members = entry.members()
        if "builtin" not in members:
            raise entry.error('the key "builtin" is missing')
        name = members.pop("builtin")
        return _builtin(name, members)
    path = base / entry.text()
    if entry.value in BUILTIN and not path.exists():
        return _builtin(entry, {})
    return os.path.normpath(path)


def _builtin(name: JsonField, parameters: dict[str, JsonField]) -> Builtin:
    """A known built-in with parameters that it has."""
    if name.text() not in BUILTIN:
        raise name.error(f'no built-in surface "{name.value}"', nearest(name.value, BUILTIN))
    known = inspect.signature(BUILTIN[name.value]).parameters
    for key, value in parameters.items():
        if key not in known:
            remedy = nearest(key, known)
            raise value.error(f'the built-in "{name.value}" has no parameter "{key}"', remedy)
    return Builtin(name.value, {key: value.value for key, value in parameters.items()})


def _singularity(entry: JsonField) -> PlacedSingularity:
    members = entry.object(["position", "valence"], ["locked"])
    return PlacedSingularity(
        members["position"].position(),
        members["valence"].integer("valence", least=1),
        "locked" in members and members["locked"].boolean(),
    )


def _corners(entry: JsonField) -> tuple[PlacedCorner, ...] | None:
    if isinstance(entry.value, str):
        if entry.value != "auto":
            raise entry.error(f'unknown corners "{entry.value}"', 'write "auto" or a list')
        return None
    corners = []
    for item in entry.items():
        members = item.object(["position", "index"], [])
        index = members["index"].integer("corner index", most=1)
        corners.append(PlacedCorner(members["position"].position(), index))
    return tuple(corners)


def _options(entry: JsonField) -> Options:
    members = entry.object([], [f.name for f in fields(Options)])
    options: dict[str, Any] = {}
    if (tolerance := members.get("tolerance_degrees")) is not None:
        options["tolerance_degrees"] = tolerance.number()
        if not 0 < options["tolerance_degrees"] <= 45:
            raise tolerance.error("the tolerance must be above 0 and at most 45 degrees")
    if (refine := members.get("refine")) is not None:
        options["refine"] = refine.integer("refine", least=0, most=MOST_REFINE)
    if (component := members.get("component")) is not None:
        options["component"] = _component(component)
    if (repair := members.get("repair")) is not None:
        options["repair"] = repair.boolean()
    return Options(**options)


def _component(entry: JsonField) -> int | str:
    if not isinstance(entry.value, str):
        return entry.integer("component", least=0)
    if entry.value not in ("largest", "all"):
        remedy = 'write "largest", "all" or a number (0 is the largest)'
        raise entry.error(f'unknown component "{entry.value}"', remedy)
    return entry.value
