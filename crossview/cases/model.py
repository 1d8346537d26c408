"""A case: surface, singularities and options, as a JSON file. All tools start from one."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

from crossview.cases.json_values import CaseError, JsonField, read_json
from crossview.cases.parts import (
    METHODS,
    Builtin,
    Options,
    PlacedCorner,
    PlacedFeatures,
    PlacedSingularity,
    Position,
    Sizes,
    check_method,
)
from crossview.cases.reading import read_case
from crossview.io.staged_files import staged

__all__ = [
    "METHODS",
    "Builtin",
    "Case",
    "CaseError",
    "Options",
    "PlacedCorner",
    "PlacedFeatures",
    "PlacedSingularity",
    "Position",
    "Sizes",
    "check_method",
]


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
    features : PlacedFeatures
    """

    surface: str | Builtin
    singularities: tuple[PlacedSingularity, ...] = ()
    corners: tuple[PlacedCorner, ...] | None = None
    method: str = METHODS[0]
    options: Options = field(default_factory=Options)
    title: str = ""
    features: PlacedFeatures = field(default_factory=PlacedFeatures)

    @classmethod
    def load(cls, path: str | Path) -> Case:
        """Read a case file.

        Raises
        ------
        CaseError
            The file or a value in it is wrong; one line with the location in the file.
        """
        path = Path(path)
        return cls(**read_case(read_json(path), path.parent))

    @classmethod
    def from_json(cls, data: Mapping[str, Any], base: str | Path = ".") -> Case:
        """The case that the parsed JSON `data` describes, its paths relative to `base`."""
        return cls(**read_case(JsonField(data, "case"), Path(base)))

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
        if self.features != PlacedFeatures():
            data["features"] = _features_to_json(self.features)
        data["method"] = self.method
        default = Options()
        data["options"] = {
            f.name: getattr(self.options, f.name)
            for f in fields(Options)
            if getattr(self.options, f.name) != getattr(default, f.name)
        }
        if isinstance(self.options.sizes, str):
            data["options"]["sizes"] = _relative(self.options.sizes, Path(base))
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


def _features_to_json(features: PlacedFeatures) -> dict[str, Any]:
    data: dict[str, Any] = {}
    if features.dihedral_degrees is not None:
        data["dihedral_degrees"] = features.dihedral_degrees
    for key, lines in (("curves", features.curves), ("without", features.without)):
        if lines:
            data[key] = [[list(point) for point in line] for line in lines]
    return data


def _relative(file: str, base: Path) -> str:
    """`file` as named from the folder `base`, with forward slashes."""
    try:
        return Path(os.path.relpath(file, base)).as_posix()
    except ValueError:  # another drive: there is no relative path
        return Path(file).absolute().as_posix()
