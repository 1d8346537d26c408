"""Icons: one family of line drawings, in the colours of the theme."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from importlib.resources import files

from PySide6.QtCore import QByteArray, QObject, QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QAction, QColor, QIcon, QPainter, QPalette, QPen, QPixmap
from PySide6.QtSvg import QSvgRenderer
from PySide6.QtWidgets import QAbstractButton, QApplication, QLabel

from crossview.view.colors import BAD, GOOD, UNSURE, WAITING, valence_color

SIZES = (14, 16, 20, 28, 32, 40)
"""Sizes that an icon is drawn in, in pixels: of verdicts, menus, toolbars; and twice as fine."""


LARGE = QSize(40, 40)
"""Of an icon that stands by itself, in pixels. Chosen."""

NAME = "icon-name"
"""Property that holds the name of an icon."""


def icon(name: str) -> QIcon:
    """Return the icon `name` of resources/icons, grey when disabled."""
    palette = QApplication.palette()
    text = palette.color(QPalette.ColorRole.ButtonText).name()
    disabled = palette.color(QPalette.ColorGroup.Disabled, QPalette.ColorRole.ButtonText).name()
    return _icon(name, text, disabled)


def put_icon(target: QAction | QAbstractButton | QLabel, name: str) -> None:
    """Give an action, a button or a label the icon `name`, which `renew_icons` knows."""
    target.setProperty(NAME, name)
    if isinstance(target, QLabel):
        target.setPixmap(icon(name).pixmap(LARGE))
    else:
        target.setIcon(icon(name))


def renew_icons(root: QObject) -> None:
    """Draw the icons of all below `root` in the colours of a theme that has changed."""
    for target in root.findChildren(QObject):
        name = target.property(NAME)
        if name and isinstance(target, QAction | QAbstractButton | QLabel):
            put_icon(target, name)


def colored_icon(name: str, color: str) -> QIcon:
    """Return the icon `name` in one colour."""
    return _icon(name, color, color)


@cache
def _icon(name: str, color: str, disabled: str) -> QIcon:
    svg = (files("crossview.resources") / "icons" / f"{name}.svg").read_text()
    made = QIcon()
    for mode, ink in ((QIcon.Mode.Normal, color), (QIcon.Mode.Disabled, disabled)):
        renderer = QSvgRenderer(QByteArray(svg.replace("currentColor", ink).encode()))
        for size in SIZES:
            pixmap = QPixmap(size, size)
            pixmap.fill(Qt.GlobalColor.transparent)
            with QPainter(pixmap) as painter:
                renderer.render(painter, QRectF(0, 0, size, size))
            made.addPixmap(pixmap, mode)
    return made


def valence_icon(valence: int | None, text: str | None = None) -> QIcon:
    """Return a disk in the colour of `valence` with its number, or grey with `text`."""
    color = QColor("#8a8f98") if valence is None else QColor(valence_color(valence))

    def paint(painter: QPainter, area: QRectF) -> None:
        _paint_disk(painter, area, color, 0.08)
        font = painter.font()
        font.setPixelSize(max(7, round(area.height() * 0.56)))
        font.setBold(True)
        painter.setFont(font)
        painter.setPen(QColor("white") if color.lightnessF() < 0.6 else QColor("#222222"))
        painter.drawText(area, Qt.AlignmentFlag.AlignCenter, text or str(valence))

    return _painted(paint)


SIGNS = {
    GOOD: ((0.29, 0.52), (0.44, 0.67), (0.72, 0.36)),
    BAD: ((0.34, 0.34), (0.66, 0.66), (0.5, 0.5), (0.66, 0.34), (0.34, 0.66)),
    UNSURE: ((0.5, 0.26), (0.5, 0.56)),
    WAITING: ((0.32, 0.5), (0.68, 0.5)),
}
"""A tick, a cross, the stroke of an exclamation mark, a dash: lines in shares of a sign's size."""


def verdict_icon(color: str) -> QIcon:
    """Return the sign of a verdict, told by its shape as by its colour: a key of `SIGNS`."""

    def paint(painter: QPainter, area: QRectF) -> None:
        _paint_disk(painter, area, QColor(color), 0.06)
        painter.setPen(
            QPen(
                QColor("white"),
                area.width() / 8,
                Qt.PenStyle.SolidLine,
                Qt.PenCapStyle.RoundCap,
                Qt.PenJoinStyle.RoundJoin,
            )
        )
        painter.drawPolyline(
            [QPointF(x * area.width(), y * area.height()) for x, y in SIGNS[color]]
        )
        if color == UNSURE:
            painter.drawPoint(QPointF(0.5 * area.width(), 0.75 * area.height()))

    return _painted(paint)


def dot_icon(color: str) -> QIcon:
    """Return a small plain disk: a valence in a table."""
    return _painted(lambda painter, area: _paint_disk(painter, area, QColor(color), 0.22))


def _painted(paint: Callable[[QPainter, QRectF], None]) -> QIcon:
    made = QIcon()
    for size in SIZES:
        pixmap = QPixmap(size, size)
        pixmap.fill(Qt.GlobalColor.transparent)
        with QPainter(pixmap) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            paint(painter, QRectF(0, 0, size, size))
        made.addPixmap(pixmap)
        made.addPixmap(pixmap, QIcon.Mode.Selected)  # else a selected row tints it
    return made


def _paint_disk(painter: QPainter, area: QRectF, color: QColor, inset: float) -> None:
    margin = inset * area.width()
    painter.setPen(QPen(QColor("white"), area.width() / 16))  # keeps it off a selected row
    painter.setBrush(color)
    painter.drawEllipse(area.adjusted(margin, margin, -margin, -margin))
