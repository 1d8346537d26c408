"""The surface layer: light grey with soft shading, coloured by a scalar."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyvista as pv
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals

from crossview.scene.actors import MeshActor
from crossview.scene.watch import Watch
from crossview.view.colors import SURFACE, color_table, rgb
from crossview.view.geometry import FloatArray, IntArray, Triangles
from crossview.view.scalars import (
    SCALARS,
    WITHIN,
    Beyond,
    Limits,
    beyond,
    scalar_limits,
    scalar_values,
    shown_scalar,
)
from crossview.view.scene_view import SceneView
from crossview.view.style import WIDTH

_FEATURE_ANGLE = 50.0
"""Edges sharper than this, in degrees, stay sharp in the shading. Chosen."""

_EDGE_COLOR = "#9aa0a8"
"""Of the triangles' edges."""

AMBIENT = 0.44
"""Share of the light that comes from everywhere; the rest comes from the scene's lights. Chosen."""


class SurfaceLayer:
    """Triangles and the scalar on them; grey if there is none."""

    def __init__(self, plotter: pv.BasePlotter, pixel_ratio: float) -> None:
        self._actor = MeshActor(plotter, "surface")
        self._pixel_ratio = pixel_ratio
        self._watch = Watch()
        self._origin: IntArray = np.empty(0, int)
        self._table = vtkLookupTable()
        self._actor.mapper.SetLookupTable(self._table)
        self._actor.mapper.UseLookupTableScalarRangeOn()
        self._actor.mapper.InterpolateScalarsBeforeMappingOn()
        style_surface(self._actor.property)
        self._actor.property.SetEdgeColor(*rgb(_EDGE_COLOR))
        self.h_range: Limits = (-1.0, 1.0)
        self.limits: Limits = (-1.0, 1.0)
        self.beyond: Beyond = WITHIN

    def show(self, view: SceneView, triangles: Triangles | None) -> None:
        """Apply what changed."""
        if self._watch.changed("triangles", triangles):
            self._replace(triangles)
        if view.cover:
            self._actor.visible = False
            return
        shown = shown_scalar(view)
        if triangles is not None and shown:
            self._color(view, shown, triangles)
        self._actor.mapper.SetScalarVisibility(bool(shown))
        self._actor.property.SetLighting(not shown or view.layer(shown).shaded)
        settings = view.layer("surface")
        self._actor.visible = bool(shown) or settings.visible
        if self._watch.changed("style", settings, triangles, view.clip is None):
            self._actor.property.SetOpacity(settings.opacity)
            self._actor.property.SetEdgeVisibility(settings.edges)
            self._cull(triangles, settings.opacity == 1.0 and view.clip is None)
            self._actor.property.SetLineWidth(WIDTH["edges"] * self._pixel_ratio)

    def remove(self) -> None:
        """Take the surface off the plotter."""
        self._actor.remove()

    def _replace(self, triangles: Triangles | None) -> None:
        if triangles is None:
            self._actor.replace(np.empty((0, 3)))
            return
        self._actor.replace(triangles.points, faces=triangles.faces)
        self._origin = shade(self._actor.mesh)

    def _cull(self, triangles: Triangles | None, solid: bool) -> None:
        """Leave out the far side of a closed surface: nearly half the time of a frame."""
        side = triangles.outward if triangles is not None and solid else 0
        self._actor.property.SetBackfaceCulling(side > 0)
        self._actor.property.SetFrontfaceCulling(side < 0)

    def _color(self, view: SceneView, shown: str, triangles: Triangles) -> None:
        settings = view.layer(shown)
        name = settings.color_map or SCALARS[shown].color_map
        if self._watch.changed("map", name, settings.opacity):
            colors = color_table(name, settings.opacity)
            self._table.SetTable(numpy_to_vtk(colors, deep=True))
        data = (view.u,) if shown == "theta" else (view.H, view.half_log_aspect)
        data = (view.error_density,) if shown == "error" else data
        if not self._watch.changed("scalar", shown, *data, triangles, settings.value_range):
            return
        values = scalar_values(view, shown, triangles)
        if values is None:
            return
        self.limits = scalar_limits(view, shown, triangles, values)
        self.beyond = beyond(values, self.limits)
        if shown == "H":
            self.h_range = self.limits
        cells = SCALARS[shown].cells
        self._set_scalars(values if cells else values[self._origin], self.limits, cells)

    def _set_scalars(self, values: FloatArray, limits: tuple[float, float], cells: bool) -> None:
        mesh, mapper = self._actor.mesh, self._actor.mapper
        data = mesh.GetCellData() if cells else mesh.GetPointData()
        array = data.GetArray("scalar")
        if array is None or array.GetNumberOfTuples() != len(values):
            array = numpy_to_vtk(values.astype(np.float32), deep=True)
            array.SetName("scalar")
            data.AddArray(array)
        else:
            vtk_to_numpy(array)[:] = values
            array.Modified()
        if cells:
            mapper.SetScalarModeToUseCellFieldData()
        else:
            mapper.SetScalarModeToUsePointFieldData()
        mapper.SelectColorArray("scalar")
        self._table.SetTableRange(*limits)


def style_surface(style: Any) -> None:
    """Give an actor's property soft shading: light grey where there is no colour."""
    style.SetColor(*rgb(SURFACE))
    style.SetInterpolationToPhong()
    style.SetAmbient(AMBIENT)
    style.SetDiffuse(1.0 - AMBIENT)
    style.SetSpecular(0.0)


def shade(mesh: pv.PolyData) -> IntArray:
    """Give the mesh point normals, split at sharp edges; return each point's old number."""
    origin = numpy_to_vtk(np.arange(mesh.n_points), deep=True)
    origin.SetName("origin")
    mesh.GetPointData().AddArray(origin)
    normals = vtkPolyDataNormals()
    normals.SetInputData(mesh)
    normals.SetFeatureAngle(_FEATURE_ANGLE)
    normals.ConsistencyOff()
    normals.AutoOrientNormalsOff()
    normals.Update()
    mesh.shallow_copy(normals.GetOutput())
    return np.asarray(vtk_to_numpy(mesh.GetPointData().GetArray("origin")).astype(int))
