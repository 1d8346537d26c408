"""Figures as a page that turns in a browser: one file, which loads nothing from elsewhere."""

from __future__ import annotations

import base64
import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from html import escape
from importlib.resources import files
from pathlib import Path
from string import Template
from typing import Any

import numpy as np
import numpy.typing as npt
import pyvista as pv

from crossview.export.alike import one_camera, shown_limits
from crossview.export.vector_curves import draw_in_space
from crossview.scene import Camera, SceneView
from crossview.scene.camera import VIEW_ANGLE
from crossview.scene.legend import BAR_COLORS
from crossview.scene.quads import quad_colors
from crossview.scene.scene import LIGHT
from crossview.scene.surface import AMBIENT, shade
from crossview.view.colors import SURFACE, THEMES, color_table, rgb, valence_color
from crossview.view.geometry import FloatArray, IntArray, Triangles
from crossview.view.quad_geometry import QuadGeometry
from crossview.view.scalars import (
    SCALARS,
    bar_texts,
    scalar_limits,
    scalar_values,
    shown_scalar,
)

STEP = 1.5
"""Of heights, as of `style.TOWARDS`, from one kind of lines to the next. Chosen."""

Bytes = npt.NDArray[np.uint8]


@dataclass
class Page:
    """What is drawn in space, as the page's script reads it; an `Easel`.

    Parameters
    ----------
    centre : (3,) float
        What becomes the origin: single precision is exact about it.
    size : float
        What becomes 1.
    """

    centre: FloatArray
    size: float
    figure: dict[str, list[Any]] = field(
        default_factory=lambda: {"lines": [], "discs": [], "signs": []}
    )

    def lines(
        self,
        segments: FloatArray,
        color: str,
        width: float,
        towards: float,
        opacity: float = 1.0,
        *,
        round_ends: bool = False,
    ) -> None:
        """Draw segments; see `Easel`."""
        if len(segments):
            self.figure["lines"].append(
                {
                    "ends": self.places(segments),
                    "color": rgb(color),
                    "width": width,
                    # what lies on something at the same height is drawn later
                    "towards": towards + STEP * len(self.figure["lines"]),
                    "opacity": opacity,
                    "round": round_ends,
                }
            )

    def discs(
        self,
        centres: FloatArray,
        radius: float,
        towards: float,
        colors: Sequence[Sequence[str]],
        parts: Sequence[float],
    ) -> None:
        """Draw discs of three parts; see `Easel`."""
        paints = np.array([[rgb(color) for color in each] for each in colors])
        self.figure["discs"].append(
            {
                "centres": self.places(centres),
                "radius": radius / self.size,
                "towards": towards,
                "shares": list(parts),
                "colors": [_text(_bytes(paints[:, part])) for part in range(len(parts))],
            }
        )

    def signs(
        self,
        places: FloatArray,
        diameter: float,
        towards: float,
        strokes: Sequence[Sequence[float]],
        paints: tuple[str, str],
        rim: float,
    ) -> None:
        """Draw signs whose letters have two strokes; see `Easel`."""
        self.figure["signs"].append(
            {
                "centres": self.places(places),
                "diameter": diameter,
                "towards": towards,
                "boxes": [list(box) for box in strokes],
                "ink": rgb(paints[0]),
                "paper": rgb(paints[1]),
                "rim": rim,
            }
        )

    def places(self, points: FloatArray) -> str:
        """Return points (..., 3) about the origin as text."""
        return _text(((points - self.centre) / self.size).astype(np.float32))


def save_web(
    view: SceneView,
    path: Path,
    size: tuple[int, int],
    camera: str | Camera,
    about: str = "",
) -> None:
    """Draw a view to a page; parameters as of `figures.render_view`."""
    path.write_text(web_page(view, size, camera, about), encoding="utf-8")


def web_page(
    view: SceneView, size: tuple[int, int], camera: str | Camera = "auto", about: str = ""
) -> str:
    """Return a view as a page that turns.

    Parameters
    ----------
    view : SceneView
    size : (int, int)
        Width and height that the camera is fitted to; the page fills its window.
    camera : str or Camera
        From where it is seen at first, as of `figures.render_view`.
    about : str
        What the page carries unseen.
    """
    if view.points is None or view.faces is None:
        raise ValueError("there is no surface to show")
    triangles = Triangles(view.points, view.faces)
    low, high = triangles.points.min(axis=0), triangles.points.max(axis=0)
    page = Page((low + high) / 2.0, triangles.diagonal)
    draw_in_space(page, view, triangles)
    theme, shown = THEMES[view.background], shown_scalar(view)
    figure = {
        "title": view.title,
        "background": rgb(theme.background),
        "light": [float(x) for x in np.array(LIGHT) / LIGHT[2]],
        # colours of a scalar are those of the bar, unless they are to show shape
        "ambient": AMBIENT if not shown or view.layer(shown).shaded else 1.0,
        "camera": _camera(view, size, camera, page),
        "surface": _surface(view, triangles, page),
        "legend": _legend(view),
        "bar": _bar(view),
        "axes": view.layer("axes").visible,
        **page.figure,
    }
    template = (files("crossview.resources") / "web" / "figure.html").read_text(encoding="utf-8")
    return Template(template).substitute(
        about=escape(about),
        title=escape(view.title or "Figure of crossview"),
        background=theme.background,
        ink=theme.text,
        # no text of a figure may end the script that holds it
        figure=json.dumps(figure, allow_nan=False).replace("<", "\\u003c"),
    )


def _camera(
    view: SceneView, size: tuple[int, int], camera: str | Camera, page: Page
) -> dict[str, Any]:
    """The camera about the page's origin."""
    camera = one_camera([view], size, camera)
    half = camera.parallel_scale
    return {
        "position": ((np.array(camera.position) - page.centre) / page.size).tolist(),
        "focus": ((np.array(camera.focus) - page.centre) / page.size).tolist(),
        "up": list(camera.up),
        "centre": list(camera.centre),
        "half": None if half is None else half / page.size,
        "angle": np.radians(VIEW_ANGLE),
        "aspect": size[0] / size[1],
    }


def _surface(view: SceneView, triangles: Triangles, page: Page) -> dict[str, Any] | None:
    """Triangles with normals and colours: of the surface, or of what is drawn in its place."""
    opacity = view.layer("surface").opacity
    if view.cover:
        mesh = view.quads if view.cover == "quads" else view.layout
        if mesh is None:
            return None
        geometry = QuadGeometry(mesh)
        points, quads = geometry.merged
        faces = quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
        colors = quad_colors(view.cover, geometry, view.layer(view.cover)).repeat(2, axis=0)
        return _mesh(points, faces, colors, True, page, 1.0)
    shown = shown_scalar(view)
    if not shown and not view.layer("surface").visible:
        return None
    values = scalar_values(view, shown, triangles) if shown else None
    if values is None:
        grey = np.tile(_bytes(np.array(rgb(SURFACE))), (len(triangles.points), 1))
        return _mesh(triangles.points, triangles.faces, grey, False, page, opacity)
    low, high = scalar_limits(view, shown, triangles, values)
    settings = view.layer(shown)
    table = color_table(settings.color_map or SCALARS[shown].color_map, settings.opacity)[:, :3]
    at = np.clip((values - low) / (high - low), 0.0, 1.0) * (len(table) - 1)
    cells = SCALARS[shown].cells
    return _mesh(
        triangles.points, triangles.faces, table[np.rint(at).astype(int)], cells, page, opacity
    )


def _mesh(
    points: FloatArray,
    faces: IntArray,
    colors: Bytes,
    of_cells: bool,
    page: Page,
    opacity: float,
) -> dict[str, Any]:
    """Triangles as the page takes them, with a colour for each vertex or each triangle."""
    mesh = pv.PolyData.from_regular_faces(np.asarray(points, float), faces)
    origin = shade(mesh)
    places, normals = np.asarray(mesh.points), np.asarray(mesh.point_data["Normals"])
    corners = np.asarray(mesh.regular_faces)
    if of_cells:
        flat = corners.reshape(-1)
        places, normals, paints = places[flat], normals[flat], colors.repeat(3, axis=0)
        corners = np.arange(len(flat))
    else:
        paints = colors[origin]
    return {
        "places": page.places(places),
        "normals": _text(normals.astype(np.float32)),
        "colors": _text(np.ascontiguousarray(paints)),
        "triangles": _text(corners.astype(np.uint32)),
        "opacity": opacity,
    }


def _legend(view: SceneView) -> list[list[Any]]:
    """Valences and their colours."""
    if not (view.layer("legend").visible and view.layer("singularities").visible):
        return []
    return [[n, valence_color(n)] for n in sorted({m.valence for m in view.singularities})]


def _bar(view: SceneView) -> dict[str, Any] | None:
    """The colour bar of the scalar that is shown."""
    shown = shown_scalar(view)
    if not shown:
        return None
    settings, limits = view.layer(shown), shown_limits(view)
    if limits is None:
        return None
    texts = bar_texts(shown, *limits)
    name = settings.color_map or SCALARS[shown].color_map
    table = color_table(name, settings.opacity, BAR_COLORS)
    colors = [f"rgb({red}, {green}, {blue})" for red, green, blue, _ in table.tolist()]
    return {"title": SCALARS[shown].title, "colors": colors, "texts": texts}


def _bytes(parts: FloatArray) -> Bytes:
    """Parts of colours, 0 to 1, as bytes."""
    return np.round(255.0 * parts).astype(np.uint8)


def _text(array: npt.NDArray[Any]) -> str:
    """The bytes of an array, lowest first, as text."""
    little = array.astype(array.dtype.newbyteorder("<"))
    return base64.b64encode(np.ascontiguousarray(little).tobytes()).decode()
