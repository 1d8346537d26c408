"""The one state and who hears of its changes; also the one place where errors go."""

from __future__ import annotations

import traceback
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from PySide6.QtCore import QObject, Signal

from crossview.gui.state import Message, MessageAction, WindowState
from crossview.scene import Elements
from solvers.errors import CrossviewError, SurfaceError

MOST_LISTED = 200


class Store(QObject):
    """Holds the state; emits `changed(old, new)` after every change of it."""

    changed = Signal(object, object)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._state = WindowState()

    @property
    def state(self) -> WindowState:
        """What the window shows now."""
        return self._state

    def set(self, **changes: Any) -> None:
        """Change fields of the state; nothing happens when none differs."""
        old = self._state
        if any(getattr(old, name) is not value for name, value in changes.items()):
            self._state = replace(old, **changes)
            self.changed.emit(old, self._state)

    def fail(
        self,
        error: BaseException,
        cause: str,
        actions: tuple[MessageAction, ...] = (),
        pointed: Elements | None = None,
    ) -> None:
        """Show an error until its cause is gone (`clear_message`).

        Parameters
        ----------
        error : BaseException
            One the user can mend is told in its own words; another with its traceback as details.
        cause : str
            What was tried.
        actions : tuple of MessageAction
            What may be done about it.
        pointed : Elements, optional
            Where it is on the surface shown.
        """
        if isinstance(error, CrossviewError):
            text, details = str(error), describe(error)
        else:
            text = f"Something went wrong: {error or type(error).__name__}"
            details = "".join(traceback.format_exception(error))
        self.set(message=Message(text, cause, "error", details, actions, pointed=pointed))

    def clear_message(self, cause: str) -> None:
        """Take the message away if this was its cause."""
        message = self._state.message
        if message is not None and message.cause == cause:
            self.set(message=None)

    def attempt(self, cause: str, verb: Callable[[], object]) -> None:
        """Do something at once that may fail."""
        try:
            verb()
        except CrossviewError as error:
            self.fail(error, cause)
        except OSError as error:
            self.fail(CrossviewError(error.strerror or str(error), str(error.filename)), cause)
        else:
            self.clear_message(cause)


def describe(error: CrossviewError) -> str:
    """Return an error on several lines: what, where, which elements, what to do."""
    lines = [error.what]
    if error.where:
        lines.append(f"Where: {error.where}")
    if isinstance(error, SurfaceError) and error.elements.size:
        listed = ", ".join(str(element) for element in error.elements.tolist()[:MOST_LISTED])
        lines.append(f"{error.kind or 'elements'} ({len(error.elements)}): {listed}")
    if error.remedy:
        lines.append(f"What to do: {error.remedy}")
    return "\n".join(lines)
