"""The verbs of the window: each changes the document or the state, and the background follows."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from PySide6.QtCore import QObject, Signal

from crossview.gui.guiding import Guiding
from crossview.gui.marking import Marks
from crossview.gui.meshing import Meshing
from crossview.gui.moves import Moves
from crossview.gui.pairs import Pairs
from crossview.gui.solving import Solving
from crossview.gui.store import Store
from crossview.gui.trials import Trials
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
from crossview.session.hand import AddTool, SelectTool
from crossview.session.history import History
from crossview.session.mending import mend
from crossview.session.message import Faulty, ShowWhere
from crossview.session.opening import Opening, open_target, read_triangles
from crossview.view.scene_view import LayerSettings
from crossview.view.values import Elements
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
        self.update(self.state.focused(self.state.focus.on(index, both=both)))

    def choose(self, index: int) -> None:
        """Select singularity `index` beside one that may be selected already."""
        self.update(self.state.focused(replace(self.state.focus, selected=index)))

    def hover(self, index: int | None) -> None:
        """Tell that singularity `index` is under the mouse."""
        self.update(self.state.focused(replace(self.state.focus, hovered=index)))

    def point_out(self, condition: int | None) -> None:
        """Point out the loop of a holonomy condition."""
        self.update(self.state.focused(replace(self.state.focus, condition=condition)))

    def toggle_pin(self, condition: int) -> None:
        """Let the guide keep to a holonomy condition, or no longer."""
        pinned = None if self.state.focus.pinned == condition else condition
        self.update(self.state.focused(replace(self.state.focus, pinned=pinned)))

    def take_tool(self, valence: int) -> None:
        """Take the tool that adds a valence, or put it back when it is in hand."""
        held = self.state.added_valence == valence
        self.update(self.state.tool_taken(SelectTool() if held else AddTool(valence)))

    def choose_valence(self, valence: int) -> None:
        """Let the tool "any valence" carry another; in hand, it does so at once."""
        self.update(self.state.any_valence_chosen(valence))

    def put_tool_back(self) -> None:
        """Take the select tool."""
        self.update(self.state.tool_taken(SelectTool()))

    def add(self, point: SurfacePoint, valence: int) -> None:
        """Add a singularity at `point` of the shown surface and select it."""
        document = self.state.document
        if document is not None:
            added = Singularity(self.state.lifted(point), valence)
            self.do(AddSingularities((added,)))
            self.choose(len(document.singularities))

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
        state = self.state.with_layer_shown("error")
        self.update(replace(state, comparing=not state.comparing))

    def set_layer(self, name: str, settings: LayerSettings) -> None:
        """Draw one layer otherwise."""
        self.update(self.state.with_layer(name, settings))
        if not self.state.layers["layout"].visible:
            self.update(self.state.unsaid("layout"))
        self.solving.pursue()

    def toggle_layer(self, name: str) -> None:
        """Show or hide a layer."""
        layer = self.state.layers[name]
        self.set_layer(name, replace(layer, visible=not layer.visible))

    def toggle_dark(self) -> None:
        """Draw on a dark background, or on white again."""
        self.update(replace(self.state, dark=not self.state.dark))

    def toggle_along_curvature(self) -> None:
        """Draw the crosses of natural singularities towards the directions of curvature, or not."""
        self.update(replace(self.state, along_curvature=not self.state.along_curvature))

    def show_poor(self, shown: bool) -> None:
        """Point out the poor triangles."""
        self.update(replace(self.state, poor=shown))

    def dismiss(self) -> None:
        """Take the message away."""
        self.update(self.state.said(None))

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
                said = replace(message, remedies=left, faulty=faulty)
                self.update(self.state.said(said))
            self.solving.resume()

        self.solving.run(
            partial(read_triangles, target), show, lambda failure: self.fail(failure, "open")
        )

    def _open_document(self, document: Document) -> None:
        self._history.open(document)
        self.update(self.state.unsaid("open", "save", "export"))
        self._document_changed()
        self.opened.emit(document)

    def _document_changed(self) -> None:
        """Bring everything in line with the present document of the history."""
        history = self._history
        self.update(
            self.state.document_changed(history.document, history.undo_name, history.redo_name)
        )
        self.solving.follow()
