"""A small picture of a figure that follows what is shown: its scene is kept, not made anew."""

from __future__ import annotations

import pyvista as pv
from PIL import Image

from crossview.export.raster import pixel_ratio, reduced
from crossview.scene import Camera, Scene, SceneView, ensure_rendering

_FINE = 2
"""Each pixel is the mean of this many squared."""


class Preview:
    """Draws views as `figures.render_view` does, small.

    Parameters
    ----------
    size : (int, int)
        Of the figure, before scaling.
    width : int
        Of the picture, pixels.
    """

    def __init__(self, size: tuple[int, int], width: int) -> None:
        ensure_rendering()
        self.size, self.width = size, width
        scale = width / size[0]
        pixels = (_FINE * width, max(_FINE * round(scale * size[1]), _FINE))
        self._plotter = pv.Plotter(off_screen=True, window_size=pixels, lighting="none")
        self._plotter.ren_win.SetMultiSamples(1)
        self._scene = Scene(self._plotter, _FINE * scale * pixel_ratio(size))

    def image(self, view: SceneView, camera: Camera) -> Image.Image:
        """Return the picture of a view."""
        self._scene.show(view)
        self._scene.fit(camera)
        self._plotter.ren_win.Render()  # a screenshot alone would be the last frame again
        pixels = self._plotter.screenshot(return_img=True, transparent_background=view.transparent)
        return reduced(pixels, _FINE)

    def close(self) -> None:
        """Free what it draws with."""
        self._scene.remove()
        self._plotter.close()
