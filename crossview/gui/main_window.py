"""The window: the parts put together, each following the one state."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PySide6.QtCore import QPoint, QSize, Qt
from PySide6.QtGui import (
    QCloseEvent,
    QDragEnterEvent,
    QDropEvent,
    QGuiApplication,
    QShowEvent,
)
from PySide6.QtWidgets import QMainWindow

from crossview.cases.pictured import FIGURES, Pictured
from crossview.cases.project import PROJECT
from crossview.gui.action_table import ACTIONS
from crossview.gui.actions import Actions
from crossview.gui.appearance import Appearance
from crossview.gui.centre import Centre
from crossview.gui.docks import add_docks
from crossview.gui.figure import Figure
from crossview.gui.figure_preview import FigurePreview
from crossview.gui.files import Files
from crossview.gui.gallery import Gallery
from crossview.gui.help_page import Help
from crossview.gui.menus import MENUS, Menus
from crossview.gui.method_box import MethodBox
from crossview.gui.mouse import Mouse
from crossview.gui.palette import Palette
from crossview.gui.panels import (
    ConvergencePanel,
    ExportPanel,
    LayersPanel,
    LogPanel,
    QuadsPanel,
    SingularitiesPanel,
    SurfacePanel,
    ValidityPanel,
)
from crossview.gui.qt_loop import QtLoop
from crossview.gui.solve_button import SolveButton
from crossview.gui.status import Status
from crossview.gui.theme import is_dark
from crossview.gui.toolbar import fill_toolbar
from crossview.gui.tour import CASE
from crossview.gui.valence_box import ValenceBox
from crossview.gui.viewport import Viewport
from crossview.gui.window_geometry import WindowGeometry
from crossview.scene.camera import read_camera
from crossview.session.log import Log
from crossview.session.look import Look
from crossview.session.opening import Opening
from crossview.session.pictures import figure_view
from crossview.session.session import Session
from crossview.session.state import SessionState


class MainWindow(QMainWindow):
    """One window, one surface."""

    def __init__(self) -> None:
        super().__init__()
        self.setWindowTitle("crossview")
        self.appearance = Appearance(self)
        # Never larger than the screen, whose edge would hide the docks on the right.
        self.resize(QSize(1440, 900).boundedTo(self.screen().availableSize()))
        self.setAcceptDrops(True)
        self.session: Session = Session(QtLoop(self))
        self.files: Files = Files(self.session, self.figure, self.look, self, self.statusBar())
        self.log = Log(self.session)
        self.actions_table = Actions(ACTIONS, self, self)
        named = self.actions_table.by_name
        by_menu = {title: [named[s.name] for s in ACTIONS if s.menu == title] for title in MENUS}
        self.help = Help(self.session, self.log, by_menu, self)
        self.centre: Centre = Centre(self.session)
        self.setCentralWidget(self.centre)
        self.viewport: Viewport = self.centre.viewport
        self.mouse: Mouse = Mouse(self.viewport, self.session)
        self.surface_panel = SurfacePanel(self.session)
        self.singularities_panel: SingularitiesPanel = SingularitiesPanel(self.session, named)
        self.validity_panel = ValidityPanel(self.session, named)
        self.layers_panel = LayersPanel(self.session)
        self.convergence_panel = ConvergencePanel(named["compare"])
        self.quads_panel = QuadsPanel(named["mesh"], named["save-quads"])
        self.quads_panel.look_wanted.connect(self.viewport.look_at)
        self.quads_panel.allow_inverted.toggled.connect(self.files.allow_inverted)
        self.export_panel = ExportPanel(named["figure"])
        self.docks = add_docks(
            self,
            {
                "Surface": self.surface_panel,
                "Singularities": self.singularities_panel,
                "Validity": self.validity_panel,
                "Layers": self.layers_panel,
                "Convergence": self.convergence_panel,
                "Quads": self.quads_panel,
                "Export": self.export_panel,
                "Log": LogPanel(self.log),
            },
        )
        shown = [dock.toggleViewAction() for dock in self.docks.values()]
        self.menus = Menus(self.menuBar(), named, shown, self.files.open)
        self.method_box: MethodBox = MethodBox(self.session)
        self.solve_button = SolveButton(named["solve"], named["stop"])
        boxes = {
            "method": self.method_box,
            "any-valence": ValenceBox(self.session),
            "solve-or-stop": self.solve_button,
        }
        fill_toolbar(self.addToolBar("Tools"), named, boxes)
        self.status = Status(self.statusBar(), self.session, named["stop"])
        self.figure_preview = FigurePreview(self.export_panel, self.figure)
        self.window_geometry: WindowGeometry = WindowGeometry(self, self.docks)
        self._connect()
        self.actions_table.show(self.state)
        self.appearance.prefer(self.appearance.preferences)

    def _connect(self) -> None:
        """Let the parts hear each other."""
        self.session.observers.append(self._show_state)
        self.session.opened.append(self._opened)
        self.appearance.preferred += [
            lambda chosen: self.session.looks.shade(chosen.shaded),
            lambda chosen: self.files.keep_copies(chosen.copies),
            lambda chosen: self.quads_panel.count_box.setValue(chosen.quads),
        ]
        self.appearance.themed += [
            lambda: self.layers_panel.show_state(None, self.state),
            lambda: self.session.looks.set_dark(is_dark()),
        ]
        self.mouse.menu_wanted.connect(self._show_menu)
        self.mouse.edit_wanted.connect(self.edit_valence)
        self.mouse.hovered.connect(self.status.show_hover)
        self.viewport.frame_drawn.connect(self.status.show_frame)
        self.viewport.limits_drawn.connect(self.layers_panel.show_limits)
        self.export_panel.titled.connect(self.session.edits.change_title)
        self.centre.empty.chosen.connect(self.files.open)
        self.centre.empty.open_wanted.connect(self.files.ask_open)
        self.centre.empty.tour_wanted.connect(self.start_tour)
        self.centre.unsaved.restore.connect(self.files.restore)
        self.docks["Export"].visibilityChanged.connect(self.figure_preview.ask)
        self.viewport.frame_drawn.connect(self.figure_preview.ask)  # the camera may have turned

    @property
    def state(self) -> SessionState:
        """What the window shows."""
        return self.session.state

    def figure(self) -> Figure | None:
        """Return what a figure would show now; None while nothing is open."""
        if self.state.document is None:
            return None
        settings = self.export_panel.settings
        view = figure_view(self.state, settings.transparent, self.viewport.held.ranges)
        camera = self.viewport.scene.camera
        return Figure(view, camera, settings, self.state.document.to_case())

    def look(self) -> Look:
        """Return how the document is looked at now."""
        return Look.of(self.state, self.viewport.scene.camera.text, self.viewport.held.ranges)

    def edit_valence(self, index: int) -> None:
        """Let the valence of singularity `index` be typed."""
        self.singularities_panel.edit(index)

    def look_from(self, camera: str) -> None:
        """Look from one of the scene's preset directions; "auto": a good side."""
        self.viewport.look_from(camera)

    def change_projection(self) -> None:
        """Show in perspective what is shown in parallel, or the other way round."""
        self.viewport.change_projection()

    def toggle_clip(self) -> None:
        """Cut away the half that is nearer to the eye, or show all again."""
        camera = self.viewport.scene.camera
        self.session.looks.toggle_clip(np.subtract(camera.position, camera.focus))

    def copy_camera(self) -> None:
        """Put the camera into the clipboard, as text."""
        QGuiApplication.clipboard().setText(self.viewport.scene.camera.text)

    def paste_camera(self) -> None:
        """Look with the camera that the clipboard holds."""
        text = QGuiApplication.clipboard().text()
        self.session.attempt("camera", lambda: self._look_from(text))

    def show_gallery(self) -> None:
        """Show the cases that come with crossview, to open one."""
        gallery = Gallery(self)
        gallery.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        gallery.chosen.connect(self.files.open)
        gallery.open()

    def start_tour(self) -> None:
        """Open the case of the tour, and say step by step what to do with it."""
        self.centre.tour.start()
        self.files.open(CASE)

    def reset_docks(self) -> None:
        """Put all panels back to where they stand at first."""
        self.window_geometry.reset()

    def show_palette(self) -> None:
        """Open the command palette."""
        Palette(self.menus.titled_actions(), self).popup()

    def make_quads(self) -> None:
        """Make quads as the Quads panel says, and show it."""
        self.docks["Quads"].raise_()
        self.session.quad_making.make(self.quads_panel.options)

    def simplify(self) -> None:
        """Merge singularities until as many are left as the Validity panel says."""
        self.session.moves.simplify(self.validity_panel.places.most.value())

    def add_pair(self) -> None:
        """Add a pair where the mouse is, where the menu was asked for, or where there is room."""
        pick = self.mouse.under_menu or self.mouse.under_mouse
        self.session.pairs.add(None if pick is None else pick.point)

    def escape(self) -> None:
        """Put a dragged singularity back, else take the select tool."""
        if not self.mouse.let_go():
            self.session.pointer.put_tool_back()

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
        self.window_geometry.show()
        self.viewport.plotter.setFocus()  # where keys are heard as tools

    def closeEvent(self, event: QCloseEvent) -> None:
        """Ask about unsaved changes; end the background and free what VTK holds."""
        if not self.files.may_leave():
            event.ignore()
            return
        self.files.close()
        self.window_geometry.keep()
        self.session.close()
        self.figure_preview.close()
        self.mouse.close()
        self.viewport.close_plotter()
        super().closeEvent(event)

    def _show_state(self, old: SessionState, new: SessionState) -> None:
        self.centre.show_state(old, new)
        for panel in (
            self.surface_panel,
            self.singularities_panel,
            self.validity_panel,
            self.layers_panel,
            self.convergence_panel,
            self.quads_panel,
            self.export_panel,
            self.method_box,
            self.solve_button,
            self.status,
        ):
            panel.show_state(old, new)
        self.actions_table.show(new)
        self.figure_preview.ask()
        self.files.show_state(old, new)
        if old.document is not new.document or old.kept is not new.kept:
            self._show_name()
        before = None if old.document is None else old.document.surface
        after = None if new.document is None else new.document.surface
        if before is not after or old.faulty is not new.faulty:
            self.viewport.look_from("auto")

    def _opened(self, opening: Opening) -> None:
        self.files.opened(opening)
        self.menus.show_recent()
        self._show_name()
        self.centre.unsaved.look()
        suffix = Path(opening.source).suffix.lower()
        if suffix in FIGURES:
            self.session.attempt(
                "open", lambda: self._look_from(Pictured.load(opening.source).camera)
            )
        elif suffix == PROJECT and Path(opening.source).is_file():
            self.session.attempt("open", lambda: self._restore(Look.load(opening.source)))

    def _restore(self, look: Look) -> None:
        self.viewport.held.restore(look.ranges)
        self.session.looks.restore(look.layers)
        self._look_from(look.camera)
        if look.quads is not None:
            self.session.quad_making.wait_for(look.quads)

    def _look_from(self, text: str) -> None:
        camera = read_camera(text)
        if isinstance(camera, str):
            self.viewport.look_from(camera)
        else:
            self.viewport.look_with(camera)

    def _show_name(self) -> None:
        name = self.files.name
        self.setWindowTitle(f"{name}[*] \u2013 crossview" if name else "crossview")
        self.setWindowModified(self.state.modified)

    def _show_menu(self, singularity: int | None, place: QPoint) -> None:
        if singularity is not None:
            self.session.pointer.choose(singularity)
            self.singularities_panel.menu().popup(place)
        elif self.state.document is not None:
            self.menus.scene_menu().popup(place)
