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
    dpi : int
        Pixels of the file per inch on paper.
    """

    size: tuple[int, int] = (1600, 1200)
    scale: int = 1
    transparent: bool = False
    dpi: int = 300

    @property
    def millimetres(self) -> tuple[float, float]:
        """Width and height on paper."""
        width, height = (25.4 * side * self.scale / self.dpi for side in self.size)
        return width, height
