"""Figures: a view drawn off screen through the window's own scene, and written to a file."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import pyvista as pv
from PIL import Image

from crossview.pipeline import Solution
from crossview.scene import (
    Camera,
    LayerSettings,
    Scene,
    SceneView,
    default_layers,
    ensure_rendering,
    field_view,
    layers_named,
)
from crossview.scene.view import Background
from solvers.errors import CrossviewError

# A picture of this height, in pixels, has texts and lines of the window's size.
_NOMINAL_HEIGHT = 640.0
# Each pixel is the mean of this many squared, as long as the whole stays below the limit.
_SUPERSAMPLING, _MOST_PIXELS, _LONGEST_SIDE = 2, 40e6, 16384
# Also makes wide lines end square, whatever their direction.
_MULTI_SAMPLES = 4


class FigureError(CrossviewError):
    """A figure that cannot be made as asked."""


def render(
    solution: Solution,
    path: str | os.PathLike[str],
    *,
    layers: Sequence[str] | None = None,
    size: tuple[int, int] = (1600, 1200),
    scale: float = 1.0,
    transparent: bool = False,
    camera: str = "auto",
    background: Background = "white",
) -> Path:
    """Draw a solution to a file.

    Parameters
    ----------
    solution : Solution
    path : path-like
        PNG, or SVG or PDF for curves and crosses as vectors.
    layers : sequence of str, optional
        Names of the layers drawn: surface, H, theta, crosses, singularities, cut, boundary,
        legend, axes. By default what the window shows at first.
    size : (int, int)
        Width and height; pixels if the scale is 1.
    scale : float
        Pixels of the picture per unit of `size`; the layout stays the same.
    transparent : bool
        Leave the background out.
    camera : str
        auto, iso, xy, xz, yz, or px,py,pz,fx,fy,fz,ux,uy,uz: position, focus, up.
    background : {"white", "dark"}

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    CrossviewError
        Unknown layer, camera or file suffix; a size that cannot be drawn; no drawing here.
    """
    chosen: Mapping[str, LayerSettings] = layers_named(layers) if layers else default_layers()
    cut_graph = solution.cut_graph if chosen["cut"].visible else None
    view = field_view(
        solution.field,
        cut_graph,
        layers=chosen,
        background="transparent" if transparent else background,
    )
    return render_view(view, path, size=size, scale=scale, camera=camera)


def render_view(
    view: SceneView,
    path: str | os.PathLike[str],
    *,
    size: tuple[int, int] = (1600, 1200),
    scale: float = 1.0,
    camera: str | Camera = "auto",
) -> Path:
    """Draw a view to a file; parameters as of `render`.

    A `Camera`, as `Scene.camera` gives, is taken as it is.
    """
    target = Path(path)
    writers: dict[str, Callable[[Path], None]] = {
        ".png": lambda to: picture(view, size, scale, camera).save(to, "PNG"),
    }
    writer = writers.get(target.suffix.lower())
    if writer is None:
        raise FigureError(
            "unknown kind of figure", str(target), "end its name in " + ", ".join(writers)
        )
    _write(target, writer)
    return target


def picture(
    view: SceneView, size: tuple[int, int], scale: float, camera: str | Camera
) -> Image.Image:
    """Draw a view to an image of `size` times `scale` pixels, smooth without a graphics card."""
    width, height = (round(side * scale) for side in size)
    if min(width, height) < 16 or max(width, height) > _LONGEST_SIDE:
        raise FigureError(
            f"cannot draw {width} x {height} pixels",
            "size times scale",
            f"choose sides from 16 to {_LONGEST_SIDE}",
        )
    fine = _supersampling(width, height)
    ensure_rendering()
    plotter = pv.Plotter(
        off_screen=True, window_size=(fine * width, fine * height), lighting="none"
    )
    try:
        plotter.ren_win.SetMultiSamples(_MULTI_SAMPLES)
        scene = Scene(plotter, fine * min(width, height * 4 / 3) / (_NOMINAL_HEIGHT * 4 / 3))
        scene.show(view)
        scene.fit(camera)
        pixels = plotter.screenshot(
            return_img=True, transparent_background=view.background == "transparent"
        )
    finally:
        plotter.close()
    image = Image.fromarray(pixels)
    if fine == 1:
        return image
    # Means of colours count by their opacity, else rims of a transparent figure turn white.
    transparent = image.mode == "RGBA"
    small = (image.convert("RGBa") if transparent else image).reduce(fine)
    return small.convert("RGBA") if transparent else small


def _supersampling(width: int, height: int) -> int:
    fine = _SUPERSAMPLING
    while fine > 1 and (
        fine * max(width, height) > _LONGEST_SIDE or fine**2 * width * height > _MOST_PIXELS
    ):
        fine -= 1
    return fine


def _write(target: Path, writer: Callable[[Path], None]) -> None:
    """Write beside the target first, so that a figure is there whole or not at all."""
    try:
        with tempfile.TemporaryDirectory(dir=target.parent, prefix=".figure-") as folder:
            draft = Path(folder) / target.name
            writer(draft)
            draft.replace(target)
    except OSError as error:
        raise FigureError(
            "cannot write the figure", str(target), error.strerror or str(error)
        ) from error
