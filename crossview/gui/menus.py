"""The menu bar and the right-click menu, from the table of actions."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QMenu, QMenuBar

from crossview.cases.gallery import exhibits, path_of
from crossview.cases.model import METHODS, Case
from crossview.gui.action_table import ACTIONS
from crossview.gui.recent import forget_all, recent
from crossview.session.hand import OWN_TOOLS

REPEATED = ("Open recent", "Method")
"""Submenus that are not in the palette: their actions are elsewhere, or no verbs."""
MENUS = ("File", "Edit", "Surface", "Singularities", "Solve", "View", "Gallery", "Help")
"""Titles of the menus, from the left."""


class Menus:
    """The menus of a window.

    Parameters
    ----------
    bar : QMenuBar
        Filled here.
    actions : mapping of str to QAction
        All of the table, by name.
    panels : iterable of QAction
        Each shows or hides a panel.
    open_target : callable
        Opens a file or a gallery case.
    """

    def __init__(
        self,
        bar: QMenuBar,
        actions: Mapping[str, QAction],
        panels: Iterable[QAction],
        open_target: Callable[[str], None],
    ) -> None:
        self._bar = bar
        self._actions = actions
        self._open = open_target
        self._menus: dict[str, QMenu] = {}
        self._submenus: dict[str, QMenu] = {}
        for title in MENUS:
            self._menus[title] = bar.addMenu(f"&{title}")
        for spec in ACTIONS:
            menu = self._menus[spec.menu]
            if spec.separated:
                menu.addSeparator()
            if spec.submenu:
                menu = self._submenu(menu, spec.submenu)
            menu.addAction(actions[spec.name])
        self._recent = QMenu("Open recent", bar)
        self._menus["File"].insertMenu(actions["save"], self._recent)
        self.show_recent()
        gallery = self._menus["Gallery"]
        for exhibit in exhibits():
            title = Case.load(path_of(exhibit.case)).title
            group = self._submenu(gallery, exhibit.group)
            action = self._add(group, title, partial(open_target, exhibit.case))
            action.setToolTip(exhibit.sentence)
            group.setToolTipsVisible(True)
        self._fill_view(panels)

    def menu(self, title: str) -> QMenu:
        """Return the menu of this title."""
        return self._menus[title]

    def titled_actions(self) -> list[tuple[str, QAction]]:
        """Return every action there is with its menus in its title, for the palette."""
        return [
            (f"{title}: {action.text().replace('&', '').rstrip('…')}", action)
            for name, menu in self._menus.items()
            for title, action in _leaves(menu, name)
        ]

    def show_recent(self) -> None:
        """Fill the menu of recent files anew."""
        self._recent.clear()
        for path in recent():
            action = self._add(self._recent, Path(path).name, partial(self._open, path))
            action.setToolTip(path)
        self._recent.setToolTipsVisible(True)
        self._recent.setEnabled(not self._recent.isEmpty())
        self._recent.addSeparator()
        self._add(self._recent, "Clear this list", self._forget)

    def scene_menu(self) -> QMenu:
        """Return the menu for a place of the scene without singularity."""
        menu = QMenu(self._bar)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        tools = (f"add-{v}" for v in OWN_TOOLS)
        for name in ("select", *tools, "add-any", "add-pair", "fit"):
            menu.addAction(self._actions[name])
        return menu

    def _forget(self) -> None:
        forget_all()
        self.show_recent()

    def _fill_view(self, panels: Iterable[QAction]) -> None:
        view = self._menus["View"]
        methods = QMenu("Method", self._bar)
        for method in METHODS:
            methods.addAction(self._actions[f"method-{method}"])
        view.insertMenu(self._actions["fit"], methods)
        shown = self._submenu(view, "Panels")
        before = shown.actions()[0]
        for action in panels:
            shown.insertAction(before, action)
        shown.insertSeparator(before)

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


def _leaves(menu: QMenu, title: str) -> list[tuple[str, QAction]]:
    """Return the actions of a menu and its submenus, each with the titles of what it is in."""
    found = []
    for action in menu.actions():
        inner = action.menu()
        if isinstance(inner, QMenu):
            if inner.title() not in REPEATED:
                found += _leaves(inner, f"{title}: {inner.title()}")
        elif not action.isSeparator():
            found.append((title, action))
    return found
