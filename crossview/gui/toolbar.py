"""The toolbar, laid out by the table of actions."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QSizePolicy, QToolBar, QToolButton, QWidget

from crossview.gui.action_table import LABELLED, TOOLBAR


def fill_toolbar(
    bar: QToolBar, actions: Mapping[str, QAction], boxes: Mapping[str, QWidget]
) -> None:
    """Lay out a toolbar as `TOOLBAR` says.

    Parameters
    ----------
    bar : QToolBar
    actions : mapping of str to QAction
        All of the table, by name.
    boxes : mapping of str to QWidget
        What stands in it that is no action, by name.
    """
    bar.setObjectName("toolbar")
    bar.setMovable(False)
    bar.setIconSize(QSize(20, 20))
    for name in TOOLBAR:
        if name == "|":
            bar.addSeparator()
        elif name == "->":
            bar.addWidget(_spring())
        elif name in boxes:
            bar.addWidget(boxes[name])
        else:
            bar.addAction(actions[name])
    for name in LABELLED:
        button = bar.widgetForAction(actions[name])
        if isinstance(button, QToolButton):
            button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)


def _spring() -> QWidget:
    """Return what pushes the rest of a toolbar to the right."""
    spring = QWidget()
    spring.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
    return spring
