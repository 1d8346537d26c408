"""A case: surface, singularities and options, as a JSON file. All tools start from one."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from crossview.cases.compounds import Either, ListOf
from crossview.cases.json_values import CaseError, JsonField, read_json
from crossview.cases.parts import (
    METHODS,
    Options,
    PlacedCorner,
    PlacedFeatures,
    PlacedSingularity,
    Position,
    Sizes,
    check_method,
)
from crossview.cases.records import Record, documented, key
from crossview.cases.scalars import Text, Word
from crossview.cases.surfaces import Builtin, SurfaceName
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


@documented
@dataclass(frozen=True)
class Case:
    """A surface with imposed singularities, and how to solve it."""

    title: str = field(
        default="", kw_only=True, metadata=key(Text(), "One line on what the case shows.")
    )
    surface: str | Builtin = field(
        metadata=key(
            SurfaceName(),
            "A file, relative to the case file; or one built in, with other parameters than its "
            "own if they are given.",
        )
    )
    singularities: tuple[PlacedSingularity, ...] = field(
        default=(),
        metadata=key(
            ListOf(Record(PlacedSingularity)), "The irregular points of the field.", always=True
        ),
    )
    corners: tuple[PlacedCorner, ...] | None = field(
        default=None,
        metadata=key(
            Either((Word({"auto": None}), ListOf(Record(PlacedCorner)))),
            'Where the boundary turns; "auto": from its angles.',
            always=True,
        ),
    )
    features: PlacedFeatures = field(
        default_factory=PlacedFeatures,
        kw_only=True,
        metadata=key(Record(PlacedFeatures), "Edges inside the surface that crosses follow."),
    )
    method: str = field(
        default=METHODS[0],
        metadata=key(Word({name: name for name in METHODS}), "How it is solved.", always=True),
    )
    options: Options = field(
        default_factory=Options,
        metadata=key(Record(Options), "What may be tuned.", always=True),
    )

    @classmethod
    def load(cls, path: str | Path) -> Case:
        """Read a case file.

        Raises
        ------
        CaseError
            The file or a value in it is wrong; one line with the location in the file.
        """
        path = Path(path)
        return cls._read(read_json(path), path.parent)

    @classmethod
    def from_json(cls, data: Mapping[str, Any], base: str | Path = ".") -> Case:
        """The case that the parsed JSON `data` describes, its paths relative to `base`."""
        return cls._read(JsonField(data, "case"), Path(base))

    @classmethod
    def _read(cls, root: JsonField, base: Path) -> Case:
        case: Case = Record(cls).read(root, base)
        return case

    def to_json(self, base: str | Path = ".") -> dict[str, Any]:
        """As JSON values; a surface file is named relative to the folder `base`."""
        return Record(Case).write(self, Path(base))

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
