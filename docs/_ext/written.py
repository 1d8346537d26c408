"""What the program writes of its documentation, into docs/written/."""

from __future__ import annotations

from pathlib import Path

from docutils import nodes
from sphinx.application import Sphinx

from .interface import interface, plain
from .pictures import draw
from .tables import actions, commands, numbers

FOLDER = "written"


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
