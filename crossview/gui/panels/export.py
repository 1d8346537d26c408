"""The Export panel: how a figure is drawn, and a preview of it."""

from __future__ import annotations

from PySide6.QtCore import QLocale, QSignalBlocker, QSize, Qt, Signal
from PySide6.QtGui import QAction, QResizeEvent
from PySide6.QtWidgets import (
    QCheckBox,
    QDoubleSpinBox,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QScrollArea,
    QSizePolicy,
    QSpinBox,
    QWidget,
)

from crossview.export.raster import LONGEST_SIDE, SHORTEST_SIDE
from crossview.gui.figure import INCH, FigureSettings
from crossview.gui.icons import put_icon
from crossview.gui.panels.scrolling import scrolled
from crossview.session.state import SessionState
from crossview.view.texts import grouped

LONGEST_TITLE = 200
"""Of letters. Chosen."""

LEAST_PREVIEW = QSize(80, 48)
"""Size of the preview at least, in pixels. Chosen."""


class ExportPanel(QScrollArea):
    """Edits `FigureSettings` and shows what they give; its button exports.

    The size typed last, in pixels or on paper, is kept when the resolution is changed.
    """

    changed = Signal()
    """The settings are others now, or the room for the preview is."""
    titled = Signal(str)
    """Another title was typed."""

    def __init__(self, export: QAction, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        default = FigureSettings()
        self.title = QLineEdit()
        self.title.setAccessibleName("Title of the figure")
        self.title.setMaxLength(LONGEST_TITLE)
        self.title.setEnabled(False)
        self.title.editingFinished.connect(lambda: self.titled.emit(self.title.text().strip()))
        self.width_box = _pixels(default.size[0])
        self.height_box = _pixels(default.size[1])
        self.scale_box = _box(1, 8, default.scale)
        self.scale_box.setSuffix("×")
        self.dpi_box = _box(36, 2400, default.dpi)
        self.dpi_box.setSuffix(" dpi")
        self.dpi_box.setToolTip("Pixels of the file per inch on paper")
        self.across_box, self.up_box = QDoubleSpinBox(), QDoubleSpinBox()
        for length in (self.across_box, self.up_box):
            length.setLocale(QLocale.c())
            length.setDecimals(1)
            length.setToolTip("Size on paper, in millimetres")
        self._on_paper = False  # whether it was typed last
        for box, name in (
            (self.across_box, "Width on paper, millimetres"),
            (self.up_box, "Height on paper, millimetres"),
            (self.width_box, "Width, pixels"),
            (self.height_box, "Height, pixels"),
            (self.scale_box, "Scale"),
            (self.dpi_box, "Pixels per inch"),
        ):
            box.setAccessibleName(name)
        self.transparent_box = QCheckBox("Transparent")
        self.transparent_box.setToolTip("No background")
        self.result = QLabel()
        self.result.setForegroundRole(self.palette().ColorRole.PlaceholderText)
        self.preview = QLabel()
        self.preview.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.preview.setMinimumSize(LEAST_PREVIEW)
        self.preview.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Expanding)
        self.button = QPushButton("Export figure…")
        put_icon(self.button, "figure")
        self.button.clicked.connect(export.trigger)
        export.enabledChanged.connect(self.button.setEnabled)
        self.button.setEnabled(export.isEnabled())
        pair = QHBoxLayout()
        pair.setSpacing(4)
        pair.addWidget(self.width_box, 1)
        pair.addWidget(QLabel("×"))
        pair.addWidget(self.height_box, 1)
        paper = QHBoxLayout()
        paper.setSpacing(4)
        paper.addWidget(self.across_box, 1)
        paper.addWidget(QLabel("×"))
        paper.addWidget(self.up_box, 1)
        paper.addWidget(QLabel("mm"))
        fine = QHBoxLayout()
        fine.setSpacing(4)
        fine.addWidget(self.scale_box, 2)
        fine.addWidget(self.dpi_box, 3)
        form = QFormLayout()
        form.setVerticalSpacing(6)
        form.addRow("Title", self.title)
        form.addRow("Pixels", pair)
        form.addRow("Paper", paper)
        form.addRow("Scale", fine)
        last = QHBoxLayout()
        last.addWidget(self.transparent_box)
        last.addStretch()
        last.addWidget(self.result)
        form.addRow(last)
        layout = scrolled(self)
        layout.setContentsMargins(10, 8, 10, 8)
        layout.setSpacing(6)
        layout.addLayout(form)
        layout.addWidget(self.preview, 1)
        layout.addWidget(self.button)
        for box in (self.width_box, self.height_box):
            box.valueChanged.connect(lambda: self._follow(on_paper=False))
        for length in (self.across_box, self.up_box):
            length.valueChanged.connect(lambda: self._follow(on_paper=True))
        for box in (self.scale_box, self.dpi_box):
            box.valueChanged.connect(lambda: self._follow(self._on_paper))
        self.transparent_box.toggled.connect(self.changed)
        self._follow(on_paper=False)

    @property
    def settings(self) -> FigureSettings:
        """What the boxes say."""
        size = (self.width_box.value(), self.height_box.value())
        transparent = self.transparent_box.isChecked()
        return FigureSettings(size, self.scale_box.value(), transparent, self.dpi_box.value())

    def show_state(self, old: SessionState, new: SessionState) -> None:
        """Follow the window's state."""
        if old.document is not new.document:
            self.title.setEnabled(new.document is not None)
            self.title.setText("" if new.document is None else new.document.title)
            self.title.setCursorPosition(0)  # the beginning is seen
            self.title.setPlaceholderText("" if new.document is None else new.document.name)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Tell that there is other room for a preview."""
        super().resizeEvent(event)
        self.changed.emit()

    def _follow(self, on_paper: bool) -> None:
        """Bring pixels in line with the size on paper, or that with the pixels."""
        self._on_paper = on_paper
        lengths, sides = (self.across_box, self.up_box), (self.width_box, self.height_box)
        each = INCH / self.dpi_box.value()
        for length, side in zip(lengths, sides, strict=True):
            with QSignalBlocker(length), QSignalBlocker(side):
                length.setRange(SHORTEST_SIDE * each, LONGEST_SIDE * each)
                if on_paper:
                    side.setValue(round(length.value() / each / self.scale_box.value()))
                else:
                    length.setValue(side.value() * self.scale_box.value() * each)
        width, height = (side.value() * self.scale_box.value() for side in sides)
        self.result.setText(f"{grouped(width)} × {grouped(height)} pixels")
        self.changed.emit()


def _pixels(value: int) -> QSpinBox:
    box = _box(SHORTEST_SIDE, LONGEST_SIDE, value)
    box.setSingleStep(100)
    return box


def _box(low: int, high: int, value: int) -> QSpinBox:
    box = QSpinBox()
    box.setLocale(QLocale.c())
    box.setRange(low, high)
    box.setValue(value)
    return box
