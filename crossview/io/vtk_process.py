"""The program that reads one file with VTK, in a process of its own: `vtk` starts it.

VTK's readers trust what a file says of itself, and end the process or take all memory when it is
wrong. Here that ends nothing but this program. It is run by its path and imports nothing of
crossview, so that it starts at once.

It takes the name of a reader, a file, and limits of memory (bytes) and processor time (seconds).
It writes a line of JSON, {"points": n, "polygons": m, "corners": k, "notes": [...]} or
{"refused": why}, then the points (n, 3) as float64, sizes (m,) and corners (k,) as int64.
"""

from __future__ import annotations

import contextlib
import json
import re
import sys
from typing import Any

import numpy as np
import numpy.typing as npt
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
from vtkmodules.vtkIOLegacy import vtkDataSetReader
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

READERS = {
    ".vtk": vtkDataSetReader,
    ".vtp": vtkXMLPolyDataReader,
    ".vtu": vtkXMLUnstructuredGridReader,
}
"""VTK's reader for each file name ending."""

SAID = re.compile(r"(ERROR|Warning): In .*?\):\s*(.*?)\s*(?=\n\s*\n|\Z)", re.DOTALL)
"""What VTK prints: the kind, where in its source, and the message."""


class Refused(Exception):
    """Why a file gives no surface."""


def limit(memory: int, seconds: int) -> None:
    """Bound this process, where the system can."""
    try:
        import resource
    except ImportError:  # on Windows only the time is limited, by the caller
        return
    for what, most in (
        (resource.RLIMIT_AS, memory),
        (resource.RLIMIT_CPU, seconds),
        (resource.RLIMIT_CORE, 0),
    ):
        hard = resource.getrlimit(what)[1]  # another limit, which may be lower, is kept
        least = most if hard == resource.RLIM_INFINITY else min(most, hard)
        with contextlib.suppress(ValueError):  # macOS has a limit of addresses and refuses it
            resource.setrlimit(what, (least, hard))


def surface(reader: Any, path: str) -> tuple[list[npt.NDArray[Any]], list[str]]:
    """Return points, sizes and corners of the polygons of a file, and notes."""
    window = vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(window)
    reader.SetFileName(path)
    reader.Update()
    data = reader.GetOutputDataObject(0)
    said = SAID.findall(window.GetOutput())
    errors = [text for kind, text in said if kind == "ERROR"]
    if errors or data is None:
        raise Refused(errors[0] if errors else "nothing was read")
    notes = [f"VTK warns: {text}" for _, text in said[:1]]
    if not data.IsA("vtkDataSet"):
        raise Refused("the file holds no mesh")
    for cells in ("GetCells", "GetPolys", "GetStrips"):
        if hasattr(data, cells):
            require_points(getattr(data, cells)(), data.GetNumberOfPoints())
    if not data.IsA("vtkPolyData"):
        number = data.GetNumberOfCells()
        if data.GetMaxSpatialDimension() == 3:
            notes.append(f"took the outer surface of {number} cell{'s' if number != 1 else ''}")
        outer = vtkDataSetSurfaceFilter()
        outer.SetNonlinearSubdivisionLevel(0)
        outer.SetInputData(data)
        outer.Update()
        data = outer.GetOutput()
    other = data.GetNumberOfLines() + data.GetNumberOfVerts()
    if other:
        notes.append(f"left out {other} line or point{'s' if other != 1 else ''}")
    sizes, corners = polygons(data.GetPolys())
    strips = unrolled(*polygons(data.GetStrips()))
    sizes = np.concatenate([sizes, np.full(len(strips) // 3, 3)])
    points = np.empty((0, 3))
    if data.GetPoints() is not None:
        points = vtk_to_numpy(data.GetPoints().GetData())
    return [points.astype(np.float64), sizes, np.concatenate([corners, strips])], notes


def polygons(cells: Any) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Return the sizes and the corners of cells one after another."""
    offsets = vtk_to_numpy(cells.GetOffsetsArray()).astype(np.int64)
    return np.diff(offsets), vtk_to_numpy(cells.GetConnectivityArray()).astype(np.int64)


def unrolled(sizes: npt.NDArray[np.int64], corners: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """Return the corners of the triangles of strips, every other one turned round."""
    count = np.maximum(sizes - 2, 0)
    in_strip = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
    first = np.repeat(np.cumsum(sizes) - sizes, count) + in_strip
    turned = in_strip % 2
    triangles = np.stack([first, first + 1 + turned, first + 2 - turned], axis=1)
    return np.asarray(corners[triangles.reshape(-1)])


def require_points(cells: Any, n_points: int) -> None:
    """Refuse cells whose corners or ends do not exist: filters would read past them."""
    if cells is None or not hasattr(cells, "GetConnectivityArray"):
        return  # of a structured grid: they follow from its dimensions
    sizes, corners = polygons(cells)
    if (sizes < 0).any() or sizes.sum() != len(corners):
        raise Refused("the lengths of cells do not fit the list of their corners")
    if corners.size and not (corners.min() >= 0 and corners.max() < n_points):
        raise Refused(f"cells name points outside 0..{n_points - 1}")


def main(ending: str, path: str, memory: str, seconds: str) -> None:
    """Read a file and write what is in it."""
    limit(int(memory), int(seconds))
    out = sys.stdout.buffer
    try:
        arrays, notes = surface(READERS[ending](), path)
    except (Refused, MemoryError, ValueError) as error:
        text = str(error) if isinstance(error, Refused) else "it is damaged"
        out.write(json.dumps({"refused": text}).encode() + b"\n")
        return
    counts = dict(zip(("points", "polygons", "corners"), map(len, arrays), strict=True))
    out.write(json.dumps({**counts, "notes": notes}).encode() + b"\n")
    for array in arrays:
        out.write(np.ascontiguousarray(array).data)


if __name__ == "__main__":
    main(*sys.argv[1:])
