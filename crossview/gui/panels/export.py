"""The Export panel: size, scale and transparency of a figure."""

from __future__ import annotations

from PySide6.QtCore import QLocale
from PySide6.QtGui import QAction
from PySide6.QtWidgets import (
    QCheckBox,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QSpinBox,
    QWidget,
)

from crossview.gui.figure_settings import FigureSettings
from crossview.gui.panels.texts import grouped

MOST_PIXELS = 16384


class ExportPanel(QWidget):
    """Edits `FigureSettings`; its button exports."""

    def __init__(self, export: QAction, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        default = FigureSettings()
        self.width_box = _pixels(default.size[0])
        self.height_box = _pixels(default.size[1])
        self.scale_box = _box(1, 8, default.scale)
        self.scale_box.setSuffix("×")
        self.transparent_box = QCheckBox("Transparent background")
        self.result = QLabel()
        self.result.setForegroundRole(self.palette().ColorRole.PlaceholderText)
        self.button = QPushButton(export.icon(), "Export figure…")
        self.button.clicked.connect(export.trigger)
        export.enabledChanged.connect(self.button.setEnabled)
        self.button.setEnabled(export.isEnabled())
        pair = QHBoxLayout()
        pair.setSpacing(4)
        pair.addWidget(self.width_box, 1)
        pair.addWidget(QLabel("×"))
        pair.addWidget(self.height_box, 1)
        form = QFormLayout(self)
        form.setContentsMargins(10, 8, 10, 8)
        form.setVerticalSpacing(6)
        form.addRow("Size", pair)
        form.addRow("Scale", self.scale_box)
        form.addRow(self.transparent_box)
        form.addRow(self.result)
        form.addRow(self.button)
        for box in (self.width_box, self.height_box, self.scale_box):
            box.valueChanged.connect(self._show_result)
        self._show_result()

    @property
    def settings(self) -> FigureSettings:
        """What the boxes say."""
        size = (self.width_box.value(), self.height_box.value())
        return FigureSettings(size, self.scale_box.value(), self.transparent_box.isChecked())

    def _show_result(self) -> None:
        settings = self.settings
        width, height = (side * settings.scale for side in settings.size)
        self.result.setText(f"{grouped(width)} × {grouped(height)} pixels")


def _pixels(value: int) -> QSpinBox:
    box = _box(16, MOST_PIXELS, value)
    box.setSingleStep(100)
    return box


def _box(low: int, high: int, value: int) -> QSpinBox:
    box = QSpinBox()
    box.setLocale(QLocale.c())
    box.setRange(low, high)
    box.setValue(value)
    return box
