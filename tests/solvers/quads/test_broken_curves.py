"""Quads along curves that turn where no angle asks for it."""

import numpy as np
import pytest

from solvers.features.edges import no_features
from solvers.fields.aligned import aligned_field
from solvers.fields.integrable import anisotropic_field
from solvers.fields.prepared import prepare
from solvers.layouts.layout import quad_layout
from solvers.primitives import BUILTIN
from solvers.progress import run
from solvers.quads.filling import fill
from solvers.quads.quantization import quantize_to
from solvers.singularities.budget import Singularity


@pytest.mark.parametrize("threes", [2, 3])
def test_edges_of_quads_run_along_the_whole_of_a_curve_that_is_broken(threes: int) -> None:
    """A circle with valences 3 on one side and as many valences 5 on the other."""
    surface = BUILTIN["cylinder"](n=48)
    at = np.abs(surface.vertices[:, 2]) < 1e-9
    circle = no_features(surface).united(np.flatnonzero(at[surface.edges].all(axis=1)))
    angle = 2 * np.pi * (0.1 + np.arange(threes)) / threes
    singularities = [
        Singularity(surface.closest_point([np.cos(a), np.sin(a), side * 0.5]), 4 - side)
        for a in angle
        for side in (1, -1)
    ]
    aligned = aligned_field(prepare(surface, singularities, features=circle))
    assert len(aligned.forced_corners) == threes
    layout = run(quad_layout(run(anisotropic_field(aligned))))
    quads = fill(layout, quantize_to(layout.tmesh, 3000).counts)
    edges = np.sort(quads.quads[:, [[0, 1], [1, 2], [2, 3], [3, 0]]].reshape(-1, 2), axis=1)
    ends = quads.vertices[np.unique(edges, axis=0)]
    along = ends[(np.abs(ends[:, :, 2]) < 1e-6).all(axis=1)]
    around = np.linalg.norm(along[:, 1] - along[:, 0], axis=1).sum()
    assert around == pytest.approx(2 * np.pi, rel=0.01)
