"""The settings of one layer: only those it listens to."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from PySide6.QtCore import QLocale, QSignalBlocker, QSize, Qt
from PySide6.QtGui import QIcon, QImage, QPixmap
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDoubleSpinBox,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QSlider,
    QWidget,
)

from crossview.scene import LayerKind, LayerSettings
from crossview.session.session import Session
from crossview.view.colors import BAD, CYCLIC, DIVERGING, color_table
from crossview.view.scalars import SCALARS

STEPS = 100
"""Steps of a slider. Chosen."""

COLORINGS = {"quality": "Scaled Jacobian", "patch": "Patches", "plain": "Plain"}
"""Names and labels of what quads are coloured by."""

FAINTEST = 0.05
"""Opacity at the left end of a slider: an open eye shows something. Chosen."""

FACTOR = 2.5
"""Sliders of factors go from 1 / FACTOR to FACTOR, 1 in the middle. Chosen."""


class LayerEditor(QWidget):
    """Edits the `LayerSettings` of one kind of layer."""

    def __init__(self, kind: LayerKind, session: Session) -> None:
        super().__init__()
        self._name = kind.name
        self._session = session
        self._refresh: list[Callable[[LayerSettings], None]] = []
        self.show_limits: Callable[[tuple[float, float]], None] = lambda _: None
        """Follows the range in use, where one is fitted."""
        self._form = QFormLayout(self)
        self._form.setContentsMargins(10, 4, 10, 4)
        self._form.setVerticalSpacing(6)
        make = {
            "opacity": lambda: self._add_slider("Opacity", "opacity", _opacity, _from_opacity),
            "size": lambda: self._add_slider("Size", "size", _factor, _from_factor),
            "density": lambda: self._add_slider("Density", "density", _factor, _from_factor),
            "color_map": self._add_color_map,
            "value_range": self._add_range,
            "uniform": lambda: self._add_check("One size", "uniform"),
            "edges": lambda: self._add_check("Edges", "edges"),
            "shaded": lambda: self._add_check("Shaded", "shaded"),
            "coloring": self._add_coloring,
        }
        for setting in kind.settings:
            make[setting]()

    def show_settings(self, settings: LayerSettings) -> None:
        """Follow the layer's settings without answering back."""
        for refresh in self._refresh:
            refresh(settings)

    def _set(self, **changes: Any) -> None:
        settings = replace(self._session.state.layers[self._name], **changes)
        self._session.looks.set_layer(self._name, settings)

    def _add_slider(
        self,
        title: str,
        setting: str,
        value: Callable[[int], float],
        step: Callable[[float], int],
    ) -> None:
        slider = QSlider(Qt.Orientation.Horizontal)
        slider.setObjectName(setting)
        slider.setAccessibleName(title)
        slider.setRange(0, STEPS)
        slider.valueChanged.connect(lambda at: self._set(**{setting: value(at)}))
        self._form.addRow(title, slider)

        def refresh(settings: LayerSettings) -> None:
            with QSignalBlocker(slider):
                slider.setValue(step(getattr(settings, setting)))
            slider.setToolTip(f"{title} {getattr(settings, setting):.2f}")

        self._refresh.append(refresh)

    def _add_check(self, title: str, setting: str) -> None:
        box = QCheckBox(title)
        box.setObjectName(setting)
        box.toggled.connect(lambda on: self._set(**{setting: on}))
        self._form.addRow(box)

        def refresh(settings: LayerSettings) -> None:
            with QSignalBlocker(box):
                box.setChecked(getattr(settings, setting))

        self._refresh.append(refresh)

    def _add_color_map(self) -> None:
        combo = QComboBox()
        combo.setObjectName("color_map")
        combo.setIconSize(QSize(56, 12))
        for name in _color_maps(SCALARS[self._name].color_map):
            combo.addItem(_gradient(name), name)
        combo.activated.connect(lambda at: self._set(color_map=combo.itemText(at)))
        self._form.addRow("Colours", combo)

        def refresh(settings: LayerSettings) -> None:
            with QSignalBlocker(combo):
                combo.setCurrentIndex(max(0, combo.findText(settings.color_map)))

        self._refresh.append(refresh)

    def _add_coloring(self) -> None:
        combo = QComboBox()
        combo.setObjectName("coloring")
        for name, label in COLORINGS.items():
            combo.addItem(label, name)
        combo.activated.connect(lambda at: self._set(coloring=combo.itemData(at)))
        self._form.addRow("Colours", combo)

        def refresh(settings: LayerSettings) -> None:
            with QSignalBlocker(combo):
                combo.setCurrentIndex(combo.findData(settings.coloring))

        self._refresh.append(refresh)

    def _add_range(self) -> None:
        auto = QCheckBox("Fit range to 98 %")
        auto.setToolTip("Leave out the far ends, which few places reach")
        low, high = _number(-1.0), _number(1.0)
        low.setAccessibleName("Least value of the colours")
        high.setAccessibleName("Largest value of the colours")
        pair = QHBoxLayout()
        pair.setContentsMargins(0, 0, 0, 0)
        pair.addWidget(low)
        pair.addWidget(high)

        def changed() -> None:
            if auto.isChecked():
                self._set(value_range=None)
            elif low.value() < high.value():
                self._set(value_range=(low.value(), high.value()))
            wrong.setVisible(not auto.isChecked() and low.value() >= high.value())

        def refresh(settings: LayerSettings) -> None:
            with QSignalBlocker(auto), QSignalBlocker(low), QSignalBlocker(high):
                auto.setChecked(settings.value_range is None)
                low.setEnabled(settings.value_range is not None)
                high.setEnabled(settings.value_range is not None)
                if settings.value_range is not None:
                    low.setValue(settings.value_range[0])
                    high.setValue(settings.value_range[1])

        def fitted(limits: tuple[float, float]) -> None:
            if auto.isChecked():
                with QSignalBlocker(low), QSignalBlocker(high):
                    low.setValue(limits[0])
                    high.setValue(limits[1])

        self.show_limits = fitted
        auto.toggled.connect(changed)
        low.valueChanged.connect(changed)
        high.valueChanged.connect(changed)
        self._form.addRow(auto)
        self._form.addRow("Range", pair)
        wrong = QLabel("Not taken: the first must be the smaller one")
        wrong.setWordWrap(True)
        wrong.setStyleSheet(f"color: {BAD}")
        wrong.hide()
        self._form.addRow(wrong)
        self._refresh.append(refresh)


def _color_maps(own: str) -> tuple[str, ...]:
    """Return the colour maps that mean the same kind of thing as a scalar's own, that one first."""
    for family in (DIVERGING, CYCLIC):
        if own in family:
            return (own, *(name for name in family if name != own))
    return (own,)


def _opacity(step: int) -> float:
    return FAINTEST + (1.0 - FAINTEST) * step / STEPS


def _from_opacity(value: float) -> int:
    return round((value - FAINTEST) / (1.0 - FAINTEST) * STEPS)


def _factor(step: int) -> float:
    return float(FACTOR ** (2.0 * step / STEPS - 1.0))


def _from_factor(value: float) -> int:
    return round(STEPS * (float(np.log(value) / np.log(FACTOR)) + 1.0) / 2.0)


def _number(value: float) -> QDoubleSpinBox:
    box = QDoubleSpinBox()
    box.setLocale(QLocale.c())
    box.setRange(-100.0, 100.0)
    box.setValue(value)
    box.setSingleStep(0.1)
    box.setKeyboardTracking(False)
    return box


def _gradient(name: str) -> QIcon:
    row = np.ascontiguousarray(np.tile(color_table(name, size=112), (24, 1, 1)))
    image = QImage(row.data, 112, 24, QImage.Format.Format_RGBA8888)
    return QIcon(QPixmap.fromImage(image.copy()))
