"""Traces end at nodes only where two meet."""

import numpy as np

from solvers.layouts.meetings import EXACT, meeting_traces
from solvers.layouts.nodes import Node, node_at
from solvers.layouts.tracing import BORDER, NODE, Traces
from solvers.primitives import BUILTIN
from solvers.surface.trisurface import TriSurface
from tests.solvers.layouts.test_tracing import flat_chart


def with_vertex_at(place: list[float]) -> tuple[TriSurface, int]:
    """A unit square with its nearest inner vertex moved to a place."""
    surface = BUILTIN["square"](n=6)
    vertices = surface.vertices - surface.vertices.min(axis=0)
    inner = np.flatnonzero(~surface.boundary_vertices)
    moved = int(inner[np.linalg.norm(vertices[inner] - [*place, 0], axis=1).argmin()])
    vertices[moved, :2] = place
    return TriSurface(vertices, surface.faces), moved


def traces_of(surface: TriSurface, vertices: dict[int, int]) -> tuple[Traces, list[Node]]:
    chart = flat_chart(surface)
    nodes = [node_at(chart, vertex, quads) for vertex, quads in vertices.items()]
    return meeting_traces(chart, nodes, 10.0), nodes


def vertex_at(surface: TriSurface, place: list[float]) -> int:
    return int(np.linalg.norm(surface.vertices[:, :2] - place, axis=1).argmin())


def test_a_corner_that_no_trace_leaves_ends_none() -> None:
    """Along the lower side, half of what counts as rounding above it, two corners wait."""
    surface, moved = with_vertex_at([0.5, EXACT / 12])
    corners = {vertex_at(surface, [x, 0.0]): 1 for x in (0.0, 1.0)}
    traces, _ = traces_of(surface, {moved: 4, **corners})
    assert traces.ends.tolist() == [BORDER] * 4
    np.testing.assert_allclose(sorted(traces.lengths), [EXACT / 12, 0.5, 0.5, 1.0])


def test_two_on_one_line_meet_and_a_third_beyond_ends_at_neither() -> None:
    """The first and second meet; the third, as near to the line, has its neighbour alone."""
    surface = BUILTIN["square"](n=6)
    line = np.flatnonzero(np.isclose(surface.vertices[:, 1], surface.vertices[:, 1].mean()))
    inside = line[~surface.boundary_vertices[line]]
    inside = inside[np.argsort(surface.vertices[inside, 0])]
    one, two, three = inside[[0, 2, 4]]
    traces, _ = traces_of(surface, {int(v): 4 for v in (one, two, three)})
    met = traces.ends == NODE
    assert met.sum() == 4
    back = traces.leading_back[met]
    np.testing.assert_array_equal(traces.leading_back[back], np.flatnonzero(met))
    pairs = {
        (int(a), int(b)) for a, b in zip(traces.starts.node[met], traces.end_node[met], strict=True)
    }
    assert pairs == {(0, 1), (1, 0), (1, 2), (2, 1)}


def test_one_that_is_met_from_one_side_alone_is_passed() -> None:
    """Of finer edges than the other, the near node counts a closer line as met."""
    off = 0.5 * EXACT / 6
    surface, moved = with_vertex_at([0.5, 0.5 + off])
    far = vertex_at(surface, [1 / 6, 0.5])
    close = 1e-3 / 6
    vertices = surface.vertices.copy()
    ring = np.unique(surface.faces[(surface.faces == moved).any(axis=1)])
    away = ring[ring != moved]
    vertices[away] = vertices[moved] + close * (vertices[away] - vertices[moved])
    squeezed = TriSurface(vertices, surface.faces)
    traces, _ = traces_of(squeezed, {moved: 4, far: 4})
    assert traces.ends.tolist() == [BORDER] * 8
