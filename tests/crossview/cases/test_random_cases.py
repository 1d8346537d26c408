"""Any case comes back from JSON as it was; any spoilt one is refused in one line, or is a case."""

import copy
import inspect
import json
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crossview.cases.model import METHODS, Case, CaseError
from solvers.primitives import BUILTIN

NUMBERS = st.one_of(st.floats(-1e6, 1e6), st.integers(-(10**6), 10**6))
POSITIVE = st.one_of(st.floats(1e-6, 1e6), st.integers(1, 10**6))
ANGLES = st.floats(0.001, 45.0)
POSITIONS = st.lists(NUMBERS, min_size=3, max_size=3)
POLYLINES = st.lists(st.lists(POSITIONS, min_size=2, max_size=4), max_size=2)
FILES = st.from_regex(r"[a-z]{1,8}\.(obj|stl|ply)", fullmatch=True)


@st.composite
def built_in(draw: st.DrawFn) -> Any:
    """The name of a built-in surface, or that with some of its parameters."""
    name = draw(st.sampled_from(sorted(BUILTIN)))
    parameters = inspect.signature(BUILTIN[name]).parameters
    named = draw(st.sets(st.sampled_from(sorted(parameters)))) if draw(st.booleans()) else None
    if named is None:
        return name
    values = {key: draw(NUMBERS) for key in sorted(named)}
    return {"builtin": name, **values}


OPTIONS = st.fixed_dictionaries(
    {},
    optional={
        "tolerance_degrees": ANGLES,
        "refine": st.integers(0, 10),
        "component": st.one_of(st.sampled_from(["largest", "all"]), st.integers(0, 99)),
        "repair": st.booleans(),
        "turns": st.lists(st.integers(-9, 9), max_size=3),
        "proximal_weight": POSITIVE,
        "sizes": st.one_of(
            st.lists(POSITIVE, min_size=1, max_size=4),
            st.lists(st.lists(POSITIVE, min_size=2, max_size=2), min_size=1, max_size=4),
            st.from_regex(r"[a-z]{1,8}\.(npy|txt)", fullmatch=True),
        ),
    },
)
SINGULARITIES = st.fixed_dictionaries(
    {"position": POSITIONS, "valence": st.integers(1, 100)}, optional={"locked": st.booleans()}
)
CORNERS = st.fixed_dictionaries({"position": POSITIONS, "index": st.integers(-98, 1)})
FEATURES = st.fixed_dictionaries(
    {},
    optional={
        "dihedral_degrees": st.floats(0.001, 180.0),
        "curves": POLYLINES,
        "without": POLYLINES,
    },
)
UNCONNECTED = st.fixed_dictionaries(
    {"surface": st.one_of(built_in(), FILES)},
    optional={
        "title": st.text(min_size=1),
        "singularities": st.lists(SINGULARITIES, max_size=4),
        "corners": st.one_of(st.just("auto"), st.lists(CORNERS, max_size=3)),
        "features": FEATURES,
        "method": st.sampled_from(METHODS),
        "options": OPTIONS,
    },
)


def connected(case: dict[str, Any]) -> st.SearchStrategy[dict[str, Any]]:
    """The same case with connections between its singularities, if it has any."""
    count = len(case.get("singularities", ()))
    if not count:
        return st.just(case)
    pairs = st.lists(st.integers(0, count - 1), min_size=2, max_size=2)
    return st.lists(pairs, max_size=3).map(lambda given: case | {"connections": given})


CASES = UNCONNECTED.flatmap(connected)
JSON = st.recursive(
    st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=8)),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=8), inner),
    max_leaves=6,
)


def objects(value: Any) -> Iterator[Any]:
    """Every object and list in a JSON value."""
    if isinstance(value, dict | list):
        yield value
        for item in value.values() if isinstance(value, dict) else value:
            yield from objects(item)


@st.composite
def spoilt(draw: st.DrawFn) -> Any:
    """A case with one to three keys or items replaced, taken away, or of another name."""
    data = copy.deepcopy(draw(CASES))
    for _ in range(draw(st.integers(1, 3))):
        at = draw(st.sampled_from(list(objects(data))))
        keys = sorted(at) if isinstance(at, dict) else list(range(len(at)))
        key = draw(st.sampled_from(keys)) if keys else None
        match draw(st.sampled_from(["replace", "remove", "add"])):
            case "replace" if key is not None:
                at[key] = draw(JSON)
            case "remove" if key is not None:
                del at[key]
            case _ if isinstance(at, dict):
                at[draw(st.text(max_size=8))] = draw(JSON)
            case _:
                at.append(draw(JSON))
    return data


def read_or_refused(read: Callable[[Any], Case], written: Any) -> Case | None:
    """The case, or None where it is refused as cases are: by one line."""
    try:
        return read(written)
    except CaseError as error:
        line = str(error)
    assert line.strip()
    assert len(line.splitlines()) == 1
    return None


@settings(max_examples=200)
@given(CASES)
def test_a_case_comes_back_as_it_was(data: dict[str, Any]) -> None:
    case = Case.from_json(data)
    assert Case.from_json(json.loads(json.dumps(case.to_json(), allow_nan=False))) == case


@settings(max_examples=200)
@given(spoilt())
def test_a_spoilt_case_is_refused_in_one_line_or_is_a_case(data: Any) -> None:
    case = read_or_refused(Case.from_json, data)
    if case is not None:
        assert Case.from_json(case.to_json()) == case


@settings(max_examples=200)
@given(JSON)
def test_what_is_no_case_is_refused_in_one_line(data: Any) -> None:
    assert read_or_refused(Case.from_json, data) is None


@settings(max_examples=200)
@given(data=CASES, place=st.floats(0, 1), put=st.binary(max_size=3), cut=st.integers(0, 3))
def test_a_damaged_file_is_refused_in_one_line_or_is_a_case(
    tmp_path_factory: pytest.TempPathFactory, data: Any, place: float, put: bytes, cut: int
) -> None:
    text = json.dumps(data, ensure_ascii=False).encode()
    at = round(place * len(text))
    path = tmp_path_factory.getbasetemp() / "damaged.json"
    path.write_bytes(text[:at] + put + text[at + cut :])
    read_or_refused(Case.load, path)
