"""Fewer singularities: which are merged, what stays, what is refused."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from solvers.errors import SingularityError
from solvers.features.edges import Features, no_features
from solvers.fields.isotropic import IsotropicSolver
from solvers.fields.merging import Merging
from solvers.primitives import BUILTIN
from solvers.progress import run
from solvers.singularities.budget import Singularity
from solvers.surface import TriSurface
from solvers.validity import ValidityError, fewest_left, simplify

CUBE = [[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]


def eight_and_pairs(surface: TriSurface) -> tuple[Singularity, ...]:
    """On a sphere: the cube's eight, then a near pair of 3 and 5, a farther one and a far one."""
    given = [(place, 3) for place in CUBE]
    for middle, gap in (([0, 0, 1], 0.2), ([0, 1, 0], 0.4), ([1, 0, 0], 0.6)):
        for side, valence in ((-1, 3), (1, 5)):
            off = side * gap / 2 * np.roll(middle, 1)
            given.append((np.add(middle, off).tolist(), valence))
    return tuple(Singularity(surface.closest_point(x), valence) for x, valence in given)


def energy(solver: IsotropicSolver, singularities: Sequence[Singularity]) -> float:
    """1/2 int |grad H|^2."""
    t = solver.discretization.triangulation
    h = solver.log_sizes(singularities)
    along = t.edge_halfedges
    return 0.5 * float(t.weights[along] @ (h[t.head[along]] - h[t.tail[along]]) ** 2)


def test_that_goes_first_which_leaves_the_least_energy() -> None:
    surface = BUILTIN["sphere"](subdivisions=3)
    solver = IsotropicSolver(surface)
    start = eight_and_pairs(surface)
    energies = {}
    for three, five in product((i for i, s in enumerate(start) if s.index > 0), (9, 11, 13)):
        left = tuple(s for i, s in enumerate(start) if i not in (three, five))
        energies[left] = energy(solver, left)
    assert run(simplify(surface, start, 12)).singularities == min(
        energies, key=energies.__getitem__
    )


def test_what_is_too_much_goes() -> None:
    surface = BUILTIN["sphere"](subdivisions=3)
    start = eight_and_pairs(surface)
    assert run(simplify(surface, start, 8)).singularities == start[:8]
    assert run(simplify(surface, start, 14)).singularities == start


def test_what_is_left_is_valid() -> None:
    surface = BUILTIN["torus"](n=32)
    x = surface.vertices[:: surface.n_vertices // 8][:8]
    valences = (3, 5, 5, 3, 6, 3, 3, 4)
    start = [Singularity(surface.closest_point(p), v) for p, v in zip(x, valences, strict=True)]
    for most in (5, 4):
        end = run(simplify(surface, start, most))
        assert 0 < len(end.singularities) <= most
        assert sum(s.index for s in end.singularities) == 0
        assert np.abs(end.defects).max() < np.radians(1e-6)
    with pytest.raises(ValidityError, match="never valid: no quadrangulation of a torus"):
        run(simplify(surface, start, 2))
    assert run(simplify(surface, start, 0)).singularities == ()


def test_what_is_locked_stays_what_and_where_it_is() -> None:
    surface = BUILTIN["sphere"](subdivisions=3)
    start = list(eight_and_pairs(surface))
    start[13] = replace(start[13], locked=True)  # one of the pair that goes first
    end = run(simplify(surface, start, 12))
    assert start[13] in end.singularities
    assert len(end.singularities) == 12
    locked = [replace(s, locked=True) for s in start]
    with pytest.raises(SingularityError, match=r"no fewer than 14 .* those locked"):
        run(simplify(surface, locked, 12))


def test_none_are_merged_across_features() -> None:
    surface = BUILTIN["square"](n=20)
    x = surface.vertices[surface.edges, 0]
    wall = Features(surface, np.flatnonzero((np.abs(x) < 1e-9).all(axis=1)))
    pair = [Singularity(surface.closest_point([side * 0.05, 0, 0]), 4 + side) for side in (-1, 1)]
    assert run(simplify(surface, pair, 0)).singularities == ()
    with pytest.raises(SingularityError, match=r"no fewer than 2 .* between features"):
        run(simplify(surface, pair, 0, features=wall))


def test_no_fewer_than_the_index_budget_and_the_valences_allow() -> None:
    surface = BUILTIN["sphere"](subdivisions=3)
    start = [Singularity(surface.closest_point(x), 3) for x in CUBE]
    with pytest.raises(SingularityError, match="no fewer than 8 singularities can be left, 7 are"):
        run(simplify(surface, start, 7))
    with pytest.raises(SingularityError, match="index budget"):
        run(simplify(surface, start[1:], 7))
    fives = [*start, *(Singularity(surface.closest_point(x), 3) for x in ([0, 0, 1], [0, 0, -1]))]
    far = [Singularity(surface.closest_point(x), 5) for x in ([1, 0.1, 0], [1, -0.1, 0])]
    with pytest.raises(SingularityError, match="no fewer than 8"):
        run(simplify(surface, [*fives, *far], 7))


def test_turning_and_renumbering_change_nothing() -> None:
    surface = BUILTIN["sphere"](subdivisions=3)
    start = eight_and_pairs(surface)
    turn = Rotation.from_rotvec([0.3, 1.2, -0.4])
    order = np.random.default_rng(0).permutation(surface.n_faces)
    other = TriSurface(7 * turn.apply(surface.vertices.copy()), surface.faces[order])
    there = [
        replace(
            s, point=other.point(int(np.flatnonzero(order == s.point.face)[0]), s.point.barycentric)
        )
        for s in reversed(start)
    ]
    one, two = run(simplify(surface, start, 10)), run(simplify(other, there, 10))
    kept = [start.index(s) for s in one.singularities]
    assert [len(start) - 1 - there.index(s) for s in two.singularities] == kept[::-1]


@pytest.mark.parametrize("seed", range(12))
def test_no_fewer_are_left_than_indices_allow(seed: int) -> None:
    surface = BUILTIN["sphere"](subdivisions=3)
    chance = np.random.default_rng(seed)
    count = int(chance.integers(4, 30))
    vertices = chance.choice(surface.n_vertices, count, replace=False)
    valences = chance.choice([2, 3, 3, 3, 5, 5, 5, 6, 8], count)
    placed = [
        Singularity(surface.point_at_vertex(v), n, locked=bool(chance.random() < 0.2))
        for v, n in zip(vertices.tolist(), valences.tolist(), strict=True)
    ]
    free = np.array([not s.locked for s in placed])
    merging = Merging(IsotropicSolver(surface), placed)
    merging.reduce(free[:, None] & free, 0, 8)
    fewest = fewest_left(placed, no_features(surface))
    assert fewest <= len(merging)


def test_of_valence_3_alone_as_many_are_left_as_they_must() -> None:
    surface = BUILTIN["sphere"](subdivisions=3)
    start = eight_and_pairs(surface)
    assert fewest_left(start, no_features(surface)) == 8
    assert len(run(simplify(surface, start, 8)).singularities) == 8
    with pytest.raises(SingularityError, match="no fewer than 8"):
        run(simplify(surface, start, 7))
