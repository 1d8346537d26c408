"""Figures: a view drawn off screen through the window's own scene, and written to a file."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any

from PIL.PngImagePlugin import PngInfo

from crossview.export.alike import one_camera, with_one_range
from crossview.export.raster import FigureError, check_size, picture, side_by_side
from crossview.export.vector import save_vector
from crossview.export.web import save_web
from crossview.io.staged_files import staged_file
from crossview.scene import (
    Camera,
    LayerSettings,
    SceneView,
    default_layers,
    ensure_rendering,
    field_view,
    layers_named,
)
from crossview.scene.camera import read_camera
from crossview.view.field import feature_lines
from crossview.view.layer_words import Settings, checked_settings
from crossview.view.meshes import curves_of, patches_of, quads_of, t_junctions_of
from crossview.view.scene_view import Background
from crossview.workflow.layout import misaligned_boundaries, separatrices
from crossview.workflow.pipeline import Solution
from solvers.errors import CrossviewError
from solvers.kind_checks import all_of_kind, one_of_kind
from solvers.layouts import QuadLayout
from solvers.number_checks import real_number
from solvers.quads import QuadMesh

EMPTY: Settings = MappingProxyType({})
"""No settings but those that layers start with."""

KINDS = (".png", ".svg", ".pdf", ".html")
"""Endings of the files that figures are written to."""


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
    dpi: float | None = None,
    settings: Settings = EMPTY,
    layout: QuadLayout | None = None,
    quads: QuadMesh | None = None,
    about: str = "",
) -> Path:
    """Draw a solution to a file.

    Parameters
    ----------
    solution : Solution
    path : path-like
        PNG; SVG or PDF for curves and crosses as vectors; HTML for a page that turns in a browser.
    layers : sequence of str, optional
        Names of the layers drawn: surface, H, theta, H1, H2, aspect, error, crosses, separatrices,
        marks, layout, quads, singularities, cut, features, boundary, legend, axes. By default what
        the window shows at first.
    size : (int, int)
        Width and height; pixels if the scale is 1.
    scale : float
        Pixels of the picture per unit of `size`; the layout stays the same.
    transparent : bool
        Leave the background out; all is drawn as on it.
    camera : str
        auto, iso, xy, xz, yz or from behind yx, zx, zy; or px,py,pz,fx,fy,fz,ux,uy,uz: position,
        focus, up, and perhaps half the height seen, for a parallel view.
    background : {"white", "dark"}
    dpi : float, optional
        Pixels per inch: how large the picture says it is on paper.
    settings : mapping of str to mapping, optional
        Of layers, by name: ``{"crosses": {"size": 2.0}}``, as of `LayerSettings`.
    layout : QuadLayout, optional
        For the layer layout, and for separatrices that are exact.
    quads : QuadMesh, optional
        For the layer quads.
    about : str
        What the file carries unseen: of `Pictured.words`, so that it opens as its case.

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    CrossviewError
        Unknown layer, or the guide; unknown camera or file suffix; a size that cannot be drawn; no
        drawing here.
    """
    check(path, layers=layers, size=size, scale=scale, camera=camera, dpi=dpi)
    view = solution_view(
        solution,
        layers=layers,
        background=background,
        transparent=transparent,
        settings=settings,
        layout=layout,
        quads=quads,
    )
    return render_view(view, path, size=size, scale=scale, camera=camera, dpi=dpi, about=about)


def solution_view(
    solution: Solution,
    *,
    layers: Sequence[str] | None = None,
    background: Background = "white",
    transparent: bool = False,
    settings: Settings = EMPTY,
    layout: QuadLayout | None = None,
    quads: QuadMesh | None = None,
) -> SceneView:
    """Return what is drawn of a solution; parameters as of `render`.

    Raises
    ------
    CrossviewError
        Unknown layer or background.
    """
    if background not in ("white", "dark"):
        raise CrossviewError(f'no background "{background}"', "background", "choose white or dark")
    chosen: Mapping[str, LayerSettings] = layers_named(layers) if layers else default_layers()
    view = field_view(
        solution.field,
        solution.cut_graph if chosen["cut"].visible else None,
        layers=chosen,
        background=background,
        transparent=transparent,
        **feature_lines(
            solution.features, solution.field, solution.problem.options.tolerance_degrees
        ),
        **_meshes(solution, chosen, layout, quads),
    )
    for name, changes in checked_settings(settings, "settings: ").items():
        view = view.with_layer(name, **changes)
    return view


def _meshes(
    solution: Solution,
    layers: Mapping[str, LayerSettings],
    layout: QuadLayout | None,
    quads: QuadMesh | None,
) -> dict[str, Any]:
    """What the layers of separatrices, marks, layout and quads draw."""
    drawn: dict[str, Any] = {}
    if layers["separatrices"].visible or layers["marks"].visible:
        curves = separatrices(solution, layout)
        drawn["separatrices"], drawn["t_junctions"] = curves_of(curves), t_junctions_of(curves)
        drawn["misaligned"] = misaligned_boundaries(solution)[1]
    if layout is not None and layers["layout"].visible:
        drawn["layout"] = patches_of(layout)
    if quads is not None:
        drawn["quads"] = quads_of(quads)
    return drawn


def shows_curves(layers: Sequence[str] | None) -> bool:
    """Whether separatrices are drawn, which are exact where `render` is given a layout."""
    chosen = layers_named(layers) if layers else default_layers()
    return chosen["separatrices"].visible or chosen["marks"].visible


def check(
    path: str | os.PathLike[str],
    *,
    layers: Sequence[str] | None = None,
    size: tuple[int, int] = (1600, 1200),
    scale: float = 1.0,
    camera: str = "auto",
    dpi: float | None = None,
) -> None:
    """Find mistakes in what is asked of `render` before a long computation; see there."""
    _check_kind(Path(path))
    check_size(size, scale)
    if dpi is not None:
        real_number("dpi", dpi, least=1, most=10_000)
    check_picture(layers=layers, camera=camera)


def check_picture(*, layers: Sequence[str] | None = None, camera: str = "auto") -> None:
    """Find mistakes in layers and camera, and whether there is something to draw with.

    Raises
    ------
    CrossviewError
        As `render`.
    """
    read_camera(one_of_kind("the camera", camera, str))
    layers_named(all_of_kind("layers", layers or (), str))
    if "guide" in (layers or ()):
        raise CrossviewError(
            "the guide shows where one singularity may be dragged", "layers", "see it in the window"
        )
    ensure_rendering()


def _check_kind(path: Path) -> None:
    if path.suffix.lower() not in KINDS:
        raise FigureError(
            "unknown kind of figure", str(path), "end its name in " + ", ".join(KINDS)
        )


def render_view(
    view: SceneView,
    path: str | os.PathLike[str],
    *,
    beside: Sequence[SceneView] = (),
    size: tuple[int, int] = (1600, 1200),
    scale: float = 1.0,
    camera: str | Camera = "auto",
    dpi: float | None = None,
    about: str = "",
) -> Path:
    """Draw a view to a file; parameters as of `render`.

    A `Camera`, as `Scene.camera` gives, is taken as it is. With `dpi`, pixels per inch, the file
    says how large it is on paper. Views `beside` it are drawn to its right, each of the same size,
    with its camera and with one range of colours for all.
    """
    target, views = Path(path), [view, *beside]
    _check_kind(target)
    if beside:
        views, camera = with_one_range(views), one_camera(views, size, camera)
    suffix = target.suffix.lower()
    with staged_file(target) as made:
        if suffix == ".png":
            said: dict[str, Any] = {} if dpi is None else {"dpi": (dpi, dpi)}
            if about:
                said["pnginfo"] = PngInfo()
                said["pnginfo"].add_text("Description", about)
            images = [picture(each, size, scale, camera) for each in views]
            side_by_side(images).save(made, "PNG", **said)
        elif suffix == ".html":
            if beside:
                raise FigureError("a page that turns shows one case", str(target), "take .png")
            save_web(view, made, size, camera, about)
        else:
            save_vector(views, made, size, scale, camera, dpi, about)
    return target
