"""A study: cases, what varies from one to the next, and what is done with each, as a JSON file."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from crossview.cases.compounds import ListOf
from crossview.cases.json_values import CaseError, JsonField, read_json
from crossview.cases.records import Record, documented, key
from crossview.cases.scalars import Number, Text, Word
from crossview.cases.shape import Shape
from crossview.studies.steps import STEPS, Step, StepShape
from crossview.studies.variation import MOST_CASES, Values, Variation

KEPT = ("case", "report", "fields", "obj", "vtk", "vtu", "ply", "gltf", "glb", "msh")
"""What may be kept of a case: case.json, report.json, fields for ParaView, quads by format."""

NEED_SOLUTION = ("quads", "render")
"""Steps that solve has to come before."""


@dataclass(frozen=True)
class Source:
    """Where cases of a study come from.

    Parameters
    ----------
    given : str or dict
        A file, a pattern of files or a name; or a case as a case file has it.
    base : Path
        The folder that paths are relative to.
    """

    given: str | dict[str, Any]
    base: Path


@dataclass(frozen=True)
class SourceShape(Shape):
    """A case, or a text that names some."""

    @property
    def words(self) -> str:
        """What it takes, with its article."""
        return "a case, a file, a pattern of files or a name"

    @property
    def many(self) -> str:
        """What several are called."""
        return "cases, files, patterns of files or names"

    def fits(self, value: object) -> bool:
        """Whether it is a string or an object."""
        return isinstance(value, str | dict)

    def read(self, entry: JsonField, base: Path) -> Source:
        """Return it as it stands, with its folder: it is understood case by case."""
        if isinstance(entry.value, dict):
            return Source(entry.value, base)
        return Source(Text().read(entry, base), base)

    def schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        return {"anyOf": [Text().schema(), {"type": "object", "required": ["surface"]}]}


@documented
@dataclass(frozen=True)
class Study:
    """Cases, what varies from one to the next, and what is done with each.

    Examples
    --------
    Three sizes of quads on a disk:

    >>> from crossview.studies import Study
    >>> study = Study.from_json(
    ...     {
    ...         "cases": ["disk-4"],
    ...         "vary": {"quads.target_quads": [200, 400, 800]},
    ...         "steps": ["solve", "quads"],
    ...     }
    ... )
    >>> [step.name for step in study.steps]
    ['solve', 'quads']
    """

    cases: tuple[Source, ...] = field(
        metadata=key(
            ListOf(SourceShape(), least=1),
            "Files (cases or surfaces, relative to the study), patterns of files, names of gallery "
            "cases or built-in surfaces, or cases as they stand in case files.",
        )
    )
    vary: Mapping[str, Values] = field(
        default_factory=dict,
        metadata=key(
            Variation(),
            "Places in a case, such as singularities[0].valence, surface.edge_length or method, or "
            "in the options of a step, such as quads.edge_length; every combination is a case.",
        ),
    )
    samples: int = field(
        default=1,
        metadata=key(
            Number(whole=True, least=1, most=MOST_CASES),
            "How often what varies at random is drawn.",
        ),
    )
    seed: int = field(
        default=0, metadata=key(Number(whole=True, least=0), "Of what is drawn at random.")
    )
    steps: tuple[Step, ...] = field(
        default=(Step("solve", STEPS["solve"]()),),
        metadata=key(ListOf(StepShape(), least=1), "What is done with each case, in this order."),
    )
    figures: tuple[str, ...] = field(
        default=("*",),
        metadata=key(
            ListOf(Text()), "Columns of the table that are kept, as patterns such as quads.*."
        ),
    )
    files: tuple[str, ...] = field(
        default=(),
        metadata=key(
            ListOf(Word({name: name for name in KEPT})),
            "What is kept of each case besides its row; pictures that are drawn are kept.",
        ),
    )
    rank: str | None = field(
        default=None,
        metadata=key(
            Text(),
            "The figure that tells the best from the worst, largest first, or least first after a "
            "minus sign.",
        ),
    )

    def __post_init__(self) -> None:
        order = list(STEPS)
        for one, other in itertools.pairwise(step.name for step in self.steps):
            if order.index(one) >= order.index(other):
                raise CaseError(
                    f'the step "{other}" comes after "{one}"',
                    "steps",
                    f"take each once, in the order {', '.join(order)}",
                )
        names = {step.name for step in self.steps}
        for name in NEED_SOLUTION:
            if name in names and "solve" not in names:
                raise CaseError(f'"{name}" needs "solve" before it', "steps", 'add "solve"')

    @classmethod
    def load(cls, path: str | Path) -> Study:
        """Read a study file.

        Parameters
        ----------
        path : path-like
            Paths in it are relative to its folder.

        Raises
        ------
        CaseError
            The file or a value in it is wrong; one line with the location in the file.
        """
        path = Path(path)
        return cls._read(read_json(path), path.absolute().parent)

    @classmethod
    def from_json(cls, data: Mapping[str, Any], base: str | Path = ".") -> Study:
        """Return the study that parsed JSON describes.

        Parameters
        ----------
        data : mapping
            As the text of a study file is parsed.
        base : path-like, optional
            The folder that its paths are relative to.

        Raises
        ------
        CaseError
            A value is wrong; one line with its location.
        """
        return cls._read(JsonField(data, "study"), Path(base).absolute())

    @classmethod
    def _read(cls, root: JsonField, base: Path) -> Study:
        study: Study = Record(cls).read(root, base)
        return study
