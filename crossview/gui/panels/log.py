"""The Log panel: what was done, said and waited for."""

from __future__ import annotations

from PySide6.QtGui import QFontDatabase
from PySide6.QtWidgets import QPlainTextEdit, QWidget

from crossview.gui.focus_frames import frame_focus
from crossview.session.log import MOST, Log


class LogPanel(QPlainTextEdit):
    """A line for each entry, the newest last."""

    def __init__(self, log: Log, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setReadOnly(True)
        self.setAccessibleName("Log")
        self.setMaximumBlockCount(MOST)
        self.setFont(QFontDatabase.systemFont(QFontDatabase.SystemFont.FixedFont))
        frame_focus(self)
        log.added.append(lambda entry: self.appendPlainText(str(entry)))
