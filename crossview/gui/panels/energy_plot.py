"""A small plot of the integrability error E over the iterations, on a logarithmic scale."""

from __future__ import annotations

import math
from collections.abc import Sequence

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPainterPath, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget

from solvers.fields import Convergence

FLOOR = 1e-16
"""What an E of zero is drawn as."""

LINE, SMOOTHING = QColor("#2f6fde"), QColor("#b7791f")
"""Colours of the curve, and from where on the sizes are smoothed."""

MARGIN, DOT = 8.0, 2.5
"""Around the curve, and radius of its dots, in pixels. Chosen."""

MOST_DOTS = 60
"""Iterations up to which each has a dot; with more only the last has. Chosen."""


class EnergyPlot(QWidget):
    """Shows E at the start and after each iteration; decades as lines, the last value as text.

    A line stands where the smoothing of the sizes begins.
    """

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.convergence = Convergence()
        self.empty_text = "No iterations yet"
        self.setMinimumHeight(80)
        self.setAccessibleName("E by iteration")

    def sizeHint(self) -> QSize:
        """A size that suits a dock."""
        return QSize(220, 140)

    @property
    def energies(self) -> tuple[float, ...]:
        """The values of E that are drawn."""
        return self.convergence.energies

    def show_convergence(self, convergence: Convergence) -> None:
        """Draw how an iteration went or goes."""
        if convergence == self.convergence:
            return
        self.convergence = convergence
        last = f"{self.energies[-1]:.1e}" if self.energies else "none"
        told = f"{max(len(self.energies) - 1, 0)} iterations, E = {last}"
        if convergence.smoothed_from is not None:
            told += f"; after {convergence.smoothed_from} the sizes are smoothed, E = 0 kept to"
        self.setToolTip(told)
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint axes, decades and values."""
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            metrics = QFontMetricsF(self.font())
            left = metrics.horizontalAdvance("1e-16") + MARGIN
            frame = QRectF(self.rect()).adjusted(
                left, MARGIN + metrics.height() / 2, -MARGIN - DOT, -MARGIN - metrics.height()
            )
            faint = self.palette().color(self.foregroundRole())
            faint.setAlphaF(0.55)
            if not self.energies:
                painter.setPen(faint)
                place = Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap
                painter.drawText(self.rect(), place, self.empty_text)
                return
            logs = [math.log10(max(energy, FLOOR)) for energy in self.energies]
            low, high = _decades(logs)
            self._paint_grid(painter, frame, low, high, faint)
            self._paint_values(painter, frame, logs, low, high)

    def _paint_grid(
        self, painter: QPainter, frame: QRectF, low: int, high: int, faint: QColor
    ) -> None:
        metrics = QFontMetricsF(self.font())
        rule = QColor(faint)
        rule.setAlphaF(0.15)
        most = max(1, int(frame.height() / (1.6 * metrics.height())))
        step = max(1, math.ceil((high - low) / most))
        for decade in range(high, low - 1, -step):
            y = frame.bottom() - frame.height() * (decade - low) / (high - low)
            painter.setPen(QPen(rule, 1))
            painter.drawLine(QPointF(frame.left(), y), QPointF(frame.right(), y))
            painter.setPen(faint)
            text = "1" if decade == 0 else f"1e{decade}"
            place = QRectF(0, y - metrics.height() / 2, frame.left() - 4, metrics.height())
            painter.drawText(
                place, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter, text
            )
        below = QRectF(frame.left(), frame.bottom() + 2, frame.width(), metrics.height())
        painter.setPen(faint)
        painter.drawText(below, Qt.AlignmentFlag.AlignLeft, "0")
        count = str(len(self.energies) - 1)
        if len(self.energies) > 1:
            painter.drawText(below, Qt.AlignmentFlag.AlignRight, count)
        painter.drawText(below, Qt.AlignmentFlag.AlignHCenter, "iterations")

    def _paint_values(
        self, painter: QPainter, frame: QRectF, logs: Sequence[float], low: int, high: int
    ) -> None:
        across = frame.width() / max(len(logs) - 1, 1)
        points = [
            QPointF(
                frame.left() + i * across,
                frame.bottom() - frame.height() * (value - low) / (high - low),
            )
            for i, value in enumerate(logs)
        ]
        begun = self.convergence.smoothed_from
        parts = [(LINE, points)]
        if begun is not None:
            parts = [(LINE, points[: begun + 1]), (SMOOTHING, points[begun:])]
            self._paint_begin(painter, frame, points[begun].x())
        for color, part in parts:
            path = QPainterPath(part[0])
            for point in part[1:]:
                path.lineTo(point)
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.setPen(QPen(color, 1.5))
            painter.drawPath(path)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(color)
            for point in part if len(points) <= MOST_DOTS else part[-1:]:
                painter.drawEllipse(point, DOT, DOT)

    def _paint_begin(self, painter: QPainter, frame: QRectF, x: float) -> None:
        """Paint the line from which on the sizes are smoothed, and say so."""
        painter.setPen(QPen(SMOOTHING, 1, Qt.PenStyle.DashLine))
        painter.drawLine(QPointF(x, frame.top()), QPointF(x, frame.bottom()))
        text, metrics = "smoothing", QFontMetricsF(self.font())
        width = metrics.horizontalAdvance(text)
        left = x + 4 if x + 4 + width < self.width() else x - 4 - width
        painter.setPen(SMOOTHING)
        painter.drawText(QPointF(left, frame.top() + metrics.ascent() / 2), text)


def _decades(logs: Sequence[float]) -> tuple[int, int]:
    """Return the whole decades around values, at least one apart."""
    low, high = math.floor(min(logs)), math.ceil(max(logs))
    return low, max(high, low + 1)
