"""What the program writes of its documentation, into docs/written/.

The gallery and its numbers, the actions of the window, the commands, the interface of the rooms.
"""

from __future__ import annotations

import json
import pkgutil
import re
from collections.abc import Iterable
from importlib import import_module
from pathlib import Path

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.errors import ExtensionError

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
    for room in rooms():
        (folder / f"{room}.rst").write_text(interface(room), encoding="utf-8")


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
    """`solvers` and its packages, as a reader meets them."""
    packages = (room.name for room in pkgutil.iter_modules(solvers.__path__) if room.ispkg)
    return ("solvers", *(f"solvers.{name}" for name in packages))


def interface(room: str) -> str:
    """The page of a room: all that it exports, but for what has a place in a room of its own."""
    inner = (import_module(other) for other in rooms() if other.startswith(f"{room}."))
    placed = {name for package in inner for name in package.__all__}
    page = f"{room}\n{'=' * len(room)}\n\n.. automodule:: {room}\n"
    if again := sorted(placed.intersection(import_module(room).__all__)):
        page += f"   :exclude-members: {', '.join(again)}\n"
    return page


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
