"""Small axes at the top right, turning with the camera."""

from __future__ import annotations

import numpy as np
import pyvista as pv

from crossview.scene.colors import THEMES
from crossview.scene.geometry import Triangles
from crossview.scene.overlay import Label, Patches, bytes_of
from crossview.scene.view import SceneView

_LENGTH, _CORNER, _TEXT_SIZE = 24.0, 46.0, 11.0


class AxesLayer:
    """x, y and z as the camera sees them, drawn just before each frame."""

    def __init__(self, plotter: pv.BasePlotter, pixel_ratio: float) -> None:
        self._renderer = plotter.renderer
        self._ratio = pixel_ratio
        self._lines = Patches(plotter, (1.0, 1.0))
        self._lines.property.SetLineWidth(1.5 * pixel_ratio)
        self._labels = [
            Label(plotter, (1.0, 1.0), _TEXT_SIZE * pixel_ratio, "centre") for _ in "xyz"
        ]
        self._color = ""
        self._turned: tuple[float, ...] = ()
        self._observer = self._renderer.AddObserver("StartEvent", self._turn)

    def show(self, view: SceneView, triangles: Triangles | None) -> None:
        """Apply what changed."""
        shown = view.layer("axes").visible and triangles is not None
        self._color = THEMES[view.background].faint if shown else ""
        self._turned = ()
        if not shown:
            self._lines.hide()
            for label in self._labels:
                label.show("", (0.0, 0.0), "black")

    def remove(self) -> None:
        """Take the axes off the plotter, and the observer of its frames."""
        self._renderer.RemoveObserver(self._observer)
        self._lines.remove()
        for label in self._labels:
            label.remove()

    def _turn(self, *_: object) -> None:
        if not self._color:
            return
        camera = self._renderer.GetActiveCamera()
        matrix = camera.GetViewTransformMatrix()
        turn = np.array([[matrix.GetElement(i, j) for j in range(3)] for i in range(3)])
        if tuple(turn.ravel()) == self._turned:
            return
        self._turned = tuple(turn.ravel())
        centre = np.array([-_CORNER, -_CORNER])
        tips = turn[:2].T
        points = np.vstack([centre, centre + _LENGTH * tips]) * self._ratio
        cells = np.array([[0, 1], [0, 2], [0, 3]])
        self._lines.show(points, cells, bytes_of([self._color] * 3), lines=True)
        for label, tip, name in zip(self._labels, tips, "xyz", strict=True):
            # An axis that points at the eye would write its name over the others.
            seen = name if np.hypot(*tip) > 0.2 else ""
            x, y = (centre + (_LENGTH + 9.0) * tip) * self._ratio
            label.show(seen, (x, y), self._color)
