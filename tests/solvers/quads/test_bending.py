"""Bends: as many edges as circles ask for, none for what is straight, features kept apart."""

import numpy as np
import pytest

from solvers.errors import CrossviewError
from solvers.features.edges import Features
from solvers.layouts.layout import QuadLayout, quad_layout
from solvers.primitives import BUILTIN
from solvers.progress import run
from solvers.quads.bending import bending_conditions, bent_spacing
from solvers.quads.filling import fill
from solvers.quads.quadmesh import QuadMesh
from solvers.quads.quantization import quantize_to
from solvers.quads.sizing import MAX_SIZE_RATIO, size_conditions
from solvers.quads.smoothing import smooth
from tests.solvers.layouts.fields import at_places, integrated, layout_of


def boundary_turns(layout: QuadLayout, n_quads: int, max_chord: float) -> np.ndarray:
    """By how much each boundary edge of the unit disk turns, radians."""
    conditions = bending_conditions(layout, max_chord)
    mesh = fill(layout, quantize_to(layout.tmesh, n_quads, conditions=conditions).counts)
    edges = mesh.edges[mesh.on_boundary[mesh.edges].all(axis=1)]
    lengths = np.linalg.norm(np.diff(mesh.vertices[edges], axis=1)[:, 0], axis=1)
    return np.asarray(2 * np.arcsin(np.minimum(lengths / 2, 1)))


@pytest.mark.parametrize("max_chord", [0.3, 0.05, 0.01, 0.002])
def test_a_circle_gets_the_edges_of_a_regular_polygon_that_is_off_by_as_much(
    max_chord: float,
) -> None:
    """The chord of an angle a on a circle is off by 1 - cos(a / 2) radii."""
    layout = layout_of("disk with four")
    conditions = bending_conditions(layout, max_chord)
    polygon = np.pi / np.arccos(1 - max_chord)
    loop = np.flatnonzero(layout.tmesh.arc_on_boundary)
    counts = quantize_to(layout.tmesh, 1, conditions=conditions).counts
    assert polygon - 1e-6 <= counts[loop].sum() <= polygon + 2 * len(loop)
    for condition in conditions:
        assert counts[condition.arcs].sum() >= condition.least
    turns = boundary_turns(layout, 1, max_chord)
    assert turns.max() < 1.1 * 2 * np.arccos(1 - max_chord)


def test_bends_ask_for_nothing_where_edges_are_short_enough() -> None:
    layout = layout_of("disk with four")
    free = quantize_to(layout.tmesh, 3000)
    bent = quantize_to(layout.tmesh, 3000, conditions=bending_conditions(layout))
    np.testing.assert_array_equal(free.counts, bent.counts)


def test_all_of_a_loop_counts_where_its_arcs_are_short() -> None:
    """On annuli in few pieces, and in many: never fewer edges than a circle asks for."""
    layout = layout_of("ring of eight")
    tmesh, arrangement = layout.tmesh, layout.arrangement
    counts = quantize_to(tmesh, 1, conditions=bending_conditions(layout)).counts
    least = np.pi / np.arccos(1 - 0.01)
    for curve in np.unique(arrangement.arc_curve[tmesh.arc_on_boundary]):
        assert counts[arrangement.arc_curve == curve].sum() >= least - 1


def test_straight_sides_and_features_ask_for_nothing() -> None:
    assert bending_conditions(layout_of("square")) == []


def test_surfaces_without_boundary_and_features_ask_for_nothing() -> None:
    assert bending_conditions(layout_of("cube sphere")) == []


def test_any_chord_is_allowed_up_to_a_half_circle() -> None:
    layout = layout_of("disk with four")
    for wrong in (0.0, -0.1, 1.1, np.nan):
        with pytest.raises(CrossviewError, match="chord error"):
            bending_conditions(layout, wrong)
    whole = bending_conditions(layout, 1.0)
    assert max(condition.least for condition in whole) <= 2


def test_features_stay_apart() -> None:
    """Two straight features across a square, much nearer to each other than a quad is long."""

    surface = BUILTIN["square"](n=20)
    y = surface.vertices[surface.edges][:, :, 1]
    near = [(np.abs(y - height) < 1e-9).all(axis=1) for height in (0.0, 0.05)]
    features = Features(surface, np.flatnonzero(near[0] | near[1]))
    field = integrated(surface, features=features)
    layout = run(quad_layout(field))
    conditions = bending_conditions(layout)
    thin = np.abs(layout.tmesh.lengths - layout.tmesh.lengths.min()) < 1e-6
    counts = quantize_to(layout.tmesh, 1, conditions=conditions).counts
    assert (counts[thin] >= 1).all()
    mesh = fill(layout, counts)
    for height in (0.0, 0.05):
        on = np.abs(mesh.vertices[mesh.edges][:, :, 1] - height).max(axis=1) < 1e-9
        ends = mesh.vertices[mesh.edges[on]][:, :, 0]
        assert np.abs(np.diff(ends, axis=1)).sum() == pytest.approx(1.0)


def stretched(places: list[list[float]], valences: list[int]) -> QuadMesh:
    """1 500 quads on an annulus whose sizes span 30 and more along a single arc of its boundary."""
    surface = BUILTIN["annulus"](inner=0.4)
    layout = run(quad_layout(integrated(surface, at_places(surface, places, valences))))
    longest = MAX_SIZE_RATIO * np.sqrt(surface.area / 1500)
    conditions = bending_conditions(layout) + size_conditions(layout, longest)
    chosen = quantize_to(layout.tmesh, 1500, conditions=conditions)
    assert not chosen.missed
    spacing = bent_spacing(layout, chosen.counts)
    assert spacing
    return smooth(fill(layout, chosen.counts, spacing))


def area(mesh: QuadMesh) -> float:
    corners = mesh.vertices[mesh.quads]
    across = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    return float(0.5 * across[:, 2].sum())


def off_circles(mesh: QuadMesh) -> float:
    """Largest distance of a boundary edge's middle from its circle, in radii."""
    edges = mesh.edges[mesh.on_boundary[mesh.edges].all(axis=1)]
    edges = edges[mesh.boundary_loop[edges[:, 0]] == mesh.boundary_loop[edges[:, 1]]]
    middle = np.linalg.norm(mesh.vertices[edges].mean(axis=1), axis=1)
    return float((1 - middle / np.where(middle > 0.7, 1.0, 0.4)).max())


def test_a_boundary_along_which_sizes_differ_much_keeps_its_shape() -> None:
    mesh = stretched([[0.7, 0, 0], [0.75, 0.3, 0], [-0.6, 0, 0], [-0.7, -0.2, 0]], [3, 3, 5, 5])
    assert mesh.scaled_jacobian.min() > 0.5
    assert area(mesh) == pytest.approx(np.pi * 0.84, rel=0.005)
    assert off_circles(mesh) < 0.01


def test_of_the_most_stretched_annulus_little_is_lost_and_nothing_inverted() -> None:
    """In equal shares of the map an edge of 1.34 takes 12 % of the area away."""
    mesh = stretched([[0.8, 0, 0], [-0.6, 0, 0]], [3, 5])
    assert mesh.scaled_jacobian.min() > 0
    assert area(mesh) == pytest.approx(mesh.surface.area, rel=0.005)
    assert off_circles(mesh) < 0.01
    sides = mesh.vertices[mesh.quads]
    lengths = np.linalg.norm(np.roll(sides, -1, axis=1) - sides, axis=2)
    assert (lengths.min(axis=1) > 1e-3 * lengths.max(axis=1)).all()


def test_circles_of_even_sizes_are_in_equal_shares() -> None:
    layout = layout_of("disk with four")
    assert bent_spacing(layout, quantize_to(layout.tmesh, 1500).counts) == {}
