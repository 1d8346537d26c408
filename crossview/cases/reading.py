"""What the JSON of a case says, checked key by key."""

from __future__ import annotations

import inspect
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

from crossview.cases.json_values import JsonField, nearest
from crossview.cases.parts import (
    Builtin,
    Options,
    PlacedCorner,
    PlacedFeatures,
    PlacedSingularity,
    Polyline,
    Sizes,
    check_method,
)
from solvers.primitives import BUILTIN

MOST_REFINE = 10
"""Levels of refinement after which triangles at a singularity are a thousandth of the others."""

OPTIONAL = ("singularities", "corners", "features", "method", "options", "title")

MOST_VALENCE = 100
"""Quads that meet in one vertex; more is a slip of the pen."""


def read_case(root: JsonField, base: Path) -> dict[str, Any]:
    """The arguments of the `Case` at the root of a JSON document, its paths relative to `base`.

    Raises
    ------
    CaseError
        A value is wrong; names its place in the document.
    """
    members = root.object(["surface"], OPTIONAL)
    case: dict[str, Any] = {"surface": _surface(members["surface"], base)}
    if "singularities" in members:
        case["singularities"] = tuple(map(_singularity, members["singularities"].items()))
    if "corners" in members:
        case["corners"] = _corners(members["corners"])
    if "features" in members:
        case["features"] = _features(members["features"])
    if "method" in members:
        case["method"] = check_method(members["method"].text(), members["method"].where)
    if "options" in members:
        case["options"] = _options(members["options"], base)
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
            advice = nearest(key, known)
            raise value.error(f'the built-in "{name.value}" has no parameter "{key}"', advice)
    return Builtin(name.value, {key: value.value for key, value in parameters.items()})


def _singularity(entry: JsonField) -> PlacedSingularity:
    members = entry.object(["position", "valence"], ["locked"])
    return PlacedSingularity(
        members["position"].position(),
        members["valence"].integer("valence", 1, MOST_VALENCE),
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
        index = members["index"].integer("corner index", 2 - MOST_VALENCE, 1)
        corners.append(PlacedCorner(members["position"].position(), index))
    return tuple(corners)


def _features(entry: JsonField) -> PlacedFeatures:
    members = entry.object([], ["dihedral_degrees", "curves", "without"])
    degrees = None
    if "dihedral_degrees" in members:
        degrees = members["dihedral_degrees"].number()
        if not 0 < degrees <= 180:
            raise members["dihedral_degrees"].error("the angle must be above 0 and at most 180")
    curves, without = (
        tuple(map(_polyline, members[key].items())) if key in members else ()
        for key in ("curves", "without")
    )
    return PlacedFeatures(degrees, curves, without)


def _polyline(entry: JsonField) -> Polyline:
    points = tuple(item.position() for item in entry.items())
    if len(points) < 2:
        raise entry.error("a curve needs at least two points")
    return points


def _options(entry: JsonField, base: Path) -> Options:
    read: dict[str, Callable[[JsonField], object]] = {
        "tolerance_degrees": _tolerance,
        "refine": lambda given: given.integer("refine", least=0, most=MOST_REFINE),
        "component": _component,
        "repair": JsonField.boolean,
        "turns": lambda given: tuple(turn.integer("each turn") for turn in given.items()),
        "proximal_weight": _weight,
        "sizes": lambda given: _sizes(given, base),
        "verify": JsonField.boolean,
    }
    members = entry.object([], read)
    values: dict[str, Any] = {name: read[name](given) for name, given in members.items()}
    return Options(**values)


def _tolerance(entry: JsonField) -> float:
    tolerance = entry.number()
    if not 0 < tolerance <= 45:
        raise entry.error("the tolerance must be above 0 and at most 45 degrees")
    return tolerance


def _weight(entry: JsonField) -> float:
    weight = entry.number()
    if weight <= 0:
        raise entry.error("the proximal weight must be above 0")
    return weight


def _component(entry: JsonField) -> int | str:
    if not isinstance(entry.value, str):
        return entry.integer("component", least=0)
    if entry.value not in ("largest", "all"):
        advice = 'write "largest", "all" or a number (0 is the largest)'
        raise entry.error(f'unknown component "{entry.value}"', advice)
    return entry.value


def _sizes(entry: JsonField, base: Path) -> Sizes:
    """A file relative to `base`, or sizes or pairs of sizes, all positive."""
    if isinstance(entry.value, str):
        path = base / entry.text()
        if path.suffix.lower() not in (".npy", ".txt"):
            raise entry.error("a size map is a .npy or a .txt file")
        return os.path.normpath(path)
    items = entry.items()
    if any(isinstance(item.value, list) for item in items):
        return tuple((_size(a), _size(b)) for a, b in (item.items(2) for item in items))
    return tuple(_size(item) for item in items)


def _size(entry: JsonField) -> float:
    size = entry.number()
    if size <= 0:
        raise entry.error("a size must be above 0")
    return size
