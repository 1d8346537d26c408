"""Undo and redo: named, unlimited, by keeping the frozen documents themselves."""

from __future__ import annotations

from dataclasses import dataclass

from crossview.session.commands import Command
from crossview.session.document import Document


@dataclass(frozen=True)
class _Step:
    name: str
    document: Document  # the other side of the step


class History:
    """The present document with what can be undone and redone.

    Documents are frozen and share their surface, so a step costs its singularities and no more.
    """

    def __init__(self) -> None:
        self._document: Document | None = None
        self._undo: list[_Step] = []
        self._redo: list[_Step] = []

    @property
    def document(self) -> Document | None:
        """The present document; None before the first one is opened."""
        return self._document

    @property
    def undo_name(self) -> str | None:
        """Name of the step that undo would take back, if any."""
        return self._undo[-1].name if self._undo else None

    @property
    def redo_name(self) -> str | None:
        """Name of the step that redo would make again, if any."""
        return self._redo[-1].name if self._redo else None

    def open(self, document: Document) -> None:
        """Make `document` the present one; undo and redo do not reach beyond it."""
        self._undo.clear()
        self._redo.clear()
        self._document = document

    def do(self, command: Command) -> None:
        """Apply `command` to the present document as one named step."""
        if self._document is None:
            raise ValueError("no document is open")
        self._undo.append(_Step(command.name, self._document))
        self._redo.clear()
        self._document = command.apply(self._document)

    def undo(self) -> None:
        """Take the last step back; nothing happens when there is none."""
        self._travel(self._undo, self._redo)

    def redo(self) -> None:
        """Make the last undone step again; nothing happens when there is none."""
        self._travel(self._redo, self._undo)

    def _travel(self, source: list[_Step], target: list[_Step]) -> None:
        if source and self._document is not None:
            step = source.pop()
            target.append(_Step(step.name, self._document))
            self._document = step.document
