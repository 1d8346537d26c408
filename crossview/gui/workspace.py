"""The verbs of the window: each changes the one state, and the background follows."""

from __future__ import annotations

import traceback
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

from PySide6.QtCore import QObject, Signal

from crossview.gui.background import Background
from crossview.gui.state import Message, MessageAction, Trial, WindowState
from crossview.pipeline import Pipeline, Solution
from crossview.session.commands import (
    AddSingularities,
    ChangeValence,
    Command,
    LockSingularity,
    MoveSingularity,
    RemoveSingularities,
    next_valence,
)
from crossview.session.document import Document
from crossview.session.history import History
from crossview.session.live import LiveBase, LiveEdit, cut, prepare, solve
from crossview.session.mending import Mending
from crossview.session.opening import open_target
from solvers.errors import CrossviewError, SurfaceError
from solvers.points import SurfacePoint
from solvers.singularities import Singularity


class Workspace(QObject):
    """Document, history, background and what is shown, behind verbs.

    Emits `changed(old, new)` after every change of state; never computes anything heavy itself.
    """

    changed = Signal(object, object)
    opened = Signal(object)
    """A Document was opened by the user, not brought back by undo."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._state = WindowState()
        self._history = History()
        self._pipeline = Pipeline()
        self._background = Background(self)
        self._background.progressed.connect(lambda progress: self.set(progress=progress))
        self._background.stopped.connect(self._stopped)

    @property
    def state(self) -> WindowState:
        """What the window shows now."""
        return self._state

    @property
    def busy(self) -> bool:
        """Whether the background still works on something."""
        return self._background.busy

    def set(self, **changes: Any) -> None:
        """Change fields of the state; nothing happens when none differs."""
        old = self._state
        if any(getattr(old, name) is not value for name, value in changes.items()):
            self._state = replace(old, **changes)
            self.changed.emit(old, self._state)

    def close(self) -> None:
        """End the background thread."""
        self._background.close()

    # ---- opening -------------------------------------------------------------------------------

    def open(self, target: str, component: str | None = None, repair: bool = False) -> None:
        """Open a file, gallery case or built-in surface in the background.

        Parameters
        ----------
        target : str
            As for `open_target`.
        component : str, optional
            Which piece to take of a surface in several.
        repair : bool
            Also mend what cannot be mended without changing the surface.
        """
        offers = (
            ("choose the largest", "Use the largest piece", ("largest", repair)),
            ("repair the surface", "Repair", (component, True)),
        )

        def failed(error: Exception) -> None:
            remedy = error.remedy if isinstance(error, SurfaceError) else ""
            actions = tuple(
                MessageAction(label, partial(self.open, target, *choices))
                for start, label, choices in offers
                if remedy.startswith(start)
            )
            self._fail(error, "open", actions)

        self._submit(
            lambda: open_target(target, component=component, repair=repair),
            self._open_document,
            failed,
        )

    def _open_document(self, document: Document) -> None:
        self._history.open(document)
        self._clear_message("open")
        self._document_changed()
        self.opened.emit(document)
        if document.problem.notes:
            notes = "; ".join(document.problem.notes)
            self.set(message=Message(notes, "edit", "info"))

    # ---- editing -------------------------------------------------------------------------------

    def do(self, command: Command) -> None:
        """Make one undoable change."""
        self._history.do(command)
        self._clear_message("edit")
        self._document_changed()

    def add(self, point: SurfacePoint, valence: int) -> None:
        """Add a singularity at `point` of the shown surface and select it."""
        document = self._state.document
        if document is None:
            return
        self.set(trial=None)
        self.do(AddSingularities((Singularity(self._lifted(point), valence),)))
        self.set(selected=len(document.singularities))

    def change_valence(self, index: int, valence: int) -> None:
        """Give singularity `index` another valence; 4 is regular and not taken."""
        if valence not in (4, self._singularity(index).valence):
            self.do(ChangeValence(index, valence))

    def step_valence(self, index: int, step: int) -> None:
        """Raise or lower the valence by one, past 4."""
        self.change_valence(index, next_valence(self._singularity(index).valence, step))

    def toggle_lock(self, index: int) -> None:
        """Lock singularity `index`, or unlock it."""
        self.do(LockSingularity(index, not self._singularity(index).locked))

    def remove(self, *indices: int) -> None:
        """Delete singularities."""
        if indices:
            self.do(RemoveSingularities(frozenset(indices)))

    def undo(self) -> None:
        """Take the last step back."""
        self._history.undo()
        self._clear_message("edit")
        self._document_changed()

    def redo(self) -> None:
        """Make the last undone step again."""
        self._history.redo()
        self._clear_message("edit")
        self._document_changed()

    def mend(self, mending: Mending) -> None:
        """Carry out an offer of the validity panel."""
        self._submit(mending.make, self.do, lambda error: self._fail(error, "edit"))

    def _singularity(self, index: int) -> Singularity:
        return self._state.singularities[index]

    def _lifted(self, point: SurfacePoint) -> SurfacePoint:
        base = self._state.base
        return point if base is None else base.lift(point)

    # ---- trying out, while the mouse moves -------------------------------------------------------

    def preview(self, point: SurfacePoint | None) -> None:
        """Show what a click of the add tool at `point` of the shown surface would do."""
        document, valence = self._state.document, self._state.tool
        if point is None or document is None or valence is None:
            self.set(trial=None)
            return
        added = Singularity(self._lifted(point), valence)
        edit = self._live_edit(document)
        if edit is not None:
            edit = edit.added(Singularity(point, valence))
        singularities = (*document.singularities, added)
        self.set(trial=Trial(singularities, len(singularities) - 1, point, edit, drag=False))

    def start_drag(self, index: int) -> bool:
        """Take hold of singularity `index`; False when it is locked."""
        document = self._state.document
        if document is None or document.singularities[index].locked:
            return False
        point = document.singularities[index].point
        base = self._state.base
        placed = point if base is None else base.locate(point)
        trial = Trial(document.singularities, index, placed, self._live_edit(document), drag=True)
        self.set(trial=trial, selected=index)
        return True

    def drag_to(self, point: SurfacePoint) -> None:
        """Move the held singularity to `point` of the shown surface; the field follows."""
        trial = self._state.trial
        if trial is None or not trial.drag:
            return
        moved = list(trial.singularities)
        moved[trial.index] = replace(moved[trial.index], point=self._lifted(point))
        edit = None if trial.edit is None else trial.edit.moved(trial.index, point)
        self.set(trial=replace(trial, singularities=tuple(moved), placed=point, edit=edit))
        if edit is not None and self._state.field is not None:
            self._background.submit(edit.solve, self._show_live, lambda error: None)

    def drop(self) -> None:
        """Let go: the whole drag becomes one step, and the refined field is solved."""
        trial, document = self._state.trial, self._state.document
        if trial is None or document is None or not trial.drag:
            return
        self.set(trial=None)
        self.do(MoveSingularity(trial.index, trial.singularities[trial.index].point))

    def cancel_drag(self) -> None:
        """Let go and put it back."""
        if self._state.trial is not None and self._state.trial.drag:
            self.set(trial=None)
            self._document_changed()

    def _live_edit(self, document: Document) -> LiveEdit | None:
        base = self._state.base
        return None if base is None else LiveEdit.start(document, base)

    def _show_live(self, field: Any) -> None:
        self.set(field=field, cut_graph=None)

    # ---- layers ---------------------------------------------------------------------------------

    def set_layer(self, name: str, **changes: Any) -> None:
        """Change settings of one layer."""
        self.set(layers=self._state.with_layer(name, **changes).layers)
        self._cut_if_wanted()

    def _cut_if_wanted(self) -> None:
        solution, state = self._state.solution, self._state
        if solution is None or state.cut_graph is not None or not state.layers["cut"].visible:
            return
        if not self.busy:  # else it is asked again when the solution has come
            self._submit(
                lambda: cut(solution),
                lambda edges: self.set(cut_graph=edges),
                lambda error: self._fail(error, "solve"),
            )

    # ---- solving -------------------------------------------------------------------------------

    def solve(self) -> None:
        """Solve the present document with refinement."""
        document = self._state.document
        if document is not None and document.budget.satisfied:
            problem = document.problem
            self._submit(
                lambda: solve(self._pipeline, problem),
                self._show_solution,
                self._solve_failed,
            )

    def stop(self) -> None:
        """Stop the background; what is shown stays."""
        self._background.stop()

    def _stopped(self) -> None:
        self.set(message=Message("Stopped; the last field is kept", "solve", "info"))

    def _document_changed(self) -> None:
        """Bring everything in line with the present document of the history."""
        document, state = self._history.document, self._state
        self._background.forget()
        self._clear_message("solve")
        same = (
            document is not None
            and state.document is not None
            and document.surface is state.document.surface
        )
        count = 0 if document is None else len(document.singularities)
        changes: dict[str, Any] = {
            "document": document,
            "trial": None,
            "undo_name": self._history.undo_name,
            "redo_name": self._history.redo_name,
        }
        if state.selected is not None and state.selected >= count:
            changes["selected"] = None
        if not same:
            changes |= {"base": None, "solution": None, "field": None, "selected": None}
            changes |= {"condition": None, "cut_graph": None}
        if document is not None and not document.budget.satisfied:
            changes |= {"solution": None, "field": None}
        self.set(**changes)
        if document is None:
            return
        if document.budget.satisfied:
            self.solve()
        elif self._state.base is None:
            present = document
            self._submit(
                lambda: prepare(present),
                self._show_base,
                lambda error: self._fail(error, "solve"),
            )

    def _show_solution(self, solution: Solution) -> None:
        self._clear_message("solve")
        base = LiveBase.from_solution(solution)
        self.set(solution=solution, base=base, field=solution.field, cut_graph=None)
        self._cut_if_wanted()

    def _solve_failed(self, error: Exception) -> None:
        self.set(solution=None, field=None, cut_graph=None)
        self._fail(error, "solve")

    def _show_base(self, base: LiveBase) -> None:
        self.set(base=base)

    def attempt(self, cause: str, verb: Callable[[], object]) -> None:
        """Do something that may fail and say so in the one place for errors."""
        try:
            verb()
        except CrossviewError as error:
            self._fail(error, cause)
        except OSError as error:
            self._fail(CrossviewError(error.strerror or str(error), str(error.filename)), cause)
        else:
            self._clear_message(cause)

    # ---- the background ------------------------------------------------------------------------

    def _submit(self, job: Any, done: Callable[[Any], None], fail: Callable[..., None]) -> None:
        self._background.submit(job, done, fail)

    def _clear_message(self, cause: str) -> None:
        message = self._state.message
        if message is not None and message.cause == cause:
            self.set(message=None)

    def report(self, error: BaseException) -> None:
        """Show an error that nothing else has dealt with."""
        self._fail(error, "unexpected")

    def _fail(
        self, error: BaseException, cause: str, actions: tuple[MessageAction, ...] = ()
    ) -> None:
        if isinstance(error, CrossviewError):
            text, details = str(error), describe(error)
        else:
            text = f"Something went wrong: {error or type(error).__name__}"
            details = "".join(traceback.format_exception(error))
        self.set(message=Message(text, cause, "error", details, actions, error))


def describe(error: CrossviewError) -> str:
    """Return an error on several lines: what, where, which elements, what to do."""
    lines = [error.what]
    if error.where:
        lines.append(f"Where: {error.where}")
    if isinstance(error, SurfaceError) and error.elements.size:
        listed = ", ".join(str(element) for element in error.elements.tolist()[:200])
        lines.append(f"{error.kind or 'elements'} ({len(error.elements)}): {listed}")
    if error.remedy:
        lines.append(f"What to do: {error.remedy}")
    return "\n".join(lines)
