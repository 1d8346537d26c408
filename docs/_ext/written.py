"""What the program writes of its documentation, into docs/written/.

The gallery and its numbers, the actions of the window, the commands, the interface of the rooms.
"""

from __future__ import annotations

import inspect
import json
import pkgutil
import re
from collections.abc import Iterable
from importlib import import_module
from pathlib import Path

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.errors import ExtensionError

import crossview
import solvers
from crossview.cases.gallery import names
from crossview.cli import app as command_line
from crossview.cli import main
from crossview.gui.action_table import ACTIONS
from tools.documents import run_examples

FOLDER = "written"

ILLUSTRATED = ("tutorial.md", "howto/figures.md", "howto/plates.md")
"""Pages that show the pictures which their examples draw."""


def write(app: Sphinx) -> None:
    """Write everything anew, but for pictures that are there (`make clean` forgets them)."""
    folder = Path(app.srcdir) / FOLDER
    folder.mkdir(exist_ok=True)
    if not (folder / "gallery").exists():
        draw(folder)
    (folder / "actions.md").write_text(actions(), encoding="utf-8")
    (folder / "commands.md").write_text(commands(), encoding="utf-8")
    (folder / "numbers.md").write_text(numbers(folder / "gallery"), encoding="utf-8")
    for name, page in interface().items():
        (folder / f"{name}.rst").write_text(page, encoding="utf-8")


def draw(folder: Path) -> None:
    """Solve and draw the gallery, and what the examples of pages draw."""
    for page in ILLUSTRATED:
        pictures = folder / Path(page).stem
        pictures.mkdir(exist_ok=True)
        run_examples(folder.parent / page, pictures)
    for layer in ("H", "theta", "cut"):
        layers = f"surface,{layer},singularities,legend,axes"
        target = folder / f"closed-H-{layer}.png"
        run("render", "closed-H", "-o", str(target), "--layers", layers)
    for name in ("suboptimal-a", "suboptimal-b", "suboptimal-c"):
        layers = "H,separatrices,marks,singularities,boundary,legend"
        target = folder / f"{name}.png"
        run("render", name, "-o", str(target), "--layers", layers, "--size", "1600x720")
    run("gallery", "-o", str(folder / "gallery"))


def run(command: str, *options: str) -> None:
    """Run a command of crossview."""
    if main([command, "--quiet", *options]) != 0:
        raise ExtensionError(f"crossview {command} {' '.join(options)} failed")


def actions() -> str:
    """The window's actions, a table for each menu."""
    said = []
    for menu in dict.fromkeys(action.menu for action in ACTIONS):
        rows = [
            (
                f"{action.submenu} › {action.text}" if action.submenu else action.text,
                " ".join(f"{{kbd}}`{key}`" for key in action.keys),
                action.tip,
            )
            for action in ACTIONS
            if action.menu == menu
        ]
        said += [f"## {menu}", *table(("action", "keys", "what it does"), rows), ""]
    return "\n".join(said)


def commands() -> str:
    """The commands as they describe themselves."""
    text = command_line.generate_docs(output_format="markdown", usage_name="crossview")
    _, _, text = text.partition("\n")  # its title
    text = re.sub(r"## Table of Contents\n.*?(?=\*\*Commands)", "", text, flags=re.DOTALL)
    return text.replace(" *[default: False]*", "").replace("```console", "```text")


def rooms() -> tuple[str, ...]:
    """The packages of `solvers`."""
    return tuple(
        f"solvers.{room.name}" for room in pkgutil.iter_modules(solvers.__path__) if room.ispkg
    )


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
    ]  # fmt: skip
    return {name: "\n".join(lines) + "\n" for name, lines in pages.items()}


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


def numbers(folder: Path) -> str:
    """What the gallery's reports say, in the order of the names."""
    rows = []
    for name in names():
        report = json.loads((folder / name / "report.json").read_text(encoding="utf-8"))
        defects = [abs(c["defect_degrees"]) for c in report["holonomy"]]
        quads = report.get("quads")
        rows.append(
            (
                f"`{name}`",
                report["method"],
                f"{max(defects, default=0):.2g}°" if defects else "none",
                f"{report['energy_final']:.1e}",
                str(report["layout"]["t_junctions"]),
                report["verdict"],
                "" if quads is None else f"{quads['quads']} in {quads['patches']} patches",
            )
        )
    head = ("case", "method", "largest defect", "E", "T-junctions", "verdict", "quads")
    return "\n".join(table(head, rows))


def table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> list[str]:
    """A table as lines of Markdown."""
    head = list(head)
    lines = [head, ["---"] * len(head), *rows]
    return ["| " + " | ".join(cell.replace("|", r"\|") for cell in line) + " |" for line in lines]


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


def linked(app: Sphinx, tree: nodes.document) -> None:
    """Let pictures fill the width that they have; Sphinx links what is scaled to the whole."""
    for image in tree.findall(nodes.image):
        image["width"] = "100%"


def setup(app: Sphinx) -> dict[str, bool]:
    """Write before Sphinx reads."""
    app.connect("builder-inited", write)
    app.connect("doctree-read", linked)
    app.connect("autodoc-process-docstring", plain, priority=900)  # after napoleon
    return {"parallel_read_safe": True, "parallel_write_safe": True}
