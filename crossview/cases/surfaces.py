"""The surface of a case: a file, or one built in with parameters."""

from __future__ import annotations

import inspect
import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from crossview.cases.json_values import JsonField, nearest
from crossview.cases.scalars import Text, relative
from crossview.cases.shape import Shape
from solvers.primitives import BUILTIN


@dataclass(frozen=True)
class Builtin:
    """A surface made by the function `name` of ``solvers.primitives.BUILTIN``."""

    name: str
    parameters: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class SurfaceName(Shape):
    """A surface file relative to the case, else the name of a built-in, alone or with parameters.

    Whether the values of parameters make sense is left to the function that makes the surface.
    """

    @property
    def words(self) -> str:
        """What it takes, with its article."""
        return 'a file, a built-in or {"builtin": name, parameter: value, ...}'

    def fits(self, value: object) -> bool:
        """Whether it is a string or an object."""
        return isinstance(value, str | dict)

    def holds(self, value: object) -> bool:
        """Whether it is a path or a built-in."""
        return isinstance(value, str | Builtin)

    def read(self, entry: JsonField, base: Path) -> str | Builtin:
        """Return the path, or the built-in."""
        if isinstance(entry.value, dict):
            members = entry.members()
            if "builtin" not in members:
                raise entry.error('the key "builtin" is missing')
            return _builtin(members.pop("builtin"), members)
        path = base / Text().read(entry, base)
        if entry.value in BUILTIN and not os.path.exists(path):
            return Builtin(entry.value)
        return os.path.normpath(path)

    def write(self, value: str | Builtin, base: Path) -> str | dict[str, Any]:
        """Return the path as named from `base`, or the built-in with its parameters."""
        if isinstance(value, Builtin):
            return {"builtin": value.name, **value.parameters}
        return relative(value, base)

    def schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        return {"anyOf": [Text().schema(), *map(_builtin_schema, BUILTIN)]}


def _builtin(name: JsonField, parameters: dict[str, JsonField]) -> Builtin:
    """A known built-in with parameters that it has."""
    if Text().read(name, Path()) not in BUILTIN:
        raise name.error(f'no built-in surface "{name.value}"', nearest(name.value, BUILTIN))
    known = inspect.signature(BUILTIN[name.value]).parameters
    for key, value in parameters.items():
        if key not in known:
            advice = nearest(key, known)
            raise value.error(f'the built-in "{name.value}" has no parameter "{key}"', advice)
    return Builtin(name.value, {key: value.value for key, value in parameters.items()})


def _builtin_schema(name: str) -> dict[str, Any]:
    parameters = inspect.signature(BUILTIN[name]).parameters
    defaults = {key: parameter.default for key, parameter in parameters.items()}
    as_json = json.loads(json.dumps(defaults))  # points are lists there
    properties = {key: {"default": value} for key, value in as_json.items()}
    return {
        "type": "object",
        "properties": {"builtin": {"const": name}, **properties},
        "required": ["builtin"],
        "additionalProperties": False,
    }
