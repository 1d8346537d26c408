"""How a figure is to be drawn."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class FigureSettings:
    """How large, how fine and on what a figure is drawn.

    Parameters
    ----------
    size : (int, int)
        Width and height before scaling, pixels.
    scale : int
        Finer by this factor, lines and text scaled with it.
    transparent : bool
        No background.
    """

    size: tuple[int, int] = (1600, 1200)
    scale: int = 1
    transparent: bool = False
