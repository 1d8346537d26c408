"""What a check finds: measures as JSON values, and faults, each in one line."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from crossview.certificate.faces import Floats
from solvers.errors import counted

Measures = dict[str, Any]
"""JSON values by name."""


@dataclass(frozen=True)
class Fault:
    """Something that is wrong with a mesh.

    Parameters
    ----------
    kind : str
        One word or two, always the same for the same.
    message : str
        What is wrong and how much, in plain words.
    place : tuple of 3 floats, or None
        The first place or the worst.
    """

    kind: str
    message: str
    place: tuple[float, float, float] | None = None

    def __str__(self) -> str:
        """The message and the place."""
        return self.message if self.place is None else f"{self.message} at {self.where}"

    @property
    def where(self) -> str:
        """The place as text, empty if there is none."""
        return "" if self.place is None else f"({', '.join(f'{x:.4g}' for x in self.place)})"

    def to_json(self) -> Measures:
        """The same as JSON values."""
        place = None if self.place is None else list(self.place)
        return {"kind": self.kind, "message": self.message, "place": place}


def first(kind: str, noun: str, rest: str, places: Floats) -> Iterator[Fault]:
    """A fault for things at places (k, 3), counted, the first named; none if there are none."""
    if len(places):
        yield at(kind, f"{counted(len(places), noun)} {rest}, the first", places[0])


def at(kind: str, message: str, place: Floats) -> Fault:
    """A fault at a place (3,)."""
    x, y, z = (float(value) for value in place)
    return Fault(kind, message, (x, y, z))
