"""Opening, saving and exporting: the dialogs, and what they lead to."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

from PySide6.QtWidgets import QFileDialog, QStatusBar, QWidget

from crossview.cases.project import PROJECT, Project
from crossview.export.meshes import write_mesh
from crossview.gui.dialogs import Answer, ask_target, ask_to_save
from crossview.gui.figure import Figure
from crossview.gui.figure_writer import FigureWriter
from crossview.gui.recent import remember
from crossview.gui.recovery import Recovery, Unsaved
from crossview.io import SUFFIXES
from crossview.session.look import Look
from crossview.session.opening import Opening
from crossview.session.session import Session
from crossview.session.state import SessionState
from solvers.errors import CrossviewError

CASES = {PROJECT: "Project, with layers, camera and ranges", ".json": "Case"}
"""Words for the suffixes that a document is saved with."""

FIGURES = {
    ".png": "PNG picture",
    ".svg": "SVG drawing",
    ".pdf": "PDF drawing",
    ".html": "Page that turns",
}
"""Words for suffixes of figures."""

MESHES = {
    ".obj": "Wavefront OBJ",
    ".vtk": "VTK",
    ".vtu": "VTK XML",
    ".ply": "PLY",
    ".gltf": "glTF, as triangles",
    ".glb": "glTF binary, as triangles",
    ".msh": "Gmsh",
}
"""Words for suffixes of quad meshes."""

SAID_MS = 4000
"""How long the status bar says what was written, milliseconds. Chosen."""


class Files:
    """File verbs of a window.

    Parameters
    ----------
    session : Session
    figure : callable
        Returns what a figure would show now; None: nothing.
    look : callable
        Returns how the document is looked at.
    parent : QWidget
        What the dialogs stand over.
    status : QStatusBar
        Says what has been written.
    """

    def __init__(
        self,
        session: Session,
        figure: Callable[[], Figure | None],
        look: Callable[[], Look],
        parent: QWidget,
        status: QStatusBar,
    ) -> None:
        self._session = session
        self._figure = figure
        self._look = look
        self._parent = parent
        self._status = status
        self._source = ""
        self._recovery = Recovery()
        self._writer = FigureWriter(parent)
        self._restored: Unsaved | None = None
        self._inverted_too = False
        self._copies = True
        session.may_leave = self.may_leave

    @property
    def busy(self) -> bool:
        """Whether a figure is still being written."""
        return self._writer.busy

    @property
    def path(self) -> Path | None:
        """The project or case file that the document is of; None: it has none yet."""
        source = Path(self._source)
        return source if source.suffix.lower() in CASES and source.is_file() else None

    @property
    def name(self) -> str:
        """What the document is called; empty while nothing is open."""
        document = self._session.state.document
        if document is None:
            return ""
        return document.name if self.path is None else self.path.stem

    def open(self, target: str) -> None:
        """Open a file, a gallery case or a built-in surface."""
        self._session.open(Opening(target))

    def restore(self, copy: Unsaved) -> None:
        """Open a copy of unsaved work."""
        self._restored = copy
        self._session.open(Opening(str(copy.case), restores=copy.source))

    def opened(self, opening: Opening) -> None:
        """Remember what was opened; among the recent ones, when it is a file."""
        self._source = opening.source
        if Path(self._source).is_file():
            remember(self._source)
        if opening.restores is not None and self._restored is not None:
            self._keep_copy()  # of this window from now on
            self._restored.forget()
            self._restored = None

    def show_state(self, old: SessionState, new: SessionState) -> None:
        """Keep a copy of what is not saved, after each step."""
        if old.document is not new.document or old.kept is not new.kept:
            self._session.attempt("copy", self._keep_copy)

    def reopen(self, component: str | None = None, repair: bool = False) -> None:
        """Open the same again with other choices."""
        self._session.open(Opening(self._source, component, repair))

    def may_leave(self) -> bool:
        """Ask what becomes of unsaved changes, if there are any; False: stay."""
        if not self._session.state.modified:
            return True
        answer = ask_to_save(self._parent, self.name)
        if answer == Answer.Save:
            self.save()
            return not self._session.state.modified
        return answer == Answer.Discard

    def close(self) -> None:
        """Give up the copy of what is not saved; let the last figures be written."""
        self._recovery.clear()
        self._writer.close()

    def ask_open(self) -> None:
        """Ask for a surface or a case and open it."""
        known = (*sorted(SUFFIXES), *CASES, *FIGURES)
        patterns = " ".join(f"*{suffix}" for suffix in known)
        path, _ = QFileDialog.getOpenFileName(
            self._parent,
            "Open a surface or a case",
            self._folder(),
            f"Surfaces, projects, cases and figures ({patterns});;All files (*)",
        )
        if path:
            self.open(path)

    def save(self) -> None:
        """Write the document to its file, or ask for one where there is none."""
        if self.path is None:
            self.ask_save()
        else:
            self.save_to(self.path)

    def ask_save(self) -> None:
        """Ask where to write the document, and write it."""
        suffix = PROJECT if self.path is None else self.path.suffix.lower()
        path = self._ask("Save", suffix, CASES)
        if path is not None:
            self.save_to(path)

    def save_to(self, path: Path) -> None:
        """Write the present document as a project or case, which it is of from now on."""
        document = self._session.state.document
        if document is None:
            return

        def verb() -> None:
            case = document.to_case()
            if path.suffix.lower() == PROJECT:
                Project(case, self._look().to_json()).save(path)
            else:
                case.save(path)
            self._source = str(path)
            remember(self._source)
            self._session.edits.keep()
            self._say("Saved", path, new)

        new = not path.parent.exists()
        self._session.attempt("save", verb)

    def ask_figure(self) -> None:
        """Ask where to write the figure, and write it."""
        path = self._ask("Export the figure", ".png", FIGURES)
        if path is not None:
            self.export(path)

    def export(self, path: Path) -> None:
        """Write what is shown, as it is seen, with the settings of the Export panel.

        The window goes on meanwhile; what is written is what is shown now.
        """
        figure = self._figure()
        if figure is None:
            return
        new = not path.parent.exists()

        def ended(failure: CrossviewError | None) -> None:
            self._status.clearMessage()
            if failure is not None:
                self._session.fail(failure, "export")
            else:
                self._session.update(self._session.state.unsaid("export"))
                self._say("Wrote", path, new)

        self._status.showMessage(f"Writing {path}")
        self._writer.write(figure.packed(path), ended)

    def allow_inverted(self, allowed: bool) -> None:
        """Whether quads are written although some are inverted."""
        self._inverted_too = allowed

    def ask_save_quads(self) -> None:
        """Ask where to write the quads, and write them."""
        path = self._ask("Save the quads", ".obj", MESHES)
        if path is not None:
            self.save_quads(path)

    def save_quads(self, path: Path) -> None:
        """Write the quads that are shown."""
        state = self._session.state
        if state.made.quads is not None and state.document is not None:
            kept = state.document.to_case().files
            made, allowed = state.made.quads, self._inverted_too
            self._write(partial(write_mesh, made, kept=kept, allow_inverted=allowed), path)

    def keep_copies(self, kept: bool) -> None:
        """Whether a copy of unsaved work is kept after each step."""
        self._copies = kept
        self._session.attempt("copy", self._keep_copy)

    def _keep_copy(self) -> None:
        state = self._session.state
        if self._copies and state.document is not None and state.modified:
            self._recovery.keep(state.document, self._source)
        else:
            self._recovery.clear()

    def _write(self, write: Callable[[Path], object], path: Path) -> None:
        """Write a file and say so, or why not."""

        def verb() -> None:
            write(path)
            self._say("Wrote", path, new)

        new = not path.parent.exists()
        self._session.attempt("export", verb)

    def _say(self, done: str, path: Path, new: bool) -> None:
        """Say what was written, and whether its folder was made for it."""
        self._status.showMessage(f"{done} {path}{', in a new folder' if new else ''}", SAID_MS)

    def _ask(self, title: str, suffix: str, kinds: dict[str, str]) -> Path | None:
        suggested = Path(self._folder()) / f"{self.name or 'crossview'}{suffix}"
        return ask_target(self._parent, title, suggested, kinds)

    def _folder(self) -> str:
        return str(Path(self._source).parent) if Path(self._source).is_file() else str(Path.home())
