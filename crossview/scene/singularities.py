"""Singularities, the preview dot and the ring of the selected: rimmed discs that face the eye."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pyvista as pv
from scipy.spatial.distance import pdist

from crossview.scene.balls import LOCK, RIM, RING, Balls
from crossview.scene.watch import Watch
from crossview.view.colors import valence_color
from crossview.view.geometry import Triangles
from crossview.view.scalars import shown_scalar
from crossview.view.scene_view import SceneView
from crossview.view.values import Marker

_RADIUS, _CROWDED = 0.014, 0.42
"""Radius of a ball, in diagonals of the surface, and at most in distances to the nearest. Chosen.
"""

DISC_PARTS, DISC_PAINTS = (1.0, 0.92, 0.76), (RIM, "#ffffff")
"""A disc is a rim, a light ring and the colour: radii as shares of its own, and paints. Chosen."""

_RING_SIZE = 1.75
"""Radius of the ring around what is selected, in those of a ball. Chosen."""

_PREVIEW_OPACITY = 0.6
"""Of a singularity that a click would place, 0 to 1. Chosen."""


class SingularitiesLayer:
    """The singularities in the colours of their valences, a lock on or a ring about some."""

    def __init__(self, plotter: pv.BasePlotter, pixel_ratio: float) -> None:
        self._discs = Balls(plotter, "singularities")
        self._locks = Balls(plotter, "locks", LOCK)
        self._rings = Balls(plotter, "selection", RING)
        self._preview = Balls(plotter, "preview")
        self._preview.property.SetOpacity(_PREVIEW_OPACITY)
        self._watch = Watch()

    def show(self, view: SceneView, triangles: Triangles | None) -> None:
        """Apply what changed."""
        settings = view.layer("singularities")
        markers = view.singularities if settings.visible else ()
        side = _front(view, triangles)
        seen = (markers, view.preview, settings.size, triangles, side)
        if not self._watch.changed("markers", *seen):
            return
        diagonal = triangles.diagonal if triangles is not None else 1.0
        # A dragged singularity is in the way of its neighbours, not of their size.
        radius = marker_radius(view.singularities, diagonal, settings.size)
        self._draw(self._discs, markers, radius, side)
        self._draw(self._locks, tuple(m for m in markers if m.locked), radius, side)
        selected = tuple(replace(m, valence=0) for m in markers if m.selected)
        self._draw(self._rings, selected, _RING_SIZE * radius, side)
        self._draw(self._preview, (view.preview,) if view.preview else (), radius, side)

    def remove(self) -> None:
        """Take them all off the plotter."""
        for balls in (self._discs, self._locks, self._rings, self._preview):
            balls.remove()

    @staticmethod
    def _draw(balls: Balls, markers: tuple[Marker, ...], radius: float, side: int) -> None:
        centres, normals = (
            np.array([getattr(m, name) for m in markers], float).reshape(-1, 3)
            for name in ("position", "normal")
        )
        colors = [valence_color(m.valence) if m.valence else RIM for m in markers]
        balls.show(centres, radius, colors, normals, side)


def _front(view: SceneView, triangles: Triangles | None) -> int:
    """Which side of the triangles hides what is on the other: 1 or -1, 0: neither does."""
    surface = view.layer("surface")
    drawn = surface.visible or shown_scalar(view)
    solid = view.cover or (drawn and surface.opacity == 1.0)
    return triangles.outward if triangles is not None and solid and view.clip is None else 0


def marker_radius(markers: tuple[Marker, ...], diagonal: float, size: float) -> float:
    """Return the radius of the discs: of the surface's size, less where they are crowded."""
    radius = _RADIUS * diagonal
    if len(markers) > 1:
        nearest = float(np.quantile(pdist(np.array([m.position for m in markers])), 0.02))
        radius = min(radius, max(_CROWDED * nearest, 0.25 * radius))
    return radius * size
