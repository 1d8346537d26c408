"""The pages of the Python interface."""

from __future__ import annotations

import inspect
import pkgutil
import re
from collections.abc import Iterable
from importlib import import_module

from sphinx.application import Sphinx

import crossview
import solvers


def interface() -> dict[str, str]:
    """The pages of the Python interface by their names: each name is told of once."""
    told = {name: room for room in rooms() for name in import_module(room).__all__}
    pages = {room: [*title(room, "="), f".. automodule:: {room}"] for room in rooms()}
    errors = [name for name in solvers.__all__ if name not in told]
    pages["solvers"] = [
        *title("The rooms of solvers", "="), ".. automodule:: solvers", "   :no-members:", "",
        ".. toctree::", "   :hidden:", "", *(f"   {room}" for room in rooms()), "",
        *title("Errors, remedies and progress", "-"), *entries("solvers", errors),
    ]  # fmt: skip
    told |= dict.fromkeys(errors, "solvers")
    verbs = [name for name in crossview.__all__ if inspect.isfunction(getattr(crossview, name))]
    verbs.sort(key=lambda name: getattr(crossview, name).__code__.co_firstlineno)
    values = [name for name in crossview.__all__ if name not in verbs and name not in told]
    values.remove("primitives")
    also = [f":obj:`~{told[n]}.{n}`" for n in crossview.__all__ if n in told and n not in verbs]
    pages["python"] = [
        *title("Python", "="), ".. automodule:: crossview", "   :no-members:", "",
        f"It also has {', '.join(also)} and, in ``crossview.primitives``, :mod:`surfaces made by",
        "functions <solvers.primitives>`.", "",
        *title("Verbs", "-"), *entries("crossview", verbs),
        *title("Values", "-"), *entries("crossview", values),
        *title("Options of figures", "-"), *entries("crossview.export.figures", ["render"]),
    ]  # fmt: skip
    return {name: "\n".join(lines) + "\n" for name, lines in pages.items()}


def rooms() -> tuple[str, ...]:
    """The packages of `solvers`."""
    return tuple(
        f"solvers.{room.name}" for room in pkgutil.iter_modules(solvers.__path__) if room.ispkg
    )


def title(text: str, line: str) -> list[str]:
    """A title or a heading."""
    return [text, line * len(text), ""]


def entries(module: str, names: Iterable[str]) -> list[str]:
    """What is said of some names of a module."""

    def kind(name: str) -> str:
        value = getattr(import_module(module), name)
        if inspect.isfunction(value):
            return "function"
        return "exception" if issubclass(value, Exception) else "class"

    return [*(f".. auto{kind(name)}:: {module}.{name}" for name in names), ""]


def plain(
    app: Sphinx, what: str, name: str, obj: object, options: object, lines: list[str]
) -> None:
    """Take the bars of |x| in a docstring as they are, but for examples and code."""
    example = False
    for number, line in enumerate(lines):
        if line.lstrip().startswith(":type"):  # choices are no names to link
            line = lines[number] = re.sub(r"\{.*?\}", r"``\g<0>``", line)
        example = line.lstrip().startswith(">>>") or (example and bool(line.strip()))
        if not example and "`" not in line:
            lines[number] = line.replace("|", r"\|")
