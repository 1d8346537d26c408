"""Flat drawing over the scene in pixels, anchored to a corner: texts, patches, lines.

Everything is placed by a point of the viewport (0 to 1 each way) and an offset in pixels from
it, so nothing has to be told when the window is resized, and nothing moves when contents change.
"""

from __future__ import annotations

from pathlib import Path

import matplotlib
import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonCore import VTK_FONT_FILE
from vtkmodules.vtkRenderingCore import vtkActor2D, vtkCoordinate, vtkPolyDataMapper2D, vtkTextActor

from crossview.scene.actors import cell_array, set_cell_colors
from crossview.view.colors import rgb
from crossview.view.geometry import FloatArray, IntArray

FONT = str(Path(matplotlib.get_data_path()) / "fonts/ttf/DejaVuSans.ttf")
"""The font of all texts; vector figures have the same.

VTK's own fonts have no Greek letters; this one comes with matplotlib, which pyvista needs.
"""

Point = tuple[float, float]


class Label:
    """One line of text.

    Parameters
    ----------
    plotter : pyvista plotter
    anchor : (float, float)
        Point of the viewport.
    size : float
        Height of the font in pixels.
    align : {"left", "centre", "right"}
    """

    def __init__(self, plotter: pv.BasePlotter, anchor: Point, size: float, align: str) -> None:
        self._plotter = plotter
        self._actor = vtkTextActor()
        self._actor.PickableOff()
        style = self._actor.GetTextProperty()
        style.SetFontFamily(VTK_FONT_FILE)
        style.SetFontFile(FONT)
        style.SetFontSize(round(size))
        style.SetVerticalJustificationToCentered()
        style.SetJustification(("left", "centre", "right").index(align))
        coordinate = self._actor.GetPositionCoordinate()
        coordinate.SetCoordinateSystemToViewport()
        coordinate.SetReferenceCoordinate(_anchor(anchor))
        plotter.renderer.AddViewProp(self._actor)

    def show(self, text: str, offset: Point, color: str) -> None:
        """Write a text (empty: nothing) at an offset in pixels, up and to the right."""
        self._actor.SetInput(text)
        self._actor.SetVisibility(bool(text))
        self._actor.SetPosition(*offset)
        self._actor.GetTextProperty().SetColor(*rgb(color))

    def width(self) -> float:
        """Width of the text in pixels."""
        box = [0.0] * 4
        self._actor.GetBoundingBox(self._plotter.renderer, box)
        return box[1] - box[0]

    def remove(self) -> None:
        """Take the text off the plotter."""
        self._plotter.renderer.RemoveViewProp(self._actor)


class Patches:
    """Flat polygons or lines, each with its colour."""

    def __init__(self, plotter: pv.BasePlotter, anchor: Point) -> None:
        self._plotter = plotter
        self.mesh = pv.PolyData()
        self._mapper = vtkPolyDataMapper2D()
        self._mapper.SetInputData(self.mesh)
        self._actor = vtkActor2D()
        self._actor.SetMapper(self._mapper)
        self._actor.PickableOff()
        self._actor.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
        self._actor.SetPosition(*anchor)
        self.property = self._actor.GetProperty()
        plotter.renderer.AddViewProp(self._actor)

    def show(
        self, points: FloatArray, cells: IntArray, colors: IntArray, lines: bool = False
    ) -> None:
        """Draw polygons, or lines, (k, c) of points (n, 2) in pixels; colours (k, 3) to 255."""
        mesh = pv.PolyData()
        mesh.points = np.column_stack([points, np.zeros(len(points))]).astype(np.float32)
        if lines:
            mesh.lines = cell_array(cells)
        else:
            mesh.faces = cell_array(cells)
        self.mesh.shallow_copy(mesh)
        set_cell_colors(self.mesh, self._mapper, colors)
        self._actor.VisibilityOn()

    def hide(self) -> None:
        """Draw nothing."""
        self._actor.VisibilityOff()

    def remove(self) -> None:
        """Take the patches off the plotter."""
        self._plotter.renderer.RemoveViewProp(self._actor)


def discs(centres: FloatArray, radius: float, sides: int = 40) -> tuple[FloatArray, IntArray]:
    """Return points (k sides, 2) and polygons (k, sides) of discs."""
    turn = np.linspace(0.0, 2.0 * np.pi, sides, endpoint=False)
    circle = radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    points = (np.asarray(centres, float)[:, None] + circle).reshape(-1, 2)
    return points, np.arange(len(points)).reshape(-1, sides)


def _anchor(anchor: Point) -> vtkCoordinate:
    coordinate = vtkCoordinate()
    coordinate.SetCoordinateSystemToNormalizedViewport()
    coordinate.SetValue(*anchor)
    return coordinate
