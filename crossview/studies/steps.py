"""The steps of a study, each with its options: what they are like in a study file."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from crossview.cases.compounds import ListOf
from crossview.cases.json_values import JsonField, known_word
from crossview.cases.records import Record, documented, key
from crossview.cases.scalars import Flag, Number, Text, Word
from crossview.cases.shape import Shape
from crossview.workflow.quads import MeshOptions
from solvers.fields import CURVATURE_WEIGHT, MOST_VALENCE, NATURAL_ALIGNMENTS, NATURAL_METHODS
from solvers.quads import MAX_CHORD, MAX_SIZE_RATIO


@dataclass(frozen=True)
class Plain:
    """No options."""


@documented
@dataclass(frozen=True)
class Natural:
    """How natural singularities are placed."""

    method: str = field(
        default=NATURAL_METHODS[0],
        metadata=key(Word({name: name for name in NATURAL_METHODS}), "How the field is smoothed."),
    )
    seed: int = field(default=0, metadata=key(Number(whole=True, least=0), "Of the random start."))
    alignment: str = field(
        default=NATURAL_ALIGNMENTS[0],
        metadata=key(
            Word({name: name for name in NATURAL_ALIGNMENTS}),
            "Whether crosses are also drawn towards the principal directions.",
        ),
    )
    weight: float = field(default=CURVATURE_WEIGHT, metadata=key(Number(least=0), "How strongly."))
    most_valence: int = field(
        default=MOST_VALENCE, metadata=key(Number(whole=True, least=5), "Of a singularity.")
    )
    fewest: bool = field(
        default=False,
        metadata=key(Flag(), "Whether as few are left as the index budget allows."),
    )
    most: int | None = field(
        default=None, metadata=key(Number(whole=True, least=0), "How many at most.")
    )
    scale: float | None = field(
        default=None,
        metadata=key(
            Number(least=0),
            "Length below which details of the surface do not count; 0.03 roots of its area if "
            "not given.",
        ),
    )


@documented
@dataclass(frozen=True)
class Quads:
    """How fine the quads are."""

    target_quads: int | None = field(
        default=None,
        metadata=key(Number(whole=True, least=1), "About how many; 5000 if neither is given."),
    )
    edge_length: float | None = field(
        default=None, metadata=key(Number(above=0), "Mean length of their edges.")
    )
    smooth: bool = field(
        default=True, metadata=key(Flag(), "Whether vertices slide to better quads.")
    )
    allow_inverted: bool = field(
        default=False, metadata=key(Flag(), "Whether they are kept although one is inverted.")
    )
    max_chord: float = field(
        default=MAX_CHORD,
        metadata=key(
            Number(above=0, most=1),
            "Largest distance of an edge from the boundary or feature that it follows, in radii "
            "of its bend.",
        ),
    )
    max_size_ratio: float = field(
        default=MAX_SIZE_RATIO,
        metadata=key(
            Number(above=1),
            "How much longer than the mean edge of all those along an arc of the layout may be, "
            "as far as the number of quads allows.",
        ),
    )

    @property
    def mesh_options(self) -> MeshOptions:
        """The same as the stage of quads takes it.

        Raises
        ------
        CrossviewError
            Both a number and a length are given.
        """
        return MeshOptions(
            self.edge_length,
            self.target_quads,
            self.smooth,
            self.max_chord,
            self.max_size_ratio,
        )


@documented
@dataclass(frozen=True)
class Render:
    """How a picture is drawn."""

    layers: tuple[str, ...] | None = field(
        default=None,
        metadata=key(ListOf(Text()), "What is drawn; by default what the window shows."),
    )
    size: tuple[int, int] = field(
        default=(800, 600),
        metadata=key(ListOf(Number(whole=True, least=1), length=2), "Pixels."),
    )
    camera: str = field(default="auto", metadata=key(Text(), "As of the command render."))


STEPS: dict[str, type] = {
    "natural": Natural,
    "complete": Plain,
    "make-valid": Plain,
    "improve": Plain,
    "solve": Plain,
    "quads": Quads,
    "render": Render,
}
"""The options of each step, by the step's name."""


@dataclass(frozen=True)
class Step:
    """A step and its options.

    Parameters
    ----------
    name : str
        One of `STEPS`.
    options : object
        Of the class that `STEPS` names.
    """

    name: str
    options: Any


@dataclass(frozen=True)
class StepShape(Shape):
    """A step's name, or an object of the name and its options."""

    @property
    def words(self) -> str:
        """What it takes, with its article."""
        return "a step or {step: options}"

    @property
    def many(self) -> str:
        """What several are called."""
        return f"steps, {Word({name: name for name in STEPS}).words}, or {{step: options}}"

    def fits(self, value: object) -> bool:
        """Whether it is a string or an object of one key."""
        return isinstance(value, str) or (isinstance(value, dict) and len(value) == 1)

    def read(self, entry: JsonField, base: Path) -> Step:
        """Return the step."""
        if not self.fits(entry.value):
            raise self.mismatch(entry)
        if isinstance(entry.value, dict):
            ((name, options),) = entry.members().items()
        else:
            name, options = entry.value, JsonField({}, entry.file, entry.keys)
        known_word(name, STEPS, "step", entry.where)
        return Step(name, Record(STEPS[name]).read(options, base))

    def holds(self, value: object) -> bool:
        """Whether it is a step."""
        return isinstance(value, Step)

    def write(self, value: Step, base: Path) -> Any:
        """Return the name, or the name and the options that are not the default."""
        options = Record(STEPS[value.name]).write(value.options, base)
        return {value.name: options} if options else value.name

    def schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        plain = Word({name: name for name in STEPS})
        each = [
            {
                "type": "object",
                "properties": {name: Record(kind).schema()},
                "required": [name],
                "additionalProperties": False,
            }
            for name, kind in STEPS.items()
        ]
        return {"anyOf": [plain.schema(), *each]}
