"""Readers for the formats that VTK and meshio read well."""

from __future__ import annotations

import contextlib
import io
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import meshio.gmsh
import numpy as np
import pyvista as pv
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
from vtkmodules.vtkIOGeometry import vtkGLTFReader
from vtkmodules.vtkIOLegacy import vtkDataSetReader
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

from crossview.io.polygons import Polygons
from solvers.errors import CrossviewError, counted

CORNERS = {"triangle": 3, "triangle6": 3, "quad": 4, "quad8": 4, "quad9": 4}
"""Corners of meshio's surface cells; their further nodes lie inside edges."""


def read_vtk(path: Path) -> Polygons:
    """Read a dataset in VTK's legacy format; of volumes, the outer surface."""
    return _surface_of(_run(vtkDataSetReader(), path), path)


def read_vtp(path: Path) -> Polygons:
    """Read a surface in VTK's XML format."""
    return _surface_of(_run(vtkXMLPolyDataReader(), path), path)


def read_vtu(path: Path) -> Polygons:
    """Read an unstructured grid in VTK's XML format; of volumes, the outer surface."""
    return _surface_of(_run(vtkXMLUnstructuredGridReader(), path), path)


def read_gltf(path: Path) -> Polygons:
    """Read all meshes of a glTF scene, placed as the scene places them."""
    parts = [_surface_of(part, path) for part in _leaves(_run(vtkGLTFReader(), path))]
    if not parts:
        raise CrossviewError("the file holds no mesh", str(path))
    first = np.cumsum([0] + [len(part.points) for part in parts])
    notes = [f"joined {len(parts)} meshes of the scene"] if len(parts) > 1 else []
    return Polygons(
        np.concatenate([part.points for part in parts]),
        np.concatenate([part.sizes for part in parts]),
        np.concatenate([part.corners + start for part, start in zip(parts, first, strict=False)]),
        tuple(notes),
    )


def read_msh(path: Path) -> Polygons:
    """Read the surface elements of a Gmsh file, format 2.2 or 4.1, text or binary."""
    with contextlib.redirect_stderr(io.StringIO()) as complaints:
        mesh = meshio.gmsh.read(path)
    if "not closed" in complaints.getvalue():
        raise CrossviewError("the MSH file is cut short", str(path), "write it anew")
    blocks = [c.data[:, : CORNERS[c.type]] for c in mesh.cells if c.type in CORNERS]
    curved = sum(len(c.data) for c in mesh.cells if c.type in CORNERS and c.type[-1].isdigit())
    volumes = sum(len(c.data) for c in mesh.cells if c.dim == 3)
    notes = [f"took {counted(curved, 'curved element')} as straight"] if curved else []
    notes += [f"left out {counted(volumes, 'volume element')}"] if volumes else []
    points = np.asarray(mesh.points, dtype=np.float64)
    return Polygons.of_blocks(points, [block.astype(np.int64) for block in blocks], notes)


def _run(reader: Any, path: Path) -> Any:
    """Return what a VTK reader reads; raises CrossviewError on its first complaint."""
    with pv.vtk_verbosity("off"), pv.VtkErrorCatcher(send_to_logging=False) as caught:
        reader.SetFileName(str(path))
        reader.Update()
        result = reader.GetOutputDataObject(0)
    if caught.events or result is None:
        reason = caught.events[0].alert.strip() if caught.events else "nothing was read"
        raise CrossviewError("cannot read this file", str(path), reason)
    return result


def _leaves(block: Any) -> Iterator[Any]:
    """Yield the datasets of a tree of blocks."""
    if not block.IsA("vtkMultiBlockDataSet"):
        yield block
        return
    for i in range(block.GetNumberOfBlocks()):
        if block.GetBlock(i) is not None:
            yield from _leaves(block.GetBlock(i))


def _surface_of(data: Any, path: Path) -> Polygons:
    """Take the polygons of any VTK dataset."""
    notes = []
    if not data.IsA("vtkDataSet"):
        raise CrossviewError("the file holds no mesh", str(path))
    for cells in ("GetCells", "GetPolys", "GetStrips"):
        if hasattr(data, cells):
            _require_points(getattr(data, cells)(), data.GetNumberOfPoints(), path)
    if not data.IsA("vtkPolyData"):
        if data.GetMaxSpatialDimension() == 3:
            notes.append(f"took the outer surface of {counted(data.GetNumberOfCells(), 'cell')}")
        surface = vtkDataSetSurfaceFilter()
        surface.SetNonlinearSubdivisionLevel(0)
        surface.SetInputData(data)
        surface.Update()
        data = surface.GetOutput()
    mesh = pv.wrap(data)
    other = mesh.GetNumberOfLines() + mesh.GetNumberOfVerts()
    if other:
        notes.append(f"left out {counted(other, 'line or point')}")
    mesh = mesh.triangulate() if mesh.n_strips else mesh
    faces = mesh.GetPolys()
    return Polygons(
        np.asarray(mesh.points, dtype=np.float64),
        np.diff(pv.convert_array(faces.GetOffsetsArray())).astype(np.int64),
        pv.convert_array(faces.GetConnectivityArray()).astype(np.int64),
        tuple(notes),
    )


def _require_points(cells: Any, n_points: int, path: Path) -> None:
    """Refuse cells with corners that do not exist: VTK's filters would read past the end."""
    corners = pv.convert_array(cells.GetConnectivityArray())
    if corners.size and not (corners.min() >= 0 and corners.max() < n_points):
        raise CrossviewError(
            f"cells name points outside 0..{n_points - 1}", str(path), "mend the file"
        )
