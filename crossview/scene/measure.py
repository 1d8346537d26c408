"""What is being measured: paths with their ends, and below the title what has come out."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pyvista as pv

from crossview.scene.actors import MeshActor
from crossview.scene.legend import FOOT, MARGIN, TEXT_SIZE
from crossview.scene.overlay import Label
from crossview.scene.watch import Watch
from crossview.view.colors import CUT_HALO, LOOP, THEMES
from crossview.view.geometry import Triangles
from crossview.view.scene_view import SceneView
from crossview.view.style import WIDTH

DOT = 9.0
"""Diameter of the ends, in pixels of the window. Chosen."""

BELOW = 24.0
"""From the title to the text, likewise."""


class MeasureLayer:
    """Lines with a light rim, a dot at each place, one line of text."""

    def __init__(self, plotter: pv.BasePlotter, pixel_ratio: float) -> None:
        self._ratio = pixel_ratio
        self._actors = {
            name: MeshActor(plotter, name) for name in ("measure halo", "measure", "measure dots")
        }
        for name, actor in self._actors.items():
            actor.flat()
            actor.color(CUT_HALO if name.endswith("halo") else LOOP)
            if name in WIDTH:
                actor.property.SetLineWidth(WIDTH[name] * pixel_ratio)
        dots = self._actors["measure dots"].property
        dots.SetRepresentationToPoints()
        dots.SetPointSize(DOT * pixel_ratio)
        dots.SetRenderPointsAsSpheres(True)
        self._label = Label(plotter, (0.0, 1.0), TEXT_SIZE * pixel_ratio, "left")
        self._watch = Watch()

    def show(self, view: SceneView, triangles: Triangles | None) -> None:
        """Apply what changed."""
        measured = view.measurement
        if not self._watch.changed("measurement", measured, view.background):
            return
        offset = (MARGIN * self._ratio, -(FOOT + BELOW) * self._ratio)
        text = "" if measured is None else measured.text
        self._label.show(text, offset, THEMES[view.background].text)
        if measured is not None:
            points = np.concatenate([np.empty((0, 3)), *measured.paths])
            ends = np.cumsum([0, *map(len, measured.paths)])
            joined = [np.arange(low, high) for low, high in pairwise(ends)]
            pairs = np.concatenate(
                [np.empty((0, 2), int), *(np.stack([p[:-1], p[1:]], axis=1) for p in joined)]
            )
            for name in ("measure halo", "measure"):
                self._actors[name].replace(points, lines=pairs)
            dots = self._actors["measure dots"]
            dots.replace(measured.places)
            ones = np.ones(len(measured.places), int)
            dots.mesh.verts = np.stack([ones, np.arange(len(ones))], axis=1).ravel()
        for actor in self._actors.values():
            actor.visible = measured is not None

    def remove(self) -> None:
        """Take it off the plotter."""
        self._label.remove()
        for actor in self._actors.values():
            actor.remove()
