"""What is shown before anything is open: where to drop a file, and three cases to begin with."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QIcon, QResizeEvent
from PySide6.QtWidgets import QHBoxLayout, QLabel, QPushButton, QToolButton, QVBoxLayout, QWidget

from crossview.gui.gallery import thumbnail
from crossview.gui.icons import put_icon

THUMBNAIL, SMALLEST = 208, 120
"""Width of a picture, in pixels, at most and at least. Chosen."""

ASPECT, GAP = 4 / 3, 16
"""Width of a picture over its height; pixels between two. Chosen."""

FEATURED = (
    ("sphere-cube", "Cube on a sphere"),
    ("disk-4", "Four on a disk"),
    ("suboptimal-a", "Plate with holes"),
)
"""Cases of the gallery that are offered, and what is said of them."""


class EmptyState(QWidget):
    """Never a blank grey box."""

    chosen = Signal(str)
    """Name of a gallery case."""
    open_wanted = Signal()
    tour_wanted = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setAutoFillBackground(True)
        self.setBackgroundRole(self.palette().ColorRole.Base)
        drop = QLabel()
        put_icon(drop, "drop")
        title = _words("Drop a surface here, or start from a case")
        font = title.font()
        font.setPointSizeF(font.pointSizeF() * 1.5)
        title.setFont(font)
        formats = _words("OBJ, PLY, STL, OFF, VTK, VTP, GLTF, GLB, MSH, projects, cases")
        formats.setForegroundRole(self.palette().ColorRole.PlaceholderText)
        browse = QPushButton("Open a file…")
        put_icon(browse, "open")
        browse.clicked.connect(self.open_wanted)
        self.tour = QPushButton("Take the tour of one minute")
        put_icon(self.tour, "solve")
        self.tour.clicked.connect(self.tour_wanted)
        choices = QHBoxLayout()
        choices.addWidget(browse)
        choices.addWidget(self.tour)
        self.thumbnails = [self._thumbnail(name, text) for name, text in FEATURED]
        row = QHBoxLayout()
        row.setSpacing(GAP)
        row.addStretch()
        for button in self.thumbnails:
            row.addWidget(button)
        row.addStretch()
        layout = QVBoxLayout(self)
        layout.addStretch(3)
        drop.setAlignment(Qt.AlignmentFlag.AlignHCenter)
        for label, space in ((drop, 8), (title, 4), (formats, 16)):
            layout.addWidget(label)
            layout.addSpacing(space)
        choices.setAlignment(Qt.AlignmentFlag.AlignHCenter)
        layout.addLayout(choices)
        layout.addSpacing(32)
        layout.addLayout(row)
        layout.addStretch(4)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Let the thumbnails shrink with the window."""
        room = (self.width() - 6 * GAP) // len(self.thumbnails)
        width = min(max(room, SMALLEST), THUMBNAIL)
        for button in self.thumbnails:
            button.setIconSize(QSize(width, round(width / ASPECT)))
        super().resizeEvent(event)

    def _thumbnail(self, name: str, text: str) -> QToolButton:
        button = QToolButton()
        button.setObjectName(name)
        button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextUnderIcon)
        button.setAutoRaise(True)
        button.setMinimumWidth(SMALLEST)
        button.setIcon(QIcon(thumbnail(name)))
        button.setText(text)
        button.clicked.connect(lambda: self.chosen.emit(name))
        return button


def _words(text: str) -> QLabel:
    """Return a label in the middle that takes more lines where there is less room."""
    label = QLabel(text)
    label.setWordWrap(True)
    label.setAlignment(Qt.AlignmentFlag.AlignHCenter)
    return label
