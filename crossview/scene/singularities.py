"""Singularities, the preview dot and the ring of the selected: rimmed discs that face the eye."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pyvista as pv
from scipy.spatial.distance import pdist

from crossview.scene.actors import MeshActor, set_cell_colors
from crossview.scene.watch import Watch
from crossview.view.colors import rgb, valence_color
from crossview.view.geometry import FloatArray, IntArray, Triangles
from crossview.view.scene_view import SceneView
from crossview.view.values import Marker

_RADIUS, _CROWDED = 0.014, 0.42
"""Radius of a ball, in diagonals of the surface, and at most in distances to the nearest. Chosen.
"""

_RIM = "#16181c"
"""Colour of the rims."""

DISC_PARTS, DISC_PAINTS = (1.0, 0.92, 0.76), (_RIM, "#ffffff")
"""A disc is a rim, a light ring and the colour: radii as shares of its own, and paints. Chosen."""

_RING_SIZE = 1.75
"""Radius of the ring around what is selected, in those of a ball. Chosen."""

_PREVIEW_OPACITY = 0.6
"""Of a singularity that a click would place, 0 to 1. Chosen."""

_AWAY = """//VTK::Light::Impl
  vec3 eye = cameraParallel != 0 ? vec3(0.0, 0.0, 1.0) : normalize(-vertexVC.xyz);
  float facing = clamp(abs(dot(normalize(normalVCVSOutput), eye)), 0.0, 1.0);
  float away = sqrt(1.0 - facing * facing);
"""
"""A ball painted by how far its normal leans from the eye: a disc in every view, of the right
size and hidden by what is before it.
"""

_DISC = (
    _AWAY
    + """
  vec3 color = mix(diffuseColor, vec3(1.0), smoothstep(0.74, 0.78, away));
  fragOutput0 = vec4(mix(color, vec3({rim}), smoothstep(0.90, 0.94, away)), opacity);
"""
)
"""So a ball is painted as a disc."""

_RING = (
    _AWAY
    + """
  if (away < 0.80) discard;
  float edge = 1.0 - smoothstep(0.84, 0.86, away) + smoothstep(0.93, 0.95, away);
  fragOutput0 = vec4(mix(diffuseColor, vec3(1.0), edge), opacity);
"""
)
"""And so as a ring."""


class Balls:
    """Any number of balls of one shader in one dataset, by default rimmed discs."""

    def __init__(self, plotter: pv.BasePlotter, name: str, shader: str = _DISC) -> None:
        self._actor = MeshActor(plotter, name)
        code = shader.format(rim=", ".join(f"{part:.4f}" for part in rgb(_RIM)))
        self._actor.actor.GetShaderProperty().AddFragmentShaderReplacement(
            "//VTK::Light::Impl", True, code, False
        )
        self._actor.property.SetInterpolationToPhong()
        ball = pv.Sphere(radius=1.0, theta_resolution=40, phi_resolution=32)
        self._unit: FloatArray = np.asarray(ball.points)
        self._faces: IntArray = np.asarray(ball.regular_faces)
        self.property = self._actor.property

    def show(self, centres: FloatArray, radius: float, colors: list[str]) -> None:
        """Draw balls of these centres (k, 3) and colours."""
        k = len(colors)
        points = (centres[:, None] + radius * self._unit).reshape(-1, 3)
        if self._actor.mesh.n_points == len(points):
            if k:
                self._actor.move(points)
        else:
            first = len(self._unit) * np.arange(k)[:, None, None]
            self._actor.replace(points, faces=(self._faces + first).reshape(-1, 3))
            normals: Any = np.tile(self._unit, (k, 1)).astype(np.float32)
            self._actor.mesh.GetPointData().SetNormals(pv.convert_array(normals, "Normals"))
        if k:
            rows = np.array([rgb(color) for color in colors]) * 255.0
            cells = np.repeat(np.round(rows), len(self._faces), axis=0)
            set_cell_colors(self._actor.mesh, self._actor.mapper, cells)
        self._actor.visible = k > 0

    def remove(self) -> None:
        """Take them off the plotter."""
        self._actor.remove()


class SingularitiesLayer:
    """The singularities in the colours of their valences, and a ring about the selected."""

    def __init__(self, plotter: pv.BasePlotter, pixel_ratio: float) -> None:
        self._discs = Balls(plotter, "singularities")
        self._rings = Balls(plotter, "selection", _RING)
        self._preview = Balls(plotter, "preview")
        self._preview.property.SetOpacity(_PREVIEW_OPACITY)
        self._watch = Watch()

    def show(self, view: SceneView, triangles: Triangles | None) -> None:
        """Apply what changed."""
        settings = view.layer("singularities")
        markers = view.singularities if settings.visible else ()
        if not self._watch.changed("markers", markers, view.preview, settings.size, triangles):
            return
        diagonal = triangles.diagonal if triangles is not None else 1.0
        # A dragged singularity is in the way of its neighbours, not of their size.
        radius = marker_radius(view.singularities, diagonal, settings.size)
        self._draw(self._discs, markers, radius)
        selected = tuple(replace(m, valence=0) for m in markers if m.selected)
        self._draw(self._rings, selected, _RING_SIZE * radius)
        self._draw(self._preview, (view.preview,) if view.preview else (), radius)

    def remove(self) -> None:
        """Take them all off the plotter."""
        for balls in (self._discs, self._rings, self._preview):
            balls.remove()

    @staticmethod
    def _draw(balls: Balls, markers: tuple[Marker, ...], radius: float) -> None:
        centres = np.array([m.position for m in markers], float).reshape(-1, 3)
        balls.show(
            centres, radius, [valence_color(m.valence) if m.valence else _RIM for m in markers]
        )


def marker_radius(markers: tuple[Marker, ...], diagonal: float, size: float) -> float:
    """Return the radius of the discs: of the surface's size, less where they are crowded."""
    radius = _RADIUS * diagonal
    if len(markers) > 1:
        nearest = float(np.quantile(pdist(np.array([m.position for m in markers])), 0.02))
        radius = min(radius, max(_CROWDED * nearest, 0.25 * radius))
    return radius * size
