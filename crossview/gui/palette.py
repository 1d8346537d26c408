"""The command palette: every action by name."""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import QEvent, QObject, QSize, Qt
from PySide6.QtGui import QAction, QIcon, QKeyEvent, QPixmap
from PySide6.QtWidgets import (
    QFrame,
    QHeaderView,
    QLabel,
    QLineEdit,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

WIDTH, ROWS = 480, 14
"""Of the palette, in pixels and in rows. Chosen."""

ROW, ICON = QSize(0, 26), QSize(16, 16)
"""Sizes of a row and of an icon, in pixels. Chosen."""

KEYS = {"-": "Minus", "+": "Plus"}
"""Words for keys that look like nothing in a list."""

PANELS = "View: Panels:"
"""Titles of the actions that show and hide panels begin so."""


class Palette(QFrame):
    """A search field over a list; Enter runs, Esc or a click elsewhere closes."""

    def __init__(self, actions: Iterable[tuple[str, QAction]], parent: QWidget) -> None:
        super().__init__(parent, Qt.WindowType.Popup)
        self._over = parent
        blank = QPixmap(ICON)
        blank.fill(Qt.GlobalColor.transparent)
        self._blank = QIcon(blank)  # so that all titles stand in line
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setFrameShape(QFrame.Shape.StyledPanel)
        usable = [(title, action) for title, action in actions if action.isEnabled()]
        # what a panel shows comes after what is done
        self._actions = sorted(usable, key=lambda named: named[0].startswith(PANELS))
        self.search = QLineEdit()
        self.search.setPlaceholderText("Search actions")
        self.search.setClearButtonEnabled(True)
        self.list = QTreeWidget()
        self.list.setColumnCount(2)
        self.list.setHeaderHidden(True)
        self.list.setRootIsDecorated(False)
        self.list.setUniformRowHeights(True)
        self.list.setIconSize(ICON)
        self.list.setFrameShape(QFrame.Shape.NoFrame)
        header = self.list.header()
        header.setStretchLastSection(False)
        header.setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        header.setSectionResizeMode(1, QHeaderView.ResizeMode.ResizeToContents)
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(8, 8, 8, 8)
        layout.addWidget(self.search)
        layout.addWidget(self.list)
        self.tip = QLabel()
        self.tip.setWordWrap(True)
        self.tip.setMinimumHeight(2 * self.tip.fontMetrics().height())
        self.tip.setAlignment(Qt.AlignmentFlag.AlignTop)
        self.tip.setForegroundRole(self.palette().ColorRole.PlaceholderText)
        layout.addWidget(self.tip)
        self.list.currentItemChanged.connect(self._show_tip)
        self.search.textChanged.connect(self._filter)
        self.search.returnPressed.connect(self.run)
        self.search.installEventFilter(self)
        self.list.itemClicked.connect(lambda _: self.run())
        self._filter("")
        self.resize(WIDTH, ROWS * ROW.height() + 90)

    def popup(self) -> None:
        """Open in the upper middle of the parent."""
        corner = self._over.mapToGlobal(self._over.rect().topLeft())
        self.move(corner.x() + (self._over.width() - self.width()) // 2, corner.y() + 80)
        self.show()
        self.search.setFocus()

    def run(self) -> None:
        """Run the chosen action."""
        item = self.list.currentItem()
        if item is not None:
            action = item.data(0, Qt.ItemDataRole.UserRole)
            self.close()
            action.trigger()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Let the arrows move in the list while the field has the focus."""
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress:
            step = {Qt.Key.Key_Down: 1, Qt.Key.Key_Up: -1}.get(Qt.Key(event.key()))
            if step is not None:
                self._step(step)
                return True
        return super().eventFilter(watched, event)

    def _step(self, step: int) -> None:
        """Choose the item below or above, around the ends."""
        present = self.list.currentItem()
        if present is not None:
            row = self.list.indexOfTopLevelItem(present) + step
            self._choose(row % self.list.topLevelItemCount())

    def _choose(self, row: int) -> None:
        item = self.list.topLevelItem(row)
        if item is not None:
            self.list.setCurrentItem(item)

    def _show_tip(self, item: QTreeWidgetItem | None) -> None:
        """Say what the chosen action does."""
        action = None if item is None else item.data(0, Qt.ItemDataRole.UserRole)
        self.tip.setText("" if action is None else action.toolTip().partition("\n")[2])

    def _filter(self, text: str) -> None:
        words = text.lower().split()
        self.list.clear()
        for title, action in self._actions:
            searched = f"{title} {action.toolTip()}".lower()
            if all(word in searched for word in words):
                key = action.shortcut().toString()
                item = QTreeWidgetItem(self.list, [title, KEYS.get(key, key)])
                item.setIcon(0, action.icon() if not action.icon().isNull() else self._blank)
                item.setSizeHint(0, ROW)
                item.setData(0, Qt.ItemDataRole.UserRole, action)
                item.setToolTip(0, action.toolTip())
        self._choose(0)
