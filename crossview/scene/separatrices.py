"""Separatrices: curves on the surface in the colour of the singularity that they leave."""

from __future__ import annotations

import numpy as np
import pyvista as pv

from crossview.scene.actors import MeshActor, set_cell_colors
from crossview.scene.watch import Watch
from crossview.view.colors import CUT_HALO, SEPARATRIX, bytes_of, valence_color
from crossview.view.geometry import Triangles
from crossview.view.scene_view import SceneView
from crossview.view.style import TOWARDS, WIDTH
from crossview.view.values import Polylines


class SeparatricesLayer:
    """All curves in one dataset of lines, with a light rim to be seen on every colour."""

    def __init__(self, plotter: pv.BasePlotter, pixel_ratio: float) -> None:
        self._halo = MeshActor(plotter, "separatrices halo")
        self._halo.color(CUT_HALO)
        self._lines = MeshActor(plotter, "separatrices")
        for actor in (self._halo, self._lines):
            actor.flat()
        self._pixel_ratio = pixel_ratio
        self._watch = Watch()

    def show(self, view: SceneView, triangles: Triangles | None) -> None:
        """Apply what changed."""
        settings, curves = view.layer("separatrices"), view.separatrices
        if not settings.visible or triangles is None or curves is None:
            self._halo.visible = self._lines.visible = False
            return
        if self._watch.changed("curves", curves):
            self._replace(curves)
        for actor, name in ((self._halo, "separatrices halo"), (self._lines, "separatrices")):
            actor.lift(curve_height(view, name))
            actor.property.SetOpacity(settings.opacity)
            actor.property.SetLineWidth(WIDTH[name] * settings.size * self._pixel_ratio)
            actor.visible = True

    def remove(self) -> None:
        """Take the separatrices off the plotter."""
        self._halo.remove()
        self._lines.remove()

    def _replace(self, curves: Polylines) -> None:
        segments = curves.segments
        for actor in (self._halo, self._lines):
            actor.replace(curves.points, lines=segments)
        if len(segments):
            valences, which = np.unique(curves.segment_valences, return_inverse=True)
            colors = bytes_of([separatrix_color(int(n)) for n in valences])
            set_cell_colors(self._lines.mesh, self._lines.mapper, colors[which])


def curve_height(view: SceneView, name: str) -> float:
    """Return how far curves on the surface are lifted: above quads that cut through it, too."""
    return TOWARDS[name] + (TOWARDS["curves on quads"] if view.cover == "quads" else 0.0)


def separatrix_color(valence: int) -> str:
    """Return the colour of a curve that leaves a singularity of this valence; 0 or less: none."""
    return valence_color(valence) if valence > 0 else SEPARATRIX
