"""Size maps: wanted quad sizes, one or two for each vertex of the surface given."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np

from crossview.cases.json_values import CaseError
from crossview.cases.model import Sizes
from crossview.io.npy import read_npy
from crossview.io.regular_file import require_regular
from solvers.fields import size_map
from solvers.surface import FloatArray, Refinement, barycentric


def read_sizes(sizes: Sizes, n_vertices: int) -> FloatArray:
    """The sizes that a case names or lists.

    Parameters
    ----------
    sizes : str or tuple
        A .npy or .txt file, or a size or a pair of sizes for each vertex.
    n_vertices : int
        Of the surface given, before any refinement.

    Returns
    -------
    (n_vertices,) or (n_vertices, 2) float array

    Raises
    ------
    CaseError
        The file cannot be read, or does not hold positive finite sizes for these vertices.
    """
    name = sizes if isinstance(sizes, str) else "options.sizes"
    values = _read(sizes) if isinstance(sizes, str) else sizes
    return size_map(values, n_vertices, name, error=CaseError)


def _read(name: str) -> FloatArray:
    path = Path(name)
    try:
        if path.suffix.lower() == ".npy":
            values = read_npy(path)
        else:
            require_regular(path)
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # an empty file is told by its length
                values = np.loadtxt(path)
        return np.asarray(values, dtype=float)
    except OSError as error:
        raise CaseError(f"cannot read the size map, {error.strerror or error}", name) from error
    except ValueError as error:
        raise CaseError("the size map is not an array of numbers", name) from error


def refined_sizes(sizes: FloatArray, refinement: Refinement) -> FloatArray:
    """The sizes at a refined surface's vertices: their logarithms are linear in each triangle."""
    coarse, surface = refinement.coarse, refinement.surface
    face = np.empty(surface.n_vertices, dtype=np.int64)
    face[surface.faces] = refinement.parent_face[:, None]
    weights = barycentric(coarse.vertices[coarse.faces[face]], surface.vertices)
    corners = np.log(sizes)[coarse.faces[face]]
    return np.asarray(np.exp(np.einsum("nc,nc...->n...", weights, corners)))
