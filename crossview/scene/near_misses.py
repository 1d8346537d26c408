"""Near misses: separatrices that a click makes meet what they nearly meet, dotted."""

from __future__ import annotations

import pyvista as pv

from crossview.scene.actors import MeshActor
from crossview.scene.separatrices import curve_height
from crossview.scene.watch import Watch
from crossview.view.colors import CUT_HALO, NEAR_MISS
from crossview.view.geometry import Triangles, dashes
from crossview.view.scene_view import SceneView
from crossview.view.style import WIDTH

DOT, GAP = 0.004, 0.009
"""Lengths of dots and of gaps between them, in diagonals of the surface. Chosen."""


class NearMissesLayer:
    """Dots with a light rim on the separatrices, and from there to what they miss."""

    def __init__(self, plotter: pv.BasePlotter, pixel_ratio: float) -> None:
        self._actors = {
            name: MeshActor(plotter, name) for name in ("near misses halo", "near misses")
        }
        for actor, color in zip(self._actors.values(), (CUT_HALO, NEAR_MISS), strict=True):
            actor.flat()
            actor.color(color)
        self._pixel_ratio = pixel_ratio
        self._watch = Watch()

    def show(self, view: SceneView, triangles: Triangles | None) -> None:
        """Apply what changed."""
        settings, curves = view.layer("guide"), view.near_misses
        if not settings.visible or triangles is None or curves is None or not len(curves.points):
            for actor in self._actors.values():
                actor.visible = False
            return
        if self._watch.changed("curves", curves):
            lengths = (DOT * triangles.diagonal, GAP * triangles.diagonal)
            ends, lines = dashes(curves.points, curves.segments, *lengths)
            for actor in self._actors.values():
                actor.replace(ends, lines=lines)
        for name, actor in self._actors.items():
            actor.lift(curve_height(view, name))
            actor.property.SetLineWidth(WIDTH[name] * settings.size * self._pixel_ratio)
            actor.visible = True

    def remove(self) -> None:
        """Take the near misses off the plotter."""
        for actor in self._actors.values():
            actor.remove()
