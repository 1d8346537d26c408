"""Read JSON values with their location, so that every complaint says where the value stands."""

from __future__ import annotations

import difflib
import json
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from crossview.io.regular_file import require_regular
from solvers.errors import CrossviewError


class CaseError(CrossviewError):
    """A case that cannot be understood: what is wrong, where in the file, what to write instead."""


def nearest(word: str, known: Iterable[str]) -> str:
    """Advice for an unknown `word`: the closest of `known`, or all of them."""
    names = sorted(known)
    close = difflib.get_close_matches(word, names, n=1)
    return f'did you mean "{close[0]}"?' if close else "known: " + ", ".join(names)


def known_word(word: str, known: Iterable[str], name: str, where: str) -> str:
    """The `word` if it is `known`.

    Raises
    ------
    CaseError
        It is not; the message names the nearest, or lists those that are.
    """
    if not isinstance(word, str) or word not in known:
        raise CaseError(f'unknown {name} "{word}"', where, nearest(str(word), known))
    return word


def read_json(path: Path) -> JsonField:
    """Parse the file `path`.

    Raises
    ------
    CaseError
        The file is missing, unreadable, not UTF-8 or not JSON (with line and column), or an
        object names a key twice.
    """
    try:
        require_regular(path)
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

    @property
    def key(self) -> str:
        """The last key alone."""
        return self.keys.rpartition(".")[2]

    def error(self, what: str, advice: str = "") -> CaseError:
        """The error that blames this value."""
        return CaseError(what, self.where, advice)

    def object(
        self, required: Iterable[str], optional: Iterable[str], retired: Iterable[str] = ()
    ) -> dict[str, JsonField]:
        """The members of an object that has all the `required` and only known keys.

        Those that are `retired`, of files from before, are left out.
        """
        if not isinstance(self.value, dict):
            raise self.error(f"expected an object {{...}}, found {shown(self.value)}")
        known, gone = {*required, *optional}, {*retired}
        for key in self.value:
            if key not in known | gone:
                raise self.error(f'unknown key "{key}"', nearest(key, known))
        for key in required:
            if key not in self.value:
                raise self.error(f'the key "{key}" is missing')
        return {key: member for key, member in self.members().items() if key not in gone}

    def members(self) -> dict[str, JsonField]:
        """The members of an object, whatever their names."""
        prefix = f"{self.keys}." if self.keys else ""
        return {k: JsonField(v, self.file, prefix + k) for k, v in self.value.items()}

    def items(self) -> list[JsonField]:
        """The items of a list."""
        return [JsonField(v, self.file, f"{self.keys}[{i}]") for i, v in enumerate(self.value)]


def shown(value: Any) -> str:
    """The value as JSON writes it, shortened so that an error stays one line."""
    text = json.dumps(value, ensure_ascii=False, default=repr)
    return text if len(text) <= 40 else text[:37] + "..."
