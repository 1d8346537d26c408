"""The Singularities panel: the table with add, delete, change of valence and lock."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import QEvent, QModelIndex, QObject, QPersistentModelIndex, QSize, Qt
from PySide6.QtGui import QAction, QGuiApplication, QKeyEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QApplication,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QMenu,
    QSpinBox,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QTableView,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from crossview.gui.focus_frames import frame_focus
from crossview.gui.icons import put_icon
from crossview.gui.panels.singularity_model import LOCK, POSITION, VALENCE, SingularityModel
from crossview.session.commands import MIN_VALENCE
from crossview.session.session import Session
from crossview.session.state import SessionState


class ValenceDelegate(QStyledItemDelegate):
    """Edits a valence with a spin box."""

    def createEditor(
        self,
        parent: QWidget,
        option: QStyleOptionViewItem,
        index: QModelIndex | QPersistentModelIndex,
    ) -> QWidget:
        """Return a spin box over the allowed valences."""
        editor = QSpinBox(parent)
        editor.setRange(MIN_VALENCE, 99)  # what is not offered is refused with the reason
        editor.setFrame(False)
        return editor

    def eventFilter(self, editor: QObject, event: QEvent) -> bool:
        """Let Return end the editing, though it is also the key that begins it."""
        ends = (Qt.Key.Key_Return, Qt.Key.Key_Enter)
        if (
            event.type() == QEvent.Type.ShortcutOverride
            and isinstance(event, QKeyEvent)
            and event.key() in ends
        ):
            event.accept()
            return True
        return super().eventFilter(editor, event)


class SingularitiesPanel(QWidget):
    """Table of the singularities; the selection is shared with the scene."""

    def __init__(
        self, session: Session, actions: Mapping[str, QAction], parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self._session = session
        self._actions = actions
        self._before: QWidget | None = None
        self.model = SingularityModel(session, self)
        self.table = self._make_table()
        buttons = QHBoxLayout()
        buttons.setContentsMargins(8, 0, 8, 0)
        buttons.setSpacing(2)
        buttons.addWidget(self._make_add_button())
        buttons.addWidget(_button(actions["delete"]))
        buttons.addStretch()
        for name in ("lower", "raise"):
            buttons.addWidget(_button(actions[name]))
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 4)
        layout.setSpacing(4)
        self.hint = QLabel("None yet. Choose a valence (3 5 6 8) and click on the surface.")
        self.hint.setWordWrap(True)
        self.hint.setContentsMargins(10, 8, 10, 8)
        self.hint.setAlignment(Qt.AlignmentFlag.AlignTop)
        self.hint.setForegroundRole(self.palette().ColorRole.PlaceholderText)
        layout.addWidget(self.hint, 1)
        layout.addWidget(self.table, 1)
        layout.addLayout(buttons)

        self.show_state(session.state, session.state)

    def show_state(self, old: SessionState, new: SessionState) -> None:
        """Follow the window's state."""
        if old.singularities is not new.singularities or old.document is not new.document:
            self.model.show_state(new)
        self.hint.setVisible(not new.singularities)
        self.table.setVisible(bool(new.singularities))
        self._select(new.focus.selected)

    def edit(self, row: int) -> None:
        """Edit the valence of singularity `row` in its cell; then the focus goes back."""
        self._before = QApplication.focusWidget()
        self.table.setFocus()
        self.table.edit(self.model.index(row, VALENCE))

    def _edited(self) -> None:
        before, self._before = self._before, None
        if before is not None:
            before.setFocus()

    def _make_table(self) -> QTableView:
        table = QTableView()
        table.setModel(self.model)
        frame_focus(table)
        table.setShowGrid(False)
        table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        table.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        delegate = ValenceDelegate(table)
        delegate.closeEditor.connect(self._edited, Qt.ConnectionType.QueuedConnection)
        table.setItemDelegateForColumn(VALENCE, delegate)
        table.setTabKeyNavigation(False)
        table.setAccessibleName("Singularities")
        table.setIconSize(QSize(14, 14))
        table.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        table.verticalHeader().hide()
        table.verticalHeader().setDefaultSectionSize(24)
        header = table.horizontalHeader()
        header.setHighlightSections(False)
        header.setMinimumSectionSize(24)
        header.setSectionResizeMode(QHeaderView.ResizeMode.Fixed)
        header.setSectionResizeMode(POSITION, QHeaderView.ResizeMode.Stretch)
        for column, width in enumerate((42, 52, 42, 100, 26)):
            table.setColumnWidth(column, width)
        table.clicked.connect(self._clicked)
        table.selectionModel().currentRowChanged.connect(self._current_changed)
        table.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        table.customContextMenuRequested.connect(
            lambda place: self.menu().popup(table.viewport().mapToGlobal(place))
        )
        return table

    def menu(self) -> QMenu:
        """Return the verbs for the selected singularity, as the scene's right-click offers."""
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        for name in ("raise", "lower", "split", "merge", "lock", "delete"):
            menu.addAction(self._actions[name])
        return menu

    def _make_add_button(self) -> QToolButton:
        button = QToolButton()
        button.setText("Add…")
        put_icon(button, "plus")
        button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        button.setAutoRaise(True)
        button.setToolTip("Choose a valence, then click on the surface")
        menu = QMenu(button)
        for name in ("add-3", "add-5", "add-6", "add-8", "add-any"):
            menu.addAction(self._actions[name])
        # not the button's own menu, whose arrow would stand below the word
        button.clicked.connect(lambda: menu.popup(button.mapToGlobal(button.rect().bottomLeft())))
        return button

    def _clicked(self, index: QModelIndex) -> None:
        if index.column() == LOCK:
            self._session.edits.toggle_lock(index.row())

    def _current_changed(self, current: QModelIndex) -> None:
        if current.isValid() and current.row() != self._session.state.focus.selected:
            held = QGuiApplication.keyboardModifiers()
            both = bool(held & Qt.KeyboardModifier.ControlModifier)
            self._session.pointer.select(current.row(), both)

    def _select(self, row: int | None) -> None:
        if row is None:
            self.table.clearSelection()
            self.table.setCurrentIndex(QModelIndex())
        elif self.table.currentIndex().row() != row:
            self.table.selectRow(row)


def _button(action: QAction) -> QToolButton:
    button = QToolButton()
    button.setDefaultAction(action)
    button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonIconOnly)
    button.setAutoRaise(True)
    return button
