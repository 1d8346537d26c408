"""Every public name is documented, and what its examples say is true."""

import doctest
import inspect
import pkgutil
from collections.abc import Callable
from functools import cached_property
from importlib import import_module
from pathlib import Path
from types import FunctionType
from typing import Any

import pytest
from numpydoc.docscrape import get_doc_object
from numpydoc.validate import validate

import crossview
import solvers

PACKAGES = [m.name for m in pkgutil.iter_modules(solvers.__path__) if m.ispkg]
ROOMS = [import_module(f"solvers.{name}") for name in PACKAGES] + [solvers, crossview]

EXPORTED: dict[int, tuple[str, Callable[..., Any]]] = {
    id(thing): (f"{room.__name__}.{name}", thing)
    for room in ROOMS
    for name in room.__all__
    if isinstance(thing := getattr(room, name), FunctionType | type)
}
"""Each exported function and class once, with the shortest name to import it by."""

METHOD = {"GL03", "GL06", "GL07", "GL08", "SS01", "SS03", "PR01", "PR02", "PR03", "PR04", "PR07"}
"""What numpydoc must not find in a method: undocumented parameters, an unreadable text."""

PUBLIC = METHOD | {"RT01", "RT03", "EX01"}
"""Nor what is missing in an exported name: what it returns, and examples."""

each_exported = pytest.mark.parametrize(
    "thing", [thing for _, thing in EXPORTED.values()], ids=[name for name, _ in EXPORTED.values()]
)


@each_exported
def test_its_examples_say_what_is_true(
    thing: Callable[..., Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    runner = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS)
    for test in doctest.DocTestFinder().find(thing, thing.__name__, globs={}):
        runner.run(test, out=lambda text: pytest.fail(text, pytrace=False))
    assert runner.tries


@each_exported
def test_it_is_documented(thing: Callable[..., Any]) -> None:
    wrong = {"": faults(thing, PUBLIC)}
    wrong |= {name: faults(member, METHOD) for name, member in members(thing).items()}
    assert not {name: texts for name, texts in wrong.items() if texts}


def test_no_name_hides_a_module() -> None:
    for package in PACKAGES:
        room = import_module(f"solvers.{package}")
        modules = {module.name for module in pkgutil.iter_modules(room.__path__)}
        assert modules.isdisjoint(room.__all__), package


@each_exported
def test_no_property_says_its_type(thing: Callable[..., Any]) -> None:
    """What stands before a colon in the first line would be taken for one."""
    for name, member in members(thing).items():
        first = (member.__doc__ or "").partition("\n")[0]
        assert not (isinstance(member, property | cached_property) and ":" in first), name


def members(thing: object) -> dict[str, object]:
    """The public methods and properties that a class defines itself."""
    kinds = (FunctionType, classmethod, staticmethod, property, cached_property)
    found = vars(thing) if inspect.isclass(thing) else {}
    public = [k for k, v in found.items() if isinstance(v, kinds) and not k.startswith("_")]
    return {k: getattr(thing, k) for k in public}


def faults(thing: object, codes: set[str]) -> list[str]:
    """What those checks of numpydoc find in a docstring."""
    return [text for code, text in validate(get_doc_object(thing))["errors"] if code in codes]
