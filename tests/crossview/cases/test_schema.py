"""The JSON Schema and the reader are two readings of one definition: they agree on every file."""

import copy
import json
from collections.abc import Iterator
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from crossview.cases import gallery
from crossview.cases.model import Case, CaseError
from crossview.cases.schema import schema
from solvers.primitives import BUILTIN

SCHEMA = schema()
VALIDATOR = Draft202012Validator(SCHEMA)
FULL: dict[str, Any] = {
    "title": "All keys",
    "surface": {"builtin": "annulus", "inner": 0.4},
    "singularities": [{"position": [0.7, 0, 0], "valence": 3, "locked": True}],
    "corners": [{"position": [1, 0, 0], "index": 1}],
    "features": {
        "dihedral_degrees": 40,
        "curves": [[[0, 0, 0], [1, 0, 0]]],
        "without": [[[0, 0, 0], [1, 0, 0]]],
    },
    "method": "alternating",
    "options": {
        "tolerance_degrees": 0.5,
        "refine": 0,
        "component": 1,
        "repair": True,
        "turns": [0, -1],
        "proximal_weight": 0.001,
        "sizes": [[1, 2], [1.5, 0.5]],
    },
}
VALUES: list[Any] = [
    *(None, True, False),
    *(-(10**18), -99, -1, 0, 0.5, 1, 1.0, 2, 10, 11, 45, 45.5, 100, 101, 180, 181, 10**400),
    *("", " ", "auto", "largest", "all", "isotropic", "word", "annulus"),
    *("a.npy", "a.TXT", "in/a.Npy", ".npy", "in/.npy", "a.npy.bak", "a_npy"),
    *([], [0], [1], [1, 2], [1, 2, 3], [1, 2, 3, 4], [[1, 2]], [[1, 2], 3], [1, [1, 2]], [[1, -2]]),
    *([[1, 2, 3]], [[1, 2, 3], [4, 5, 6]], [[[1, 2, 3], [4, 5, 6]]], [[]], [{}]),
    *({}, {"builtin": "torus"}, {"builtin": "none"}, {"valence": 3}, {"position": [1, 2, 3]}),
]


def read(data: Any) -> bool:
    """Whether the reader takes it."""
    try:
        Case.from_json(data)
    except CaseError:
        return False
    return True


def paths(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """All places in a JSON value."""
    yield path
    if isinstance(value, dict | list):
        for key, item in value.items() if isinstance(value, dict) else enumerate(value):
            yield from paths(item, (*path, key))


def changed(path: tuple[Any, ...], value: Any) -> Any:
    """The full case with another value at one place."""
    if not path:
        return value
    data = copy.deepcopy(FULL)
    at: Any = data
    for step in path[:-1]:
        at = at[step]
    at[path[-1]] = value
    return data


def test_it_is_a_schema_and_survives_being_written() -> None:
    Draft202012Validator.check_schema(SCHEMA)
    assert json.loads(json.dumps(SCHEMA, allow_nan=False)) == SCHEMA


@pytest.mark.parametrize("name", gallery.names())
def test_every_gallery_case_validates(name: str) -> None:
    text = gallery.path_of(name).read_text(encoding="utf-8")
    VALIDATOR.validate(json.loads(text))
    VALIDATOR.validate(Case.load(gallery.path_of(name)).to_json())


def test_every_built_in_surface_validates_with_its_defaults() -> None:
    for name in BUILTIN:
        VALIDATOR.validate({"surface": name})
        VALIDATOR.validate({"surface": {"builtin": name}})


@pytest.mark.parametrize("path", list(paths(FULL)), ids=str)
def test_reader_and_schema_refuse_the_same(path: tuple[Any, ...]) -> None:
    """Any value at any place, in one case of all keys: more than three thousand files."""
    for value in VALUES:
        data = changed(path, value)
        assert VALIDATOR.is_valid(data) == read(data), value


@pytest.mark.parametrize("path", [p for p in paths(FULL) if p and isinstance(p[-1], str)], ids=str)
def test_a_missing_and_a_misspelt_key_are_refused_by_both(path: tuple[Any, ...]) -> None:
    whole = changed(path, None)
    parent: Any = whole
    for step in path[:-1]:
        parent = parent[step]
    del parent[path[-1]]
    assert VALIDATOR.is_valid(whole) == read(whole)
    parent["misspelt"] = 1
    assert not VALIDATOR.is_valid(whole)
    assert not read(whole)


def test_each_default_is_what_it_says() -> None:
    """Given or left out, a key with its default is the same case."""
    options = SCHEMA["properties"]["options"]["properties"]
    given = {name: key["default"] for name, key in options.items() if "default" in key}
    assert set(given) == {"tolerance_degrees", "refine", "repair", "proximal_weight"}
    bare = Case.from_json({"surface": "torus"})
    assert Case.from_json({"surface": "torus", "options": given}) == bare
    own = {name: key["default"] for name, key in SCHEMA["properties"].items() if "default" in key}
    assert set(own) == {"singularities", "connections", "corners", "features", "method", "options"}
    assert Case.from_json({"surface": "torus", **own}) == bare


def test_what_is_written_is_read_and_validates() -> None:
    case = Case.from_json(FULL)
    assert case.to_json() == FULL
    VALIDATOR.validate(case.to_json())
