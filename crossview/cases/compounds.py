"""Shapes made of others: lists and alternatives."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from crossview.cases.json_values import JsonField
from crossview.cases.shape import Shape, either


@dataclass(frozen=True)
class ListOf(Shape):
    """A list of values of one shape; a tuple in Python.

    Parameters
    ----------
    item : Shape
    length : int, optional
        How many there must be.
    least : int
        How many there must be at least.
    name : str
        What several such lists are called.
    """

    item: Shape
    length: int | None = None
    least: int = 0
    name: str = "lists"

    @property
    def words(self) -> str:
        """What it takes, with its article."""
        if self.length is not None:
            return f"a list of {self.length} {self.item.many}"
        number = f"{self.least} or more " if self.least else ""
        return f"a list of {number}{self.item.many}"

    @property
    def many(self) -> str:
        """What several are called."""
        return self.name

    def fits(self, value: object) -> bool:
        """Whether it is a list, with an item that fits if there are any."""
        return isinstance(value, list) and (not value or any(map(self.item.fits, value)))

    def read(self, entry: JsonField, base: Path) -> tuple[Any, ...]:
        """Return the values."""
        if not isinstance(entry.value, list) or not self._long_enough(len(entry.value)):
            raise self.mismatch(entry)
        return tuple(self.item.read(item, base) for item in entry.items())

    def holds(self, value: object) -> bool:
        """Whether it is a tuple, of values that the items' shape takes."""
        return isinstance(value, tuple) and all(map(self.item.holds, value))

    def write(self, value: tuple[Any, ...], base: Path) -> list[Any]:
        """Return the values as a list."""
        return [self.item.write(item, base) for item in value]

    def schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        found: dict[str, Any] = {"type": "array", "items": self.item.schema()}
        if self.length or self.least:
            found["minItems"] = self.length or self.least
        if self.length:
            found["maxItems"] = self.length
        return found

    def _long_enough(self, length: int) -> bool:
        return length >= self.least if self.length is None else length == self.length


@dataclass(frozen=True)
class Either(Shape):
    """A value of one of several shapes, the first that fits.

    Parameters
    ----------
    shapes : tuple of Shape
    """

    shapes: tuple[Shape, ...]

    @property
    def words(self) -> str:
        """What it takes, with its article."""
        return either(choice for shape in self.shapes for choice in shape.choices)

    def fits(self, value: object) -> bool:
        """Whether it fits any of them."""
        return any(shape.fits(value) for shape in self.shapes)

    def read(self, entry: JsonField, base: Path) -> Any:
        """Return the value as the first shape that fits reads it."""
        for shape in self.shapes:
            if shape.fits(entry.value):
                return shape.read(entry, base)
        raise self.mismatch(entry)

    def holds(self, value: object) -> bool:
        """Whether one of them takes the value."""
        return any(shape.holds(value) for shape in self.shapes)

    def write(self, value: Any, base: Path) -> Any:
        """Return the value as the first shape that takes it writes it."""
        return next(shape for shape in self.shapes if shape.holds(value)).write(value, base)

    def schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        return {"anyOf": [shape.schema() for shape in self.shapes]}
