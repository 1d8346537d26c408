"""The turns of a field between the boundaries of an annulus, against what topology allows."""

from itertools import product

import numpy as np
import pytest

from solvers.features import Features
from solvers.fields.aligned import AlignedField, aligned_field
from solvers.fields.integrable import anisotropic_field
from solvers.fields.pieces import Piece, field_existence, pieces
from solvers.fields.prepared import prepare
from solvers.fields.turning import holonomy_class, paired
from solvers.fields.verdict import judge
from solvers.maps.folds import with_possible_turns
from solvers.maps.seamless import seamless_map
from solvers.primitives import annulus, cylinder, torus
from solvers.progress import run
from solvers.singularities.budget import Singularity
from solvers.singularities.decision import existence
from solvers.singularities.remedies import ChangeTurns
from solvers.singularities.theorems import ANNULUS_TURNS, SPIN, TORUS_TURNS
from solvers.surface.trisurface import TriSurface
from tests.solvers.suite import SURFACES, random_configuration

STAIRS = [[], [1, 1, -1, -1], [1, -1, -1, 1], [-1, -1, 1, 1]]


def cornered(surface: TriSurface, *given: list[int], shift: int = 3) -> dict[int, int]:
    """Corners evenly around both boundaries."""
    found: dict[int, int] = {}
    for loop, indices in zip(surface.boundary_loops, given, strict=True):
        places = (shift + np.arange(len(indices)) * len(loop) // max(len(indices), 1)) % len(loop)
        found |= dict(zip(loop[places].tolist(), indices, strict=True))
    return found


def field_with(surface: TriSurface, corners: dict[int, int], turns: int) -> AlignedField:
    return aligned_field(prepare(surface, corners=corners), [turns])


@pytest.mark.parametrize("outer", STAIRS)
@pytest.mark.parametrize("inner", [[], [1, -1]])
def test_the_turns_nearest_to_the_isotropic_field_are_possible(
    outer: list[int], inner: list[int]
) -> None:
    """For its own have the mean zero."""
    surface = annulus(n=72)
    for shift in (0, 3, 7):
        corners = cornered(surface, outer, inner, shift=shift)
        if not outer and inner:
            assert existence(surface, [], corners).answer == "impossible"
            continue
        aligned = field_with(surface, corners, 0)
        turns = holonomy_class(aligned)
        assert existence(surface, [], corners, turns).answer == "possible"
        assert holonomy_class(field_with(surface, corners, 2)) == (turns[0] + 2,)


def test_a_field_whose_turns_part_the_boundaries_is_impossible_and_mended() -> None:
    surface = annulus(n=72)
    corners = cornered(surface, [1, 1, -1, -1], [])
    for turns in (-1, 1):
        aligned = field_with(surface, corners, turns)
        solved = run(anisotropic_field(aligned))
        verdict = judge(solved.field, 0, known=field_existence(aligned))
        assert verdict.theorem is ANNULUS_TURNS
        assert len(seamless_map(solved).inverted)
        change = verdict.remedies[0]
        assert isinstance(change, ChangeTurns)
        assert change.by == (-turns,)


def test_the_possible_turns_have_an_injective_map() -> None:
    surface = annulus(n=72)
    aligned = field_with(surface, cornered(surface, [1, 1, -1, -1], []), 0)
    solved = run(anisotropic_field(aligned))
    assert solved.field.energy < 1e-8
    assert not len(seamless_map(solved).inverted)


@pytest.mark.parametrize("name", ["torus", "double_torus", "torus_with_hole", "plate"])
def test_turns_over_each_condition_count_one_by_one(name: str) -> None:
    surface = SURFACES[name]()
    prepared = prepare(surface, random_configuration(surface, seed=3), refine=0)
    first = aligned_field(prepared)
    own = np.array(holonomy_class(first))
    for number, row in enumerate(np.eye(len(own), dtype=int)):
        turned = aligned_field(prepared, row.tolist(), like=first.isotropic)
        assert holonomy_class(turned) == tuple(own + row), number


def test_two_singularities_half_a_period_apart_turn_by_odd_turns_around_a_handle() -> None:
    """Those of indices 2 and -2 there have an isotropic field; with even turns they have none."""
    surface = torus(n=36)
    places = [surface.closest_point([1.4, 0.0, 0.0]), surface.closest_point([-1.4, 0.0, 0.0])]
    placed = [Singularity(p, n) for p, n in zip(places, (2, 6), strict=True)]
    prepared = prepare(surface, placed)
    nearest = aligned_field(prepared)
    assert np.abs(nearest.isotropic.defects).max() < 1e-6
    turns = holonomy_class(nearest)
    assert any(n % 2 for n in turns)
    assert field_existence(nearest).theorem is None
    even = aligned_field(prepared, [n % 2 for n in turns])
    assert field_existence(even).theorem is TORUS_TURNS
    assert holonomy_class(with_possible_turns(even)) == turns


def test_the_spin_of_whole_turns_depends_on_no_choice_of_loops() -> None:
    """One loop is joined to another, again and again."""
    rng = np.random.default_rng(1)
    for turns in product((0, 4), repeat=4):
        odd = np.array(turns) // 4 + 1
        spin = (odd[0] * odd[1] + odd[2] * odd[3]) % 2
        cross = np.array([[0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 0, 1], [0, 0, -1, 0]])
        for _ in range(6):
            a, b, c, d = (n // 4 + 1 for n in paired((4 * (odd + 1)).tolist(), cross.tolist()))
            assert (a * b + c * d) % 2 == spin
            i, j = rng.choice(4, 2, replace=False)
            odd[i] += odd[j] + cross[i, j]
            cross[i] += cross[j]
            cross[:, i] += cross[:, j]


def strip(surface: TriSurface, *heights: float) -> Features:
    height = surface.vertices[surface.edges][:, :, 2]
    at = [np.isclose(height, h).all(axis=1) for h in heights]
    return Features(surface, np.flatnonzero(np.logical_or.reduce(at)))


def test_each_piece_between_features_is_told_by_what_it_has() -> None:
    surface = cylinder(n=32)
    features = strip(surface, -0.5, 0.5)
    assert len(features.curves) == 2
    found = list(pieces(aligned_field(prepare(surface, features=features))))
    assert found == [Piece(0, ((), ()), ())] * 3
    pair = [surface.closest_point([x, 0.0, 0.0]) for x in (1.0, -1.0)]
    placed = [Singularity(p, n) for p, n in zip(pair, (3, 5), strict=True)]
    aligned = aligned_field(prepare(surface, placed, features=features))
    inside = [sorted(piece.indices) for piece in pieces(aligned) if piece.indices]
    assert inside == [[-1, 1]]
    for piece in pieces(aligned):
        n_loops = len(piece.corners)
        total = sum(piece.indices) + sum(map(sum, piece.corners))
        assert total == 4 * (2 - 2 * piece.genus - n_loops)


def test_crossings_of_the_loops_of_a_double_torus_make_pairs() -> None:
    """Asked for whole turns, the field has them; of a valence 12 alone half of them, by spin."""
    surface = SURFACES["double_torus"]()
    vertex = int(np.flatnonzero(~surface.boundary_vertices)[7])
    prepared = prepare(surface, [Singularity(surface.point_at_vertex(vertex), 12)], refine=0)
    first = aligned_field(prepared)
    own = -np.array(holonomy_class(first))
    spins = []
    for more in product((0, 4), repeat=4):
        turned = aligned_field(prepared, (own + more).tolist(), like=first.isotropic)
        turns = holonomy_class(turned)
        assert set(turns) <= {0, 4}
        spins.append(field_existence(turned).theorem is SPIN)
    assert sum(spins) == 10  # of 16 quadratic forms in four variables as many are even
