"""The verbs of the window: each changes the document or the state, and the background follows."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Any

from PySide6.QtCore import QObject, Signal

from crossview.gui.guiding import Guiding
from crossview.gui.marking import Marks
from crossview.gui.meshing import Meshing
from crossview.gui.moves import Moves
from crossview.gui.pairs import Pairs
from crossview.gui.solving import Solving
from crossview.gui.state import Faulty, ShowWhere
from crossview.gui.store import Store
from crossview.gui.trials import Trials
from crossview.scene import Elements
from crossview.session.commands import (
    AddSingularities,
    ChangeValence,
    ChooseMethod,
    Command,
    LockSingularity,
    RemoveSingularities,
    next_valence,
)
from crossview.session.document import Document
from crossview.session.history import History
from crossview.session.mending import mend
from crossview.session.opening import Opening, open_target, read_triangles
from crossview.workflow.quads import MeshOptions
from solvers.remedies import MakeValid, Remedy, RepairSurface, TakeLargest
from solvers.singularities.budget import Singularity
from solvers.surface.points import SurfacePoint
from solvers.surface.triangulation import FloatArray, IntArray


class Workspace(Store):
    """Document, history, background and what is shown, behind verbs; computes nothing itself."""

    opened = Signal(object)
    """A Document was opened by the user, not brought back by undo."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._history = History()
        self.solving = Solving(self)
        self.trials = Trials(self, self.solving, self.do)
        self.moves = Moves(self, self.solving, self.do)
        self.marks = Marks(self, self.do)
        self.guiding = Guiding(self)
        self.pairs = Pairs(self, self.solving, self.do)
        self.meshing = Meshing(self, self.solving)

    def close(self) -> None:
        """End the background thread."""
        self.guiding.close()
        self.solving.close()

    def open(self, target: str, component: str | None = None, repair: bool = False) -> None:
        """Open a file, gallery case or built-in surface in the background.

        Parameters
        ----------
        target : str
            As of `Opening`.
        component : str, optional
            Which piece to take of a surface in several.
        repair : bool
            Also mend what cannot be mended without changing the surface.
        """
        self._open(Opening(target, component, repair))

    def do(self, command: Command) -> None:
        """Make one undoable change."""
        self._history.do(command)
        self._document_changed()

    def undo(self) -> None:
        """Take the last step back."""
        self._history.undo()
        self._document_changed()

    def redo(self) -> None:
        """Make the last undone step again."""
        self._history.redo()
        self._document_changed()

    def select(self, index: int | None, both: bool = False) -> None:
        """Select singularity `index`; with `both` the one selected before stays selected too."""
        before = self.state.selected if both and index != self.state.selected else None
        self.set(selected=index, partner=before)

    def take_tool(self, valence: int) -> None:
        """Take the tool that adds a valence, or put it back when it is in hand."""
        taken = None if self.state.tool == valence else valence
        self.set(tool=taken, trial=None, mark_tool=None)

    def put_tool_back(self) -> None:
        """Take the select tool."""
        self.set(tool=None, trial=None, mark_tool=None)

    def add(self, point: SurfacePoint, valence: int) -> None:
        """Add a singularity at `point` of the shown surface and select it."""
        document = self.state.document
        if document is not None:
            added = Singularity(self.state.lifted(point), valence)
            self.do(AddSingularities((added,)))
            self.set(selected=len(document.singularities))

    def change_valence(self, index: int, valence: int) -> None:
        """Give singularity `index` another valence; 4 is regular and not taken."""
        if valence not in (4, self.state.singularities[index].valence):
            self.do(ChangeValence(index, valence))

    def step_valence(self, index: int, step: int) -> None:
        """Raise or lower the valence by one, past 4."""
        self.change_valence(index, next_valence(self.state.singularities[index].valence, step))

    def toggle_lock(self, index: int) -> None:
        """Lock singularity `index`, or unlock it."""
        self.do(LockSingularity(index, not self.state.singularities[index].locked))

    def remove(self, *indices: int) -> None:
        """Delete singularities."""
        self.do(RemoveSingularities(frozenset(indices)))

    def carry_out(self, remedy: Remedy, tried: Opening | MeshOptions | None = None) -> None:
        """Do what a button of a message or of the validity panel says.

        Parameters
        ----------
        remedy : Remedy
        tried : Opening, MeshOptions or None
            What has failed: a file is opened again, quads are made afterwards.
        """
        match remedy:
            case RepairSurface() if isinstance(tried, Opening):
                self._open(replace(tried, repair=True))
            case TakeLargest() if isinstance(tried, Opening):
                self._open(replace(tried, component="largest"))
            case ShowWhere(elements=elements) if isinstance(tried, Opening):
                self._locate(tried.target, elements)
            case MakeValid():
                self.moves.make_valid()
            case _:
                self._mend(remedy)
        if isinstance(tried, MeshOptions):
            self.meshing.wait_for(tried)

    def _mend(self, remedy: Remedy) -> None:
        document = self.state.document
        if document is not None:
            job = partial(mend, document, remedy)
            self.solving.run(job, self.do, lambda error: self.fail(error, "edit"))

    def choose_method(self, method: str) -> None:
        """Solve by another method; the last result of each is kept."""
        document = self.state.document
        if document is not None and document.problem.method != method:
            self.do(ChooseMethod(method))

    def compare(self) -> None:
        """Show the error density of the start, or of the result again, on the same range."""
        comparing = not self.state.comparing
        layers = self.state.with_layer("error", visible=True).layers
        self.set(comparing=comparing, layers=layers)

    def set_layer(self, name: str, **changes: Any) -> None:
        """Change settings of one layer."""
        self.set(layers=self.state.with_layer(name, **changes).layers)
        if not self.state.layers["layout"].visible:
            self.clear_message("layout")
        self.solving.pursue()

    def toggle_layer(self, name: str) -> None:
        """Show or hide a layer."""
        self.set_layer(name, visible=not self.state.layers[name].visible)

    def _open(self, opening: Opening) -> None:
        def failed(error: Exception) -> None:
            self.fail(error, "open", opening)
            self.solving.resume()

        self.solving.run(partial(open_target, opening), self._open_document, failed)

    def _locate(self, target: str, elements: Elements) -> None:
        """Show what could not be opened, the offending elements pointed out."""
        message = self.state.message

        def show(triangles: tuple[FloatArray, IntArray]) -> None:
            if message is not None and message is self.state.message:
                left = tuple(r for r in message.remedies if not isinstance(r, ShowWhere))
                faulty = Faulty(*triangles, elements)
                self.set(message=replace(message, remedies=left, faulty=faulty))
            self.solving.resume()

        self.solving.run(
            partial(read_triangles, target), show, lambda failure: self.fail(failure, "open")
        )

    def _open_document(self, document: Document) -> None:
        self._history.open(document)
        for cause in ("open", "save", "export"):
            self.clear_message(cause)
        self._document_changed()
        self.opened.emit(document)

    def _document_changed(self) -> None:
        """Bring everything in line with the present document of the history."""
        document, state = self._history.document, self.state
        changes: dict[str, Any] = {
            "document": document,
            "trial": None,
            "feature_trial": None,
            "partner": None,
            "hovered": None,
            "undo_name": self._history.undo_name,
            "redo_name": self._history.redo_name,
        }
        if state.selected is not None and (
            document is None or state.selected >= len(document.singularities)
        ):
            changes["selected"] = None
        before = None if state.document is None else state.document.surface
        if document is None or document.surface is not before:
            gone = (
                "base",
                "solution",
                "field",
                "start",
                "cut_graph",
                "selected",
                "condition",
                "pinned",
            )
            changes |= dict.fromkeys((*gone, "mark_tool"))
        elif not document.budget.satisfied:
            changes |= {"solution": None, "field": None, "start": None, "cut_graph": None}
        self.clear_message("edit")
        self.clear_message("mesh")
        self.clear_message("layout")
        self.set(**changes)
        self.solving.follow()
