"""Figures: a view drawn off screen through the window's own scene, and written to a file."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from PIL.PngImagePlugin import PngInfo

from crossview.export.raster import FigureError, check_size, picture
from crossview.export.vector import save_vector
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
from crossview.view.meshes import curves_of, patches_of, quads_of, t_junctions_of
from crossview.view.scene_view import Background
from crossview.workflow.layout import misaligned_boundaries, separatrices
from crossview.workflow.pipeline import Solution
from solvers.errors import CrossviewError
from solvers.kind_checks import all_of_kind, one_of_kind
from solvers.layouts import QuadLayout
from solvers.quads import QuadMesh

KINDS = (".png", ".svg", ".pdf")
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
    layout: QuadLayout | None = None,
    quads: QuadMesh | None = None,
    about: str = "",
) -> Path:
    """Draw a solution to a file.

    Parameters
    ----------
    solution : Solution
    path : path-like
        PNG, or SVG or PDF for curves and crosses as vectors.
    layers : sequence of str, optional
        Names of the layers drawn: surface, H, theta, H1, H2, aspect, error, crosses, separatrices,
        marks, layout, quads, singularities, cut, features, boundary, legend, axes. By default what
        the window shows at first.
    size : (int, int)
        Width and height; pixels if the scale is 1.
    scale : float
        Pixels of the picture per unit of `size`; the layout stays the same.
    transparent : bool
        Leave the background out.
    camera : str
        auto, iso, xy, xz, yz or from behind yx, zx, zy; or px,py,pz,fx,fy,fz,ux,uy,uz: position,
        focus, up, and perhaps half the height seen, for a parallel view.
    background : {"white", "dark"}
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
    check(path, layers=layers, size=size, scale=scale, camera=camera)
    if background not in ("white", "dark"):
        raise CrossviewError(f'no background "{background}"', "background", "choose white or dark")
    chosen: Mapping[str, LayerSettings] = layers_named(layers) if layers else default_layers()
    cut_graph = solution.cut_graph if chosen["cut"].visible else None
    view = field_view(
        solution.field,
        cut_graph,
        layers=chosen,
        background="transparent" if transparent else background,
        **feature_lines(
            solution.features, solution.field, solution.problem.options.tolerance_degrees
        ),
        **_meshes(solution, chosen, layout, quads),
    )
    return render_view(view, path, size=size, scale=scale, camera=camera, about=about)


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
) -> None:
    """Find mistakes in what is asked of `render` before a long computation; see there."""
    _check_kind(Path(path))
    check_size(size, scale)
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
    size: tuple[int, int] = (1600, 1200),
    scale: float = 1.0,
    camera: str | Camera = "auto",
    dpi: float | None = None,
    about: str = "",
) -> Path:
    """Draw a view to a file; parameters as of `render`.

    A `Camera`, as `Scene.camera` gives, is taken as it is. With `dpi`, pixels per inch, the file
    says how large it is on paper.
    """
    target = Path(path)
    _check_kind(target)
    with staged_file(target) as made:
        if target.suffix.lower() == ".png":
            said: dict[str, Any] = {} if dpi is None else {"dpi": (dpi, dpi)}
            if about:
                said["pnginfo"] = PngInfo()
                said["pnginfo"].add_text("Description", about)
            picture(view, size, scale, camera).save(made, "PNG", **said)
        else:
            save_vector(view, made, size, scale, camera, dpi, about)
    return target
