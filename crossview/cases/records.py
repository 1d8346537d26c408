"""Objects of case files: the keys that a dataclass defines, each in the metadata of its field."""

from __future__ import annotations

import dataclasses
from dataclasses import MISSING, dataclass
from inspect import cleandoc
from pathlib import Path
from typing import Any, TypeVar

from crossview.cases.json_values import JsonField
from crossview.cases.scalars import Number
from crossview.cases.shape import Shape


@dataclass(frozen=True)
class Key:
    """A key of an object in a case file.

    Parameters
    ----------
    shape : Shape
        What its value is like.
    doc : str
        What it is for, in a sentence or two.
    always : bool
        Whether it is written also where its value is the default.
    """

    shape: Shape
    doc: str
    always: bool = False


def key(shape: Shape, doc: str, *, always: bool = False) -> dict[str, Key]:
    """Return the metadata of a dataclass field that makes it a key of case files.

    Parameters
    ----------
    shape, doc, always
        As of `Key`.
    """
    return {"key": Key(shape, doc, always)}


def keys_of(kind: type) -> dict[str, Key]:
    """Return the keys of a dataclass by name, in the order in which they are written."""
    return {field.name: field.metadata["key"] for field in dataclasses.fields(kind)}


def checked(kind: type, name: str, entry: JsonField) -> Any:
    """Return a value from elsewhere, checked as that of a key of a case file is.

    Parameters
    ----------
    kind : type
        The dataclass that has the key.
    name : str
        The key.
    entry : JsonField
        The value, with where it stands.

    Raises
    ------
    CaseError
        It is wrong.
    """
    return keys_of(kind)[name].shape.read(entry, Path())


def check_numbers(made: Any) -> None:
    """Check the numbers of a value made in Python as those of a case file are: 3.0 becomes 3.

    Parameters
    ----------
    made : object
        Of a dataclass with keys, while it is made.

    Raises
    ------
    CaseError
        One is wrong.
    """
    unset = defaults_of(type(made))
    for name, key in keys_of(type(made)).items():
        given = getattr(made, name)
        if isinstance(key.shape, Number) and not (given is None and unset.get(name, 0) is None):
            entry = JsonField(given, name)
            object.__setattr__(made, name, key.shape.read(entry, Path()))


def defaults_of(kind: type) -> dict[str, Any]:
    """Return the default values of a dataclass by name, of the keys that have one."""
    found = {}
    for field in dataclasses.fields(kind):
        if field.default is not MISSING:
            found[field.name] = field.default
        elif field.default_factory is not MISSING:
            found[field.name] = field.default_factory()
    return found


Kind = TypeVar("Kind", bound=type)


def documented(kind: Kind) -> Kind:
    """Put what each key is, and what it is for, into the docstring of a dataclass."""
    by_call = sorted(dataclasses.fields(kind), key=lambda field: field.kw_only is True)
    keys = [(field.name, field.metadata["key"]) for field in by_call]
    lines = [f"{name} : {key.shape.words}\n    {key.doc}" for name, key in keys]
    summary, section, examples = cleandoc(kind.__doc__ or "").partition("\nExamples\n")
    listed = "\n".join(["", "Parameters", "----------", *lines, ""])
    kind.__doc__ = "\n".join([summary.rstrip(), listed]) + section + examples
    return kind


@dataclass(frozen=True)
class Record(Shape):
    """An object whose keys are the fields of a dataclass.

    Parameters
    ----------
    kind : type
        The dataclass; its fields have `key` as metadata, and are required without a default.
    """

    kind: type

    @property
    def words(self) -> str:
        """What it takes, with its article."""
        return f"an object {self.many.partition(' ')[2]}"

    @property
    def many(self) -> str:
        """What several are called."""
        return f"objects {{{', '.join(keys_of(self.kind))}}}"

    def fits(self, value: object) -> bool:
        """Whether it is an object."""
        return isinstance(value, dict)

    def holds(self, value: object) -> bool:
        """Whether it is of the dataclass."""
        return isinstance(value, self.kind)

    def read(self, entry: JsonField, base: Path) -> Any:
        """Return the dataclass; keys that it never had are told with the nearest."""
        keys, optional = keys_of(self.kind), defaults_of(self.kind)
        required = [name for name in keys if name not in optional]
        retired = getattr(self.kind, "RETIRED", ())
        members = entry.object(required, optional, retired)
        return self.kind(**{n: keys[n].shape.read(members[n], base) for n in members})

    def write(self, value: Any, base: Path) -> dict[str, Any]:
        """Return the object, without most keys that have their default."""
        default = defaults_of(self.kind)
        found = {}
        for name, key in keys_of(self.kind).items():
            own = getattr(value, name)
            if key.always or name not in default or own != default[name]:
                found[name] = key.shape.write(own, base)
        return found

    def schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        default = defaults_of(self.kind)
        properties = {}
        for name, key in keys_of(self.kind).items():
            properties[name] = key.shape.schema() | {"description": key.doc}
            if name in default and key.shape.holds(default[name]):
                properties[name]["default"] = key.shape.write(default[name], Path())
        required = [name for name in keys_of(self.kind) if name not in default]
        for name in getattr(self.kind, "RETIRED", ()):
            properties[name] = {"deprecated": True, "description": "Of older files; read over."}
        found: dict[str, Any] = {"type": "object", "properties": properties}
        if required:
            found["required"] = required
        return found | {"additionalProperties": False}
