"""What stands in the docks: each panel shows a `SessionState` and calls verbs of the session."""

from __future__ import annotations

from crossview.gui.panels.convergence import ConvergencePanel
from crossview.gui.panels.export import ExportPanel
from crossview.gui.panels.layers import LayersPanel
from crossview.gui.panels.log import LogPanel
from crossview.gui.panels.quads import QuadsPanel
from crossview.gui.panels.singularities import SingularitiesPanel
from crossview.gui.panels.surface import SurfacePanel
from crossview.gui.panels.validity import ValidityPanel

__all__ = [
    "ConvergencePanel",
    "ExportPanel",
    "LayersPanel",
    "LogPanel",
    "QuadsPanel",
    "SingularitiesPanel",
    "SurfacePanel",
    "ValidityPanel",
]
