"""A plotter off screen, and what its pixels are."""

from collections.abc import Callable, Sequence

import numpy as np
import pyvista as pv
from numpy.typing import NDArray

from crossview.scene import Scene, ensure_rendering

WIDTH, HEIGHT = 480, 360

Near = Callable[..., NDArray[np.bool_]]


class Stage:
    """A plotter, its scene, and eyes."""

    def __init__(self) -> None:
        ensure_rendering()
        self.plotter = pv.Plotter(off_screen=True, window_size=(WIDTH, HEIGHT))
        self.plotter.ren_win.SetMultiSamples(1)
        self.scene = Scene(self.plotter)

    def pixels(self) -> NDArray[np.uint8]:
        """(height, width, 3), the top row first."""
        self.plotter.ren_win.Render()
        return np.array(self.plotter.screenshot(return_img=True))

    def where(self, position: Sequence[float]) -> tuple[int, int]:
        """Row and column of a point in space."""
        renderer = self.plotter.renderer
        renderer.SetWorldPoint(*position, 1.0)
        renderer.WorldToDisplay()
        x, y, _ = renderer.GetDisplayPoint()
        return HEIGHT - 1 - round(y - 0.5), round(x - 0.5)

    def color_at(self, position: Sequence[float]) -> NDArray[np.int64]:
        """Colour, 0 to 255, of the pixel at a point in space."""
        return np.asarray(self.pixels()[self.where(position)], dtype=np.int64)

    def props(self) -> list[object]:
        """Everything on the plotter, flat and in space."""
        return list(self.plotter.renderer.GetViewProps())
