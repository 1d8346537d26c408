"""Quad mesh and layout: quadrilaterals in place of the triangles, their edges and colours."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pyvista as pv

from crossview.scene.actors import MeshActor, set_cell_colors
from crossview.scene.balls import Balls
from crossview.scene.singularities import marker_radius
from crossview.scene.surface import shade, style_surface
from crossview.scene.watch import Watch
from crossview.view.colors import QUAD_EDGE, SURFACE, THEMES, color_table, rgb, valence_color
from crossview.view.geometry import Triangles
from crossview.view.quad_geometry import QuadGeometry
from crossview.view.scalars import SCALARS, quality_limits, shown_scalar
from crossview.view.scene_view import LayerSettings, SceneView
from crossview.view.style import WIDTH
from crossview.view.values import Quads

IRREGULAR_SIZE = 0.7
"""Radius of an irregular vertex's dot, in radii of a singularity's."""


class QuadsLayer:
    """The quad mesh, or the layout's patches, in place of the triangles."""

    def __init__(self, plotter: pv.BasePlotter, pixel_ratio: float) -> None:
        self._quads = MeshActor(plotter, "quads")
        self._borders = MeshActor(plotter, "layout borders")
        self._borders.flat()
        self._dots = Balls(plotter, "irregular")
        style_surface(self._quads.property)
        self._quads.property.SetEdgeColor(*rgb(QUAD_EDGE))
        self._pixel_ratio = pixel_ratio
        self._watch = Watch()
        self._geometry = QuadGeometry(_NOTHING)

    def show(self, view: SceneView, triangles: Triangles | None) -> None:
        """Apply what changed."""
        cover = view.cover if triangles is not None else ""
        mesh = {"quads": view.quads, "layout": view.layout}.get(cover)
        settings = view.layer(cover or "quads")
        if mesh is None:
            self._quads.visible = self._borders.visible = False
        else:
            fresh = self._watch.changed("mesh", mesh)
            if fresh:
                self._replace(mesh)
            self._color(cover, mesh, settings, fresh)
            self._style(cover, settings, THEMES[view.background].ink, shown_scalar(view) == cover)
        self._dot(view, triangles, cover, settings)

    def remove(self) -> None:
        """Take quads, borders and dots off the plotter."""
        self._quads.remove()
        self._borders.remove()
        self._dots.remove()

    def _replace(self, mesh: Quads) -> None:
        self._geometry = QuadGeometry(mesh)
        points, quads = self._geometry.merged
        self._quads.replace(points, faces=quads)
        shade(self._quads.mesh)
        self._borders.replace(mesh.points, lines=self._geometry.borders)

    def _color(self, cover: str, mesh: Quads, settings: LayerSettings, fresh: bool) -> None:
        chosen = (cover, settings.coloring, settings.opacity, settings.value_range)
        if self._watch.changed("colors", *chosen) or fresh:
            colors = quad_colors(cover, self._geometry, settings)
            set_cell_colors(self._quads.mesh, self._quads.mapper, colors)

    def _style(self, cover: str, settings: LayerSettings, ink: str, colored: bool) -> None:
        width = WIDTH[cover] * settings.size * self._pixel_ratio
        self._quads.property.SetLighting(settings.shaded or not colored)
        self._quads.property.SetEdgeVisibility(settings.edges and cover == "quads")
        self._quads.property.SetLineWidth(width)
        self._quads.visible = True
        self._borders.color(ink)
        self._borders.property.SetLineWidth(width)
        self._borders.visible = settings.edges and cover == "layout"

    def _dot(
        self, view: SceneView, triangles: Triangles | None, cover: str, settings: LayerSettings
    ) -> None:
        mesh = view.quads if cover == "quads" and triangles is not None else None
        side = 0 if triangles is None or view.clip is not None else triangles.outward
        if not self._watch.changed(
            "dots", mesh, triangles, settings.size, view.singularities, side
        ):
            return
        if mesh is None or triangles is None:
            self._dots.show(np.empty((0, 3)), 1.0, [], np.empty((0, 3)), 0)
            return
        radius = irregular_radius(view, triangles)
        colors = [valence_color(int(n)) for n in mesh.valences]
        self._dots.show(mesh.irregular, radius, colors, mesh.normals, side)


def irregular_radius(view: SceneView, triangles: Triangles) -> float:
    """Return the radius of the dots of irregular vertices."""
    size = view.layer("quads").size
    return IRREGULAR_SIZE * marker_radius(view.singularities, triangles.diagonal, size)


def quad_colors(
    cover: str, geometry: QuadGeometry, settings: LayerSettings
) -> npt.NDArray[np.uint8]:
    """Return a colour (q, 3), 0 to 255, for each quad of a layout or mesh."""
    mesh = geometry.mesh
    grey = 255.0 * np.array(rgb(SURFACE))
    if cover == "layout":
        mixed = settings.opacity * geometry.patch_colors + (1.0 - settings.opacity) * grey
        return np.round(mixed).astype(np.uint8)
    if settings.coloring == "patch":
        return geometry.patch_colors
    if settings.coloring == "quality" and mesh.quality is not None:
        table = color_table(SCALARS["quads"].color_map)[:, :3]
        low, high = quality_limits(settings, mesh.quality)
        share = (mesh.quality - low) / (high - low)
        return np.asarray(
            table[np.clip(np.rint(share * (len(table) - 1)), 0, len(table) - 1).astype(int)]
        )
    return np.tile(np.round(grey).astype(np.uint8), (len(mesh.quads), 1))


_NOTHING = Quads(np.zeros((1, 3)), np.empty((0, 4), int), np.empty(0, int))
"""What there is before there are quads."""
