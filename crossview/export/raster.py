"""Views as images, off screen and smooth without a graphics card."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import pyvista as pv
from PIL import Image
from scipy.ndimage import maximum_filter
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkFloatArray

from crossview.scene import Camera, Scene, SceneView, ensure_rendering
from crossview.scene.camera import rows
from crossview.view.geometry import FloatArray
from crossview.view.scalars import Beyond
from solvers.errors import CrossviewError
from solvers.number_checks import real_numbers

_NOMINAL_HEIGHT = 640.0
"""A picture of this height, in pixels, has texts and lines of the window's size. Chosen."""

_SUPERSAMPLING, _MOST_PIXELS = 2, 40e6
"""Each pixel is the mean of this many squared, as long as the whole stays below so many. Chosen."""

SHORTEST_SIDE, LONGEST_SIDE = 16, 8192
"""Sides of a picture, in pixels, at least and at most. Chosen, below what drivers draw at once."""

_MULTI_SAMPLES = 4
"""Samples of a pixel; they also make wide lines end square, whatever their direction. Chosen."""


class FigureError(CrossviewError):
    """A figure that cannot be made as asked."""


def picture(
    view: SceneView,
    size: tuple[int, int],
    scale: float,
    camera: str | Camera,
    texts: bool = True,
) -> Image.Image:
    """Draw a view to an image of `size` times `scale` pixels.

    Parameters
    ----------
    view, size, scale, camera
        As of `figures.render_view`.
    texts : bool
        Whether title, legend, colour bar and axes are drawn.

    Raises
    ------
    FigureError
        The size cannot be drawn.
    """
    width, height = check_size(size, scale)
    fine = _supersampling(width, height)
    ratio = fine * scale * pixel_ratio(size)
    with _staged_scene(fine * width, fine * height, ratio, texts) as (plotter, scene):
        plotter.ren_win.SetMultiSamples(_MULTI_SAMPLES)
        scene.show(view)
        scene.fit(camera)
        pixels = plotter.screenshot(return_img=True, transparent_background=view.transparent)
    return reduced(pixels, fine)


def reduced(pixels: npt.NDArray[np.uint8], fine: int) -> Image.Image:
    """Return an image of which each pixel is the mean of `fine` squared.

    Means of colours count by their opacity, else rims of a transparent figure turn white.
    """
    image = Image.fromarray(pixels)
    if image.mode == "RGBA":
        return image.convert("RGBa").reduce(fine).convert("RGBA")
    return image.reduce(fine)


def shots(
    shown: Iterable[tuple[SceneView, Camera]], size: tuple[int, int]
) -> Iterator[Image.Image]:
    """Draw views, each with its camera; the scene is kept from one to the next.

    Parameters
    ----------
    shown : iterable of (SceneView, Camera)
    size : (int, int)
        Pixels.
    """
    width, height = check_size(size, 1.0)
    fine = _supersampling(width, height)
    ratio = fine * pixel_ratio(size)
    with _staged_scene(fine * width, fine * height, ratio, True) as (plotter, scene):
        plotter.ren_win.SetMultiSamples(_MULTI_SAMPLES)
        for view, camera in shown:
            scene.show(view)
            scene.fit(camera)
            plotter.ren_win.Render()  # a screenshot alone would be the last frame again
            yield Image.fromarray(plotter.screenshot(return_img=True)).reduce(fine)


def side_by_side(images: Sequence[Image.Image]) -> Image.Image:
    """Return one image of several of one size."""
    if len(images) == 1:
        return images[0]
    width, height = images[0].size
    whole = Image.new(images[0].mode, (len(images) * width, height))
    for number, image in enumerate(images):
        whole.paste(image, (number * width, 0))
    return whole


@dataclass(frozen=True, eq=False)
class Seen:
    """Where things are in a picture, and which of them the surface hides.

    Attributes
    ----------
    size : (int, int)
        Pixels.
    matrix : (4, 4) float
        From space to the cube of half size 1 that is seen.
    turn : (3, 3) float
        From space to right, up and towards the eye.
    depth : (height, width) float
        Of the surface: 0 near to 1 far and where nothing is; the bottom row first.
    limits : (float, float)
        Of the colours of the scalar shown.
    beyond : (bool, bool)
        Whether it is below them somewhere, and whether above.
    """

    size: tuple[int, int]
    matrix: FloatArray
    turn: FloatArray
    depth: npt.NDArray[np.float32]
    limits: tuple[float, float]
    beyond: Beyond

    def project(self, points: FloatArray) -> FloatArray:
        """Return (..., 3): pixels to the right and up from the bottom left, and depth."""
        homogeneous = np.concatenate([points, np.ones((*points.shape[:-1], 1))], axis=-1)
        clip = homogeneous @ self.matrix.T
        cube = (clip[..., :3] / clip[..., 3:] + 1.0) / 2.0
        return np.asarray(cube * np.array([*self.size, 1.0]))

    def visible(self, projected: FloatArray, towards: float) -> npt.NDArray[np.bool_]:
        """Return whether projected points (..., 3) are before the surface, or behind by less.

        `towards` is in 1/65 536 of the depth seen, as that of the scene's actors.
        """
        width, height = self.size
        x = np.clip(projected[..., 0].astype(int), 0, width - 1)
        y = np.clip(projected[..., 1].astype(int), 0, height - 1)
        return np.asarray(projected[..., 2] <= self.depth[y, x] + towards / 65536.0)


def seen(view: SceneView, size: tuple[int, int], camera: str | Camera) -> Seen:
    """Look at a view; parameters as of `figures.render_view`."""
    with _staged_scene(*size, pixel_ratio(size), True) as (plotter, scene):
        plotter.ren_win.SetMultiSamples(1)
        scene.show(view)
        scene.fit(camera)
        plotter.screenshot(return_img=True)
        values = vtkFloatArray()
        plotter.ren_win.GetZbufferData(0, 0, size[0] - 1, size[1] - 1, values)
        depth = vtk_to_numpy(values).reshape(size[1], size[0])
        # The farthest of the pixels around: lines on a slanted surface are not to sink into it.
        depth = maximum_filter(depth, size=3)
        seen_with = plotter.renderer.GetActiveCamera()
        matrix = seen_with.GetCompositeProjectionTransformMatrix(size[0] / size[1], -1.0, 1.0)
        turn = rows(seen_with.GetViewTransformMatrix())[:3, :3]
        return Seen(size, rows(matrix), turn, depth, scene.limits, scene.beyond)


def check_size(size: tuple[int, int], scale: float) -> tuple[int, int]:
    """Return the pixels of a picture, or raise if they are too few or too many to draw."""
    sides = real_numbers("the size", size, (2,), error=FigureError)
    width, height = (sides * real_numbers("the scale", scale, (), error=FigureError)).tolist()
    if not (min(width, height) >= SHORTEST_SIDE and max(width, height) <= LONGEST_SIDE):
        raise FigureError(
            f"cannot draw {width:g} x {height:g} pixels",
            "size times scale",
            f"choose sides from {SHORTEST_SIDE} to {LONGEST_SIDE}",
        )
    return round(width), round(height)


def pixel_ratio(size: tuple[int, int]) -> float:
    """Return the pixels of a figure per pixel of the window, for texts and lines."""
    width, height = size
    return min(0.75 * width, height) / _NOMINAL_HEIGHT


@contextmanager
def _staged_scene(
    width: int, height: int, ratio: float, texts: bool
) -> Iterator[tuple[pv.Plotter, Scene]]:
    ensure_rendering()
    plotter = pv.Plotter(off_screen=True, window_size=(width, height), lighting="none")
    try:
        yield plotter, Scene(plotter, ratio, texts)
    finally:
        plotter.close()


def _supersampling(width: int, height: int) -> int:
    fine = _SUPERSAMPLING
    while fine > 1 and (
        fine * max(width, height) > LONGEST_SIDE or fine**2 * width * height > _MOST_PIXELS
    ):
        fine -= 1
    return fine
