"""Light, dark, or as the system has it."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QGuiApplication, QPalette
from PySide6.QtWidgets import QApplication

Role, Group = QPalette.ColorRole, QPalette.ColorGroup

SCHEMES = {
    "system": Qt.ColorScheme.Unknown,
    "light": Qt.ColorScheme.Light,
    "dark": Qt.ColorScheme.Dark,
}
"""Themes by name."""

DARK = {
    Role.Window: "#454b55",
    Role.WindowText: "#e6e8eb",
    Role.Base: "#1d2026",
    Role.AlternateBase: "#262a31",
    Role.Text: "#e6e8eb",
    Role.PlaceholderText: "#9aa1ab",
    Role.Button: "#4a505b",
    Role.ButtonText: "#e6e8eb",
    Role.BrightText: "#ffffff",
    Role.ToolTipBase: "#3a3f48",
    Role.ToolTipText: "#e6e8eb",
    Role.Highlight: "#2f6fde",
    Role.HighlightedText: "#ffffff",
    Role.Link: "#7aa7f0",
    Role.Light: "#4a505b",
    Role.Midlight: "#424751",
    Role.Mid: "#6b7380",
    Role.Dark: "#6b7380",
    Role.Shadow: "#101216",
}
"""Colours where the platform has no dark ones of its own."""

FAINT = "#8b929d"
"""Of text that is disabled, there."""


CHECK_BOX = "#aab1bc"
"""What the frame of a box to tick is drawn darker than, there: else it is not seen."""


def apply_theme(theme: str) -> None:
    """Give all windows a theme, a key of `SCHEMES`."""
    hints = QGuiApplication.styleHints()
    hints.setColorScheme(SCHEMES[theme])
    QApplication.setPalette(QApplication.style().standardPalette())
    if theme != "system" and is_dark() != (theme == "dark"):
        QApplication.setPalette(_dark() if theme == "dark" else QPalette(QColor("#efefef")))
        if theme == "dark":
            boxes = _dark()
            boxes.setColor(Role.Window, QColor(CHECK_BOX))
            QApplication.setPalette(boxes, "QCheckBox")  # type: ignore[arg-type]  # PySide's stub errs


def is_dark() -> bool:
    """Return whether windows are dark."""
    return QApplication.palette().color(Role.Window).lightnessF() < 0.5


def _dark() -> QPalette:
    palette = QPalette()
    for role, color in DARK.items():
        palette.setColor(role, QColor(color))
    for role in (Role.WindowText, Role.Text, Role.ButtonText):
        palette.setColor(Group.Disabled, role, QColor(FAINT))
    palette.setColor(Group.Disabled, Role.Highlight, QColor(DARK[Role.Mid]))
    return palette
