"""Smoothing: back to closed forms, on the surface and its boundary, nothing made worse."""

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from solvers.primitives import BUILTIN
from solvers.quads.corners import worth
from solvers.quads.quadmesh import QuadMesh
from solvers.quads.rails import Rail, boundary_rails
from solvers.quads.sliding import Sliding
from solvers.quads.smoothing import rectangles, smooth, smoothing_stages
from solvers.surface.trisurface import TriSurface
from tests.solvers.quads.quad_grids import (
    GRIDS,
    annulus,
    lattice,
    on_surface,
    sphere,
    square,
    torus,
)


@pytest.mark.parametrize("name", GRIDS)
@pytest.mark.parametrize("noise", [0.0, 0.1, 0.3, 0.5])
def test_no_quad_becomes_worse_than_the_worst(name: str, noise: float) -> None:
    mesh = GRIDS[name](noise=noise)
    smoothed = smooth(mesh)
    smoothed.check()
    before, after = mesh.scaled_jacobian, smoothed.scaled_jacobian
    assert after.min() >= before.min()
    assert (after >= np.minimum(before, 0.5) - 1e-12).all() or before.min() <= 0
    assert after.mean() >= before.mean() - 1e-4
    if noise:
        assert after.min() > max(before.min(), 0)
        assert after.mean() > max(before.mean(), 0.95)


@pytest.mark.parametrize("name", GRIDS)
@pytest.mark.parametrize("noise", [1.0, 2.5])
def test_of_many_folded_quads_most_unfold_and_the_worst_is_no_worse(
    name: str, noise: float
) -> None:
    before = GRIDS[name](noise=noise)
    after = smooth(before).scaled_jacobian
    assert after.min() >= before.scaled_jacobian.min()
    assert (after <= 0).sum() < 0.5 * (before.scaled_jacobian <= 0).sum()


@pytest.mark.parametrize("name", GRIDS)
def test_vertices_stay_on_the_surface_its_boundary_and_where_they_are_fixed(name: str) -> None:
    mesh = GRIDS[name](noise=0.3)
    smoothed = smooth(mesh)
    assert smoothed.max_distance_to_surface < 1e-14
    corners = mesh.surface.vertices[mesh.surface.faces[smoothed.faces]]
    assert np.einsum("ki,kij->kj", smoothed.barycentric, corners) == pytest.approx(
        smoothed.vertices, abs=1e-14
    )
    assert (smoothed.vertices[mesh.fixed] == mesh.vertices[mesh.fixed]).all()
    for number, rail in enumerate(boundary_rails(mesh.surface)):
        on = smoothed.vertices[mesh.boundary_loop == number]
        assert rail.positions(rail.nearest(on)) == pytest.approx(on, abs=1e-14)


def test_an_annulus_returns_to_circles_and_rays() -> None:
    """Nearly; some of what the sizes were is kept."""
    around = 60
    rows = round(np.log(2.5) * around / (2 * np.pi))
    exact, shaken = annulus(around, rows), smooth(annulus(around, rows, noise=0.2))
    turn = np.arctan2(shaken.vertices[:, 1], shaken.vertices[:, 0])
    per_ray = turn.reshape(rows + 1, around)
    spread = np.abs(np.exp(1j * per_ray) - np.exp(1j * per_ray[:1])).max()
    assert spread < 0.3 * 2 * np.pi / around
    radius = np.linalg.norm(shaken.vertices, axis=1).reshape(rows + 1, around)
    wanted = np.linalg.norm(exact.vertices, axis=1).reshape(rows + 1, around)
    assert np.abs(radius / wanted - 1).max() < 0.03


@pytest.mark.parametrize(("build", "least"), [(annulus, 0.95), (torus, 0.95), (sphere, 0.7)])
def test_five_thousand_quads_come_out_nearly_rectangular(
    build: Callable[..., QuadMesh], least: float
) -> None:
    sizes = {annulus: (180, 28), torus: (120, 42), sphere: (29,)}
    smoothed = smooth(build(*sizes[build], noise=0.3))
    assert 4900 < smoothed.n_quads < 5100
    assert smoothed.scaled_jacobian.min() > least
    assert smoothed.scaled_jacobian.mean() > 0.98


def test_sizes_and_aspects_stay() -> None:
    """Columns of a square three times as wide on one side as on the other keep their widths."""
    mesh = square(12)
    x = mesh.vertices[:, 0] + 0.5
    stretched = np.stack([x**1.5 - 0.5, *mesh.vertices[:, 1:].T], axis=1)
    mesh = on_surface(mesh.surface, stretched, mesh.quads, np.flatnonzero(mesh.fixed).tolist())
    rows = smooth(mesh).vertices[:, 0].reshape(13, 13)
    assert rows == pytest.approx(np.broadcast_to(np.linspace(0, 1, 13) ** 1.5 - 0.5, (13, 13)))


def test_folded_quads_are_unfolded() -> None:
    mesh = square(10)
    inner = np.flatnonzero(~mesh.on_boundary)
    places = mesh.vertices.copy()
    places[inner[30:34]] = places[inner[[40, 18, 50, 12]]]
    folded = on_surface(mesh.surface, places, mesh.quads, np.flatnonzero(mesh.fixed).tolist())
    assert folded.scaled_jacobian.min() < -0.5
    assert smooth(folded).scaled_jacobian.min() > 0.9


@pytest.mark.parametrize("name", GRIDS)
def test_each_stage_is_better_than_the_one_before_and_the_last_is_returned(name: str) -> None:
    mesh = GRIDS[name](noise=2.5)
    stages = list(smoothing_stages(mesh))
    assert len(stages) > 1
    worths = [worth(stage.scaled_jacobian) for stage in [mesh, *stages]]
    assert worths == sorted(worths)
    assert np.array_equal(stages[-1].vertices, smooth(mesh).vertices)


def test_rectangles_are_kept_and_rhombi_become_squares() -> None:
    rng = np.random.default_rng(4)
    turns = np.linalg.qr(rng.normal(size=(20, 3, 3)))[0]
    turns *= np.linalg.det(turns)[:, None, None]
    sides = rng.uniform(0.1, 9, size=(20, 2, 1))
    unit = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])
    flat = np.stack([unit * side[:, 0] for side in sides])
    quads = np.concatenate([flat, np.zeros((20, 4, 1))], axis=2) @ turns.transpose(0, 2, 1)
    outward = turns[:, :, 2]
    sides = sides[:, :, 0].T
    assert rectangles(quads, outward, sides) == pytest.approx(quads)
    # a mirror image asks to be turned over, in its plane
    back = rectangles(quads[:, ::-1], outward, sides)
    normal = np.cross(back[:, 1] - back[:, 0], back[:, 3] - back[:, 0])
    assert ((normal * outward).sum(axis=1) > 0).all()
    slanted = np.array([[[0.0, 0, 0], [2, 0, 0], [3, 3**0.5, 0], [1, 3**0.5, 0]]])
    made = rectangles(slanted, np.array([[0.0, 0, 1]]), np.full((2, 1), 2.0))
    assert np.linalg.norm(made - np.roll(made, 1, axis=1), axis=2) == pytest.approx(
        np.full((1, 4), 2.0)
    )


def hexagonal_annulus(shift: float) -> QuadMesh:
    """Rings around a hexagonal hole, whose corners lie between vertices of the mesh."""
    turn = np.linspace(0, 2 * np.pi, 7)[:-1]
    hexagon = 0.4 * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    surface = BUILTIN["planar"](
        outer=2.5 * hexagon, holes=[hexagon[::-1].tolist()], edge_length=0.08
    )
    s = (np.arange(60) + shift) / 10
    corner = np.floor(s).astype(int) % 6
    part = (s % 1)[:, None]
    ring = (1 - part) * hexagon[corner] + part * hexagon[(corner + 1) % 6]
    places = np.concatenate([t * ring for t in np.linspace(1, 2.5, 13)])
    quads = lattice(60, 12, around=True)[:, ::-1]
    return on_surface(surface, np.column_stack([places, 0 * places[:, 0]]), quads, [])


@pytest.mark.parametrize("shift", [0.0, 0.3, 0.45])
def test_sharp_corners_of_the_boundary_get_a_vertex(shift: float) -> None:
    mesh = hexagonal_annulus(shift)
    smoothed = smooth(mesh)
    corners = np.concatenate(
        [rail.positions(rail.corners) for rail in boundary_rails(mesh.surface)]
    )
    assert len(corners) == 12
    gaps = np.linalg.norm(corners[:, None] - smoothed.vertices[mesh.on_boundary], axis=2)
    assert gaps.min(axis=1) == pytest.approx(0, abs=1e-13)
    # at a corner of 120 degrees with two quads no better is possible
    assert np.sin(np.pi / 3) > smoothed.scaled_jacobian.min() > 0.7


def test_edges_on_a_curve_stay_on_it() -> None:
    """A straight line through the square, another across it, which the mesh does not follow."""
    mesh = square(16, noise=0.3)
    surface = mesh.surface
    upright, level = (
        on[np.argsort(surface.vertices[on, 1 - axis])]
        for axis in (0, 1)
        for on in [np.flatnonzero(np.abs(surface.vertices[:, axis]) < 1e-9)]
    )
    middle = np.arange(17) * 17 + 8
    places = mesh.vertices.copy()
    places[middle, 0] = 0
    mesh = on_surface(surface, places, mesh.quads, np.flatnonzero(mesh.fixed).tolist())
    free, held = smooth(mesh), smooth(mesh, curves=[upright, level])
    assert np.abs(free.vertices[middle, 0]).max() > 1e-3
    assert np.abs(held.vertices[middle, 0]).max() < 1e-14
    assert np.ptp(held.vertices[middle, 1] - mesh.vertices[middle, 1]) > 1e-3
    assert (held.vertices[middle[[0, -1]]] == mesh.vertices[middle[[0, -1]]]).all()
    assert held.scaled_jacobian.min() > 0.9


def test_no_edge_is_drawn_over_a_crease() -> None:
    """A square bent along its middle: vertices on the crease stay there, sharp."""
    flat = square(12, noise=0.3)
    x, y, _ = flat.surface.vertices.T
    surface = TriSurface(np.stack([x, y, -np.abs(x)], axis=1), flat.surface.faces)
    middle = np.arange(13) * 13 + 6
    places = flat.vertices.copy()
    places[middle, 0] = 0
    places[:, 2] = -np.abs(places[:, 0])
    mesh = on_surface(surface, places, flat.quads, np.flatnonzero(flat.fixed).tolist())
    on = np.flatnonzero(np.abs(x) < 1e-9)
    smoothed = smooth(mesh, curves=[on[np.argsort(y[on])]])
    assert np.abs(smoothed.vertices[middle, 0]).max() < 1e-14
    assert smoothed.scaled_jacobian.min() > max(0.9, mesh.scaled_jacobian.min())


def test_a_rail_knows_its_places() -> None:
    surface = BUILTIN["square"](n=8)
    (rail,) = boundary_rails(surface)
    assert rail.closed
    assert rail.length == pytest.approx(4)
    assert len(rail.corners) == 4
    s = np.linspace(-1, 5.9, 57)
    faces, weights = rail.points(s)
    places = np.einsum("ki,kij->kj", weights, surface.vertices[surface.faces[faces]])
    assert places == pytest.approx(rail.positions(s), abs=1e-14)
    assert rail.apart(rail.nearest(places), 0.0) == pytest.approx(rail.apart(s, 0.0), abs=1e-12)
    loop = surface.boundary_loops[0]
    back = Rail(surface, loop[:6][::-1])
    assert not back.closed
    assert back.positions(np.array([0.0, 9.0])) == pytest.approx(surface.vertices[loop[[5, 0]]])
    faces, weights = back.points(np.array([0.1]))
    there = weights[0] @ surface.vertices[surface.faces[faces[0]]]
    assert there == pytest.approx(back.positions(np.array([0.1]))[0])


def test_the_same_mesh_gives_the_same_places() -> None:
    mesh = sphere(noise=0.5)
    assert (smooth(mesh).vertices == smooth(replace(mesh)).vertices).all()


def test_a_corner_of_several_curves_takes_one_vertex_alone() -> None:
    mesh = square(10)
    surface, places = mesh.surface, mesh.vertices

    def run(*ends: tuple[float, float]) -> np.ndarray:
        """The vertices of the surface along straight rows from end to end."""
        rows = np.concatenate([np.linspace(a, b, 200) for a, b in pairwise(ends)])
        near = [surface.nearest_vertex(surface.closest_point([x, y, 0])) for x, y in rows]
        return np.array([v for v, before in zip(near, [-1, *near], strict=False) if v != before])

    rails = boundary_rails(surface)
    rails += [Rail(surface, run((-0.5, 0), (0, 0), (0, 0.5)))]
    rails += [Rail(surface, run((0.5, 0), (0, 0), (0, -0.5)))]
    gaps = [np.linalg.norm(r.positions(r.nearest(places)) - places, axis=1) for r in rails]
    on = np.array(gaps) < 1e-9
    rail = np.where(on.any(axis=0), on.argmax(axis=0), -1)
    held = replace(mesh, fixed=mesh.fixed | (on.sum(axis=0) > 1))
    sliding = Sliding(held, rails, rail)
    snapped, _ = sliding.snapped(sliding.start())
    ends = snapped.vertices[mesh.edges]
    assert np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).min() == pytest.approx(0.1)
