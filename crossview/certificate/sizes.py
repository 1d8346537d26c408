"""Whether faces are as large as they should be."""

from __future__ import annotations

import numpy as np

from crossview.certificate.faces import Faces, Floats
from crossview.certificate.fault import Measures
from crossview.certificate.reference import Sizes
from crossview.certificate.samples import Ground, doubled, fans

EVEN = 1e-3
"""Spread of H below which no slope is told. Chosen."""


def compared_sizes(mesh: Faces, wanted: Sizes) -> Measures:
    """The line of least squares through the logarithms of faces' sizes over H.

    The size of a face is the root of its area, H that at the mean of its corners. "slope" is 1
    where sizes follow e^H (None where H hardly varies), "scatter" the root mean square of what is
    left beside the line of slope 1.
    """
    triangles, owner = fans(mesh)
    areas = np.bincount(owner, np.linalg.norm(doubled(triangles), axis=1) / 2)
    have = np.log(np.maximum(areas, 1e-300)) / 2
    H = _interpolated(mesh.middles, wanted)
    off = have - H
    spread = float(H.std())
    slope = float(np.cov(have, H, bias=True)[0, 1] / spread**2) if spread > EVEN else None
    return {"slope": slope, "scatter": float(off.std()), "spread": spread}


def _interpolated(places: Floats, wanted: Sizes) -> Floats:
    """H at places (k, 3)."""
    under = Ground(wanted.triangles).under(places)
    a, b, c = np.moveaxis(wanted.triangles[under], 1, 0)
    normal = np.cross(b - a, c - a)
    parts = [np.cross(c - b, places - b), np.cross(a - c, places - c), np.cross(b - a, places - a)]
    shares = np.stack([np.einsum("ij,ij->i", part, normal) for part in parts], axis=1).clip(0)
    shares /= np.maximum(shares.sum(axis=1, keepdims=True), 1e-300)
    return np.asarray((shares * wanted.logarithms[under]).sum(axis=1))
