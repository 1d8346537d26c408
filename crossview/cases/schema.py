"""The format of case files for other programs and for readers: a JSON Schema and a table."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from crossview.cases.compounds import Either, ListOf
from crossview.cases.model import Case
from crossview.cases.records import Record, defaults_of, keys_of
from crossview.cases.shape import Shape

DRAFT = "https://json-schema.org/draft/2020-12/schema"
"""The version of JSON Schema that is written."""


def schema() -> dict[str, Any]:
    """Return the JSON Schema (draft 2020-12) of case files.

    It refuses what the reader refuses, but for what JSON Schema cannot say: a surface file that
    does not exist, values of parameters that make no surface, and a key that stands twice.

    Examples
    --------
    >>> found = schema()
    >>> found["required"]
    ['surface']
    >>> found["properties"]["options"]["properties"]["refine"]["maximum"]
    10
    """
    title = {"$schema": DRAFT, "title": "A case of crossview", "description": _summary(Case)}
    return title | Record(Case).schema()


def table() -> str:
    """Return the keys of case files as a table in Markdown."""
    head = ["| key | value | default | |", "|---|---|---|---|"]
    return "\n".join([*head, *_rows(Case, "")])


def _rows(kind: type, prefix: str) -> Iterator[str]:
    default = defaults_of(kind)
    for name, key in keys_of(kind).items():
        inner, suffix = _inner(key.shape)
        told = "" if name in default else "required"
        if name in default and key.shape.holds(default[name]):
            value = key.shape.write(default[name], Path())
            told = "" if isinstance(value, list | dict) else f"`{json.dumps(value)}`"
        words = "an object" if inner is not None and not suffix else key.shape.words
        yield f"| `{prefix}{name}` | {words} | {told} | {key.doc} |"
        if inner is not None:
            yield from _rows(inner, f"{prefix}{name}{suffix}.")


def _inner(shape: Shape) -> tuple[type | None, str]:
    """Return the dataclass that a shape has keys of, and how these are written."""
    match shape:
        case Record(kind=kind):
            return kind, ""
        case ListOf(item=Record(kind=kind)):
            return kind, "[]"
        case Either(shapes=shapes):
            return next((found for found in map(_inner, shapes) if found[0]), (None, ""))
        case _:
            return None, ""


def _summary(kind: type) -> str:
    return (kind.__doc__ or "").partition("\n")[0]
