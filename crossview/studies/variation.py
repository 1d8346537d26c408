"""What varies from one case of a study to the next: lists, ranges, and what is drawn at random."""

from __future__ import annotations

import re
import zlib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from crossview.cases.json_values import JsonField
from crossview.cases.records import Record, documented, key
from crossview.cases.scalars import Flag, Number
from crossview.cases.shape import Shape

ANYWHERE = "anywhere"
"""Stands for a random point of the surface, each as likely as any other by area."""

MOST_CASES = 1_000_000
"""Cases of a study; more is a slip of the pen, and would fill the memory. Chosen."""

PLACE = re.compile(r"[\w-]+(?:\[\d+\])*(?:\.[\w-]+(?:\[\d+\])*)*")
"""A place in a case: names of keys with points between them, and positions in lists."""


@documented
@dataclass(frozen=True)
class Spread:
    """Numbers from one to another, evenly spaced; without a count, one drawn for each sample."""

    least: float = field(metadata=key(Number(), "The first."))
    most: float = field(metadata=key(Number(), "The last."))
    count: int | None = field(
        default=None,
        metadata=key(Number(whole=True, least=1, most=MOST_CASES), "How many numbers."),
    )
    whole: bool = field(
        default=False, metadata=key(Flag(), "Whether they are rounded to whole numbers.")
    )

    def spaced(self, count: int) -> tuple[float | int, ...]:
        """Return `count` evenly spaced numbers, of rounded ones each once."""
        numbers = np.linspace(self.least, self.most, count)
        if self.whole:
            return tuple(int(number) for number in np.unique(np.rint(numbers)))
        return tuple(numbers.tolist())

    def drawn(self, generator: np.random.Generator) -> float | int:
        """Return a number drawn at random."""
        if self.whole:
            return int(generator.integers(round(self.least), round(self.most), endpoint=True))
        return float(generator.uniform(self.least, self.most))


Values = tuple[Any, ...] | Spread | str
"""A list of values, a spread of numbers, or `ANYWHERE`."""


@dataclass(frozen=True)
class Variation(Shape):
    """Places in a case or in the options of a step, and the values that each takes."""

    @property
    def words(self) -> str:
        """What it takes, with its article."""
        return f'an object of places, each with a list, {{least, most, count}} or "{ANYWHERE}"'

    def fits(self, value: object) -> bool:
        """Whether it is an object."""
        return isinstance(value, dict)

    def read(self, entry: JsonField, base: Path) -> dict[str, Values]:
        """Return the values of each place."""
        if not self.fits(entry.value):
            raise self.mismatch(entry)
        for place in entry.value:
            if not PLACE.fullmatch(place):
                raise entry.error(
                    f'"{place}" is no place in a case', "write singularities[0].position"
                )
        return {place: self._values(values, base) for place, values in entry.members().items()}

    def _values(self, entry: JsonField, base: Path) -> Values:
        match entry.value:
            case str() if entry.value == ANYWHERE:
                return ANYWHERE
            case list() if entry.value:
                return tuple(entry.value)
            case dict():
                spread: Spread = Record(Spread).read(entry, base)
                if spread.most < spread.least:
                    raise entry.error("the most is below the least", "exchange them")
                return spread
        raise entry.error(
            f'expected a list of values, {{least, most, count}} or "{ANYWHERE}"',
        )

    def write(self, value: dict[str, Values], base: Path) -> dict[str, Any]:
        """Return the object."""
        return {
            place: Record(Spread).write(values, base)
            if isinstance(values, Spread)
            else (values if isinstance(values, str) else list(values))
            for place, values in value.items()
        }

    def schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        values = {"type": "array", "minItems": 1}
        each = [{"const": ANYWHERE}, values, Record(Spread).schema()]
        return {"type": "object", "additionalProperties": {"anyOf": each}}


def generator(seed: int, sample: int, place: str) -> np.random.Generator:
    """Return what draws the values of a place for a sample.

    It is of its own for each place: what else varies changes nothing about it.

    Parameters
    ----------
    seed : int
        Of the study.
    sample : int
        Its number.
    place : str
        Where the value goes.
    """
    return np.random.default_rng([seed, sample, zlib.crc32(place.encode())])
