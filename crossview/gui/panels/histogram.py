"""A small histogram: of scaled Jacobians, in the colours of their bar, or of edges' lengths."""

from __future__ import annotations

import math

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget

from crossview.view.colors import BAD, SEPARATRIX, color_table
from crossview.view.scalars import SCALARS
from crossview.view.texts import MINUS
from solvers.surface import FloatArray, IntArray

BINS, STEP, LEAST_HEIGHT = 20, 0.1, 2.0
"""Bars, steps that the range begins at, and pixels that a bar with anything in it has."""
MARGIN, GAP = 8.0, 1.0
"""Beside the bars, and between two, in pixels. Chosen."""
WIDE = 1.1
"""Ratio of the ends that is shown at least. Chosen."""


class Histogram(QWidget):
    """How many quads there are of each quality, or edges of each length."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.counts: IntArray = np.zeros(0, int)
        self._below = "", "", ""
        self._colors: list[QColor] = []
        self.setMinimumHeight(72)

    def sizeHint(self) -> QSize:
        """A size that suits a dock."""
        return QSize(200, 90)

    def show_lengths(self, lengths: FloatArray) -> None:
        """Draw these lengths, at least one, from the least to the largest by equal ratios."""
        low, high = float(lengths.min()), float(lengths.max())
        if high < WIDE * low:  # of squares alone
            low, high = high / WIDE, low * WIDE
        edges = np.geomspace(max(low, 1e-9 * high), high, BINS + 1)
        edges[0], edges[-1] = min(edges[0], low), high
        counts = np.histogram(lengths, edges)[0]
        colors = [QColor(SEPARATRIX)] * BINS
        self._show(counts, colors, (f"{low:.3g}", "edge length", f"{high:.3g}"))
        self.setToolTip("Lengths of the edges, each bar longer than the last by the same ratio")
        self.setAccessibleName("Edges by length")

    def show_quality(self, values: FloatArray) -> None:
        """Draw these scaled Jacobians, at least one, from the worst to 1."""
        worst = float(values.min())
        # at least two steps, so that a mesh of squares is no single bar over nothing
        low = min(math.floor(worst / STEP + 1e-9) * STEP, 1.0 - 2.0 * STEP)
        edges = np.linspace(low, 1.0, BINS + 1)
        counts = np.histogram(np.minimum(values, 1.0), edges)[0]
        colors = [_color(centre) for centre in (edges[:-1] + edges[1:]) / 2.0]
        self._show(counts, colors, (f"{low:.1f}".replace("-", MINUS), "scaled Jacobian", "1"))
        self.setToolTip("Scaled Jacobian: 1 is a square, 0 or less a quad that is folded over")
        self.setAccessibleName("Quads by scaled Jacobian")

    def _show(self, counts: IntArray, colors: list[QColor], below: tuple[str, str, str]) -> None:
        self.counts, self._colors, self._below = counts, colors, below
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint bars and the range below."""
        if not len(self.counts):
            return
        with QPainter(self) as painter:
            metrics = QFontMetricsF(self.font())
            frame = QRectF(self.rect()).adjusted(MARGIN, 4, -MARGIN, -metrics.height() - 4)
            faint = self.palette().color(self.foregroundRole())
            faint.setAlphaF(0.55)
            across, most = frame.width() / len(self.counts), int(self.counts.max()) or 1
            painter.setPen(Qt.PenStyle.NoPen)
            for i, count in enumerate(self.counts.tolist()):
                height = max(frame.height() * count / most, LEAST_HEIGHT) if count else 0.0
                painter.setBrush(self._colors[i])
                left = frame.left() + i * across
                painter.drawRect(
                    QRectF(left, frame.bottom() - height, max(across - GAP, 1.0), height)
                )
            painter.setPen(QPen(faint, 1))
            painter.drawLine(
                QPointF(frame.left(), frame.bottom() + 0.5),
                QPointF(frame.right(), frame.bottom() + 0.5),
            )
            below = QRectF(frame.left(), frame.bottom() + 2, frame.width(), metrics.height())
            sides = Qt.AlignmentFlag.AlignLeft, Qt.AlignmentFlag.AlignHCenter
            for side, text in zip((*sides, Qt.AlignmentFlag.AlignRight), self._below, strict=True):
                painter.drawText(below, side, text)


def _color(quality: float) -> QColor:
    """Return the colour of a quality, a little darker to be seen on white."""
    if quality <= 0.0:
        return QColor(BAD)
    table = color_table(SCALARS["quads"].color_map)
    red, green, blue = table[round(quality * (len(table) - 1)), :3].tolist()
    return QColor(red, green, blue).darker(118)
