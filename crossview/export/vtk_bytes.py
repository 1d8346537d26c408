"""Files of VTK's formats, made in memory: its writers end the process where a disk is full."""

from __future__ import annotations

from pathlib import Path

import pyvista as pv
from vtkmodules.vtkIOLegacy import vtkUnstructuredGridWriter
from vtkmodules.vtkIOXML import (
    vtkXMLPolyDataWriter,
    vtkXMLUnstructuredGridWriter,
)

OLDER = 42
"""Version of VTK's legacy format that its readers outside of VTK know best."""


def save_vtk(data: pv.PolyData | pv.UnstructuredGrid, path: Path) -> None:
    """Write a file in VTK's formats.

    Parameters
    ----------
    data : PolyData or UnstructuredGrid
        .vtp is for the first; .vtu, or .vtk in the legacy format, for the other.
    path : Path

    Raises
    ------
    OSError
        It cannot be written.
    MemoryError
        It cannot be made.
    """
    if path.suffix.lower() == ".vtk":
        writer = vtkUnstructuredGridWriter()
        writer.SetFileVersion(OLDER)
        writer.SetFileTypeToBinary()
    else:
        polygonal = isinstance(data, pv.PolyData)
        writer = vtkXMLPolyDataWriter() if polygonal else vtkXMLUnstructuredGridWriter()
        writer.SetDataModeToBinary()
    writer.SetInputData(data)
    writer.WriteToOutputStringOn()
    if not writer.Write():
        raise MemoryError
    legacy = isinstance(writer, vtkUnstructuredGridWriter)
    made = writer.GetOutputStdString() if legacy else writer.GetOutputString()
    path.write_bytes(made if isinstance(made, bytes) else made.encode())
