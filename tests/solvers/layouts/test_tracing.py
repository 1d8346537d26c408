"""Traces and walks against straight lines that are known."""

import numpy as np
import pytest

from solvers.fields.isotropic import IsotropicSolver
from solvers.layouts.charts import Chart
from solvers.layouts.crossings import crossings, ends_of
from solvers.layouts.nodes import node_at, singular_nodes, starts_at
from solvers.layouts.separatrices import field_separatrices
from solvers.layouts.straight import barycentric_in, walk
from solvers.layouts.tracing import BORDER, NODE, trace
from solvers.primitives import BUILTIN
from solvers.singularities.budget import Singularity
from solvers.surface.points import SurfacePoint
from solvers.surface.trisurface import TriSurface
from solvers.surface.working import WorkingTriangulation
from tests.solvers.layouts.fields import FIELDS, at_places, layout_of


def flat_chart(surface: TriSurface) -> Chart:
    """A planar surface is its own map."""
    t = surface.triangulation
    corners = surface.vertices[surface.faces] @ np.array([1, 1j, 0])
    working = WorkingTriangulation.of(t)
    return Chart(working, corners[:, [1, 2, 0]] - corners, np.zeros(3 * t.n_faces, dtype=np.int64))


def test_traces_of_a_plane_are_its_axes() -> None:
    surface = BUILTIN["rectangle"](width=2.0, height=1.0, columns=34, rows=16)
    chart = flat_chart(surface)
    inner = np.flatnonzero(~surface.boundary_vertices)
    middle = int(inner[np.argmin(np.linalg.norm(surface.vertices[inner] - [0.7, 0.3, 0], axis=1))])
    node = node_at(chart, middle, 4)
    traces = trace(chart, [node], starts_at(chart, [node]), 1e-9, 10.0)
    assert (traces.ends == BORDER).all()
    x, y, _ = surface.vertices[middle]
    low, high = surface.vertices.min(axis=0), surface.vertices.max(axis=0)
    wanted = [high[0] - x, high[1] - y, x - low[0], y - low[1]]
    np.testing.assert_allclose(np.sort(traces.lengths), np.sort(wanted), atol=1e-12)


def test_as_many_crossings_as_rows_and_columns_make() -> None:
    surface = BUILTIN["square"](n=12)
    chart = flat_chart(surface)
    x, y, _ = surface.vertices.T
    low = np.isclose(y, y.min()) & ~np.isclose(x, x.min()) & ~np.isclose(x, x.max())
    left = np.isclose(x, x.min()) & ~np.isclose(y, y.min()) & ~np.isclose(y, y.max())
    nodes = [node_at(chart, int(v), 2) for v in np.flatnonzero(low | left)]
    traces = trace(chart, nodes, starts_at(chart, nodes), 0.0, 10.0)
    found = crossings(chart, traces.chords)
    # every trace runs through vertices all along, and every crossing is at one
    assert len(found) == low.sum() * left.sum()
    assert len(np.unique(np.sort(found.trace, axis=1), axis=0)) == len(found)


def test_chords_follow_each_other() -> None:
    traces_of = layout_of("winding sphere").arrangement.curves
    chords = traces_of.chords
    start, end = ends_of(traces_of.chart, chords)
    np.testing.assert_allclose(np.abs(end - start), chords.end - chords.start, atol=1e-9)
    for i in range(len(traces_of.offsets) - 1):
        own = chords[np.arange(traces_of.offsets[i], traces_of.offsets[i + 1])]
        np.testing.assert_allclose(own.start[1:], own.end[:-1], atol=1e-12)


def test_separatrices_lead_back_along_themselves() -> None:
    layout = layout_of("cube sphere")
    chart = layout.arrangement.curves.chart
    nodes = singular_nodes(chart, layout.integrated.field)
    starts = starts_at(chart, nodes)
    traces = trace(chart, nodes, starts, 1e-6 * chart.edge_length, 10.0)
    assert (traces.ends == NODE).all()
    number = {key: i for i, key in enumerate(zip(starts.node, starts.slot, strict=True))}
    for i, key in enumerate(zip(traces.end_node, traces.end_slot, strict=True)):
        back = number[key]
        assert (traces.end_node[back], traces.end_slot[back]) == (starts.node[i], starts.slot[i])


@pytest.mark.parametrize("name", ["cube sphere", "disk with four", "ring of eight", "L"])
def test_a_field_sends_out_one_separatrix_for_each_quad(name: str) -> None:
    field = FIELDS[name]().field
    chart = Chart.of_field(field)
    nodes = singular_nodes(chart, field)
    starts = starts_at(chart, nodes)
    for number, node in enumerate(nodes):
        assert (starts.node == number).sum() == (node.quads if node.inner else node.quads - 1)
    curves = field_separatrices(field)
    assert (np.diff(curves.offsets) >= 2).all()
    gap = np.linalg.norm(np.diff(curves.points, axis=0), axis=1)
    inside = np.ones(len(gap), dtype=bool)
    inside[curves.offsets[1:-1] - 1] = False
    assert gap[inside].max() <= field.surface.triangulation.lengths.max()


def test_separatrices_along_a_field_end_near_those_of_its_map() -> None:
    layout = layout_of("disk with four")
    rough = field_separatrices(layout.integrated.field)
    exact = layout.separatrices
    assert rough.leaving == exact.leaving
    one = rough.points[rough.offsets[1:] - 1]
    other = exact.points[np.concatenate([exact.offsets[1:] - 1, exact.offsets[:-1]])]
    gaps = np.linalg.norm(one[:, None] - other[None], axis=2).min(axis=1)
    assert gaps.max() < 0.05


def test_walks_in_a_plane_are_straight() -> None:
    surface = BUILTIN["square"](n=10)
    chart = flat_chart(surface)
    rng = np.random.default_rng(0)
    face = rng.integers(surface.n_faces, size=40)
    low, high = surface.vertices.min(axis=0), surface.vertices.max(axis=0)
    goal = low + rng.random((40, 3)) * (high - low)
    start = surface.barycentres[face]
    origin = surface.vertices[surface.faces[face, 0]]
    to_plane = np.array([1, 1j, 0])
    found, place = walk(chart, face, (start - origin) @ to_plane, (goal - start) @ to_plane)
    weights = barycentric_in(chart, found, place)
    reached = np.einsum("kc,kcd->kd", weights, surface.vertices[surface.faces[found]])
    np.testing.assert_allclose(reached, goal, atol=1e-12)


def test_walks_do_not_leave_over_the_boundary() -> None:
    surface = BUILTIN["square"](n=6)
    chart = flat_chart(surface)
    face = np.arange(surface.n_faces)
    origin = surface.vertices[surface.faces[:, 0]]
    start = (surface.barycentres - origin) @ np.array([1, 1j, 0])
    found, place = walk(chart, face, start, np.full(len(face), 5.0 + 0j))
    weights = barycentric_in(chart, found, place)
    reached = np.einsum("kc,kcd->kd", weights, surface.vertices[surface.faces[found]])
    np.testing.assert_allclose(reached[:, 0], surface.vertices[:, 0].max(), atol=1e-12)
    np.testing.assert_allclose(reached[:, 1], surface.barycentres[:, 1], atol=1e-12)


def test_curves_of_a_dragged_singularity_start_where_it_is() -> None:
    surface = BUILTIN["disk"](edge_length=0.1)
    solver = IsotropicSolver(surface)
    face = surface.closest_point([0.3, 0.1, 0.0]).face
    dragged = Singularity(SurfacePoint(face, (0.5, 0.3, 0.2)), 3)
    others = at_places(surface, [[-0.5, 0.2, 0], [0.1, -0.5, 0], [-0.1, 0.6, 0]], [3] * 3)
    field = solver.solve([dragged, *at_vertices_near(surface, others)])
    curves = field_separatrices(field)
    starts = curves.points[curves.offsets[:-1]]
    ends = curves.points[curves.offsets[1:] - 1][curves.ends == 0]
    gaps = np.linalg.norm(np.concatenate([starts, ends]) - surface.position(dragged.point), axis=1)
    assert (gaps < 1e-12).sum() == 3


def at_vertices_near(surface: TriSurface, given: list[Singularity]) -> list[Singularity]:
    places = surface.positions([s.point for s in given])
    gaps = np.linalg.norm(surface.vertices[:, None] - places[None], axis=2)
    return [
        Singularity(surface.point_at_vertex(int(v)), s.valence)
        for v, s in zip(gaps.argmin(axis=0), given, strict=True)
    ]
