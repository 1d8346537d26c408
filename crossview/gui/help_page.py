"""The page of keys, and what a report of trouble should tell."""

from __future__ import annotations

import html
import platform
from collections.abc import Mapping

import PySide6
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QDialog, QDialogButtonBox, QTextBrowser, QVBoxLayout, QWidget
from vtkmodules.vtkCommonCore import vtkVersion

import crossview
from crossview.session.state import SessionState


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


def diagnostics(state: SessionState) -> str:
    """Return versions, the machine, what is open and what the message says, a line each."""
    lines = [
        f"crossview {crossview.__version__}",
        f"Python {platform.python_version()}, PySide6 {PySide6.__version__}, "
        f"VTK {vtkVersion().GetVTKVersion()}",
        platform.platform(),
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
