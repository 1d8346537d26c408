"""Quad layouts: known counts, and what holds of every one."""

import numpy as np
import pytest

from solvers.errors import CrossviewError
from solvers.fields.aligned import IntegratedField, aligned_field
from solvers.fields.isotropic import IsotropicSolver
from solvers.fields.prepared import prepare
from solvers.fields.verdict import Verdict
from solvers.layouts import drawing
from solvers.layouts.arrangement import arrange
from solvers.layouts.connections import beside, ending
from solvers.layouts.crossings import crossings
from solvers.layouts.errors import LayoutError
from solvers.layouts.gauge import joining_gauge
from solvers.layouts.joined_map import JoinedMap
from solvers.layouts.layout import QuadLayout, quad_layout
from solvers.layouts.motorcycles import stops
from solvers.layouts.nodes import singular_nodes, starts_at
from solvers.layouts.separatrices import T_JUNCTION
from solvers.layouts.tracing import NODE, Traces, trace
from solvers.maps.seamless import SeamlessFit, seamless_map
from solvers.primitives import BUILTIN
from solvers.progress import run
from solvers.singularities.budget import Singularity
from solvers.surface.trisurface import TriSurface
from tests.solvers.layouts.fields import FIELDS, at_places, cube_corners, integrated, layout_of
from tests.solvers.suite import random_configuration


@pytest.mark.parametrize(
    ("name", "patches", "arcs"),
    [
        ("cube sphere", 6, 12),
        ("cube with edges", 6, 12),
        ("disk with four", 5, 12),
        ("square", 1, 4),
        ("L", 3, 10),
        ("torus", 1, 2),
        ("annulus", 1, 3),
        ("cylinder", 1, 3),
    ],
)
def test_layouts_known_by_hand(name: str, patches: int, arcs: int) -> None:
    layout = layout_of(name)
    assert (layout.patches, layout.tmesh.n_arcs) == (patches, arcs)
    assert layout.conforming


@pytest.mark.parametrize("name", FIELDS)
def test_as_many_separatrices_leave_as_valences_and_corners_say(name: str) -> None:
    layout = layout_of(name)
    field = layout.integrated.field
    wanted = sum(s.valence for s in field.singularities)
    wanted += sum(1 - k for k in field.corners.values())  # one less than the quads that meet there
    assert layout.separatrices.leaving == wanted


@pytest.mark.parametrize("name", FIELDS)
def test_opposite_sides_are_equally_long(name: str) -> None:
    tmesh = layout_of(name).tmesh
    sides = tmesh.side_totals(tmesh.lengths)
    np.testing.assert_allclose(sides[:, :2], sides[:, 2:], rtol=0, atol=1e-11 * sides.max())


@pytest.mark.parametrize("name", FIELDS)
def test_rectangles_tile_the_map(name: str) -> None:
    layout = layout_of(name)
    used = np.bincount(layout.tmesh.side_halfarcs, minlength=2 * layout.tmesh.n_arcs)
    # each half-arc bounds one rectangle, but for those outside the boundary
    outside = 2 * np.flatnonzero(layout.tmesh.arc_on_boundary) + 1
    assert (np.delete(used, outside) == 1).all()
    assert (used[outside] == 0).all()
    assert layout.tmesh.area == pytest.approx(layout.arrangement.curves.chart.area, rel=1e-8)


@pytest.mark.parametrize("name", FIELDS)
def test_nodes_arcs_and_rectangles_have_the_surfaces_characteristic(name: str) -> None:
    layout = layout_of(name)
    tmesh = layout.tmesh
    characteristic = tmesh.n_nodes - tmesh.n_arcs + tmesh.n_rectangles
    assert characteristic == layout.surface.euler_characteristic


@pytest.mark.parametrize("name", FIELDS)
def test_patches_cover_the_surface(name: str) -> None:
    layout = layout_of(name)
    mesh = layout.patch_mesh
    corners = mesh.points[mesh.quads]
    diagonals = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    area = 0.5 * np.linalg.norm(np.cross(*diagonals), axis=1)
    assert area.sum() == pytest.approx(layout.surface.area, rel=0.02)
    assert set(mesh.patch) == set(range(layout.patches))


def test_what_winds_is_cut_where_it_first_meets_another_at_right_angles() -> None:
    layout = layout_of("winding sphere")
    assert not layout.conforming
    assert len(layout.t_junctions) == len(layout.arrangement.t_junctions)
    assert (layout.tmesh.node_valence[layout.arrangement.t_junctions] == 3).all()
    # 16 of 24 curves are cut, each into a rectangle's side: T-junctions bound the rectangles
    assert layout.patches >= len(layout.integrated.field.singularities) - 2


def test_a_boundary_that_nothing_reaches_gets_a_curve_of_its_own() -> None:
    curves = layout_of("annulus").separatrices
    assert curves.valences.tolist() == [-1]
    ends = curves.points[[0, -1]]
    np.testing.assert_allclose(np.sort(np.linalg.norm(ends, axis=1)), [0.4, 1.0], atol=1e-9)


def test_layouts_turn_with_the_surface() -> None:
    rng = np.random.default_rng(3)
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    surface = BUILTIN["sphere"](subdivisions=3)
    singularities = at_places(surface, cube_corners(), [3] * 8)
    turned = TriSurface(surface.vertices @ turn.T, surface.faces)
    one = run(quad_layout(integrated(surface, singularities)))
    other = run(quad_layout(integrated(turned, singularities)))
    np.testing.assert_array_equal(one.tmesh.arcs, other.tmesh.arcs)
    np.testing.assert_allclose(one.tmesh.lengths, other.tmesh.lengths, rtol=1e-6)


def test_the_same_field_gives_the_same_layout() -> None:
    field = FIELDS["winding sphere"]()
    one, other = run(quad_layout(field)), run(quad_layout(field))
    np.testing.assert_array_equal(one.tmesh.side_halfarcs, other.tmesh.side_halfarcs)
    np.testing.assert_array_equal(one.separatrices.points, other.separatrices.points)


def test_nearly_collinear_singularities_are_joined() -> None:
    surface = BUILTIN["disk"](edge_length=0.08)
    places = [[0.5, 0.003, 0], [0, 0.5, 0], [-0.5, 0, 0], [0.002, -0.5, 0]]
    layout = run(quad_layout(integrated(surface, at_places(surface, places, [3] * 4))))
    assert (layout.patches, layout.conforming) == (5, True)


def test_a_trace_that_ends_beside_a_node_is_led_onto_it() -> None:
    field = FIELDS["disk with four"]()
    map_ = JoinedMap(field, SeamlessFit(field))
    nodes = singular_nodes(map_.chart, map_.integrated.field)

    def traced() -> Traces:
        chart = map_.chart
        return trace(chart, nodes, starts_at(chart, nodes), 0.02, 4 * chart.diameter)

    loose = beside(traced())
    assert len(loose) == 4  # the sides of the square, each from one of its ends
    assert map_.join(ending(traced(), loose))
    assert len(beside(traced())) == 0


def test_a_field_that_is_not_integrable_has_no_layout() -> None:
    surface = BUILTIN["annulus"](n=48)
    aligned = aligned_field(prepare(surface, random_configuration(surface, 1), refine=0))
    with pytest.raises(LayoutError, match=r"not integrable.*anisotropic"):
        run(quad_layout(IntegratedField(aligned, aligned.start)))


def test_separatrices_of_a_disk_join_its_singularities_along_the_diagonals() -> None:
    curves: QuadLayout = layout_of("disk with four")
    separatrices = curves.separatrices
    ends = separatrices.points[np.stack([separatrices.offsets[:-1], separatrices.offsets[1:] - 1])]
    gaps = np.linalg.norm(ends[0] - ends[1], axis=1)
    joining = separatrices.ends == 0
    np.testing.assert_allclose(gaps[joining], np.sqrt(0.5), atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(ends[1][~joining], axis=1), 1.0, atol=5e-3)


@pytest.mark.parametrize("name", ["sphere", "cube_sphere"])
@pytest.mark.parametrize("angle", [0.0, 0.3, -0.7])
def test_crosses_that_nothing_fixes_turn_to_where_separatrices_join(
    name: str, angle: float
) -> None:
    surface = BUILTIN[name]()
    solver = IsotropicSolver(surface).in_gauge(angle)
    singularities = [
        Singularity(surface.point_at_vertex(_nearest(surface, p)), 3) for p in cube_corners()
    ]
    turned = solver.in_gauge(joining_gauge(solver.solve(singularities)))
    field = turned.solve(singularities)
    # on the great circle between two corners of the cube a branch runs along it
    one, other = cube_corners()[:2]
    middle = surface.closest_point((one + other) / 2).face
    u, v = field.u[middle], field.v[middle]
    along = (other - one) / np.linalg.norm(other - one)
    assert min(abs(u @ along), abs(v @ along)) < np.sin(np.radians(0.1))


def test_a_boundary_holds_the_crosses() -> None:
    solver = IsotropicSolver(BUILTIN["disk"](edge_length=0.2))
    with pytest.raises(CrossviewError, match="boundary"):
        solver.in_gauge(0.1)


def _nearest(surface: TriSurface, place: np.ndarray) -> int:
    return int(np.argmin(np.linalg.norm(surface.vertices - place, axis=1)))


@pytest.mark.parametrize("longest", [np.inf, 1.0, 0.1, 1e-9])
def test_however_early_curves_are_cut_rectangles_are_left(longest: float) -> None:
    made = layout_of("ring of eight")
    chart, field = made.arrangement.curves.chart, made.integrated.field
    nodes = singular_nodes(chart, field)
    starts = starts_at(chart, nodes)
    traces = trace(chart, nodes, starts, 1e-6 * chart.edge_length, 10.0)
    crossed = crossings(chart, traces.chords)
    stopped = stops(traces, crossed, longest)
    # what joins two nodes is kept whole: the curve back along it has been left out
    joining = (traces.ends == NODE) & stopped.kept
    assert joining.any()
    assert not stopped.cut[joining].any()
    critical = np.ones(len(nodes), dtype=bool)
    tmesh = arrange(made.surface, nodes, critical, traces, crossed, stopped).tmesh
    assert tmesh.n_nodes - tmesh.n_arcs + tmesh.n_rectangles == 0
    assert tmesh.area == pytest.approx(chart.area, rel=1e-8)


def test_traces_are_followed_until_each_meets_another(monkeypatch: pytest.MonkeyPatch) -> None:
    """However short they are at first, none is left with a loose end."""
    made = layout_of("winding sphere")
    monkeypatch.setattr(drawing, "AT_FIRST", 1.0)
    again = run(quad_layout(made.integrated))
    assert set(again.separatrices.ends.tolist()) == {T_JUNCTION}
    assert len(again.t_junctions) == 24
    tmesh = again.tmesh
    assert tmesh.n_nodes - tmesh.n_arcs + tmesh.n_rectangles == 2
    assert tmesh.area == pytest.approx(again.arrangement.curves.chart.area, rel=1e-8)


def test_triangles_turned_over_are_named_with_the_singularities_near_them() -> None:
    surface = BUILTIN["torus"](n=32)
    places = surface.vertices[[0, surface.n_vertices // 2]]
    field = integrated(surface, at_places(surface, places, [3, 5]))
    with pytest.raises(LayoutError, match=r"inverted \(near singularity") as refused:
        run(quad_layout(field, Verdict("not found", "Taken for possible.")))
    np.testing.assert_array_equal(refused.value.faces, seamless_map(field).inverted)
