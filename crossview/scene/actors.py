"""Actors whose contents are replaced or changed in place, never the actors themselves."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pyvista as pv
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkRenderingCore import vtkActor, vtkMapper, vtkPolyDataMapper

from crossview.view.colors import rgb
from crossview.view.geometry import FloatArray, IntArray
from crossview.view.style import TOWARDS


class MeshActor:
    """One polydata, one mapper, one actor on one plotter.

    Parameters
    ----------
    plotter : pyvista plotter
    name : str
        Of the actor, unique on the plotter; a key of `style.TOWARDS`.
    """

    def __init__(self, plotter: pv.BasePlotter, name: str) -> None:
        self._plotter = plotter
        self.mesh = pv.PolyData()
        self.mapper = vtkPolyDataMapper()
        self.mapper.SetInputData(self.mesh)
        self.mapper.ScalarVisibilityOff()
        # Switched on once for the process; each mapper then adds its own offset.
        vtkMapper.SetResolveCoincidentTopologyToPolygonOffset()
        self.lift(TOWARDS[name])
        self.actor = vtkActor()
        self.actor.SetMapper(self.mapper)
        self.actor.PickableOff()
        self.property = self.actor.GetProperty()
        plotter.add_actor(self.actor, name=name, reset_camera=False, render=False, pickable=False)

    def lift(self, towards: float) -> None:
        """Draw it nearer to the eye than it is; see `style.TOWARDS`."""
        self.mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(0.0, -towards)
        self.mapper.SetRelativeCoincidentTopologyLineOffsetParameters(0.0, -towards)
        self.mapper.SetRelativeCoincidentTopologyPointOffsetParameter(-towards)

    @property
    def visible(self) -> bool:
        """Whether the actor is drawn."""
        return bool(self.actor.GetVisibility())

    @visible.setter
    def visible(self, visible: bool) -> None:
        self.actor.SetVisibility(visible and self.mesh.n_points > 0)

    def replace(
        self, points: FloatArray, lines: IntArray | None = None, faces: IntArray | None = None
    ) -> None:
        """Put other contents, pairs or triangles of point numbers, into the actor's dataset."""
        mesh = pv.PolyData()
        mesh.points = np.ascontiguousarray(points, np.float32).reshape(-1, 3)
        if lines is not None and len(lines):
            mesh.lines = cell_array(lines)
        if faces is not None and len(faces):
            mesh.faces = cell_array(faces)
        self.mesh.shallow_copy(mesh)
        self.mesh.Modified()

    def move(self, points: FloatArray) -> None:
        """Move the points that are there."""
        self.mesh.points[:] = points
        self.mesh.GetPoints().Modified()

    def color(self, color: str) -> None:
        """Draw all of it in one colour."""
        self.property.SetColor(*rgb(color))

    def flat(self) -> None:
        """Draw colours as they are, without light."""
        self.property.LightingOff()

    def remove(self) -> None:
        """Take the actor off the plotter."""
        self._plotter.remove_actor(self.actor, reset_camera=False, render=False)


def set_cell_colors(mesh: pv.PolyData, mapper: Any, colors: npt.ArrayLike) -> None:
    """Colour each cell by a row (red, green, blue), 0 to 255."""
    array = numpy_to_vtk(np.ascontiguousarray(colors, np.uint8), deep=True)
    array.SetName("color")
    mesh.GetCellData().SetScalars(array)
    mapper.SetScalarModeToUseCellData()
    mapper.SetColorModeToDirectScalars()
    mapper.ScalarVisibilityOn()


def cell_array(corners: IntArray) -> IntArray:
    """Return (k, c) point numbers as the flat array, counts before corners, that VTK takes."""
    counts = np.full((len(corners), 1), corners.shape[1])
    return np.hstack([counts, corners]).ravel()
