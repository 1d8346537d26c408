"""The page of keys, and what a report of trouble should tell."""

from __future__ import annotations

import html
import platform
from collections.abc import Mapping
from pathlib import Path

import PySide6
from PySide6.QtCore import Qt
from PySide6.QtGui import QAction, QGuiApplication
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QMessageBox,
    QTextBrowser,
    QVBoxLayout,
    QWidget,
)
from vtkmodules.vtkCommonCore import vtkVersion

import crossview
from crossview.scene import renderer_name
from crossview.session.log import Log
from crossview.session.script import script
from crossview.session.session import Session
from crossview.session.state import SessionState

PAPER = (
    "Jovana Jezdimirović, Alexandre Chemin, Jean-François Remacle: Integrable cross-field "
    "generation based on imposed singularity configuration \u2013 the 2D manifold case"
)
"""Whose method it is."""

LAST = 30
"""Lines of the log that a report of trouble tells. Chosen."""


class KeysPage(QDialog):
    """All actions that have keys, by menu."""

    def __init__(self, actions: Mapping[str, list[QAction]], parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle("Keys")
        self.resize(560, 640)
        self.page = QTextBrowser()
        self.page.setAccessibleName("Keys")
        self.page.setHtml("".join(_table(menu, listed) for menu, listed in actions.items()))
        close = QDialogButtonBox(QDialogButtonBox.StandardButton.Close)
        close.rejected.connect(self.close)
        layout = QVBoxLayout(self)
        layout.addWidget(self.page)
        layout.addWidget(close)


def _table(menu: str, actions: list[QAction]) -> str:
    rows = "".join(
        f"<tr><td width=150><b>{html.escape(keys)}</b></td>"
        f"<td>{html.escape(action.text())}</td></tr>"
        for action in actions
        if (keys := ", ".join(key.toString() for key in action.shortcuts()))
    )
    return f"<h3>{menu}</h3><table cellpadding=2>{rows}</table>" if rows else ""


class AboutBox(QMessageBox):
    """What this is, whose method it computes, and which versions run; all of it to be copied."""

    def __init__(self, parent: QWidget) -> None:
        title = f"crossview {crossview.__version__}"
        does = "Imposed singularities on a surface, and the boundary-aligned cross-field they give."
        lines = [does, f"The method: {PAPER}", "BSD-3-Clause", *_versions()]
        super().__init__(
            QMessageBox.Icon.NoIcon,
            "About crossview",
            f"<b>{title}</b>" + "".join(f"<p>{html.escape(line)}</p>" for line in lines),
            QMessageBox.StandardButton.Close,
            parent,
        )
        self.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.copy = self.addButton("Copy", QMessageBox.ButtonRole.ActionRole)
        self.copy.clicked.disconnect()  # which closes the box
        told = "\n".join([title, *lines])
        self.copy.clicked.connect(lambda: QGuiApplication.clipboard().setText(told))


class Help:
    """Keys, what this is, and what a report of trouble should tell.

    Parameters
    ----------
    session : Session
    log : Log
    actions : mapping of str to list of QAction
        By menu.
    parent : QWidget
        What dialogs stand over.
    """

    def __init__(
        self,
        session: Session,
        log: Log,
        actions: Mapping[str, list[QAction]],
        parent: QWidget,
    ) -> None:
        self._session = session
        self._log = log
        self._actions = actions
        self._parent = parent

    def show_keys(self) -> None:
        """List all keys."""
        page = KeysPage(self._actions, self._parent)
        page.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        page.show()

    def show_about(self) -> None:
        """Say what this is."""
        box = AboutBox(self._parent)
        box.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        box.open()

    def copy_script(self) -> None:
        """Put a Python script of what was done into the clipboard."""
        QGuiApplication.clipboard().setText(script(self._session.state))

    def copy_diagnostics(self) -> None:
        """Put versions, machine, what is open, the message and the last of the log there.

        What may be shared without a second look: the user's own folder is told as "~".
        """
        last = [str(entry) for entry in self._log.entries][-LAST:]
        told = "\n".join([diagnostics(self._session.state), *last])
        QGuiApplication.clipboard().setText(told.replace(str(Path.home()), "~"))


def _versions() -> list[str]:
    return [
        f"Python {platform.python_version()}, PySide6 {PySide6.__version__}, "
        f"VTK {vtkVersion().GetVTKVersion()}",
        platform.platform(),
        f"Drawn by {renderer_name()}",
    ]


def diagnostics(state: SessionState) -> str:
    """Return versions, the machine, what is open and what the message says, a line each."""
    lines = [
        f"crossview {crossview.__version__}",
        *_versions(),
    ]
    if state.document is not None:
        surface = state.document.surface
        lines += [
            f"{state.document.name}: {surface.n_vertices} vertices, {surface.n_faces} triangles, "
            f"genus {surface.genus}",
            f"valences {[s.valence for s in state.document.singularities]}, {state.method}",
        ]
    if state.message is not None:
        lines += [state.message.text, state.message.below, state.message.details]
    return "\n".join(line for line in lines if line)
