"""Read JSON values with their location, so that every complaint says where the value stands."""

from __future__ import annotations

import difflib
import json
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from solvers.errors import CrossviewError
from solvers.surface.validation import LARGEST


class CaseError(CrossviewError):
    """A case that cannot be understood: what is wrong, where in the file, what to write instead."""


def nearest(word: str, known: Iterable[str]) -> str:
    """Advice for an unknown `word`: the closest of `known`, or all of them."""
    names = sorted(known)
    close = difflib.get_close_matches(word, names, n=1)
    return f'did you mean "{close[0]}"?' if close else "known: " + ", ".join(names)


def read_json(path: Path) -> JsonField:
    """Parse the file `path`.

    Raises
    ------
    CaseError
        The file is missing, unreadable, not UTF-8 or not JSON (with line and column), or an
        object names a key twice.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")  # some editors begin with a byte order mark
    except UnicodeDecodeError as error:
        raise CaseError("the case is not a text file in UTF-8", str(path)) from error
    except OSError as error:
        raise CaseError(f"cannot read the case, {error.strerror}", str(path)) from error

    def unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        keys = [key for key, _ in pairs]
        twice = next((key for key in keys if keys.count(key) > 1), None)
        if twice is not None:
            raise CaseError(f'the key "{twice}" stands twice in one object', str(path))
        return dict(pairs)

    try:
        return JsonField(json.loads(text, object_pairs_hook=unique), str(path))
    except json.JSONDecodeError as error:
        where = f"{path}, line {error.lineno}, column {error.colno}"
        raise CaseError(f"malformed JSON, {error.msg}", where) from error
    except RecursionError as error:
        raise CaseError("malformed JSON, nested too deeply", str(path)) from error
    except ValueError as error:
        raise CaseError("malformed JSON, a number is too long", str(path)) from error


@dataclass(frozen=True)
class JsonField:
    """A JSON value and where it stands (file, then keys and list positions)."""

    value: Any
    file: str
    keys: str = ""

    @property
    def where(self) -> str:
        """File and location in one piece."""
        return f"{self.file}, {self.keys}" if self.keys else self.file

    def error(self, what: str, advice: str = "") -> CaseError:
        """The error that blames this value."""
        return CaseError(what, self.where, advice)

    def object(self, required: Iterable[str], optional: Iterable[str]) -> dict[str, JsonField]:
        """The members of an object that has all the `required` and only known keys."""
        if not isinstance(self.value, dict):
            raise self.error(f"expected an object {{...}}, found {_shown(self.value)}")
        known = {*required, *optional}
        for key in self.value:
            if key not in known:
                raise self.error(f'unknown key "{key}"', nearest(key, known))
        for key in required:
            if key not in self.value:
                raise self.error(f'the key "{key}" is missing')
        return self.members()

    def members(self) -> dict[str, JsonField]:
        """The members of an object, whatever their names."""
        prefix = f"{self.keys}." if self.keys else ""
        return {k: JsonField(v, self.file, prefix + k) for k, v in self.value.items()}

    def items(self, length: int | None = None) -> list[JsonField]:
        """The items of a list, exactly `length` of them if given."""
        wanted = "a list" if length is None else f"a list of {length} numbers"
        if not isinstance(self.value, list) or (length is not None and len(self.value) != length):
            raise self.error(f"expected {wanted}, found {_shown(self.value)}")
        return [JsonField(v, self.file, f"{self.keys}[{i}]") for i, v in enumerate(self.value)]

    def number(self) -> float:
        """A finite number that can be computed with."""
        if isinstance(self.value, bool) or not isinstance(self.value, int | float):
            raise self.error(f"expected a number, found {_shown(self.value)}")
        if not abs(self.value) < LARGEST:
            raise self.error(
                f"expected a finite number below {LARGEST:g}, found {_shown(self.value)}"
            )
        return float(self.value)

    def integer(self, name: str, least: int | None = None, most: int | None = None) -> int:
        """A whole number called `name`, between `least` and `most`."""
        number = self.number()
        if number != int(number):
            raise self.error(f"{name} must be a whole number, found {_shown(self.value)}")
        if least is not None and number < least:
            raise self.error(f"{name} must be at least {least}, found {_shown(self.value)}")
        if most is not None and number > most:
            raise self.error(f"{name} must be at most {most}, found {_shown(self.value)}")
        return int(number)

    def position(self) -> tuple[float, float, float]:
        """A point of space: three finite numbers."""
        x, y, z = (item.number() for item in self.items(3))
        return x, y, z

    def text(self) -> str:
        """A string that is not empty."""
        if not isinstance(self.value, str) or not self.value.strip():
            raise self.error(f"expected a text, found {_shown(self.value)}")
        return self.value

    def boolean(self) -> bool:
        """True or false."""
        if not isinstance(self.value, bool):
            raise self.error(f"expected true or false, found {_shown(self.value)}")
        return self.value


def _shown(value: Any) -> str:
    """The value as JSON writes it, shortened so that an error stays one line."""
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= 40 else text[:37] + "..."
