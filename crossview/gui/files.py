"""Opening, saving and exporting: the dialogs, and what they lead to."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

from PySide6.QtWidgets import QFileDialog, QStatusBar, QWidget

from crossview.export.meshes import write_mesh
from crossview.gui.figure import Figure
from crossview.gui.recent import remember
from crossview.io import SUFFIXES
from crossview.session.document import Document
from crossview.session.session import Session

FIGURES = "PNG picture (*.png);;SVG drawing (*.svg);;PDF drawing (*.pdf)"
"""Kinds of figures, as file dialogs want them."""

MESHES = ";;".join(
    f"{title} (*{suffix})"
    for title, suffix in (
        ("Wavefront OBJ", ".obj"),
        ("VTK", ".vtk"),
        ("VTK XML", ".vtu"),
        ("PLY", ".ply"),
        ("glTF, as triangles", ".gltf"),
        ("glTF binary, as triangles", ".glb"),
        ("Gmsh", ".msh"),
    )
)
"""Kinds of quad meshes, likewise."""

SAID_MS = 4000
"""How long the status bar says what was written, milliseconds. Chosen."""


class Files:
    """File verbs of a window.

    Parameters
    ----------
    session : Session
    figure : callable
        Returns what a figure would show now; None: nothing.
    parent : QWidget
        What the dialogs stand over.
    status : QStatusBar
        Says what has been written.
    """

    def __init__(
        self,
        session: Session,
        figure: Callable[[], Figure | None],
        parent: QWidget,
        status: QStatusBar,
    ) -> None:
        self._session = session
        self._figure = figure
        self._parent = parent
        self._status = status
        self._target = ""
        self._asked = ""

    def open(self, target: str) -> None:
        """Open a file, a gallery case or a built-in surface."""
        self._asked = target
        self._session.open(target)

    def opened(self, document: Document) -> None:
        """Remember what was opened; among the recent ones, when it is a file."""
        self._target = self._asked
        if Path(self._target).is_file():
            remember(self._target)

    def reopen(self, component: str | None = None, repair: bool = False) -> None:
        """Open the same again with other choices."""
        self._asked = self._target
        self._session.open(self._target, component, repair)

    def ask_open(self) -> None:
        """Ask for a surface or a case and open it."""
        patterns = " ".join(f"*{suffix}" for suffix in sorted(SUFFIXES))
        path, _ = QFileDialog.getOpenFileName(
            self._parent,
            "Open a surface or a case",
            self._folder(),
            f"Surfaces and cases ({patterns} *.json);;All files (*)",
        )
        if path:
            self.open(path)

    def ask_save(self) -> None:
        """Ask where to write the case, and write it."""
        path, _ = QFileDialog.getSaveFileName(
            self._parent, "Save the case", self._suggested(".json"), "Cases (*.json)"
        )
        if path:
            self.save(Path(path))

    def save(self, path: Path) -> None:
        """Write the present document as a case file."""
        document = self._session.state.document
        if document is not None:
            self._session.attempt("save", lambda: document.to_case().save(path))

    def ask_figure(self) -> None:
        """Ask where to write the figure, and write it."""
        path, _ = QFileDialog.getSaveFileName(
            self._parent, "Export the figure", self._suggested(".png"), FIGURES
        )
        if path:
            self.export(Path(path))

    def export(self, path: Path) -> None:
        """Write what is shown, as it is seen, with the settings of the Export panel."""
        figure = self._figure()
        if figure is not None:
            self._write(figure.write, path)

    def ask_save_quads(self) -> None:
        """Ask where to write the quads, and write them."""
        path, _ = QFileDialog.getSaveFileName(
            self._parent, "Save the quads", self._suggested(".obj"), MESHES
        )
        if path:
            self.save_quads(Path(path))

    def save_quads(self, path: Path) -> None:
        """Write the quads that are shown."""
        quads = self._session.state.made.quads
        if quads is not None:
            self._write(partial(write_mesh, quads), path)

    def _write(self, write: Callable[[Path], object], path: Path) -> None:
        """Write a file and say so, or why not."""

        def verb() -> None:
            write(path)
            self._status.showMessage(f"Wrote {path}", SAID_MS)

        self._session.attempt("export", verb)

    def _folder(self) -> str:
        return str(Path(self._target).parent) if Path(self._target).is_file() else str(Path.home())

    def _suggested(self, suffix: str) -> str:
        document = self._session.state.document
        name = "crossview" if document is None else document.name
        return str(Path(self._folder()) / f"{name}{suffix}")
