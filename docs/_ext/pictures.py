"""The pictures of the documentation: drawn by the program, and by the examples of its pages."""

from __future__ import annotations

import contextlib
import runpy
from pathlib import Path

import matplotlib
from sphinx.errors import ExtensionError

from crossview.cli import main
from tools.documents import run_examples

ILLUSTRATED = ("tutorial.md", "howto/figures.md", "howto/plates.md")
"""Pages that show the pictures which their examples draw."""


def draw(folder: Path) -> None:
    """Solve and draw the gallery, and what the examples of pages draw."""
    for page in ILLUSTRATED:
        pictures = folder / Path(page).stem
        pictures.mkdir(exist_ok=True)
        run_examples(folder.parent / page, pictures)
    (folder / "examples").mkdir(exist_ok=True)
    matplotlib.use("agg")
    for script in sorted((folder.parent.parent / "examples").glob("*.py")):
        with contextlib.chdir(folder / "examples"):
            runpy.run_path(str(script))
    run("gallery", "-o", str(folder / "gallery"))


def run(command: str, *options: str) -> None:
    """Run a command of crossview."""
    if main([command, "--quiet", *options]) != 0:
        raise ExtensionError(f"crossview {command} {' '.join(options)} failed")
