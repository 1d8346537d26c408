"""What a user prefers, kept in the settings from one session to the next, and its dialog."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any

from PySide6.QtCore import QSettings
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QSpinBox,
    QVBoxLayout,
    QWidget,
)

from crossview.gui.theme import SCHEMES
from crossview.workflow.quads import DEFAULT_QUADS
from solvers.quads import MOST_QUADS

KEPT = "preferences"
"""Where settings keep them."""


@dataclass(frozen=True)
class Preferences:
    """What a user prefers.

    Parameters
    ----------
    theme : {"system", "light", "dark"}
    shaded : bool
        Whether the colours of scalars are lit at first.
    copies : bool
        Whether a copy of unsaved work is kept after each step.
    quads : int
        How many quads are asked for at first.
    """

    theme: str = "system"
    shaded: bool = False
    copies: bool = True
    quads: int = DEFAULT_QUADS

    @classmethod
    def load(cls) -> Preferences:
        """Return those of the settings; what makes no sense there is as at first."""
        settings = QSettings()
        found: dict[str, Any] = {}
        for part in fields(cls):
            value = settings.value(f"{KEPT}/{part.name}", part.default, type(part.default))
            found[part.name] = value
        theme = found["theme"] if found["theme"] in SCHEMES else cls.theme
        return cls(**found | {"theme": theme, "quads": min(max(found["quads"], 1), MOST_QUADS)})

    def keep(self) -> None:
        """Put them into the settings."""
        settings = QSettings()
        for part in fields(self):
            settings.setValue(f"{KEPT}/{part.name}", getattr(self, part.name))


class PreferencesDialog(QDialog):
    """Edits preferences; each change is in force at once.

    Parameters
    ----------
    preferences : Preferences
        As they are.
    changed : callable
        Told of them after each change.
    parent : QWidget
    """

    def __init__(
        self,
        preferences: Preferences,
        changed: Callable[[Preferences], None],
        parent: QWidget,
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle("Preferences")
        self._changed = changed
        self.theme = QComboBox()
        for theme in SCHEMES:
            self.theme.addItem("As the system" if theme == "system" else theme.title(), theme)
        self.theme.setCurrentIndex(self.theme.findData(preferences.theme))
        self.shaded = QCheckBox("Shade the colours of scalars")
        self.shaded.setToolTip("Shows shape; unshaded, each colour is that of the bar")
        self.shaded.setChecked(preferences.shaded)
        self.copies = QCheckBox("Keep a copy of unsaved work after each step")
        self.copies.setToolTip("Offered again if the program ends before it is saved")
        self.copies.setChecked(preferences.copies)
        self.quads = QSpinBox()
        self.quads.setRange(1, MOST_QUADS)
        self.quads.setSingleStep(500)
        self.quads.setValue(preferences.quads)
        form = QFormLayout()
        form.addRow("Theme", self.theme)
        form.addRow("Quads at first", self.quads)
        form.addRow(self.shaded)
        form.addRow(self.copies)
        close = QDialogButtonBox(QDialogButtonBox.StandardButton.Close)
        close.rejected.connect(self.close)
        layout = QVBoxLayout(self)
        layout.addLayout(form)
        layout.addWidget(close)
        self.theme.currentIndexChanged.connect(self._tell)
        self.shaded.toggled.connect(self._tell)
        self.copies.toggled.connect(self._tell)
        self.quads.valueChanged.connect(self._tell)

    def _tell(self) -> None:
        self._changed(
            Preferences(
                self.theme.currentData(),
                self.shaded.isChecked(),
                self.copies.isChecked(),
                self.quads.value(),
            )
        )
