"""Shapes of single values: numbers, truth values, texts, words and files."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from crossview.cases.json_values import JsonField, known_word, shown
from crossview.cases.shape import Shape, either
from solvers.number_checks import LARGEST, plain


@dataclass(frozen=True)
class Number(Shape):
    """A finite number, perhaps a whole one or one within limits.

    Parameters
    ----------
    above, least, most : float, optional
        Limits; that one itself is not taken, the others are.
    whole : bool
    """

    above: float | None = None
    least: float | None = None
    most: float | None = None
    whole: bool = False

    @property
    def words(self) -> str:
        """What it takes, with its article."""
        return f"a {'whole ' if self.whole else ''}number{self._limits}"

    @property
    def many(self) -> str:
        """What several are called."""
        return f"{'whole ' if self.whole else ''}numbers{self._limits}"

    @property
    def _limits(self) -> str:
        if self.least is not None:
            last = " on" if self.most is None else f" to {self.most:g}"
            return f" from {self.least:g}{last}"
        limits = {"above": self.above, "at most": self.most}
        told = [f"{word} {limit:g}" for word, limit in limits.items() if limit is not None]
        return f" {' and '.join(told)}" if told else ""

    def fits(self, value: object) -> bool:
        """Whether it is a number at all."""
        number = isinstance(value, int | float | np.integer | np.floating)
        return number and not isinstance(value, bool)

    def read(self, entry: JsonField, base: Path) -> int | float:
        """Return the number."""
        if not self.fits(entry.value):
            raise self.mismatch(entry)
        value = plain(entry.value)
        if value is None:
            raise entry.error(
                f"expected a finite number below {LARGEST:g}, found {shown(entry.value)}"
            )
        within = (
            (self.above is None or value > self.above)
            and (self.least is None or value >= self.least)
            and (self.most is None or value <= self.most)
        )
        if not within or (self.whole and value != int(value)):
            raise self.mismatch(entry)
        return int(value) if self.whole else float(value)

    def schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        limits = {"exclusiveMinimum": self.above, "minimum": self.least, "maximum": self.most}
        found: dict[str, Any] = {"type": "integer" if self.whole else "number"}
        found |= {name: limit for name, limit in limits.items() if limit is not None}
        if self.above is None and self.least is None:
            found["exclusiveMinimum"] = -LARGEST
        if self.most is None:
            found["exclusiveMaximum"] = LARGEST
        return found


@dataclass(frozen=True)
class Flag(Shape):
    """True or false."""

    @property
    def words(self) -> str:
        """What it takes."""
        return "true or false"

    def fits(self, value: object) -> bool:
        """Whether it is one of the two."""
        return isinstance(value, bool)

    def read(self, entry: JsonField, base: Path) -> bool:
        """Return which."""
        if not isinstance(entry.value, bool):
            raise self.mismatch(entry)
        return entry.value

    def schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        return {"type": "boolean"}


@dataclass(frozen=True)
class Text(Shape):
    """A string that is not blank."""

    @property
    def words(self) -> str:
        """What it takes, with its article."""
        return "a text"

    def fits(self, value: object) -> bool:
        """Whether it is a string that says something."""
        return isinstance(value, str) and bool(value.strip())

    def read(self, entry: JsonField, base: Path) -> str:
        """Return the string."""
        if not self.fits(entry.value):
            raise self.mismatch(entry)
        return str(entry.value)

    def schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        return {"type": "string", "pattern": r"\S"}


@dataclass(frozen=True)
class Word(Shape):
    """One of a few words.

    Parameters
    ----------
    values : mapping of str to object
        What each stands for.
    """

    values: Mapping[str, Any]

    @property
    def words(self) -> str:
        """The words."""
        return either(self.choices)

    @property
    def choices(self) -> tuple[str, ...]:
        """Each word."""
        return tuple(f'"{word}"' for word in self.values)

    def fits(self, value: object) -> bool:
        """Whether it is one of them."""
        return isinstance(value, str) and value in self.values

    def read(self, entry: JsonField, base: Path) -> Any:
        """Return what the word stands for; an unknown one is told with the nearest."""
        if not isinstance(entry.value, str):
            raise self.mismatch(entry)
        return self.values[known_word(entry.value, self.values, entry.key, entry.where)]

    def holds(self, value: object) -> bool:
        """Whether a word stands for the value."""
        return value in self.values.values()

    def write(self, value: Any, base: Path) -> str:
        """Return the word."""
        return next(word for word, meant in self.values.items() if meant == value)

    def schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        return {"enum": list(self.values)}


@dataclass(frozen=True)
class File(Shape):
    """A file, named relative to the case.

    Parameters
    ----------
    suffixes : tuple of str
        Those it may have, in lower case.
    """

    suffixes: tuple[str, ...]

    @property
    def words(self) -> str:
        """What it takes, with its article."""
        return f"a {' or '.join(self.suffixes)} file"

    def fits(self, value: object) -> bool:
        """Whether it is a string."""
        return isinstance(value, str)

    def read(self, entry: JsonField, base: Path) -> str:
        """Return the path, relative to the working directory or absolute."""
        path = base / Text().read(entry, base)
        if path.suffix.lower() not in self.suffixes:
            raise self.mismatch(entry)
        return os.path.normpath(path)

    def write(self, value: str, base: Path) -> str:
        """Return the path as named from `base`, with forward slashes."""
        return relative(value, base)

    def schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        ends = "|".join(
            "".join(f"[{c}{c.upper()}]" for c in suffix.removeprefix("."))
            for suffix in self.suffixes
        )
        return {"type": "string", "pattern": rf"[^/]\.({ends})$"}


def relative(file: str, base: Path) -> str:
    """Return `file` as named from the folder `base`, with forward slashes."""
    try:
        return Path(os.path.relpath(file, base)).as_posix()
    except ValueError:  # another drive: there is no relative path
        return Path(file).absolute().as_posix()
