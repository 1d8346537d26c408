"""A case: surface, singularities and options, as a JSON file. All tools start from one."""

from __future__ import annotations

import inspect
import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

from crossview.jsonfield import CaseError, JsonField, nearest, read_json
from crossview.staging import staged
from solvers.primitives import BUILTIN

METHODS = ("isotropic",)
MOST_REFINE = 10

__all__ = [
    "METHODS",
    "Builtin",
    "Case",
    "CaseError",
    "Options",
    "PlacedCorner",
    "PlacedSingularity",
    "check_method",
]

Position = tuple[float, float, float]


@dataclass(frozen=True)
class Builtin:
    """A surface made by the function `name` of ``solvers.primitives.BUILTIN``."""

    name: str
    parameters: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class PlacedSingularity:
    """A singularity given by a point of space, to be projected to the surface."""

    position: Position
    valence: int
    locked: bool = False


@dataclass(frozen=True)
class PlacedCorner:
    """A boundary vertex given by a point of space; index = 2 - quads meeting there."""

    position: Position
    index: int


@dataclass(frozen=True)
class Options:
    """What may be tuned.

    Attributes
    ----------
    tolerance_degrees : float
        Largest holonomy defect of a configuration called valid, degrees.
    refine : int
        Levels of graded refinement around each singularity; 0 only inserts it as a vertex.
    component : int, str or None
        Of a surface in several pieces: "largest", a number (0 is the largest) or "all";
        None refuses such a surface.
    repair : bool
        Also make repairs that change the surface: drop degenerate and duplicate triangles, cut
        non-manifold edges and vertices apart.
    """

    tolerance_degrees: float = 0.01
    refine: int = 3
    component: int | str | None = None
    repair: bool = False


@dataclass(frozen=True)
class Case:
    """A surface with imposed singularities, and how to solve it.

    Attributes
    ----------
    surface : str or Builtin
        Path of a surface file (absolute, or relative to the working directory), or a built-in.
    singularities : tuple of PlacedSingularity
    corners : tuple of PlacedCorner, or None
        None: chosen from the boundary's interior angles ("auto").
    method : str
        One of `METHODS`.
    options : Options
    title : str
        One line on what the case shows.
    """

    surface: str | Builtin
    singularities: tuple[PlacedSingularity, ...] = ()
    corners: tuple[PlacedCorner, ...] | None = None
    method: str = METHODS[0]
    options: Options = Options()
    title: str = ""

    @classmethod
    def load(cls, path: str | Path) -> Case:
        """Read a case file.

        Raises
        ------
        CaseError
            The file or a value in it is wrong; one line with the location in the file.
        """
        path = Path(path)
        return _case(read_json(path), path.parent)

    @classmethod
    def from_json(cls, data: Mapping[str, Any], base: str | Path = ".") -> Case:
        """The case that the parsed JSON `data` describes, its paths relative to `base`."""
        return _case(JsonField(data, "case"), Path(base))

    def to_json(self, base: str | Path = ".") -> dict[str, Any]:
        """As JSON values; a surface file is named relative to the folder `base`."""
        data: dict[str, Any] = {"title": self.title} if self.title else {}
        if isinstance(self.surface, Builtin):
            data["surface"] = {"builtin": self.surface.name, **self.surface.parameters}
        else:
            data["surface"] = _relative(self.surface, Path(base))
        data["singularities"] = [
            {"position": list(s.position), "valence": s.valence}
            | ({"locked": True} if s.locked else {})
            for s in self.singularities
        ]
        data["corners"] = (
            "auto"
            if self.corners is None
            else [{"position": list(c.position), "index": c.index} for c in self.corners]
        )
        data["method"] = self.method
        default = Options()
        data["options"] = {
            f.name: getattr(self.options, f.name)
            for f in fields(Options)
            if getattr(self.options, f.name) != getattr(default, f.name)
        }
        return data

    def save(self, path: str | Path) -> None:
        """Write the case file whole or not at all.

        Raises
        ------
        CrossviewError
            The file cannot be written.
        """
        path = Path(path)
        text = json.dumps(self.to_json(path.parent), indent=2, ensure_ascii=False) + "\n"
        with staged(path.parent) as staging:
            (staging / path.name).write_text(text, encoding="utf-8")


def check_method(name: str, where: str) -> str:
    """The method `name` if it is available.

    Raises
    ------
    CaseError
        It is not; the message lists those that are.
    """
    if name not in METHODS:
        raise CaseError(
            f'the method "{name}" is not available', where, "available: " + ", ".join(METHODS)
        )
    return name


def _case(root: JsonField, base: Path) -> Case:
    """The case at the root of a JSON document."""
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
    return Case(**case)


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


def _relative(surface: str, base: Path) -> str:
    """`surface` as named from the folder `base`, with forward slashes."""
    try:
        return Path(os.path.relpath(surface, base)).as_posix()
    except ValueError:  # another drive: there is no relative path
        return Path(surface).absolute().as_posix()
