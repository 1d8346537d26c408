"""The one state and who hears of its changes; also the one place where errors go."""

from __future__ import annotations

import os
import traceback
from collections import deque
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path

from crossview.session.message import Message, ShowWhere
from crossview.session.opening import Opening
from crossview.session.state import SessionState
from crossview.view.values import Elements
from crossview.workflow.loading import RepairAndChoose
from crossview.workflow.quads import MeshOptions
from solvers.errors import CrossviewError, SurfaceError, printable, shortened
from solvers.remedies import Remedy, RepairSurface, TakeLargest, UseMethod

MOST_LISTED = 200
"""Elements of an error that are listed, at most. Chosen, for the clipboard."""


class Store:
    """Holds the state, and tells observers of each change of it."""

    def __init__(self) -> None:
        self.observers: list[Callable[[SessionState, SessionState], object]] = []
        """Called with the states before and after each change, in the order of the changes."""
        self._state = SessionState()
        self._untold: deque[tuple[SessionState, SessionState]] = deque()
        self._telling = False

    @property
    def state(self) -> SessionState:
        """What the window shows now."""
        return self._state

    def update(self, new: SessionState) -> None:
        """Go on to the next state; nothing happens when no field differs."""
        old = self._state
        if all(getattr(old, f.name) is getattr(new, f.name) for f in fields(new)):
            return
        self._state = new
        self._untold.append((old, new))
        if not self._telling:  # else an observer has changed it: all hear of the change before
            self._tell()

    def dismiss(self) -> None:
        """Take the message away."""
        self.update(self.state.said(None))

    def fail(
        self,
        error: BaseException,
        cause: str,
        tried: Opening | MeshOptions | None = None,
        pointed: Elements | None = None,
    ) -> None:
        """Show an error until its cause is gone (`SessionState.unsaid`).

        Parameters
        ----------
        error : BaseException
            One the user can mend is told in its own words, with a button for each remedy that
            the window can carry out; another with its traceback as details.
        cause : str
            What was tried.
        tried : Opening or MeshOptions, optional
            The same as a value that a remedy goes on with.
        pointed : Elements, optional
            Where it is on the surface shown.
        """
        remedies: tuple[Remedy, ...] = ()
        if isinstance(error, CrossviewError):
            text, below, details = shortened(error.what), _below(error, tried), describe(error)
            remedies = offered(error, tried, self._state.method)
        else:
            text, below = f"Something went wrong: {error or type(error).__name__}", ""
            details = "".join(traceback.format_exception(error))
        message = Message(text, cause, "error", below, details, remedies, tried, pointed=pointed)
        self.update(self.state.said(message))

    def attempt(self, cause: str, verb: Callable[[], object]) -> None:
        """Do something at once that may fail."""
        try:
            verb()
        except CrossviewError as error:
            self.fail(error, cause)
        except OSError as error:
            self.fail(CrossviewError(error.strerror or str(error), str(error.filename)), cause)
        else:
            self.update(self.state.unsaid(cause))

    def _tell(self) -> None:
        self._telling = True
        try:
            while self._untold:
                old, new = self._untold.popleft()
                for tell in tuple(self.observers):
                    tell(old, new)
        finally:
            self._telling = False


def offered(
    error: CrossviewError, tried: Opening | MeshOptions | None, method: str
) -> tuple[Remedy, ...]:
    """Return what the window can do about an error, by the kinds of its remedies alone.

    Parameters
    ----------
    error : CrossviewError
    tried : Opening, MeshOptions or None
        What has failed: only an opening is repeated otherwise.
    method : str
        The method of the document; there is no use in choosing it.
    """
    found = []
    for remedy in error.remedies:
        match remedy:
            case RepairSurface():
                useful = isinstance(tried, Opening) and not tried.repair
            case TakeLargest() | RepairAndChoose():
                useful = isinstance(tried, Opening)
            case UseMethod(method=other):
                useful = other != method
            case _:
                useful = True
        found += [remedy] if useful else []
    as_read = isinstance(tried, Opening) and not (tried.component or tried.repair)
    if as_read and isinstance(error, SurfaceError) and error.elements.size:
        found.append(ShowWhere("show where", Elements(**{error.kind: error.elements})))
    return tuple(found)


def _below(error: CrossviewError, tried: Opening | MeshOptions | None) -> str:
    """Return where it is and what to do; a file that was opened is told by its name."""
    where = error.where
    if isinstance(tried, Opening):
        where = where.replace(f"{Path(tried.target).parent}{os.sep}", "")
    told = ": ".join(part for part in (where, error.to_do()) if part)
    return printable(" ".join(shortened(told).split()))


def describe(error: CrossviewError) -> str:
    """Return an error on several lines: what, where, which elements, what to do."""
    lines = [error.what]
    if error.where:
        lines.append(f"Where: {error.where}")
    if isinstance(error, SurfaceError) and error.elements.size:
        listed = ", ".join(str(element) for element in error.elements.tolist()[:MOST_LISTED])
        lines.append(f"{error.kind or 'elements'} ({len(error.elements)}): {listed}")
    if error.to_do():
        lines.append(f"What to do: {error.to_do()}")
    return "\n".join(lines)
