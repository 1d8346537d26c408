"""Plotters off screen, and what their pixels are."""

from collections.abc import Callable, Iterator

import numpy as np
import pytest
import pyvista as pv
from numpy.typing import NDArray

from crossview.scene import Scene, ensure_rendering
from crossview.view.colors import rgb

WIDTH, HEIGHT = 480, 360


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

    def where(self, position) -> tuple[int, int]:
        """Row and column of a point in space."""
        renderer = self.plotter.renderer
        renderer.SetWorldPoint(*position, 1.0)
        renderer.WorldToDisplay()
        x, y, _ = renderer.GetDisplayPoint()
        return HEIGHT - 1 - round(y - 0.5), round(x - 0.5)

    def color_at(self, position) -> NDArray[np.int64]:
        """Colour, 0 to 255, of the pixel at a point in space."""
        return self.pixels()[self.where(position)].astype(int)

    def props(self) -> list[object]:
        """Everything on the plotter, flat and in space."""
        return list(self.plotter.renderer.GetViewProps())


@pytest.fixture
def new_stage() -> Iterator[Callable[[], Stage]]:
    stages: list[Stage] = []

    def make() -> Stage:
        stages.append(Stage())
        return stages[-1]

    yield make
    for stage in stages:
        stage.plotter.close()


@pytest.fixture
def stage(new_stage: Callable[[], Stage]) -> Stage:
    return new_stage()


@pytest.fixture
def near() -> Callable[..., NDArray[np.bool_]]:
    """Whether pixels have a colour, up to rounding."""

    def compare(pixels, color: str, tolerance: int = 3) -> NDArray[np.bool_]:
        wanted = np.round(255.0 * np.array(rgb(color)))
        return (np.abs(np.asarray(pixels, float) - wanted) <= tolerance).all(axis=-1)

    return compare
