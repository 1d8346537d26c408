"""What a value in a case file must be like: a shape, by which it is read, written and described.

A shape is a value itself. `words` names what it takes, in errors and in tables, and `schema` says
the same as a JSON Schema (draft 2020-12), as far as JSON Schema can.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from crossview.cases.json_values import JsonField, shown


def either(choices: Iterable[str]) -> str:
    """Return "a, b or c"."""
    *others, last = choices
    return f"{', '.join(others)} or {last}" if others else last


class Shape(ABC):
    """What a JSON value must be like."""

    @property
    @abstractmethod
    def words(self) -> str:
        """What it takes, with its article: "a number above 0"."""

    @property
    def choices(self) -> tuple[str, ...]:
        """The same, alternatives apart."""
        return (self.words,)

    @property
    def many(self) -> str:
        """What several are called: "numbers above 0"."""
        return f"values, each {self.words}"

    @abstractmethod
    def fits(self, value: object) -> bool:
        """Whether a parsed JSON value is meant to be of this shape, though it may be wrong."""

    def holds(self, value: object) -> bool:
        """Whether `write` takes a value, as `read` returns it."""
        return self.fits(value)

    @abstractmethod
    def read(self, entry: JsonField, base: Path) -> Any:
        """Return the value; paths in it are relative to the folder `base`.

        Raises
        ------
        CaseError
            It is not of this shape; names its place in the file.
        """

    def write(self, value: Any, base: Path) -> Any:
        """Return the value as JSON has it; paths in it relative to the folder `base`."""
        return value

    @abstractmethod
    def schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""

    def mismatch(self, entry: JsonField) -> Exception:
        """Return the error that says what was expected in place of `entry`."""
        return entry.error(f"expected {self.words}, found {shown(entry.value)}")
