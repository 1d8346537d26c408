"""The window: the parts put together, each following the one state."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QSize
from PySide6.QtGui import (
    QCloseEvent,
    QDragEnterEvent,
    QDropEvent,
    QResizeEvent,
    QShowEvent,
)
from PySide6.QtWidgets import QMainWindow, QMessageBox, QStackedWidget, QVBoxLayout, QWidget

import crossview
from crossview.gui.action_table import ACTIONS
from crossview.gui.actions import Actions
from crossview.gui.arrangement import Arrangement
from crossview.gui.docks import add_docks
from crossview.gui.empty_state import EmptyState
from crossview.gui.figure_preview import FigurePreview
from crossview.gui.files import Files
from crossview.gui.menus import Menus, make_toolbar
from crossview.gui.message_bar import MessageBar
from crossview.gui.method_box import MethodBox
from crossview.gui.palette import Palette
from crossview.gui.panels import (
    ConvergencePanel,
    ExportPanel,
    LayersPanel,
    QuadsPanel,
    SingularitiesPanel,
    SurfacePanel,
    ValidityPanel,
)
from crossview.gui.state import WindowState
from crossview.gui.status import Status
from crossview.gui.viewport import Viewport
from crossview.gui.workspace import Workspace
from crossview.session.document import Document


class Centre(QWidget):
    """The empty state or the viewport, and the message bar floating over them."""

    def __init__(self, workspace: Workspace) -> None:
        super().__init__()
        self.empty = EmptyState()
        self.viewport = Viewport(workspace)
        self.stack = QStackedWidget()
        self.stack.addWidget(self.empty)
        self.stack.addWidget(self.viewport)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.stack)
        self.message_bar = MessageBar(workspace, self)

    def show_state(self, old: WindowState, new: WindowState) -> None:
        """Follow the window's state."""
        nothing = new.document is None and new.faulty is None
        self.stack.setCurrentWidget(self.empty if nothing else self.viewport)
        self.viewport.show_state(old, new)
        self.message_bar.show_state(old, new)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Keep the bar in its place."""
        super().resizeEvent(event)
        self.message_bar.place()


class MainWindow(QMainWindow):
    """One window, one surface."""

    def __init__(self) -> None:
        super().__init__()
        self.setWindowTitle("crossview")
        # Never larger than the screen, whose edge would hide the docks on the right.
        self.resize(QSize(1440, 900).boundedTo(self.screen().availableSize()))
        self.setAcceptDrops(True)
        self.workspace: Workspace = Workspace(self)
        self.files: Files = Files(self)
        self.centre: Centre = Centre(self.workspace)
        self.setCentralWidget(self.centre)
        self.viewport: Viewport = self.centre.viewport
        self.actions_table = Actions(ACTIONS, self)
        named = self.actions_table.by_name
        self.surface_panel = SurfacePanel(self.workspace)
        self.singularities_panel: SingularitiesPanel = SingularitiesPanel(self.workspace, named)
        self.validity_panel = ValidityPanel(self.workspace, named["make-valid"])
        self.layers_panel = LayersPanel(self.workspace)
        self.convergence_panel = ConvergencePanel(named["compare"])
        self.quads_panel = QuadsPanel(named["mesh"], named["save-quads"])
        self.export_panel = ExportPanel(named["figure"])
        self.docks = add_docks(self)
        self.menus = Menus(self)
        self.method_box: MethodBox = MethodBox(self.workspace)
        self.toolbar = make_toolbar(self)
        self.status = Status(self)
        self.figure_preview = FigurePreview(self)
        self.arrangement: Arrangement = Arrangement(self)
        self.workspace.changed.connect(self._show_state)
        self.workspace.opened.connect(self._opened)
        self.viewport.menu_wanted.connect(self._show_menu)
        self.viewport.edit_wanted.connect(self.singularities_panel.edit)
        self.centre.empty.chosen.connect(self.files.open)
        self.centre.empty.open_wanted.connect(self.files.ask_open)
        self.actions_table.show(self.state)

    @property
    def state(self) -> WindowState:
        """What the window shows."""
        return self.workspace.state

    def show_palette(self) -> None:
        """Open the command palette."""
        Palette(self.menus.titled_actions(), self).popup()

    def make_quads(self) -> None:
        """Make quads as the Quads panel says, and show it."""
        self.docks["Quads"].raise_()
        self.workspace.meshing.make(self.quads_panel.options)

    def add_pair(self) -> None:
        """Add a pair where the mouse is, where the menu was asked for, or where there is room."""
        pick = self.viewport.under_menu or self.viewport.under_mouse
        self.workspace.pairs.add(None if pick is None else pick.point)

    def show_about(self) -> None:
        """Say what this is."""
        QMessageBox.about(
            self,
            "About crossview",
            f"<b>crossview {crossview.__version__}</b><p>Imposed singularities on a surface, "
            "and the boundary-aligned cross-field they give.</p><p>BSD-3-Clause</p>",
        )

    def escape(self) -> None:
        """Put a dragged singularity back, else take the select tool."""
        if not self.viewport.mouse.let_go():
            self.workspace.set(tool=None, trial=None, mark_tool=None)

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        """Take files."""
        if any(url.isLocalFile() for url in event.mimeData().urls()):
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:
        """Open the first dropped file."""
        for url in event.mimeData().urls():
            if url.isLocalFile():
                event.acceptProposedAction()
                self.files.open(url.toLocalFile())
                return

    def showEvent(self, event: QShowEvent) -> None:
        """Arrange the docks once there is a size to share."""
        super().showEvent(event)
        self.arrangement.show()

    def closeEvent(self, event: QCloseEvent) -> None:
        """End the background and free what VTK holds."""
        self.arrangement.keep()
        self.workspace.close()
        self.figure_preview.close()
        self.viewport.close_plotter()
        super().closeEvent(event)

    def _show_state(self, old: WindowState, new: WindowState) -> None:
        self.centre.show_state(old, new)
        for panel in (
            self.surface_panel,
            self.singularities_panel,
            self.validity_panel,
            self.layers_panel,
            self.convergence_panel,
            self.quads_panel,
            self.method_box,
            self.status,
        ):
            panel.show_state(old, new)
        self.actions_table.show(new)
        if old.document is not new.document:
            name = "" if new.document is None else f"{new.document.name} \u2013 "
            self.setWindowTitle(f"{name}crossview")
        self.workspace.guiding.follow()
        before = None if old.document is None else old.document.surface
        after = None if new.document is None else new.document.surface
        if before is not after or old.faulty is not new.faulty:
            self.viewport.fit()

    def _opened(self, document: Document) -> None:
        self.files.opened(document)
        self.menus.show_recent()

    def _show_menu(self, singularity: int | None, place: QPoint) -> None:
        if singularity is not None:
            self.workspace.set(selected=singularity)
            self.singularities_panel.menu().popup(place)
        elif self.state.document is not None:
            self.menus.scene_menu().popup(place)
