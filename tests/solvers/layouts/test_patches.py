"""The patches of a layout as fine grids on the surface."""

from collections.abc import Callable, Sequence

import numpy as np
import pytest

from solvers.fields.aligned import IntegratedField
from solvers.fields.prepared import prepare
from solvers.layouts.gauge import joined_field
from solvers.layouts.layout import QuadLayout, quad_layout
from solvers.primitives import cube_sphere, square
from solvers.progress import run
from solvers.singularities.budget import Singularity
from solvers.surface.trisurface import TriSurface


def layout_of(surface: TriSurface, singularities: Sequence[Singularity] = ()) -> QuadLayout:
    aligned = joined_field(prepare(surface, singularities, refine=0))
    return run(quad_layout(IntegratedField(aligned, aligned.start)))


def on_cube() -> QuadLayout:
    ball = cube_sphere(n=12)
    places = np.stack(np.meshgrid(*[[-1.0, 1.0]] * 3), axis=-1).reshape(-1, 3) / np.sqrt(3.0)
    corners = [int(np.linalg.norm(ball.vertices - place, axis=1).argmin()) for place in places]
    return layout_of(ball, [Singularity(ball.point_at_vertex(v), 3) for v in corners])


@pytest.mark.parametrize("make", [lambda: layout_of(square(8)), on_cube], ids=["square", "sphere"])
def test_the_grids_cover_the_surface_evenly(make: Callable[[], QuadLayout]) -> None:
    layout = make()
    sampled, surface = layout.patch_mesh, layout.surface
    corners = sampled.points[sampled.quads]
    sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    # none leaps over its patch, also not along the boundary
    assert sides.max() < 0.12 * surface.diagonal / 2
    across = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]) / 2
    assert np.linalg.norm(across, axis=1).sum() == pytest.approx(surface.area, rel=5e-3)
    near = surface.positions([surface.closest_point(p) for p in sampled.points[::97]])
    assert np.abs(near - sampled.points[::97]).max() < 1e-9
