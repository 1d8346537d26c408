"""A case: surface, singularities and options, as a JSON file. All tools start from one."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
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
from crossview.cases.records import Record, checked, documented, key
from crossview.cases.scalars import Number, Text, Word
from crossview.cases.surfaces import Builtin, SurfaceName
from crossview.io.staged_files import staged_file
from solvers.kind_checks import all_of_kind, one_of_kind
from solvers.singularities import Connections, checked_connections

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
    """A surface with imposed singularities, and how to solve it.

    Examples
    --------
    >>> from crossview import Case
    >>> corner = {"position": [0.4, 0, 0], "valence": 3}
    >>> case = Case.from_json({"surface": "disk", "singularities": [corner]})
    >>> case.method, case.singularities[0].valence
    ('isotropic', 3)
    """

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
    connections: Connections = field(
        default=(),
        kw_only=True,
        metadata=key(
            ListOf(ListOf(Number(whole=True, least=0), length=2, name="pairs [a, b]")),
            "Two by two, singularities by their numbers from 0, which separatrices join: improve, "
            "make-valid and snap keep them joined. Of two the separatrices that miss least are "
            "meant, as many as the pair is given often.",
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

    def __post_init__(self) -> None:
        check_method(self.method, "method")
        if not isinstance(self.surface, str | Builtin):
            raise CaseError(
                "the surface of a case must be the name of a file or a Builtin, "
                f"not {type(self.surface).__name__}",
                "surface",
                "solve one made in Python by Problem(surface, singularities)",
            )
        one_of_kind("the title of a case", self.title, str, error=CaseError)
        one_of_kind("the options of a case", self.options, Options, error=CaseError)
        one_of_kind("the features of a case", self.features, PlacedFeatures, error=CaseError)
        for name, kind in (("singularities", PlacedSingularity), ("corners", PlacedCorner)):
            if (given := getattr(self, name)) is not None:
                placed = all_of_kind(name, given, kind, error=CaseError)
                object.__setattr__(self, name, placed)
        found = checked_connections(self.connections, len(self.singularities), error=CaseError)
        object.__setattr__(self, "connections", found)

    @property
    def files(self) -> tuple[str, ...]:
        """The files that it is solved from, its surface and its size map, unless built in."""
        named = (self.surface, self.options.sizes)
        return tuple(name for name in named if isinstance(name, str))

    def with_choices(
        self,
        *,
        method: str | None = None,
        features: float | None = None,
        component: int | str | None = None,
        repair: bool = False,
        prefix: str = "",
    ) -> Case:
        """Return the same case but for what is chosen on a command line or in a script.

        Parameters
        ----------
        method : str, optional
            One of `METHODS`.
        features : float, optional
            Edges over which the surface bends by more degrees are features, as are the curves.
        component : int or str, optional
            Of a surface in several pieces: "largest", a number (0 is the largest) or "all".
        repair : bool, optional
            Whether to repair even if the case does not ask for it.
        prefix : str, optional
            What stands before the names of choices where one is wrong.

        Returns
        -------
        Case
            Another one.

        Raises
        ------
        CaseError
            There is no such method or component, or no such angle.
        """
        given = {"component": component, "features": features}
        chosen = {k: JsonField(v, f"{prefix}{k}") for k, v in given.items() if v is not None}
        case = self
        if "component" in chosen:
            taken = checked(Options, "component", chosen["component"])
            case = replace(case, options=replace(case.options, component=taken))
        if repair:
            case = replace(case, options=replace(case.options, repair=True))
        if "features" in chosen:
            degrees = checked(PlacedFeatures, "dihedral_degrees", chosen["features"])
            case = replace(case, features=replace(case.features, dihedral_degrees=degrees))
        if method is not None:
            case = replace(case, method=check_method(method, f"{prefix}method"))
        return case

    @classmethod
    def load(cls, path: str | Path) -> Case:
        """Read a case file.

        Parameters
        ----------
        path : path-like
            Paths in it are relative to its folder.

        Returns
        -------
        Case
            What it says.

        Raises
        ------
        CaseError
            The file or a value in it is wrong; one line with the location in the file.
        """
        path = Path(path)
        return cls._read(read_json(path), path.parent)

    @classmethod
    def from_json(cls, data: Mapping[str, Any], base: str | Path = ".") -> Case:
        """Return the case that parsed JSON describes.

        Parameters
        ----------
        data : mapping
            As the text of a case file is parsed.
        base : path-like, optional
            The folder that its paths are relative to.

        Returns
        -------
        Case
            What it says.

        Raises
        ------
        CaseError
            A value is wrong; one line with its location.
        """
        return cls._read(JsonField(data, "case"), Path(base))

    @classmethod
    def _read(cls, root: JsonField, base: Path) -> Case:
        case: Case = Record(cls).read(root, base)
        return case

    def to_json(self, base: str | Path = ".") -> dict[str, Any]:
        """Return it as JSON values.

        Parameters
        ----------
        base : path-like, optional
            The folder that a surface file is named relative to.
        """
        return Record(Case).write(self, Path(base))

    def save(self, path: str | Path) -> None:
        """Write the case file whole or not at all.

        Parameters
        ----------
        path : path-like
            The file; a surface is named relative to its folder.

        Raises
        ------
        CrossviewError
            The file cannot be written, or its name does not end in .json.
        """
        path = Path(path)
        text = json.dumps(self.to_json(path.parent), indent=2, ensure_ascii=False) + "\n"
        if path.suffix.lower() != ".json":
            raise CaseError("cannot write a case under a name without .json", str(path), "add that")
        with staged_file(path, self.files) as made:
            made.write_text(text, encoding="utf-8")
