"""The README's case solves, and its tables say what is there."""

import inspect
import json
import re
from pathlib import Path

import pytest

from crossview.cases.model import Case
from crossview.cases.schema import table
from crossview.io import SUFFIXES
from crossview.workflow.pipeline import solve_case
from solvers.primitives import BUILTIN
from solvers.progress import run

README = (Path(__file__).resolve().parents[1] / "README.md").read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    """The examples in a language, in their order."""
    return re.findall(rf"```{language}\n(.*?)```", README, re.DOTALL)


def test_the_case_example_solves() -> None:
    (text,) = blocks("json")
    (solution,) = run(solve_case(Case.from_json(json.loads(text))))
    assert solution.field.index_sum == solution.field.index_required
    assert [s.locked for s in solution.singularities] == [False, True]


def test_the_keys_of_a_case_are_those_that_are_read() -> None:
    assert f"\n\n{table()}\n\n" in README, "make keys"


@pytest.mark.parametrize("name", BUILTIN)
def test_built_in_surfaces_are_listed_with_their_parameters(name: str) -> None:
    (row,) = re.findall(rf"^\| `{name}` \|.*\| (.*) \|$", README, re.MULTILINE)
    listed = dict(re.findall(r"`(\w+)` (\S+?)(?:,|$)", row.replace("(a pentagon)", "pentagon")))
    parameters = inspect.signature(BUILTIN[name]).parameters
    assert list(listed) == list(parameters)
    for key, text in listed.items():
        if key != "outer" and text != "[]":
            assert float(text) == parameters[key].default


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_file_formats_are_named(suffix: str) -> None:
    known = {".gltf": "glTF", ".obj": "OBJ", ".msh": "MSH"}.get(suffix, suffix[1:].upper())
    assert known in README
