"""A frame about lists and texts with the focus, which shows also where nothing is chosen."""

from __future__ import annotations

from PySide6.QtWidgets import QAbstractScrollArea, QWidget

FRAME = """
{kind} {{ border: 1px solid transparent; }}
{kind}:focus {{ border: 1px solid palette(highlight); }}
"""
"""Style of one of them."""


def frame_focus(area: QAbstractScrollArea) -> None:
    """Let a list or text show that it has the focus."""
    kind = area.metaObject().className()
    area.setStyleSheet(FRAME.format(kind=kind))


def renew_frames(window: QWidget) -> None:
    """Draw framed lists and texts in the colours of a new theme: one with a style keeps the old."""
    for area in window.findChildren(QAbstractScrollArea):
        if style := area.styleSheet():
            area.setStyleSheet("")
            area.setStyleSheet(style)
