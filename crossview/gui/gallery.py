"""The gallery: every case with its picture and a sentence, in groups."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QIcon, QPixmap
from PySide6.QtWidgets import (
    QDialog,
    QFrame,
    QGridLayout,
    QLabel,
    QScrollArea,
    QSizePolicy,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from crossview.cases.gallery import RESOURCES, Exhibit, exhibits, path_of
from crossview.cases.model import Case

PICTURE, COLUMNS = QSize(208, 156), 4
"""Of a card, in pixels; cards side by side. Chosen: they fit beside each other at 1280."""

ROOM = 640
"""Height that the dialog asks for, in pixels. Chosen."""


def thumbnail(case: str) -> QPixmap:
    """Return the picture of a gallery case."""
    picture = QPixmap()
    picture.loadFromData((RESOURCES / "thumbnails" / f"{case}.png").read_bytes())
    return picture


class Gallery(QDialog):
    """A card for each case: a click opens it."""

    chosen = Signal(str)
    """Name of a gallery case."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle("Gallery")
        self.cards: dict[str, QToolButton] = {}
        inside = QWidget()
        column = QVBoxLayout(inside)
        column.setSpacing(8)
        for title, cases in groupby(exhibits(), key=lambda each: each.group):
            heading = QLabel(title)
            font = heading.font()
            font.setPointSizeF(font.pointSizeF() * 1.25)
            heading.setFont(font)
            column.addWidget(heading)
            column.addLayout(self._group(tuple(cases)))
            column.addSpacing(16)
        area = QScrollArea()
        area.setWidgetResizable(True)
        area.setFrameShape(QFrame.Shape.NoFrame)
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        area.setWidget(inside)
        area.setMinimumWidth(inside.minimumSizeHint().width() + 24)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(8, 8, 0, 8)
        layout.addWidget(area)
        self.resize(self.sizeHint().width(), min(ROOM, parent.height()))

    def _group(self, cases: Sequence[Exhibit]) -> QGridLayout:
        grid = QGridLayout()
        grid.setSpacing(16)
        for number, exhibit in enumerate(cases):
            grid.addWidget(self._card(exhibit), number // COLUMNS, number % COLUMNS)
        for column in range(COLUMNS):  # cards of a short row are as wide as those of a full one
            grid.setColumnMinimumWidth(column, PICTURE.width())
        grid.setColumnStretch(COLUMNS, 1)
        return grid

    def _card(self, exhibit: Exhibit) -> QWidget:
        title = Case.load(path_of(exhibit.case)).title
        button = QToolButton()
        button.setObjectName(exhibit.case)
        button.setAccessibleName(title)
        button.setAccessibleDescription(exhibit.sentence)
        button.setAutoRaise(True)
        button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        button.setIcon(QIcon(thumbnail(exhibit.case)))
        button.setIconSize(PICTURE)
        button.clicked.connect(lambda: self._choose(exhibit.case))
        self.cards[exhibit.case] = button
        name, sentence = QLabel(title), QLabel(exhibit.sentence)
        font = name.font()
        font.setBold(True)
        name.setFont(font)
        sentence.setForegroundRole(self.palette().ColorRole.PlaceholderText)
        card = QWidget()
        column = QVBoxLayout(card)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(4)
        column.addWidget(button)
        for text in (name, sentence):
            text.setWordWrap(True)
            text.setFixedWidth(PICTURE.width())
            text.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.MinimumExpanding)
            column.addWidget(text)
        column.addStretch()
        return card

    def _choose(self, case: str) -> None:
        self.accept()
        self.chosen.emit(case)
