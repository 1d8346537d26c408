"""The figure as it would be written, small, in the Export panel."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QSize, Qt, QTimer
from PySide6.QtGui import QImage, QPainter, QPalette, QPixmap

from crossview.export.preview import Preview
from crossview.gui.scene_view import figure_view

if TYPE_CHECKING:
    from crossview.gui.main_window import MainWindow

REST_MS = 250
"""How long nothing may change before it is drawn."""
LEAST_WIDTH = 64


class FigurePreview(QObject):
    """Draws what a figure would show, for as long as the Export panel is in front."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._panel = window.export_panel
        self._preview: Preview | None = None
        self._rest = QTimer(self)
        self._rest.setSingleShot(True)
        self._rest.setInterval(REST_MS)
        self._rest.timeout.connect(self._draw)
        self._panel.changed.connect(self._ask)
        window.docks["Export"].visibilityChanged.connect(self._ask)
        window.workspace.changed.connect(self._ask)
        window.viewport.frame_drawn.connect(self._ask)  # the camera may have turned

    def close(self) -> None:
        """Free what it draws with."""
        self._rest.stop()
        if self._preview is not None:
            self._preview.close()
            self._preview = None

    def _ask(self) -> None:
        if self._seen():
            self._rest.start()

    def _seen(self) -> bool:
        """Whether the panel is in front: docks behind others are visible too, but elsewhere."""
        return not self._panel.visibleRegion().isEmpty()

    def _draw(self) -> None:
        window, label = self._window, self._panel.preview
        if not self._seen() or window.state.document is None:
            label.clear()
            return
        settings, ratio = self._panel.settings, label.devicePixelRatioF()
        fitted = QSize(*settings.size).scaled(label.size(), Qt.AspectRatioMode.KeepAspectRatio)
        width = max(round(fitted.width() * ratio), LEAST_WIDTH)
        preview = self._for(settings.size, width)
        view = figure_view(window.state, settings, window.viewport.held.ranges)
        image = preview.image(view, window.viewport.scene.camera).convert("RGBA")
        drawn = QImage(image.tobytes(), *image.size, QImage.Format.Format_RGBA8888)
        pixmap = QPixmap.fromImage(drawn.copy())
        with QPainter(pixmap) as painter:  # where the figure ends
            painter.setPen(label.palette().color(QPalette.ColorRole.Mid))
            painter.drawRect(pixmap.rect().adjusted(0, 0, -1, -1))
        pixmap.setDevicePixelRatio(ratio)
        label.setPixmap(pixmap)
        across, up = settings.millimetres
        label.setToolTip(f"As it would be written: {across:.0f} × {up:.0f} mm")

    def _for(self, size: tuple[int, int], width: int) -> Preview:
        """Return the preview of these sizes, made anew if they have changed."""
        before = self._preview
        if before is None or (before.size, before.width) != (size, width):
            self.close()
            self._preview = before = Preview(size, width)
        return before
