"""The command palette: every action by name."""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QAction, QKeyEvent
from PySide6.QtWidgets import (
    QFrame,
    QLineEdit,
    QListWidget,
    QListWidgetItem,
    QVBoxLayout,
    QWidget,
)

WIDTH, ROWS, ROW_HEIGHT = 460, 12, 28


class Palette(QFrame):
    """A search field over a list; Enter runs, Esc or a click elsewhere closes."""

    def __init__(self, actions: Iterable[tuple[str, QAction]], parent: QWidget) -> None:
        super().__init__(parent, Qt.WindowType.Popup)
        self._over = parent
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setFrameShape(QFrame.Shape.StyledPanel)
        self._actions = [(title, action) for title, action in actions if action.isEnabled()]
        self.search = QLineEdit()
        self.search.setPlaceholderText("Search actions")
        self.search.setClearButtonEnabled(True)
        self.list = QListWidget()
        self.list.setFrameShape(QFrame.Shape.NoFrame)
        self.list.setUniformItemSizes(True)
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(8, 8, 8, 8)
        layout.addWidget(self.search)
        layout.addWidget(self.list)
        self.search.textChanged.connect(self._filter)
        self.search.returnPressed.connect(self.run)
        self.search.installEventFilter(self)
        self.list.itemClicked.connect(lambda _: self.run())
        self._filter("")
        self.resize(WIDTH, ROWS * ROW_HEIGHT + 60)

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
            action = item.data(Qt.ItemDataRole.UserRole)
            self.close()
            action.trigger()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Let the arrows move in the list while the field has the focus."""
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress:
            step = {Qt.Key.Key_Down: 1, Qt.Key.Key_Up: -1}.get(Qt.Key(event.key()))
            if step is not None and self.list.count():
                self.list.setCurrentRow((self.list.currentRow() + step) % self.list.count())
                return True
        return super().eventFilter(watched, event)

    def _filter(self, text: str) -> None:
        words = text.lower().split()
        self.list.clear()
        for title, action in self._actions:
            searched = f"{title} {action.toolTip()}".lower()
            if all(word in searched for word in words):
                keys = action.shortcut().toString()
                item = QListWidgetItem(action.icon(), f"{title}    {keys}" if keys else title)
                item.setData(Qt.ItemDataRole.UserRole, action)
                self.list.addItem(item)
        self.list.setCurrentRow(0)
