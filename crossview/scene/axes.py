"""Small axes at the top right, turning with the camera."""

from __future__ import annotations

import numpy as np
import pyvista as pv

from crossview.scene.camera import rows
from crossview.scene.overlay import Label, Patches
from crossview.view.colors import THEMES, bytes_of
from crossview.view.geometry import FloatArray, Triangles
from crossview.view.scene_view import SceneView

_LENGTH, _CORNER = 24.0, 46.0
"""Of the arrows, and of their origin from the corner, in pixels of the window. Chosen."""

TEXT_SIZE, LINE_WIDTH = 11.0, 1.5
"""In pixels of the window. Chosen."""


class AxesLayer:
    """x, y and z as the camera sees them, drawn just before each frame."""

    def __init__(self, plotter: pv.BasePlotter, pixel_ratio: float) -> None:
        self._renderer = plotter.renderer
        self._ratio = pixel_ratio
        self._lines = Patches(plotter, (1.0, 1.0))
        self._lines.property.SetLineWidth(LINE_WIDTH * pixel_ratio)
        self._labels = [
            Label(plotter, (1.0, 1.0), TEXT_SIZE * pixel_ratio, "centre") for _ in "xyz"
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
        turn = rows(self._renderer.GetActiveCamera().GetViewTransformMatrix())[:3, :3]
        if tuple(turn.ravel()) == self._turned:
            return
        self._turned = tuple(turn.ravel())
        lines, names = axes_layout(turn)
        cells = np.arange(6).reshape(3, 2)
        colors = bytes_of([self._color] * 3)
        self._lines.show(lines.reshape(-1, 2) * self._ratio, cells, colors, lines=True)
        for label, (name, x, y) in zip(self._labels, names, strict=True):
            label.show(name, (x * self._ratio, y * self._ratio), self._color)


def axes_layout(turn: FloatArray) -> tuple[FloatArray, list[tuple[str, float, float]]]:
    """Return lines (3, 2, 2) and names with their places, in pixels from the top right corner.

    Parameters
    ----------
    turn : (3, 3) float
        From space to right, up and towards the eye.
    """
    centre = np.array([-_CORNER, -_CORNER])
    tips = turn[:2].T
    lines = centre + _LENGTH * np.stack([0.0 * tips, tips], axis=1)
    # An axis that points at the eye would write its name over the others.
    names = ["" if np.hypot(*tip) < 0.2 else name for name, tip in zip("xyz", tips, strict=True)]
    places = centre + (_LENGTH + 9.0) * tips
    return lines, [(n, float(x), float(y)) for n, (x, y) in zip(names, places, strict=True)]
