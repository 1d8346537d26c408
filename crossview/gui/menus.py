"""Menus, toolbar and right-click menu, all from the table of actions."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QLocale, QSize, Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QMenu, QSizePolicy, QSpinBox, QToolBar, QToolButton, QWidget

from crossview.cases.gallery import names, path_of
from crossview.cases.model import METHODS, Case
from crossview.gui.action_table import ACTIONS, LABELLED, TOOL_VALENCES, TOOLBAR
from crossview.gui.recent import forget_all, recent
from crossview.session.commands import MAX_VALENCE, MIN_VALENCE

if TYPE_CHECKING:
    from crossview.gui.main_window import MainWindow

SEARCHED = ("Natural singularities", "Mirror", "Rotate")
"""Submenus whose actions are in the palette: the others repeat some."""
MENUS = ("File", "Edit", "Surface", "Singularities", "Solve", "View", "Gallery", "Help")


class Menus:
    """The menu bar of a window."""

    def __init__(self, window: MainWindow) -> None:
        self._window = window
        self._menus: dict[str, QMenu] = {}
        self._submenus: dict[str, QMenu] = {}
        for title in MENUS:
            self._menus[title] = window.menuBar().addMenu(f"&{title}")
        for spec in ACTIONS:
            menu = self._menus[spec.menu]
            if spec.separated:
                menu.addSeparator()
            if spec.submenu:
                menu = self._submenu(menu, spec.submenu)
            menu.addAction(window.actions_table.by_name[spec.name])
        self._recent = QMenu("Open recent", window)
        file_menu = self._menus["File"]
        file_menu.insertMenu(window.actions_table.by_name["save"], self._recent)
        self.show_recent()
        gallery = self._menus["Gallery"]
        gallery.setToolTipsVisible(True)
        for name in names():
            action = self._add(gallery, name, partial(window.files.open, name))
            action.setToolTip(Case.load(path_of(name)).title)
        self._fill_view()

    def menu(self, title: str) -> QMenu:
        """Return the menu of this title."""
        return self._menus[title]

    def titled_actions(self) -> list[tuple[str, QAction]]:
        """Return every action there is with its menu in its title, for the palette."""
        return [
            (f"{title}: {action.text().replace('&', '').rstrip('…')}", action)
            for title, menu in self._menus.items()
            for action in _leaves(menu)
        ]

    def show_recent(self) -> None:
        """Fill the menu of recent files anew."""
        self._recent.clear()
        for path in recent():
            action = self._add(
                self._recent, Path(path).name, partial(self._window.files.open, path)
            )
            action.setToolTip(path)
        self._recent.setToolTipsVisible(True)
        self._recent.setEnabled(not self._recent.isEmpty())
        self._recent.addSeparator()
        self._add(self._recent, "Clear this list", self._forget)

    def scene_menu(self) -> QMenu:
        """Return the menu for a place of the scene without singularity."""
        menu = QMenu(self._window)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        tools = (f"add-{v}" for v in TOOL_VALENCES)
        for name in ("select", *tools, "add-any", "add-pair", "fit"):
            menu.addAction(self._window.actions_table.by_name[name])
        return menu

    def _forget(self) -> None:
        forget_all()
        self.show_recent()

    def _fill_view(self) -> None:
        view = self._menus["View"]
        methods = QMenu("Method", self._window)
        for method in METHODS:
            methods.addAction(self._window.actions_table.by_name[f"method-{method}"])
        view.insertMenu(self._window.actions_table.by_name["fit"], methods)
        view.addSeparator()
        for dock in self._window.docks.values():
            view.addAction(dock.toggleViewAction())

    def _submenu(self, menu: QMenu, title: str) -> QMenu:
        """Return the submenu of this title, added if it is not there yet."""
        if title not in self._submenus:
            self._submenus[title] = menu.addMenu(title)
            self._submenus[title].setObjectName(title)
        return self._submenus[title]

    def _add(self, menu: QMenu, text: str, run: Callable[[], object]) -> QAction:
        action = QAction(text, menu)
        action.triggered.connect(lambda: run())
        menu.addAction(action)
        return action


def _leaves(menu: QMenu) -> list[QAction]:
    """Return the actions of a menu and of the submenus that its own actions fill."""
    found = []
    for action in menu.actions():
        inner = action.menu()
        if isinstance(inner, QMenu) and inner.title() in SEARCHED:
            found += _leaves(inner)
        elif inner is None and not action.isSeparator():
            found.append(action)
    return found


def make_toolbar(window: MainWindow) -> QToolBar:
    """Return the toolbar, laid out by `actions.TOOLBAR`."""
    bar = window.addToolBar("Tools")
    bar.setObjectName("toolbar")
    bar.setMovable(False)
    bar.setIconSize(QSize(20, 20))
    for name in TOOLBAR:
        if name == "|":
            bar.addSeparator()
        elif name == "any-valence":
            bar.addWidget(_any_valence_box(window))
        elif name == "method":
            bar.addWidget(window.method_box)
        elif name == "->":
            bar.addWidget(_spring())
        else:
            bar.addAction(window.actions_table.by_name[name])
    for name in LABELLED:
        button = bar.widgetForAction(window.actions_table.by_name[name])
        if isinstance(button, QToolButton):
            button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
    return bar


def _spring() -> QWidget:
    """Return what pushes the rest of a toolbar to the right."""
    spring = QWidget()
    spring.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
    return spring


def _any_valence_box(window: MainWindow) -> QSpinBox:
    """Return the box beside the tool "n": the valence it places."""
    box = QSpinBox()
    box.setLocale(QLocale.c())
    box.setRange(MIN_VALENCE, MAX_VALENCE)
    box.setValue(window.state.any_valence)
    box.setToolTip("Valence that the tool n places")
    box.setFocusPolicy(Qt.FocusPolicy.ClickFocus)

    def changed(valence: int) -> None:
        held = window.state.tool
        carried = held is not None and held not in TOOL_VALENCES
        window.workspace.set(any_valence=valence, tool=valence if carried else held)

    box.valueChanged.connect(changed)
    return box
