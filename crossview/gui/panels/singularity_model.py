"""The singularities as a Qt table: one row each."""

from __future__ import annotations

from typing import Any

import numpy as np
from PySide6.QtCore import QAbstractTableModel, QModelIndex, QObject, QPersistentModelIndex, Qt

from crossview.gui.icons import dot_icon, icon
from crossview.session.session import Session
from crossview.session.state import SessionState
from crossview.view.colors import valence_color
from crossview.view.texts import position, signed
from solvers.singularities import Singularity

NUMBER, VALENCE, INDEX, POSITION, LOCK = range(5)
"""Columns of the table."""

HEADERS = ("#", "Valence", "Index", "Position", "")
"""Their titles."""

Role = Qt.ItemDataRole
AnyIndex = QModelIndex | QPersistentModelIndex


class SingularityModel(QAbstractTableModel):
    """Rows are the state's singularities; editing the valence asks the session."""

    def __init__(self, session: Session, parent: QObject) -> None:
        super().__init__(parent)
        self._session = session
        self._singularities: tuple[Singularity, ...] = ()
        self._positions: list[str] = []

    def show_state(self, state: SessionState) -> None:
        """Follow the state; the selection stays where the number of rows does."""
        document = state.document
        points = [s.point for s in state.singularities]
        positions = [] if document is None else list(document.surface.positions(points))
        same_rows = len(points) == len(self._singularities)
        if not same_rows:
            self.beginResetModel()
        self._singularities = state.singularities
        flat = document is not None and bool(np.ptp(document.surface.vertices[:, 2]) == 0.0)
        size = 0.0 if document is None else document.surface.diagonal
        self._positions = [position(xyz[:2] if flat else xyz, size) for xyz in positions]
        if not same_rows:
            self.endResetModel()
        elif points:
            self.dataChanged.emit(self.index(0, 0), self.index(len(points) - 1, LOCK))

    def rowCount(self, parent: AnyIndex = QModelIndex()) -> int:  # noqa: B008
        """Return the number of singularities."""
        return 0 if parent.isValid() else len(self._singularities)

    def columnCount(self, parent: AnyIndex = QModelIndex()) -> int:  # noqa: B008
        """Return the number of columns."""
        return 0 if parent.isValid() else len(HEADERS)

    def headerData(self, section: int, orientation: Qt.Orientation, role: int = 0) -> Any:
        """Return a column's title."""
        if orientation == Qt.Orientation.Horizontal and role == Role.DisplayRole:
            return HEADERS[section]
        return None

    def flags(self, index: AnyIndex) -> Qt.ItemFlag:
        """Let the valence be edited."""
        flags = Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsSelectable
        return flags | Qt.ItemFlag.ItemIsEditable if index.column() == VALENCE else flags

    def data(self, index: AnyIndex, role: int = Role.DisplayRole) -> Any:
        """Return a cell's text, icon, alignment, tip or value to edit."""
        singularity, column = self._singularities[index.row()], index.column()
        if role == Role.DisplayRole:
            return self._text(index.row(), column)
        if role == Role.EditRole and column == VALENCE:
            return singularity.valence
        if role == Role.DecorationRole:
            if column == NUMBER:
                return dot_icon(valence_color(singularity.valence))
            if column == LOCK and singularity.locked:
                return icon("lock")
        if role == Role.ToolTipRole and column == LOCK:
            return "Locked: click to unlock" if singularity.locked else "Click to lock"
        if role == Role.ToolTipRole and column == POSITION:
            return self._positions[index.row()]
        if role == Role.TextAlignmentRole and column in (VALENCE, INDEX):
            return Qt.AlignmentFlag.AlignCenter
        return None

    def setData(self, index: AnyIndex, value: Any, role: int = Role.EditRole) -> bool:
        """Change a valence through the session, so that it can be undone."""
        if role != Role.EditRole or index.column() != VALENCE:
            return False
        self._session.edits.change_valence(index.row(), int(value))
        return True

    def _text(self, row: int, column: int) -> str | None:
        if column == NUMBER:
            return str(row + 1)
        if column == VALENCE:
            return str(self._singularities[row].valence)
        if column == INDEX:
            return signed(self._singularities[row].index)
        return self._positions[row] if column == POSITION else None
