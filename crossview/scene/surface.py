"""The surface layer: light grey with soft shading, coloured by H or by theta."""

from __future__ import annotations

import numpy as np
import pyvista as pv
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals

from crossview.scene.actors import MeshActor
from crossview.scene.colors import SURFACE, color_table, rgb
from crossview.scene.field import cross_angle
from crossview.scene.geometry import FloatArray, IntArray, Triangles
from crossview.scene.style import WIDTH
from crossview.scene.view import SceneView
from crossview.scene.watch import Watch

# Edges sharper than this, in degrees, stay sharp in the shading.
_FEATURE_ANGLE = 50.0
# Sizes that differ by less than a percent are not worth a colour.
_LEAST_LIMIT = 0.01
_EDGE_COLOR = "#9aa0a8"
# Light that comes from everywhere; the rest comes from the scene's lights.
AMBIENT = 0.44


class SurfaceLayer:
    """Triangles and the scalar on them: theta if visible, else H if visible, else grey."""

    def __init__(self, plotter: pv.BasePlotter, pixel_ratio: float) -> None:
        self._actor = MeshActor(plotter, "surface")
        self._pixel_ratio = pixel_ratio
        self._watch = Watch()
        self._origin: IntArray = np.empty(0, int)
        self._table = vtkLookupTable()
        self._actor.mapper.SetLookupTable(self._table)
        self._actor.mapper.UseLookupTableScalarRangeOn()
        self._actor.mapper.InterpolateScalarsBeforeMappingOn()
        style = self._actor.property
        style.SetColor(*rgb(SURFACE))
        style.SetInterpolationToPhong()
        style.SetAmbient(AMBIENT)
        style.SetDiffuse(1.0 - AMBIENT)
        style.SetSpecular(0.0)
        style.SetEdgeColor(*rgb(_EDGE_COLOR))
        self.h_range = (-1.0, 1.0)

    def show(self, view: SceneView, triangles: Triangles | None) -> None:
        """Apply what changed."""
        if self._watch.changed("triangles", triangles):
            self._replace(triangles)
        shown = shown_scalar(view)
        if triangles is not None and shown:
            self._color(view, shown, triangles)
        self._actor.mapper.SetScalarVisibility(bool(shown))
        settings = view.layer("surface")
        self._actor.visible = bool(shown) or settings.visible
        if self._watch.changed("style", settings, triangles):
            self._actor.property.SetOpacity(settings.opacity)
            self._actor.property.SetEdgeVisibility(settings.edges)
            self._cull(triangles, settings.opacity)
            self._actor.property.SetLineWidth(WIDTH["edges"] * self._pixel_ratio)

    def remove(self) -> None:
        """Take the surface off the plotter."""
        self._actor.remove()

    def _replace(self, triangles: Triangles | None) -> None:
        if triangles is None:
            self._actor.replace(np.empty((0, 3)))
            return
        self._actor.replace(triangles.points, faces=triangles.faces)
        self._origin = _shade(self._actor.mesh)

    def _cull(self, triangles: Triangles | None, opacity: float) -> None:
        """Leave out the far side of a closed surface: nearly half the time of a frame."""
        side = triangles.outward if triangles is not None and opacity == 1.0 else 0
        self._actor.property.SetBackfaceCulling(side > 0)
        self._actor.property.SetFrontfaceCulling(side < 0)

    def _color(self, view: SceneView, shown: str, triangles: Triangles) -> None:
        settings = view.layer(shown)
        name = settings.color_map or DEFAULT_MAPS[shown]
        if self._watch.changed("map", name, settings.opacity):
            colors = color_table(name, settings.opacity)
            self._table.SetTable(numpy_to_vtk(colors, deep=True))
        data = view.H if shown == "H" else view.u
        if data is None or not self._watch.changed(
            "scalar", shown, data, triangles, settings.value_range
        ):
            return
        if shown == "H":
            self.h_range = settings.value_range or symmetric_range(data, triangles.vertex_areas)
            self._set_scalars(data[self._origin], self.h_range, cells=False)
        else:
            self._set_scalars(cross_angle(triangles, data), (0.0, np.pi / 2), cells=True)

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


DEFAULT_MAPS = {"H": "vik", "theta": "romaO"}


def shown_scalar(view: SceneView) -> str:
    """Return which scalar colours the surface: "theta", "H" or "" for none."""
    if view.layer("theta").visible and view.u is not None:
        return "theta"
    return "H" if view.layer("H").visible and view.H is not None else ""


def symmetric_range(values: FloatArray, weights: FloatArray) -> tuple[float, float]:
    """Return round limits about 0 that leave out the far ends at the singularities.

    H has a logarithm's pole at each singularity, as deep as the mesh there is fine. So the limit
    is what 98 % of the area stay below, rounded up to one or two digits.

    Parameters
    ----------
    values : (n,) float
    weights : (n,) float
        Area about each value.
    """
    size = np.abs(values)
    order = np.argsort(size)
    share = np.cumsum(weights[order])
    top = max(float(size[order][np.searchsorted(share, 0.98 * share[-1])]), _LEAST_LIMIT)
    unit = 10.0 ** np.floor(np.log10(top))
    steps = np.array([1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0]) * unit
    limit = float(steps[np.searchsorted(steps, top * (1.0 - 1e-9))])
    return (-limit, limit)


def _shade(mesh: pv.PolyData) -> IntArray:
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
    return vtk_to_numpy(mesh.GetPointData().GetArray("origin")).astype(int)
