"""The figure as it would be written, small, in the Export panel."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QObject, QSize, Qt, QTimer
from PySide6.QtGui import QColor, QImage, QPainter, QPalette, QPixmap

from crossview.export.preview import Preview
from crossview.gui.figure import Figure
from crossview.gui.panels import ExportPanel
from crossview.view.colors import THEMES, Theme

REST_MS = 250
"""How long nothing may change before it is drawn."""
LEAST_WIDTH, SQUARE = 64, 8
"""Of what is drawn, and of the squares behind what is transparent, in pixels. Chosen."""


class FigurePreview(QObject):
    """Draws what a figure would show, for as long as the Export panel is in front.

    Parameters
    ----------
    panel : ExportPanel
        Where it is shown.
    figure : callable
        Returns what would be written now; None: nothing.
    """

    def __init__(self, panel: ExportPanel, figure: Callable[[], Figure | None]) -> None:
        super().__init__(panel)
        self._panel = panel
        self._figure = figure
        self._preview: Preview | None = None
        self._rest = QTimer(self)
        self._rest.setSingleShot(True)
        self._rest.setInterval(REST_MS)
        self._rest.timeout.connect(self._draw)
        panel.changed.connect(self.ask)

    def close(self) -> None:
        """Free what it draws with."""
        self._rest.stop()
        if self._preview is not None:
            self._preview.close()
            self._preview = None

    def ask(self) -> None:
        """Draw anew once nothing changes any more."""
        if self._seen():
            self._rest.start()

    def _seen(self) -> bool:
        """Whether the panel is in front: docks behind others are visible too, but elsewhere."""
        return not self._panel.visibleRegion().isEmpty()

    def _draw(self) -> None:
        label = self._panel.preview
        figure = self._figure() if self._seen() else None
        if figure is None:
            label.clear()
            return
        settings, ratio = figure.settings, label.devicePixelRatioF()
        fitted = QSize(*settings.size).scaled(label.size(), Qt.AspectRatioMode.KeepAspectRatio)
        width = max(round(fitted.width() * ratio), LEAST_WIDTH)
        preview = self._for(settings.size, width)
        image = preview.image(figure.view, figure.camera).convert("RGBA")
        drawn = QImage(image.tobytes(), *image.size, QImage.Format.Format_RGBA8888)
        pixmap = QPixmap(drawn.size())
        with QPainter(pixmap) as painter:
            _paint_squares(painter, THEMES[figure.view.background])  # seen where it is transparent
            painter.drawImage(0, 0, drawn)
            # where the figure ends
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


def _paint_squares(painter: QPainter, theme: Theme) -> None:
    """Fill the whole with squares of a theme's background and of one that differs a little."""
    area, plain = painter.window(), QColor(theme.background)
    painter.fillRect(area, plain)
    other = plain.lighter(140) if plain.lightness() < 128 else plain.darker(112)
    for row in range(0, area.height(), SQUARE):
        for column in range(row % (2 * SQUARE), area.width(), 2 * SQUARE):
            painter.fillRect(column, row, SQUARE, SQUARE, other)
